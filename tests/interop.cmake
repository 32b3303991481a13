# What we export, read back by programs that are not ours. ./test puts their npm packages into build/interop.
us_test(interop_test SOURCES
  tests/interop/assimp_test.cpp tests/interop/exported.cpp tests/interop/outside_programs.cpp
  tests/interop/three_test.cpp tests/interop/validator_test.cpp
  tests/retarget/character/characters.cpp tests/app/program.cpp
  LIBS understudy_character nlohmann_json::nlohmann_json ${ASSIMP_LIBRARY} LABELS interop TIMEOUT 300)
target_compile_definitions(interop_test PRIVATE US_INTEROP_PACKAGES="${PROJECT_BINARY_DIR}/interop")
