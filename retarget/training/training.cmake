us_module(training_data SOURCES training/training_data.cpp training/scan_maker.cpp
  PUBLIC understudy_data_folder understudy_occlusions understudy_nn_core)
us_module(training TORCH SOURCES
  training/skeleton_loss.cpp training/skeleton_batch.cpp training/scan_streams.cpp training/skeleton_trainer.cpp
  training/deformation_losses.cpp training/deformation_data.cpp training/deformation_step.cpp training/deformation_trainer.cpp
  training/losses/motion_losses.cpp training/motion_discriminator.cpp training/motion_data.cpp training/motion_evaluator.cpp
  training/motion_trainer.cpp training/motion_training.cpp
  training/part_data.cpp training/part_trainer.cpp
  PUBLIC understudy_training_data understudy_nn)
