# us_module(NAME [TORCH] SOURCES ... [PUBLIC ...] [PRIVATE ...]): one folder, one static library understudy_NAME.
# TORCH: its sources may include torch headers; LibTorch stays PRIVATE and comes by one shared precompiled header.
add_library(warnings INTERFACE)
target_compile_options(warnings INTERFACE -Wall -Wextra -Wshadow $<$<BOOL:${STRICT}>:-Werror>)

function(us_torch target)
  target_link_libraries(${target} PRIVATE torch_headers)
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "EXECUTABLE")  # -fPIE would not fit the precompiled header, which is -fPIC
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
    target_compile_options(${target} PRIVATE -fPIC)
  endif()
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT target STREQUAL "torch_pch")
    target_precompile_headers(${target} REUSE_FROM torch_pch)
  endif()
endfunction()

function(us_module name)
  cmake_parse_arguments(M "TORCH" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(target understudy_${name})
  add_library(${target} STATIC ${M_SOURCES})
  target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(${target} PUBLIC Eigen3::Eigen ${M_PUBLIC} PRIVATE warnings ${M_PRIVATE})
  if(M_TORCH)
    us_torch(${target})
  endif()
endfunction()

# us_test(NAME [TORCH] [LABELS ...] SOURCES ... LIBS ...): one gtest binary, tests/NAME.
# LibTorch binaries are one ctest entry each: every process would pay LibTorch's start-up.
function(us_test name)
  cmake_parse_arguments(T "TORCH" "TIMEOUT" "SOURCES;LIBS;LABELS" ${ARGN})
  add_executable(${name} ${T_SOURCES})
  target_link_libraries(${name} PRIVATE warnings GTest::gtest_main ${T_LIBS})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_definitions(${name} PRIVATE US_TEST_DATA="${PROJECT_SOURCE_DIR}/tests/data"
    US_SOURCE_DIR="${PROJECT_SOURCE_DIR}" US_PROGRAM="$<TARGET_FILE_DIR:understudy>/understudy")
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
  if(T_TORCH)
    us_torch(${name})
  endif()
  if(NOT T_TIMEOUT)
    set(T_TIMEOUT 120)
  endif()
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES TIMEOUT ${T_TIMEOUT} LABELS "${T_LABELS}"
    ENVIRONMENT "OMP_NUM_THREADS=1;OMP_WAIT_POLICY=PASSIVE")
endfunction()
