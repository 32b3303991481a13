us_test(nn_deformation_test TORCH SOURCES
  tests/retarget/nn/deformation_module_test.cpp tests/retarget/nn/deformation_deformer_test.cpp
  tests/retarget/nn/deformation_training_test.cpp tests/retarget/nn/deformation_support.cpp
  LIBS understudy_training understudy_nn understudy_npz LABELS torch TIMEOUT 300)
us_test(large_binding_test SOURCES tests/retarget/nn/large_binding_test.cpp
  LIBS understudy_character understudy_nn understudy_builtin LABELS torch)
