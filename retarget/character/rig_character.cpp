#include "retarget/character/rig_character.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "retarget/character/picture.hpp"
#include "retarget/formats/motion_writers.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr float kTurnNoise = 3e-4f, kSlideNoise = 2e-5f;  // radians, share of the body: what floats leave
constexpr float kHingeTurn = 0.01f;                       // radians that a hinge turns at least
constexpr float kScaleNoise = 2e-3f, kLost = 1e-3f;
constexpr double kMostFrames = 100000;

CharacterPart part_of(const Rig& rig, int node) {
  CharacterPart part;
  part.name = rig.name;
  part.node = node;
  part.skin = 0;
  part.material = 0;
  part.vertices = rig.surface.vertices;
  part.faces = rig.surface.faces;
  if (!rig.surface.is_cloud()) part.normals = vertex_normals(part.vertices, part.faces);
  if (rig.surface.colors.rows() > 0) {
    part.colors = RowMatrix::Ones(rig.surface.colors.rows(), 4);
    part.colors.leftCols<3>() = rig.surface.colors;
  }
  part.joints = rig.skin.bones;
  part.weights = rig.skin.weights;
  return part;
}

/// The rotations of a joint, neighbours on the same side of the sphere; empty where it never turns.
std::vector<float> turns_of(const RigMotion& motion, size_t joint) {
  std::vector<float> values;
  Eigen::Quaternionf before = Eigen::Quaternionf::Identity();
  bool turns = false;
  for (const RigPose& pose : motion.poses) {
    Eigen::Quaternionf q(pose.turns[joint]);
    if (q.dot(before) < 0) q.coeffs() *= -1;
    turns |= !pose.turns[joint].isIdentity(1e-7f);
    values.insert(values.end(), q.coeffs().begin(), q.coeffs().end());  // x y z w
    before = q;
  }
  return turns ? values : std::vector<float>();
}

/// The translations of the root and of sliders; empty of others.
std::vector<float> translations_of(const Rig& rig, const RigMotion& motion, size_t j, const Vec3& local) {
  const RigJoint& joint = rig.joints[j];
  std::vector<float> values;
  if (j > 0 && joint.kind != JointKind::Slider) return values;
  for (const RigPose& pose : motion.poses) {
    const Vec3 place = j == 0 ? pose.root : Vec3(local + pose.slides[j] * joint.axis);
    values.insert(values.end(), place.begin(), place.end());
  }
  return values;
}

CharacterAnimation animation_of(const Rig& rig, const RigClip& clip, const Character& character) {
  CharacterAnimation animation;
  animation.name = clip.name;
  std::vector<float> times;
  for (size_t t = 0; t < clip.motion.poses.size(); ++t)
    times.push_back(static_cast<float>(static_cast<double>(t) / clip.motion.fps));
  const auto add = [&](size_t joint, TrackPath path, std::vector<float> values) {
    if (!values.empty())
      animation.tracks.push_back(
          {static_cast<int>(joint), path, TrackInterpolation::Linear, times, std::move(values)});
  };
  for (size_t j = 0; j < rig.joints.size(); ++j) {
    add(j, TrackPath::Rotation, turns_of(clip.motion, j));
    add(j, TrackPath::Translation,
        translations_of(rig, clip.motion, j, character.nodes[j].local.translation));
  }
  return animation;
}

void check_poses(const Rig& rig, const RigMotion& motion) {
  US_CHECK(motion.poses.empty() || motion.fps > 0, rig.name, ": a motion of ", motion.fps,
           " frames a second");
  for (const RigPose& pose : motion.poses)
    US_CHECK(ssize(pose.turns) == rig.count() && ssize(pose.slides) == rig.count(), rig.name, ": a pose of ",
             pose.turns.size(), " joints for a rig of ", rig.count());
}

/// Nodes whose motion the surface knows: bones with a weight, and nodes that carry parts without skin.
std::vector<bool> carriers_of(const Character& character) {
  std::vector<bool> carries(character.nodes.size(), false);
  for (const CharacterPart& part : character.parts) {
    if (part.vertices.rows() == 0) continue;
    if (part.skin < 0) carries[part.node] = true;
    for (Eigen::Index i = 0; part.skin >= 0 && i < part.joints.size(); ++i)
      if (part.weights.data()[i] > 0)
        carries[character.skins[part.skin].joints[part.joints.data()[i]]] = true;
  }
  return carries;
}

