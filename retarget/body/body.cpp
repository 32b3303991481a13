#include "retarget/body/body.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr int kPoseFeatures = 9 * (kJointCount - 1);

/// Which of the 22 each joint of the file belongs to: itself, or its first ancestor among the 22.
std::vector<int> folded_joints(const NpyArray& tree, const std::string& path) {
  US_CHECK(tree.shape.size() == 2 && tree.shape[0] == 2 && tree.shape[1] >= kJointCount, path,
           ": kintree_table must be 2 x joints, at least ", kJointCount);
  const int64_t joints = tree.shape[1];
  const IntegerMatrix parents = tree.integers(joints, path);
  std::vector<int> owner(joints);
  for (int64_t j = 0; j < joints; ++j) {
    const int64_t parent = parents(0, j);
    if (j < kJointCount) {
      owner[j] = j;
      US_CHECK(j == 0 || parent == kParents[j], path, ": joint ", j, " has the parent ", parent,
               ", in SMPL's order it is ", kParents[j]);
      continue;
    }
    US_CHECK(parent >= 0 && parent < j, path, ": joint ", j, " comes before its parent");
    owner[j] = owner[parent];
  }
  return owner;
}

RowMatrix folded_weights(const NpyArray& array, const std::vector<int>& owner, int64_t vertices,
                         const std::string& path) {
  const auto joints = static_cast<int64_t>(owner.size());
  US_CHECK(array.size() == vertices * joints, path, ": weights must be vertices x joints");
  const RowMatrix all = array.matrix(joints, path);
  RowMatrix weights = RowMatrix::Zero(vertices, kJointCount);
  for (int64_t j = 0; j < joints; ++j) weights.col(owner[j]) += all.col(j);
  return weights;
}

Faces faces_from(const NpyArray& array, int64_t vertices, const std::string& path) {
  const IntegerMatrix numbers = array.integers(3, path + ": f");
  US_CHECK((numbers.array() >= 0 && numbers.array() < vertices).all(), path,
           ": a face names a vertex that does not exist");
  return numbers.cast<int>();
}

}  // namespace

ShapedBody Body::shaped(const Eigen::VectorXf& betas) const {
  US_CHECK(betas.size() <= shape_dirs.cols(), betas.size(), " shape parameters for a body that has ",
           shape_dirs.cols());
  ShapedBody body;
  body.vertices = template_vertices;
  Eigen::Map<Eigen::VectorXf> flat(body.vertices.data(), body.vertices.size());
  if (betas.size() > 0) flat += shape_dirs.leftCols(betas.size()) * betas;
  body.faces = faces;
  body.joints = joint_regressor * body.vertices;
  body.weights = weights;
  body.pose_dirs = pose_dirs;
  return body;
}

Eigen::VectorXf pose_features(const Rotations& local) {
  Eigen::VectorXf features(kPoseFeatures);
  for (int j = 1; j < kJointCount; ++j) {
    const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> bent = local[j] - Mat3::Identity();
    features.segment<9>(9 * (j - 1)) = Eigen::Map<const Eigen::Matrix<float, 9, 1>>(bent.data());
  }
  return features;
}

Points posed_vertices(const ShapedBody& body, const Pose& pose) {
  Points rest = body.vertices;
  if (body.pose_dirs) {
    Eigen::Map<Eigen::VectorXf> flat(rest.data(), rest.size());
    flat.noalias() += *body.pose_dirs * pose_features(pose.local);
  }
  return linear_blend_skinning(rest, body.weights, body.joints, forward_kinematics(body.joints, pose));
}

bool is_smpl_body(const std::string& path) {
  if (!can_be(path, kBody)) return false;
  try {
    const std::vector<std::string> names = npz_names(path);
    return std::find(names.begin(), names.end(), "v_template") != names.end();
  } catch (const Error&) {
    return false;
  }
}

Body read_smpl_body(const std::string& path) {
  const Npz npz = read_npz(path);
  Body body;
  body.template_vertices = require(npz, "v_template", path).matrix(3, path + ": v_template");
  const int64_t vertices = body.template_vertices.rows();
  US_CHECK(vertices > 0, path, ": the body has no vertices");
  const std::vector<int> owner = folded_joints(require(npz, "kintree_table", path), path);

  body.faces = faces_from(require(npz, "f", path), vertices, path);
  body.weights = folded_weights(require(npz, "weights", path), owner, vertices, path);
  const NpyArray& shape = require(npz, "shapedirs", path);
  US_CHECK(shape.shape.size() == 3 && shape.shape[0] == vertices && shape.shape[1] == 3 && shape.shape[2] > 0,
           path, ": shapedirs must be vertices x 3 x parameters");
  body.shape_dirs = shape.matrix(shape.shape[2], path);
  const NpyArray& regressor = require(npz, "J_regressor", path);
  US_CHECK(regressor.shape.size() == 2 && regressor.shape[0] >= kJointCount && regressor.shape[1] == vertices,
           path, ": J_regressor must be joints x vertices");
  body.joint_regressor = regressor.matrix(vertices, path).topRows(kJointCount);
  if (const auto it = npz.find("posedirs"); it != npz.end()) {
    const auto& s = it->second.shape;
    US_CHECK(s.size() == 3 && s[0] == vertices && s[1] == 3 && s[2] >= kPoseFeatures, path,
             ": posedirs must be vertices x 3 x pose features");
    body.pose_dirs = std::make_shared<RowMatrix>(it->second.matrix(s[2], path).leftCols(kPoseFeatures));
  }
  return body;
}

AmassArrays read_amass_arrays(const std::string& path) {
  const Npz npz = read_npz(path);
  const NpyArray& poses = require(npz, "poses", path);
  US_CHECK(poses.shape.size() == 2 && poses.shape[1] >= 3 * kJointCount, path,
           ": poses must be frames x at least ", 3 * kJointCount);
  AmassArrays arrays{poses.matrix(poses.shape[1], path),
                     require(npz, "trans", path).matrix(3, path + ": trans")};
  const Eigen::Index frames = arrays.angles.rows();
  US_CHECK(frames > 0 && arrays.trans.rows() == frames, path, ": ", frames, " poses but ",
           arrays.trans.rows(), " root positions");
  for (const char* key : {"mocap_framerate", "mocap_frame_rate"})
    if (npz.count(key) && npz.at(key).size() == 1) arrays.fps = npz.at(key).values[0];
  US_CHECK(arrays.fps > 0 && arrays.fps < 10000, path, ": the frame rate ", arrays.fps, " is not possible");
  if (const auto it = npz.find("frame_flags"); it != npz.end() && it->second.size() == frames)
    arrays.flags.assign(it->second.values.begin(), it->second.values.end());
  return arrays;
}

Motion read_amass_motion(const std::string& path) {
  const AmassArrays arrays = read_amass_arrays(path);
  Motion motion{arrays.fps, std::vector<Pose>(arrays.angles.rows()), arrays.flags};
  for (Eigen::Index t = 0; t < arrays.angles.rows(); ++t) {
    motion.poses[t].root = arrays.trans.row(t).transpose();
    for (int j = 0; j < kJointCount; ++j)
      motion.poses[t].local[j] = rotation_from_axis_angle(arrays.angles.block<1, 3>(t, 3 * j).transpose());
  }
  return motion;
}

}  // namespace understudy
