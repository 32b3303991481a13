us_test(formats_test SOURCES
  tests/retarget/formats/mesh_reader_test.cpp tests/retarget/formats/gltf_mesh_test.cpp
  tests/retarget/formats/scan_source_test.cpp tests/retarget/formats/import_test.cpp
  tests/retarget/formats/fuzz_test.cpp
  LIBS understudy_formats understudy_npz LABELS fast)
