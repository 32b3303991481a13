us_test(baselines_test SOURCES tests/retarget/baselines/body_fit_test.cpp LIBS understudy_baselines understudy_builtin LABELS fast)
