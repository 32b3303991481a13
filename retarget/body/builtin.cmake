us_module(builtin SOURCES
  body/builtin_surface.cpp body/builtin_shape.cpp body/builtin_person.cpp
  body/builtin_body_plan.cpp body/builtin_motion.cpp body/capture.cpp body/builtin_samples.cpp
  PUBLIC understudy_core)
