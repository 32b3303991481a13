us_module(pipeline SOURCES
  pipeline/human_rest.cpp pipeline/confidence.cpp pipeline/copy_transfer.cpp pipeline/joint_filter.cpp pipeline/root_path.cpp
  pipeline/foot_lock.cpp pipeline/body_girth.cpp pipeline/hand_contacts.cpp pipeline/person_check.cpp pipeline/target.cpp pipeline/retargeter.cpp
  PUBLIC understudy_core)
