// A target from a file: read, brought to metres and y up.
#pragma once

#include <string>
#include <vector>

#include "retarget/formats/import.hpp"
#include "retarget/geometry/mesh.hpp"

namespace understudy::app {

struct TargetOptions {
  std::string path;
  std::vector<float> betas;  ///< of an SMPL-format body
  ImportOptions import;      ///< up is y unless told otherwise
};

/// The target as the retargeter wants it: metres, y up. Says what it decided. Throws Error naming the file.
Mesh import_target(const TargetOptions& options);

/// The T-pose of an SMPL-format body with these shape parameters, as a mesh; any other file as it is.
Mesh read_target(const std::string& path, const std::vector<float>& betas);

}  // namespace understudy::app
