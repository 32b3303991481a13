#include "tests/support/training_folder.hpp"

#include <filesystem>
#include <fstream>
#include <vector>

#include "retarget/base/rng.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy::test {
namespace {

namespace fs = std::filesystem;

// T-pose joints of a person of 1.7 m, pelvis at the origin.
constexpr float kRest[kJointCount][3] = {
    {0, 0, 0},          {.1f, 0, 0},         {-.1f, 0, 0},     {0, .08f, 0},     {.13f, -.4f, 0},
    {-.13f, -.4f, 0},   {0, .15f, 0},        {.15f, -.8f, 0},  {-.15f, -.8f, 0}, {0, .22f, 0},
    {.17f, -.86f, .1f}, {-.17f, -.86f, .1f}, {0, .5f, 0},      {.03f, .44f, 0},  {-.03f, .44f, 0},
    {0, .6f, .03f},     {.17f, .46f, 0},     {-.17f, .46f, 0}, {.4f, .46f, 0},   {-.4f, .46f, 0},
    {.64f, .46f, 0},    {-.64f, .46f, 0}};

constexpr int kCorners = 4;  // a tetrahedron around each joint

NpyArray array(std::vector<int64_t> shape, std::vector<float> values) {
  return {std::move(shape), std::move(values), ""};
}

struct Boxes {
  std::vector<float> vertices, faces, weights, regressor;
};

Boxes boxes() {
  Boxes b;
  const int V = kJointCount * kCorners;
  b.weights.assign(V * kJointCount, 0);
  b.regressor.assign(kJointCount * V, 0);
  const float corner[kCorners][3] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  for (int j = 0; j < kJointCount; ++j) {
    for (int c = 0; c < kCorners; ++c) {
      const int v = j * kCorners + c;
      for (int axis = 0; axis < 3; ++axis) b.vertices.push_back(kRest[j][axis] + 0.06f * corner[c][axis]);
      b.weights[v * kJointCount + j] = 1;
      b.regressor[j * V + v] = 1.0f / kCorners;
    }
    const int o = j * kCorners;
    for (int f : {o, o + 1, o + 2, o, o + 3, o + 1, o, o + 2, o + 3, o + 1, o + 3, o + 2})
      b.faces.push_back(f);
  }
  return b;
}

void write_body(const fs::path& path) {
  const Boxes b = boxes();
  const int64_t V = kJointCount * kCorners;
  std::vector<float> shape(b.vertices);  // one parameter: size
  for (float& x : shape) x *= 0.1f;
  std::vector<float> tree(2 * kJointCount);
  for (int j = 0; j < kJointCount; ++j) tree[j] = kParents[j], tree[kJointCount + j] = j;
  tree[0] = 4294967295.0f;
  write_npz(path.string(), {{"v_template", array({V, 3}, b.vertices)},
                            {"shapedirs", array({V, 3, 1}, shape)},
                            {"J_regressor", array({kJointCount, V}, b.regressor)},
                            {"weights", array({V, kJointCount}, b.weights)},
                            {"kintree_table", array({2, kJointCount}, tree)},
                            {"f", array({static_cast<int64_t>(b.faces.size() / 3), 3}, b.faces)}});
}

void write_dressed(const fs::path& path) {
  const Boxes b = boxes();
  const int64_t V = kJointCount * kCorners;
  std::vector<float> owner(V * 4, 0), weight(V * 4, 0), joints(&kRest[0][0], &kRest[0][0] + 3 * kJointCount);
  for (int64_t v = 0; v < V; ++v) owner[4 * v] = static_cast<float>(v / kCorners), weight[4 * v] = 1;
  write_npz(path.string(), {{"vertices", array({V, 3}, b.vertices)},
                            {"faces", array({static_cast<int64_t>(b.faces.size() / 3), 3}, b.faces)},
                            {"joints", array({kJointCount, 3}, joints)},
                            {"weight_joint", array({V, 4}, owner)},
                            {"weight", array({V, 4}, weight)}});
}

/// A hand is the box of its wrist; one corner is a fingertip.
void write_hand_poses(const fs::path& path) {
  constexpr int64_t kJoints = 26, kAngles = 26, kBones = 20, kPoses = 3;
  std::vector<float> left, right, weights(kCorners * kBones, 0), joints, poses(kPoses * kAngles, 0);
  for (int c = 0; c < kCorners; ++c) {
    left.push_back(static_cast<float>(LeftWrist * kCorners + c));
    right.push_back(static_cast<float>(RightWrist * kCorners + c));
  }
  weights[6] = 1;  // the third bone of the index
  Rng rng(4);
  for (int j = 0; j < kJoints; ++j) {
    std::vector<float> shares(kCorners);
    float sum = 0;
    for (float& share : shares) sum += share = rng.uniform();
    for (const float share : shares) joints.push_back(share / sum);
  }
  for (float& angle : poses) angle = rng.uniform(0, 60);
  write_npz(path.string(), {{"left_idx", array({kCorners}, left)},
                            {"right_idx", array({kCorners}, right)},
                            {"weights", array({kCorners, 5, 4}, weights)},
                            {"joint_reg", array({kJoints, kCorners}, joints)},
                            {"pose_angles", array({kPoses, kAngles}, poses)},
                            {"dof_lo", array({kAngles}, std::vector<float>(kAngles, -20))},
                            {"dof_hi", array({kAngles}, std::vector<float>(kAngles, 90))},
                            {"thumb_nail", array({3}, {0, 0, 1})},
                            {"finger_roll", array({5}, {0, 0, 0, 0, 0})}});
}

void write_clip(const fs::path& path, uint64_t seed) {
  constexpr int64_t frames = 60;
  Rng rng(seed);
  std::vector<float> poses, trans, flags(frames, 0);
  std::vector<float> phase(66), size(66);
  for (int k = 0; k < 66; ++k) phase[k] = rng.uniform(0, 6), size[k] = 0.3f * rng.uniform();
  for (int64_t t = 0; t < frames; ++t) {
    for (int k = 0; k < 66; ++k) poses.push_back(size[k] * std::sin(0.2f * t + phase[k]));
    trans.insert(trans.end(), {0.01f * t, 0.9f, 0});
  }
  flags[5] = 1;
  write_npz(path.string(), {{"poses", array({frames, 66}, poses)},
                            {"trans", array({frames, 3}, trans)},
                            {"mocap_framerate", array({}, {30})},
                            {"frame_flags", array({frames}, flags)}});
}

}  // namespace

