# Others' ways to do the main job, to compare with.
us_module(baselines SOURCES baselines/body_fit.cpp PUBLIC understudy_body understudy_pipeline)
