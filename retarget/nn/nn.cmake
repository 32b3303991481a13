us_module(nn_core SOURCES nn/scan_patches.cpp nn/part_crops.cpp nn/weights_layout.cpp
  PUBLIC understudy_core PRIVATE nlohmann_json::nlohmann_json)
us_module(nn TORCH SOURCES
  nn/weights_file.cpp nn/skeleton_form.cpp nn/modules/skeleton_extractor.cpp nn/modules/point_transformer.cpp
  nn/extractor_input.cpp nn/network_extractor.cpp nn/part_refiner.cpp nn/modules/part_refiner.cpp
  nn/network_deformer.cpp nn/modules/deformation.cpp
  nn/paper_transfer.cpp nn/modules/motion_gru.cpp nn/modules/forward_kinematics.cpp
  nn/modules/joint_tensors.cpp
  PUBLIC understudy_nn_core understudy_pipeline PRIVATE nlohmann_json::nlohmann_json)

# The way to the networks without LibTorch (nn/networks.hpp); the plug-in itself is built by nn/plugin.cmake.
us_module(networks SOURCES nn/networks.cpp PUBLIC understudy_core PRIVATE ${CMAKE_DL_LIBS} Threads::Threads)
