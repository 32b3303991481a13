us_module(formats SOURCES
  formats/bytes.cpp formats/gltf_mesh.cpp formats/mesh_reader.cpp formats/obj.cpp formats/off.cpp formats/pcd.cpp
  formats/ply.cpp formats/stl.cpp formats/xyz.cpp
  PUBLIC understudy_core PRIVATE understudy_npz PkgConfig::LIBZIP nlohmann_json::nlohmann_json Threads::Threads)
