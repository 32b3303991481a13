us_test(character_test SOURCES
  tests/retarget/character/characters.cpp tests/retarget/character/bone_map_test.cpp
  tests/retarget/character/character_file_test.cpp tests/retarget/character/character_export_test.cpp
  tests/retarget/character/odd_shapes_test.cpp tests/retarget/character/painted_skin_test.cpp
  LIBS understudy_character nlohmann_json::nlohmann_json LABELS fast)
add_dependencies(character_test understudy)  # its import worker

us_test(export_command_test SOURCES
  tests/retarget/character/export_command_test.cpp tests/retarget/character/characters.cpp
  tests/app/program.cpp tests/app/sample_files.cpp
  LIBS understudy_character understudy_builtin nlohmann_json::nlohmann_json LABELS torch gl TIMEOUT 600)
add_dependencies(export_command_test understudy_all)

us_test(vertex_colors_test SOURCES tests/retarget/character/vertex_colors_test.cpp
  LIBS understudy_character PkgConfig::LIBWEBP LABELS fast)
