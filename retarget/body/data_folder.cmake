us_module(data_folder SOURCES body/data_folder.cpp body/exact_body.cpp base/numpy_random.cpp
  PUBLIC understudy_body PRIVATE understudy_npz nlohmann_json::nlohmann_json)
