#include "retarget/training/training_data.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "retarget/base/error.hpp"
#include "retarget/formats/npz.hpp"

namespace understudy::training {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json read_splits(const fs::path& path) {
  std::ifstream in(path);
  US_CHECK(in, path.string(), ": cannot be opened");
  const json splits = json::parse(in, nullptr, false);
  US_CHECK(!splits.is_discarded(), path.string(), ": not JSON");
  return splits;
}

std::vector<Eigen::VectorXf> read_betas(const fs::path& path, int first, int last) {
  const Npz npz = read_npz(path.string());
  const NpyArray& array = require(npz, "betas", path.string());
  US_CHECK(array.shape.size() == 2 && first >= 0 && last <= array.shape[0] && first < last, path.string(),
           ": betas must be people x parameters, rows ", first, " to ", last);
  const RowMatrix rows = array.matrix(array.shape[1], path.string());
  std::vector<Eigen::VectorXf> betas;
  for (int i = first; i < last; ++i) betas.emplace_back(rows.row(i).transpose());
  return betas;
}

std::vector<Clip> read_clips(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".npz") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<Clip> clips;
  for (const auto& file : files) {
    Clip clip{read_amass_motion(file.string()), {}};
    for (int t = 0; t < static_cast<int>(clip.motion.poses.size()); ++t)
      if (clip.motion.flags.empty() || clip.motion.flags[t] == 0) clip.good.push_back(t);
    if (!clip.good.empty()) clips.push_back(std::move(clip));
  }
  return clips;
}

}  // namespace

ShapedBody read_dressed_body(const std::string& path) {
  const Npz npz = read_npz(path);
  ShapedBody body;
  body.vertices = require(npz, "vertices", path).matrix(3, path);
  body.faces = require(npz, "faces", path).matrix(3, path).cast<int>();
  const RowMatrix joints = require(npz, "joints", path).matrix(3, path);
  US_CHECK(joints.rows() == kJointCount, path, ": ", joints.rows(), " joints, not ", kJointCount);
  body.joints = joints;
  const RowMatrix owner = require(npz, "weight_joint", path).matrix(4, path);
  const RowMatrix weight = require(npz, "weight", path).matrix(4, path);
  const Eigen::Index count = body.vertices.rows();
  US_CHECK(owner.rows() == count && weight.rows() == count, path, ": weights do not fit ", count,
           " vertices");
  US_CHECK(body.faces.size() == 0 || (body.faces.minCoeff() >= 0 && body.faces.maxCoeff() < count), path,
           ": a face names a vertex that is not there");
  US_CHECK(owner.minCoeff() >= 0 && owner.maxCoeff() < kJointCount, path,
           ": a weight names a joint that is not there");
  body.weights = RowMatrix::Zero(count, kJointCount);
  for (Eigen::Index v = 0; v < count; ++v)
    for (int k = 0; k < 4; ++k) body.weights(v, static_cast<int>(owner(v, k))) += weight(v, k);
  return body;
}

TrainingData load_training_data(const std::string& folder, Split split) {
  const fs::path root(folder);
  const json part = read_splits(root / "splits.json").at(split == Split::Train ? "train" : "dev");
  TrainingData data;
  data.body = read_smpl_body((root / "body/makehuman_smplformat.npz").string());
  data.template_leg = leg_length(data.body.shaped(Eigen::VectorXf::Zero(1)).joints);
  const json& betas = part.at("betas");
  data.betas =
      read_betas(root / betas.at("file").get<std::string>(), betas.at("rows")[0], betas.at("rows")[1]);
  for (const auto& file : part.at("clothed"))
    data.dressed.push_back(read_dressed_body((root / file.get<std::string>()).string()));
  for (const auto& subject : part.at("motion_subjects"))
    for (Clip& clip : read_clips(root / subject.get<std::string>())) data.clips.push_back(std::move(clip));
  for (const Clip& clip : data.clips) data.good_frames += static_cast<int64_t>(clip.good.size());
  US_CHECK(data.good_frames > 0, folder, ": the split has no usable motion");
  return data;
}

Eigen::VectorXf random_shape(const TrainingData& data, Rng& rng) {
  const auto pick = [&] { return data.betas[rng.below(static_cast<int>(data.betas.size()))]; };
  const Eigen::VectorXf a = pick();
  if (rng.chance(0.5f)) return a;
  const float mix = rng.uniform();
  return (1 - mix) * a + mix * pick();
}

const Pose& random_pose(const TrainingData& data, Rng& rng) {
  if (rng.chance(0.5f)) {
    const Clip& clip = data.clips[rng.below(static_cast<int>(data.clips.size()))];
    return clip.motion.poses[clip.good[rng.below(static_cast<int>(clip.good.size()))]];
  }
  int64_t at = rng.below(static_cast<int>(data.good_frames));
  for (const Clip& clip : data.clips) {
    if (at < static_cast<int64_t>(clip.good.size())) return clip.motion.poses[clip.good[at]];
    at -= static_cast<int64_t>(clip.good.size());
  }
  return data.clips.back().motion.poses[data.clips.back().good.back()];
}

}  // namespace understudy::training
