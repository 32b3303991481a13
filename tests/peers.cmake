us_test(peers_test SOURCES tests/retarget/peers/body_fit_test.cpp LIBS understudy_peers understudy_builtin LABELS fast)
