// The one place where tinygltf, a library of one header, is compiled.
#include <fstream>
#include <sstream>
#define TINYGLTF_IMPLEMENTATION
#include "retarget/formats/gltf_file.hpp"
