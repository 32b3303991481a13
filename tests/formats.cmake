us_test(formats_test SOURCES
  tests/retarget/formats/mesh_reader_test.cpp tests/retarget/formats/gltf_mesh_test.cpp
  tests/retarget/formats/scan_source_test.cpp tests/retarget/formats/import_test.cpp
  tests/retarget/formats/fuzz_test.cpp
  LIBS understudy_formats understudy_npz LABELS fast)
us_test(motion_writers_test SOURCES tests/retarget/formats/motion_writers_test.cpp
  LIBS understudy_results understudy_motion understudy_body understudy_npz understudy_pipeline LABELS fast)
