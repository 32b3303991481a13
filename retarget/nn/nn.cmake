us_module(nn_core SOURCES nn/scan_patches.cpp PUBLIC understudy_core)
us_module(nn TORCH SOURCES
  nn/weights_file.cpp nn/skeleton_form.cpp nn/modules/skeleton_extractor.cpp
  nn/network_deformer.cpp nn/modules/deformation.cpp
  PUBLIC understudy_nn_core PRIVATE nlohmann_json::nlohmann_json)
