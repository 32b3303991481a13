us_test(binding_test SOURCES tests/retarget/character/binding_test.cpp LIBS understudy_character LABELS fast)
