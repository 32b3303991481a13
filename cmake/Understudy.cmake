# How a folder becomes a library, and a folder of tests a program. Each finds the sources of its folder by itself, so a
# new file is written down nowhere; CONFIGURE_DEPENDS makes the next build look again.

# Ours are compiled with these; under STRICT a warning is an error. Others' headers are system headers: no warnings.
add_library(warnings INTERFACE)
target_compile_options(warnings INTERFACE -Wall -Wextra -Wshadow $<$<BOOL:${STRICT}>:-Werror>)

# us_precompiled(NAME LIBS ... HEADERS ...): others' headers as one precompiled header; us_reads(TARGET NAME) gives it to
# a target. g++ gains nothing by it and goes without: so it notices what a source forgets to include.
function(us_precompiled name)
  cmake_parse_arguments(P "" "" "LIBS;HEADERS" ${ARGN})
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/${name}.cpp CONTENT "")  # untouched where it is there
  add_library(${name} OBJECT ${PROJECT_BINARY_DIR}/${name}.cpp)
  target_precompile_headers(${name} PRIVATE ${P_HEADERS})
  target_link_libraries(${name} PRIVATE warnings ${P_LIBS})
endfunction()
function(us_reads target name)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    return()
  endif()
  target_precompile_headers(${target} REUSE_FROM ${name})
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "EXECUTABLE")  # -fPIE would not fit the precompiled header, which is -fPIC
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
    target_compile_options(${target} PRIVATE -fPIC)
  endif()
endfunction()

# us_torch(TARGET): its sources may include LibTorch.
function(us_torch target)
  target_link_libraries(${target} PRIVATE torch_headers)
  us_reads(${target} torch_pch)
endfunction()

# us_module(NAME [TORCH] [PUBLIC ...] [PRIVATE ...]): the current folder, those inside it too, as the static library
# understudy_NAME. TORCH: its sources may include torch headers; LibTorch stays PRIVATE.
function(us_module name)
  cmake_parse_arguments(M "TORCH" "" "PUBLIC;PRIVATE" ${ARGN})
  set(target understudy_${name})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS *.cpp)
  add_library(${target} STATIC ${sources})
  target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(${target} PUBLIC Eigen3::Eigen ${M_PUBLIC} PRIVATE warnings ${M_PRIVATE})
  if(M_TORCH)
    us_torch(${target})
  endif()
endfunction()

# us_test_helpers(NAME FOLDER [TORCH] [PUBLIC ...]): the sources of a folder of tests that are no tests themselves, as
# the static library NAME_support. It links nothing of ours but PUBLIC: the test says which libraries it uses.
function(us_test_helpers name folder)
  cmake_parse_arguments(H "TORCH" "" "PUBLIC" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.cpp)
  if(NOT folder MATCHES "support$")
    list(FILTER sources EXCLUDE REGEX "_test\\.cpp$")
  endif()
  if(NOT sources)
    return()
  endif()
  add_library(${name}_support STATIC ${sources})
  us_test_settings(${name}_support)
  target_link_libraries(${name}_support PUBLIC Eigen3::Eigen GTest::gtest nlohmann_json::nlohmann_json ${H_PUBLIC})
  if(H_TORCH)
    us_torch(${name}_support)
  else()
    us_reads(${name}_support test_pch)
  endif()
endfunction()

function(us_test_settings target)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${target} PRIVATE warnings)
  target_compile_definitions(${target} PRIVATE US_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
    US_PROGRAM="$<TARGET_FILE_DIR:understudy>/understudy" US_INTEROP_PACKAGES="${PROJECT_BINARY_DIR}/interop")
endfunction()

# us_tests(NAME FOLDER [EACH] [TORCH|LIGHT] [TIMEOUT SECONDS] LABELS ... LIBS ...): the *_test.cpp of a folder as one
# program, build/tests/NAME_test, and one entry of ctest. EACH: one program a file, named after it: for tests that run
# long, so that they run side by side. LIGHT: they compute little themselves and are compiled without optimisation, in a
# third of the time. NAME_support, if the folder has helpers, is linked unasked.
function(us_tests name folder)
  cmake_parse_arguments(T "EACH;TORCH;LIGHT" "TIMEOUT" "LIBS;LABELS" ${ARGN})
  us_test_helpers(${name} ${folder} ${ARGN})
  if(TARGET ${name}_support)
    list(PREPEND T_LIBS ${name}_support)
  endif()
  if(NOT T_TIMEOUT)
    set(T_TIMEOUT 900)  # sanitizers on a busy machine included
  endif()
  file(GLOB sources CONFIGURE_DEPENDS ${folder}/*_test.cpp)
  foreach(source ${sources})
    set(program ${name}_test)
    if(T_EACH)
      cmake_path(GET source STEM program)
    endif()
    if(TARGET ${program})
      target_sources(${program} PRIVATE ${source})
      continue()
    endif()
    add_executable(${program} ${source})
    us_test_settings(${program})
    target_link_libraries(${program} PRIVATE GTest::gtest_main ${T_LIBS})
    set_target_properties(${program} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
    if(T_TORCH)
      us_torch(${program})
    elseif(T_LIGHT AND CMAKE_BUILD_TYPE STREQUAL "Release")  # sanitizers are slow enough
      target_compile_options(${program} PRIVATE -O0)
      us_reads(${program} light_test_pch)
    else()
      us_reads(${program} test_pch)
    endif()
    foreach(label ${T_LABELS})
      if(TARGET ${label}_tests)
        add_dependencies(${label}_tests ${program})
      endif()
    endforeach()
    add_test(NAME ${program} COMMAND ${program})
    set_tests_properties(${program} PROPERTIES TIMEOUT ${T_TIMEOUT} LABELS "${T_LABELS}"
      ENVIRONMENT "OMP_NUM_THREADS=1;OMP_WAIT_POLICY=PASSIVE")
  endforeach()
endfunction()