/// Which nodes become which joints.
struct BoneNodes {
  std::vector<int> nodes;     // of each joint its node; -1: the root that the file does not have
  std::vector<int> parents;   // of each joint
  std::vector<int> joint_of;  // of each node its joint, -1: none
};

BoneNodes bone_nodes(const Character& character) {
  const std::vector<bool> carries = carriers_of(character);
  const int count = ssize(character.nodes);
  std::vector<bool> kept = carries;
  std::vector<int> below(count, 0);  // kept children
  for (int n = count - 1; n >= 0; --n) {
    const int parent = character.nodes[n].parent;
    if (!kept[n] || parent < 0) continue;
    kept[parent] = true;
    ++below[parent];
  }
  const auto is_top = [&](int n) {
    return character.nodes[n].parent < 0 || !kept[character.nodes[n].parent];
  };
  int tops = 0;
  for (int n = 0; n < count; ++n) {  // what carries one bone alone from above is no joint
    if (!kept[n] || !is_top(n)) continue;
    if (!carries[n] && below[n] == 1)
      kept[n] = false;
    else
      ++tops;
  }
  BoneNodes bones;
  bones.joint_of.assign(count, -1);
  if (tops > 1) bones.nodes = {-1}, bones.parents = {-1};
  for (int n = 0; n < count; ++n) {
    if (!kept[n]) continue;
    bones.joint_of[n] = ssize(bones.nodes);
    bones.nodes.push_back(n);
    bones.parents.push_back(!is_top(n) ? bones.joint_of[character.nodes[n].parent] : tops > 1 ? 0 : -1);
  }
  return bones;
}

SkinWeights skin_of(const Character& character, const BoneNodes& bones) {
  SkinWeights skin;
  skin.bones.setZero(character.vertex_count(), kSkinBones);
  skin.weights.setZero(character.vertex_count(), kSkinBones);
  Eigen::Index at = 0;
  for (const CharacterPart& part : character.parts)
    for (Eigen::Index v = 0; v < part.vertices.rows(); ++v, ++at) {
      std::vector<std::pair<float, int>> pulls;  // less the weight, joint: the largest first
      if (part.skin < 0) pulls = {{-1.0f, bones.joint_of[part.node]}};
      for (Eigen::Index k = 0; part.skin >= 0 && k < part.joints.cols(); ++k)
        if (part.weights(v, k) > 0)
          pulls.emplace_back(-part.weights(v, k),
                             bones.joint_of[character.skins[part.skin].joints[part.joints(v, k)]]);
      if (pulls.empty()) pulls = {{-1.0f, 0}};
      std::sort(pulls.begin(), pulls.end());
      if (pulls.size() > kSkinBones) pulls.resize(kSkinBones);
      for (size_t k = 0; k < pulls.size(); ++k) {
        skin.bones(at, k) = pulls[k].second;
        skin.weights(at, k) = -pulls[k].first;
      }
      skin.weights.row(at) /= skin.weights.row(at).sum();
    }
  return skin;
}

Mesh surface_of(const Character& character, const Points& vertices) {
  Mesh mesh{vertices, Faces(0, 3), Points(0, 3)};
  Eigen::Index at = 0, faces = 0;
  bool coloured = true;
  for (const CharacterPart& part : character.parts) {
    coloured &= part.colors.rows() == part.vertices.rows();
    faces += part.faces.rows();
  }
  mesh.faces.resize(faces, 3);
  if (coloured) mesh.colors.resize(vertices.rows(), 3);
  faces = 0;
  for (const CharacterPart& part : character.parts) {
    mesh.faces.middleRows(faces, part.faces.rows()) = part.faces.array() + static_cast<int>(at);
    if (coloured) mesh.colors.middleRows(at, part.vertices.rows()) = part.colors.leftCols(3);
    at += part.vertices.rows();
    faces += part.faces.rows();
  }
  return mesh;
}

/// How the nodes moved each joint from the bind pose.
BoneMotions motions_of(const Character& character, const BoneNodes& bones, const std::vector<Mat4>& bind,
                       const std::vector<Mat4>& world) {
  BoneMotions moved(bones.nodes.size());
  for (size_t j = 0; j < moved.size(); ++j) {
    const int node = bones.nodes[j];
    if (node < 0) continue;
    const Mat4 M = world[node] * bind[node].inverse();
    const Mat3 linear = M.topLeftCorner<3, 3>();
    US_CHECK(
        M.allFinite() && (linear.transpose() * linear).isIdentity(kScaleNoise) && linear.determinant() > 0,
        character.called(), ": the bone '", character.nodes[node].name,
        "' scales, but the bones of a rig only turn and slide");
    moved[j].R = nearest_rotation(linear);
    moved[j].t = M.topRightCorner<3, 1>();
  }
  return moved;
}

