// A folder of people and motions, and the splits of it: what networks learn from and are evaluated on.
#pragma once

#include <string>
#include <vector>

#include "retarget/body/body.hpp"

namespace understudy {

/// A stretch of a clip that is evaluated on.
struct EvaluatedMotion {
  std::string path;  ///< AMASS-format
  int start = 0;     ///< frame
  std::string tag;   ///< what it shows
};

/// One split of FOLDER/splits.json; paths are whole.
struct DataSplit {
  std::string body;                         ///< SMPL-format
  std::string hand_poses;                   ///< beside it: poses of its fingers; empty where there are none
  std::vector<Eigen::VectorXf> betas;       ///< shape parameters of its people
  std::vector<std::string> clothed;         ///< rigged, dressed T-pose meshes; may be empty
  std::vector<std::string> motion_folders;  ///< of clips
  std::vector<EvaluatedMotion> motions;     ///< may be empty
};

/// splits.json: {"dev": {"betas": {"file": "betas.npz", "rows": [first, last]}, "clothed": ["a.npz"],
/// "motion_subjects": ["folder"], "motions": [{"file": "clip.npz", "start": 0, "tag": "walk"}]}, ...}, and
/// "body" at the top where it is not body/makehuman_smplformat.npz. Throws Error naming the file.
DataSplit read_split(const std::string& folder, const std::string& name);

/// A rigged, dressed T-pose mesh (.npz: vertices, faces, joints, weight_joint [V, 4], weight [V, 4]).
ShapedBody read_dressed_body(const std::string& path);

}  // namespace understudy
