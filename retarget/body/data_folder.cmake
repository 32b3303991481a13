us_module(occlusions SOURCES body/labelled_points.cpp body/costume.cpp body/partial_view.cpp PUBLIC understudy_core)
us_module(data_folder SOURCES body/data_folder.cpp body/exact_body.cpp base/numpy_random.cpp
  PUBLIC understudy_body PRIVATE understudy_npz nlohmann_json::nlohmann_json)
