us_module(motion SOURCES
  motion/amass_motion.cpp motion/bone_shapes.cpp motion/bvh.cpp motion/clip.cpp motion/moving_surface.cpp
  motion/read_motion.cpp motion/skeletal_motion.cpp
  PUBLIC understudy_character PRIVATE understudy_body understudy_npz)
