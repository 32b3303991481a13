us_module(metrics SOURCES metrics/joint_metrics.cpp metrics/surface_metrics.cpp metrics/inside.cpp metrics/windings.cpp
  metrics/failures.cpp metrics/confidence.cpp metrics/hand_contact.cpp metrics/bent_volume.cpp
  PUBLIC understudy_core)
