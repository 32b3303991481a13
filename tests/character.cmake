us_test(character_test SOURCES
  tests/retarget/character/characters.cpp tests/retarget/character/bone_map_test.cpp
  tests/retarget/character/character_file_test.cpp tests/retarget/character/character_export_test.cpp
  LIBS understudy_character nlohmann_json::nlohmann_json LABELS fast)
add_dependencies(character_test understudy)  # its import worker
