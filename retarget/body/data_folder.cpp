#include "retarget/body/data_folder.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/formats/npz.hpp"

namespace understudy {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::vector<Eigen::VectorXf> read_betas(const std::string& path, int first, int last) {
  const Npz npz = read_npz(path);
  const NpyArray& array = require(npz, "betas", path);
  US_CHECK(array.shape.size() == 2 && first >= 0 && last <= array.shape[0] && first < last, path,
           ": betas must be people x parameters, rows ", first, " to ", last);
  const RowMatrix rows = array.matrix(array.shape[1], path);
  std::vector<Eigen::VectorXf> betas;
  for (int i = first; i < last; ++i) betas.emplace_back(rows.row(i).transpose());
  return betas;
}

DataSplit split_of(const fs::path& root, const json& all, const std::string& name) {
  const json& part = all.at(name);
  const auto whole = [&root](const json& path) { return (root / path.get<std::string>()).string(); };
  DataSplit split;
  split.body = (root / all.value("body", "body/makehuman_smplformat.npz")).string();
  const fs::path hands = fs::path(split.body).parent_path() / "hand_poses.npz";
  if (fs::exists(hands)) split.hand_poses = hands.string();
  const json& betas = part.at("betas");
  split.betas = read_betas(whole(betas.at("file")), betas.at("rows").at(0), betas.at("rows").at(1));
  for (const json& path : part.value("clothed", json::array())) split.clothed.push_back(whole(path));
  for (const json& path : part.value("motion_subjects", json::array()))
    split.motion_folders.push_back(whole(path));
  for (const json& motion : part.value("motions", json::array()))
    split.motions.push_back({whole(motion.at("file")), motion.value("start", 0), motion.value("tag", "")});
  return split;
}

/// Whether all are numbers from 0 to below `count`.
bool all_below(const IntegerMatrix& values, Eigen::Index count) {
  return (values.array() >= 0 && values.array() < count).all();
}

}  // namespace

DataSplit read_split(const std::string& folder, const std::string& name) {
  const fs::path path = fs::path(folder) / "splits.json";
  const json all = json::parse(read_file(path.string()), nullptr, false);
  US_CHECK(!all.is_discarded(), path.string(), ": not JSON");
  US_CHECK(all.is_object() && all.contains(name), path.string(), ": has no split \"", name, "\"");
  try {
    return split_of(folder, all, name);
  } catch (const json::exception& wrong) {
    throw Error(path.string() + ": the split \"" + name + "\" cannot be read: " + wrong.what());
  }
}

ShapedBody read_dressed_body(const std::string& path) {
  const Npz npz = read_npz(path);
  ShapedBody body;
  body.vertices = require(npz, "vertices", path).matrix(3, path);
  const RowMatrix joints = require(npz, "joints", path).matrix(3, path);
  US_CHECK(joints.rows() == kJointCount, path, ": ", joints.rows(), " joints, not ", kJointCount);
  body.joints = joints;
  const IntegerMatrix owner = require(npz, "weight_joint", path).integers(4, path);
  const RowMatrix weight = require(npz, "weight", path).matrix(4, path);
  const Eigen::Index count = body.vertices.rows();
  US_CHECK(owner.rows() == count && weight.rows() == count, path, ": weights do not fit ", count,
           " vertices");
  const IntegerMatrix corners = require(npz, "faces", path).integers(3, path);
  US_CHECK(all_below(corners, count), path, ": a face names a vertex that does not exist");
  body.faces = corners.cast<int>();
  US_CHECK(all_below(owner, kJointCount), path, ": a weight names a joint that does not exist");
  body.weights = RowMatrix::Zero(count, kJointCount);
  for (Eigen::Index v = 0; v < count; ++v)
    for (int k = 0; k < 4; ++k) body.weights(v, owner(v, k)) += weight(v, k);
  return body;
}

}  // namespace understudy
