us_test(scan_patches_test SOURCES tests/retarget/nn/scan_patches_test.cpp tests/retarget/nn/part_crops_test.cpp
  LIBS understudy_pipeline understudy_nn_core LABELS fast)
us_test(skeleton_extractor_test TORCH TIMEOUT 300
  SOURCES tests/retarget/nn/skeleton_extractor_test.cpp tests/retarget/nn/weights_file_test.cpp
          tests/retarget/training/skeleton_training_test.cpp tests/support/training_folder.cpp
  LIBS understudy_training understudy_nn understudy_body understudy_npz LABELS torch)
us_test(part_test TORCH TIMEOUT 300
  SOURCES tests/retarget/nn/part_refiner_test.cpp tests/retarget/training/part_training_test.cpp
          tests/support/training_folder.cpp
  LIBS understudy_training understudy_nn understudy_pipeline understudy_body understudy_npz LABELS torch)
