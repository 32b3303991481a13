#include "app/run/target_file.hpp"

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/body/body.hpp"
#include "retarget/formats/mesh_reader.hpp"
#include "retarget/formats/npz.hpp"

namespace understudy::app {
namespace {

bool is_npz(const std::string& path) {
  return path.size() > 4 && path.compare(path.size() - 4, 4, ".npz") == 0;
}

Eigen::VectorXf as_vector(const std::vector<float>& values) {
  return Eigen::Map<const Eigen::VectorXf>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace

Mesh import_target(const TargetOptions& options) {
  Mesh target = read_target(options.path, options.betas);
  ImportOptions import = options.import;
  if (import.up.empty()) import.up = "y";
  const ImportDecision decision = decide_import(target, import);
  decision.apply(target);
  log::info(options.path + ": " + decision.sentence);
  return target;
}

Mesh read_target(const std::string& path, const std::vector<float>& betas) {
  if (is_npz(path)) {
    const Npz npz = read_npz(path);
    if (npz.count("v_template")) {
      const ShapedBody person = read_smpl_body(path).shaped(as_vector(betas));
      return {person.vertices, person.faces};
    }
  }
  US_CHECK(betas.empty(), path, ": only an SMPL-format body takes --betas");
  return read_mesh(path);
}

}  // namespace understudy::app
