us_test(nn_motion_test TORCH TIMEOUT 300 SOURCES
  tests/retarget/nn/motion_modules_test.cpp tests/retarget/nn/motion_losses_test.cpp
  tests/retarget/nn/motion_training_test.cpp tests/retarget/nn/motion_transfer_test.cpp
  tests/retarget/nn/motion_support.cpp tests/support/training_folder.cpp
  LIBS understudy_training understudy_nn understudy_baselines understudy_body understudy_npz LABELS torch)
