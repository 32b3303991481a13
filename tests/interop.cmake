# What we export, read back by programs that are not ours. ./test puts their npm packages into build/interop.
set(interop_sources tests/interop/exported.cpp tests/interop/outside_programs.cpp
  tests/retarget/character/characters.cpp tests/app/program.cpp)
us_test(interop_test SOURCES ${interop_sources}
  tests/interop/assimp_test.cpp tests/interop/round_trip_test.cpp tests/interop/three_test.cpp
  tests/interop/validator_test.cpp
  LIBS understudy_character nlohmann_json::nlohmann_json ${ASSIMP_LIBRARY} LABELS interop TIMEOUT 600)
us_test(interop_program_test SOURCES ${interop_sources} tests/interop/program_test.cpp tests/app/sample_files.cpp
  LIBS understudy_character understudy_builtin nlohmann_json::nlohmann_json ${ASSIMP_LIBRARY}
  LABELS torch interop TIMEOUT 600)
add_dependencies(interop_program_test understudy_all)
us_test(blender_test SOURCES ${interop_sources} tests/interop/blender_test.cpp
  LIBS understudy_run understudy_character nlohmann_json::nlohmann_json LABELS blender TIMEOUT 600)
foreach(test interop_test interop_program_test blender_test)
  target_compile_definitions(${test} PRIVATE US_INTEROP_PACKAGES="${PROJECT_BINARY_DIR}/interop")
endforeach()

# Blender is large and slow to start: a test for whoever asks for it with -DUNDERSTUDY_BLENDER=/usr/bin/blender.
set(UNDERSTUDY_BLENDER "" CACHE FILEPATH "Blender, to test that it plays what we export")
if(UNDERSTUDY_BLENDER)
  set_property(TEST blender_test APPEND PROPERTY ENVIRONMENT "UNDERSTUDY_BLENDER=${UNDERSTUDY_BLENDER}")
else()
  set_tests_properties(blender_test PROPERTIES DISABLED TRUE)
endif()
