us_module(character SOURCES
  character/body_heading.cpp character/bone_choices.cpp character/bone_map.cpp character/careful_deformer.cpp
  character/character.cpp character/character_export.cpp character/corrective_shapes.cpp
  character/geometric_binding.cpp
  character/gltf_character.cpp character/gltf_character_writer.cpp character/import_process.cpp
  character/key_reduction.cpp character/obj_character.cpp character/painted_skin.cpp character/picture.cpp character/pixels.cpp character/plausible_person.cpp
  character/prepared_character.cpp character/read_character.cpp character/rest_pose.cpp
  character/vertex_colors.cpp character/voxel_body.cpp
  PUBLIC understudy_core understudy_formats understudy_pipeline PRIVATE nlohmann_json::nlohmann_json PkgConfig::LIBWEBP)

# Only the program's import worker runs this.
find_library(ASSIMP_LIBRARY assimp REQUIRED)
us_module(assimp SOURCES character/assimp_import.cpp
  PUBLIC understudy_character PRIVATE nlohmann_json::nlohmann_json ${ASSIMP_LIBRARY})
