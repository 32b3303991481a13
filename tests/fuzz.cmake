# Readers of files that strangers make. The corpus once through each of them, in any build.
us_test(corpus_test SOURCES tests/fuzz/corpus_test.cpp tests/fuzz/readers.cpp app/cli/report_rows.cpp
  LIBS understudy_studio understudy_run understudy_motion understudy_body understudy_data_folder understudy_npz
  understudy_nn_core LABELS fast)

# libFuzzer under AddressSanitizer, objects of its own (clang only; .ci/run builds and runs it):
#   cmake -G Ninja -B build-fuzz -DUNDERSTUDY_FUZZ=ON -DCMAKE_CXX_COMPILER=clang++
#   ninja -C build-fuzz fuzz_readers && build-fuzz/fuzz_readers --reader=ply -max_total_time=3600 NEW tests/fuzz/corpus/ply
# What it finds is mended and goes into the corpus. FBX and DAE are not fuzzed: assimp reads them in a process of its own,
# which may crash; what that process answers is (worker_words, and its GLB as every other: gltf).
option(UNDERSTUDY_FUZZ "build the fuzzer of the readers" OFF)
if(NOT UNDERSTUDY_FUZZ)
  return()
endif()

add_executable(fuzz_readers tests/fuzz/fuzz_readers.cpp tests/fuzz/readers.cpp
  retarget/base/log.cpp retarget/geometry/mesh.cpp retarget/math/rotation.cpp retarget/skeleton/skeleton.cpp
  retarget/formats/bytes.cpp retarget/formats/gltf_file.cpp retarget/formats/gltf_mesh.cpp
  retarget/formats/mesh_reader.cpp retarget/formats/npz.cpp retarget/formats/obj.cpp retarget/formats/off.cpp
  retarget/formats/pcd.cpp retarget/formats/ply.cpp retarget/formats/scan_array.cpp
  retarget/formats/scan_follow.cpp retarget/formats/scan_source.cpp retarget/formats/stl.cpp
  retarget/formats/xyz.cpp
  retarget/formats/part_file.cpp retarget/formats/import.cpp
  retarget/body/body.cpp retarget/body/data_folder.cpp retarget/skeleton/skinning.cpp
  retarget/nn/weights_layout.cpp retarget/pipeline/human_rest.cpp
  retarget/character/bone_choices.cpp retarget/character/bone_map.cpp retarget/character/character.cpp
  retarget/character/gltf_character.cpp retarget/character/obj_character.cpp retarget/character/picture.cpp
  retarget/character/pixels.cpp retarget/character/vertex_colors.cpp retarget/character/import_process.cpp
  retarget/character/read_character.cpp
  retarget/motion/amass_motion.cpp retarget/motion/bvh.cpp retarget/motion/read_motion.cpp
  app/cli/report_rows.cpp app/run/case_folder.cpp app/session/settings.cpp
  app/session/commands.cpp app/session/document.cpp app/session/document_file.cpp
  app/session/document_json.cpp app/session/whole_file.cpp app/studio/event_text.cpp app/studio/key_chord.cpp
  render/context/input_event.cpp)
target_compile_options(fuzz_readers PRIVATE -O1 -g1 -fsanitize=fuzzer-no-link,address -fno-omit-frame-pointer)
target_link_options(fuzz_readers PRIVATE -fsanitize=fuzzer,address -Wl,--gc-sections)
target_include_directories(fuzz_readers PRIVATE ${PROJECT_SOURCE_DIR})
target_link_libraries(fuzz_readers PRIVATE warnings Eigen3::Eigen nlohmann_json::nlohmann_json
  PkgConfig::LIBWEBP PkgConfig::LIBZIP Threads::Threads)

file(GLOB corpora RELATIVE ${PROJECT_SOURCE_DIR}/tests/fuzz/corpus ${PROJECT_SOURCE_DIR}/tests/fuzz/corpus/*)
foreach(reader ${corpora})
  set(found ${PROJECT_BINARY_DIR}/fuzz/${reader})
  file(MAKE_DIRECTORY ${found})
  add_test(NAME fuzz_${reader} COMMAND fuzz_readers --reader=${reader} -seed=1 -runs=5000 -timeout=10
    -rss_limit_mb=3000 -artifact_prefix=${found}/found- ${found} ${PROJECT_SOURCE_DIR}/tests/fuzz/corpus/${reader})
  set_tests_properties(fuzz_${reader} PROPERTIES LABELS fuzz TIMEOUT 120)
endforeach()
