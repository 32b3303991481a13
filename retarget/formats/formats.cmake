us_module(formats SOURCES
  formats/bytes.cpp formats/gltf_file.cpp formats/gltf_mesh.cpp formats/mesh_reader.cpp formats/obj.cpp formats/off.cpp formats/pcd.cpp
  formats/part_file.cpp formats/ply.cpp formats/stl.cpp formats/xyz.cpp
  formats/scan_source.cpp formats/scan_follow.cpp formats/scan_array.cpp formats/import.cpp
  PUBLIC understudy_core PRIVATE PkgConfig::LIBZIP nlohmann_json::nlohmann_json Threads::Threads)
us_module(results SOURCES
  formats/amass_writer.cpp formats/bvh_writer.cpp formats/joint_table.cpp formats/npz_writer.cpp
  formats/result_writer.cpp formats/surface_writer.cpp
  PUBLIC understudy_core understudy_formats PRIVATE PkgConfig::LIBZIP nlohmann_json::nlohmann_json)