void write_training_folder(const std::string& folder) {
  const fs::path root(folder);
  for (const char* part : {"body", "motion/a", "motion/b"}) fs::create_directories(root / part);
  write_body(root / "body/makehuman_smplformat.npz");
  write_hand_poses(root / "body/hand_poses.npz");
  write_npz((root / "body/betas.npz").string(), {{"betas", array({8, 1}, {-2, -1, -.5f, 0, .5f, 1, 2, 3})}});
  write_dressed(root / "body/dressed.npz");
  write_clip(root / "motion/a/one_poses.npz", 1);
  write_clip(root / "motion/b/two_poses.npz", 2);
  const auto split = [](const char* rows, const char* subject) {
    return std::string("{\"betas\": {\"file\": \"body/betas.npz\", \"rows\": ") + rows +
           "}, \"clothed\": [\"body/dressed.npz\"], \"motion_subjects\": [\"" + subject +
           "\"], \"motions\": [{\"file\": \"motion/b/two_poses.npz\", \"start\": 4, \"tag\": \"sway\"}]}";
  };
  std::ofstream(root / "splits.json")
      << "{\"train\": " << split("[0, 6]", "motion/a") << ", \"dev\": " << split("[6, 8]", "motion/b") << "}";
}

Motion write_walk_clip(const std::string& path) {
  const Motion walk = builtin_motion("walk", builtin_joints());
  std::vector<float> poses, trans;
  for (const Pose& pose : walk.poses) {
    for (const Mat3& R : pose.local) {
      const Vec3 turn = rotation_to_axis_angle(R);
      poses.insert(poses.end(), turn.data(), turn.data() + 3);
    }
    trans.insert(trans.end(), pose.root.data(), pose.root.data() + 3);
  }
  const auto frames = static_cast<int64_t>(walk.poses.size());
  write_npz(path, {{"poses", array({frames, 66}, poses)},
                   {"trans", array({frames, 3}, trans)},
                   {"mocap_framerate", array({}, {30})}});
  return walk;
}

}  // namespace understudy::test