/// The one line that all of these vectors lie on, none where one is further off it than `noise`.
std::optional<Vec3> common_line(const std::vector<Vec3>& vectors, float noise) {
  Mat3 spread = Mat3::Zero();
  for (const Vec3& v : vectors) spread += v * v.transpose();
  Vec3 line = Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors().col(2);
  for (const Vec3& v : vectors)
    if ((v - v.dot(line) * line).norm() > noise) return {};
  Eigen::Index largest = 0;
  line.cwiseAbs().maxCoeff(&largest);
  return line[largest] < 0 ? Vec3(-line) : line;
}

float longest(const std::vector<Vec3>& vectors) {
  float most = 0;
  for (const Vec3& v : vectors) most = std::max(most, v.norm());
  return most;
}

/// How far apart the first of these vectors and any other are.
float varied(const std::vector<Vec3>& vectors) {
  float most = 0;
  for (const Vec3& v : vectors) most = std::max(most, (v - vectors[0]).norm());
  return most;
}

/// What kind of joint moves so. Less than `slide_noise` is no slide; two frames show no line.
void set_kind(RigJoint& joint, size_t j, const std::vector<BoneMotions>& frames, float slide_noise) {
  if (frames.size() < 3) return;
  std::vector<Vec3> turns, slides;
  for (const BoneMotions& bones : frames) {
    const RigidMotion& parent = bones[joint.parent];
    turns.push_back(rotation_to_axis_angle(parent.R.transpose() * bones[j].R));
    slides.emplace_back(parent.inverse()(bones[j](joint.rest)) - joint.rest);
  }
  if (varied(slides) > slide_noise && longest(turns) < kTurnNoise) {
    const std::optional<Vec3> line = common_line(slides, slide_noise);
    if (line) joint.kind = JointKind::Slider, joint.axis = *line;
  } else if (varied(turns) > kHingeTurn) {
    const std::optional<Vec3> line = common_line(turns, kTurnNoise);
    if (line) joint.kind = JointKind::Hinge, joint.axis = *line;
  }
}

/// Times in seconds, evenly from 0 to the animation's end.
std::vector<float> times_of(const Character& character, int animation, double fps) {
  if (animation < 0) return {0.0f};
  US_CHECK(animation < ssize(character.animations), character.called(), ": there is no animation number ",
           animation);
  US_CHECK(fps > 0, "an animation cannot be taken ", fps, " times a second");
  const double frames =
      std::floor(static_cast<double>(character.animations[animation].duration()) * fps + 0.01) + 1;
  US_CHECK(frames <= kMostFrames, character.called(), ": the animation has ", frames, " frames, at most ",
           kMostFrames, " are taken");
  std::vector<float> times;
  times.reserve(static_cast<size_t>(frames));
  for (int t = 0; t < static_cast<int>(frames); ++t) times.push_back(static_cast<float>(t / fps));
  return times;
}

/// Warns of what no rig can do.
void warn_of_loss(const Character& character, const RiggedMotion& read, int animation,
                  const std::vector<float>& times) {
  float lost = 0;
  for (const size_t t : {size_t{0}, times.size() / 2, times.size() - 1}) {
    const Points posed =
        skinned(read.rig.surface.vertices, read.rig.skin, bone_motions(read.rig, read.motion.poses[t]));
    const Points is = vertices_at(character, animation, times[t]);
    if (is.rows() > 0) lost = std::max(lost, (posed - is).rowwise().norm().maxCoeff());
  }
  const float size = box_diagonal(read.rig.surface.vertices);
  if (lost > kLost * size)
    log::warn(character.called() +
              printed(": as a rig its surface is up to %.1f %% of its size off the file's: bones leave their "
                      "parents, or morph targets move it",
                      static_cast<double>(100 * lost / size)));
}

}  // namespace

Character to_character(const RiggedMotion& performed) {
  return to_character(performed.rig, {{"motion", performed.motion}});
}

