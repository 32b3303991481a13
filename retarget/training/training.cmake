us_module(training_data SOURCES training/training_data.cpp training/scan_maker.cpp
  PUBLIC understudy_body understudy_nn_core PRIVATE understudy_npz nlohmann_json::nlohmann_json)
us_module(training TORCH SOURCES
  training/skeleton_loss.cpp training/skeleton_batch.cpp training/skeleton_trainer.cpp
  training/deformation_losses.cpp training/deformation_data.cpp training/deformation_step.cpp training/deformation_trainer.cpp
  PUBLIC understudy_training_data understudy_nn)
