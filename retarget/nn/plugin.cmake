# All that needs LibTorch, loaded at run time by understudy_networks.
add_library(networks_plugin MODULE nn/plugin.cpp)
set_target_properties(networks_plugin PROPERTIES OUTPUT_NAME understudy_networks
  LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
target_link_libraries(networks_plugin PRIVATE warnings understudy_training understudy_nn understudy_pipeline ${CMAKE_DL_LIBS})
us_torch(networks_plugin)