Character to_character(const Rig& rig, const std::vector<RigClip>& clips) {
  check_rig(rig);
  for (const RigClip& clip : clips) check_poses(rig, clip.motion);
  Character character;
  character.name = rig.name;
  CharacterSkin& skin = character.skins.emplace_back();
  skin.name = rig.name;
  for (int j = 0; j < rig.count(); ++j) {
    const RigJoint& joint = rig.joints[j];
    CharacterNode& node = character.nodes.emplace_back();
    node.name = joint.name;
    node.parent = joint.parent;
    node.local.translation = j == 0 ? joint.rest : Vec3(joint.rest - rig.joints[joint.parent].rest);
    skin.joints.push_back(j);
    skin.inverse_bind.push_back(affine(Mat3::Identity(), -joint.rest));
  }
  if (rig.surface.vertices.rows() > 0) {
    character.nodes.push_back({rig.name.empty() ? "surface" : rig.name, -1, {}, {}});
    character.parts.push_back(part_of(rig, rig.count()));
    // Without one glTF's own is metal, which programs draw black where nothing is reflected in it.
    const Vec3 color = Vec3::Constant(rig.surface.colors.rows() > 0 ? 1.0f : 0.8f);
    character.materials.push_back(plain_material("surface", color, 1, -1).dump());
  }
  for (const RigClip& clip : clips) {
    CharacterAnimation animation = animation_of(rig, clip, character);
    if (!clip.motion.poses.empty() && !animation.tracks.empty())
      character.animations.push_back(std::move(animation));
  }
  return character;
}

RiggedMotion from_character(const Character& character, int animation, double fps) {
  const bool skinned_part =
      std::any_of(character.parts.begin(), character.parts.end(),
                  [](const CharacterPart& part) { return part.skin >= 0 && part.vertices.rows() > 0; });
  US_CHECK(skinned_part, character.called(), ": has no skin, so nothing says which bone moves what");
  const BindPose bind = bind_pose(character);
  const BoneNodes bones = bone_nodes(character);
  RiggedMotion read;
  read.rig.name = character.name;
  read.rig.surface = surface_of(character, bind.vertices);
  read.rig.skin = skin_of(character, bones);
  for (size_t j = 0; j < bones.nodes.size(); ++j) {
    RigJoint& joint = read.rig.joints.emplace_back();
    const int node = bones.nodes[j];
    joint.name = node < 0 ? "root" : character.nodes[node].name;
    joint.parent = bones.parents[j];
    joint.kind = j == 0 ? JointKind::Free : JointKind::Ball;
    if (node >= 0) joint.rest = bind.nodes[node].topRightCorner<3, 1>();
  }
  const std::vector<float> times = times_of(character, animation, fps);
  std::vector<BoneMotions> frames;
  frames.reserve(times.size());
  for (const float time : times)
    frames.push_back(motions_of(character, bones, bind.nodes, nodes_at(character, animation, time).world));
  const float slide_noise = kSlideNoise * box_diagonal(bind.vertices);
  for (size_t j = 1; j < read.rig.joints.size(); ++j) set_kind(read.rig.joints[j], j, frames, slide_noise);
  check_rig(read.rig);
  read.motion.fps = fps > 0 ? fps : read.motion.fps;
  for (const BoneMotions& moved : frames) read.motion.poses.push_back(pose_of(read.rig, moved));
  warn_of_loss(character, read, animation, times);
  return read;
}

void write_rig_bvh(const std::string& path, const RiggedMotion& performed) {
  const Rig& rig = performed.rig;
  check_rig(rig);
  std::vector<BvhJoint> joints;
  std::set<std::string> taken;
  for (const RigJoint& joint : rig.joints)
    joints.push_back({bvh_word(joint.name, joints.size(), taken), joint.parent, joint.rest,
                      joint.kind == JointKind::Slider});
  for (const BoneTip& tip : bone_tips(rig)) {
    BvhJoint& joint = joints[static_cast<size_t>(tip.joint)];
    joint.end = tip.rest - joint.rest;
  }
  BvhWriter file(path, joints, performed.motion.fps);
  Points places(rig.count(), 3);
  for (const RigPose& pose : performed.motion.poses) {
    US_CHECK(pose.turns.size() == joints.size() && pose.slides.size() == joints.size(), path, ": a pose of ",
             pose.turns.size(), " joints for a rig of ", joints.size());
    places.row(0) = pose.root.transpose();
    for (size_t j = 1; j < joints.size(); ++j) {
      const RigJoint& joint = rig.joints[j];
      const Vec3 still = joint.rest - rig.joints[static_cast<size_t>(joint.parent)].rest;
      places.row(static_cast<Eigen::Index>(j)) = (still + pose.slides[j] * joint.axis).transpose();
    }
    file.push(pose.turns, places);
  }
  file.finish();
}

}  // namespace understudy
