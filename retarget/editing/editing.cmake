us_module(editing SOURCES
  editing/point_grid.cpp editing/scan_edits.cpp editing/skeleton_edits.cpp editing/pose_edits.cpp
  editing/foot_pins.cpp editing/target_edits.cpp
  PUBLIC understudy_pipeline)
