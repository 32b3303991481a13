us_test(motion_test SOURCES
  tests/retarget/motion/bvh_test.cpp tests/retarget/motion/skeletal_motion_test.cpp
  tests/retarget/motion/made_motion.cpp tests/retarget/character/characters.cpp
  LIBS understudy_motion understudy_npz LABELS fast)
