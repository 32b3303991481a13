#include "tests/retarget/character/characters.hpp"

#include <array>
#include <cmath>

#include "retarget/character/geometric_binding.hpp"
#include "retarget/character/rest_pose.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "retarget/skeleton/skinning.hpp"

namespace understudy::tests {
namespace {

constexpr int kSides = 8, kRings = 5;

// Names of the 22 joints' bones, as programs and collections give them.
using Names = std::array<const char*, kJointCount>;
constexpr Names kMixamo = {"Hips",        "LeftUpLeg",    "RightUpLeg", "Spine",        "LeftLeg",
                           "RightLeg",    "Spine1",       "LeftFoot",   "RightFoot",    "Spine2",
                           "LeftToeBase", "RightToeBase", "Neck",       "LeftShoulder", "RightShoulder",
                           "Head",        "LeftArm",      "RightArm",   "LeftForeArm",  "RightForeArm",
                           "LeftHand",    "RightHand"};
constexpr Names kRigify = {"DEF-spine",       "DEF-thigh.L",     "DEF-thigh.R",    "DEF-spine.001",
                           "DEF-shin.L",      "DEF-shin.R",      "DEF-spine.002",  "DEF-foot.L",
                           "DEF-foot.R",      "DEF-spine.003",   "DEF-toe.L",      "DEF-toe.R",
                           "DEF-spine.004",   "DEF-shoulder.L",  "DEF-shoulder.R", "DEF-spine.006",
                           "DEF-upper_arm.L", "DEF-upper_arm.R", "DEF-forearm.L",  "DEF-forearm.R",
                           "DEF-hand.L",      "DEF-hand.R"};
constexpr Names kVrm = {"J_Bip_C_Hips",     "J_Bip_L_UpperLeg",   "J_Bip_R_UpperLeg", "J_Bip_C_Spine",
                        "J_Bip_L_LowerLeg", "J_Bip_R_LowerLeg",   "J_Bip_C_Chest",    "J_Bip_L_Foot",
                        "J_Bip_R_Foot",     "J_Bip_C_UpperChest", "J_Bip_L_ToeBase",  "J_Bip_R_ToeBase",
                        "J_Bip_C_Neck",     "J_Bip_L_Shoulder",   "J_Bip_R_Shoulder", "J_Bip_C_Head",
                        "J_Bip_L_UpperArm", "J_Bip_R_UpperArm",   "J_Bip_L_LowerArm", "J_Bip_R_LowerArm",
                        "J_Bip_L_Hand",     "J_Bip_R_Hand"};
constexpr Names kUnreal = {"pelvis",     "thigh_l",    "thigh_r",    "spine_01", "calf_l",     "calf_r",
                           "spine_02",   "foot_l",     "foot_r",     "spine_03", "ball_l",     "ball_r",
                           "neck_01",    "clavicle_l", "clavicle_r", "head",     "upperarm_l", "upperarm_r",
                           "lowerarm_l", "lowerarm_r", "hand_l",     "hand_r"};
constexpr Names kBiped = {"Bip01 Pelvis",     "Bip01 L Thigh",    "Bip01 R Thigh",    "Bip01 Spine",
                          "Bip01 L Calf",     "Bip01 R Calf",     "Bip01 Spine1",     "Bip01 L Foot",
                          "Bip01 R Foot",     "Bip01 Spine2",     "Bip01 L Toe0",     "Bip01 R Toe0",
                          "Bip01 Neck",       "Bip01 L Clavicle", "Bip01 R Clavicle", "Bip01 Head",
                          "Bip01 L UpperArm", "Bip01 R UpperArm", "Bip01 L Forearm",  "Bip01 R Forearm",
                          "Bip01 L Hand",     "Bip01 R Hand"};
constexpr Names kWords = {"Hip",
                          "Left Thigh",
                          "Right Thigh",
                          "Abdomen",
                          "Left Shin",
                          "Right Shin",
                          "Waist",
                          "Left Foot",
                          "Right Foot",
                          "Chest",
                          "Left Toes",
                          "Right Toes",
                          "Neck",
                          "Left Clavicle",
                          "Right Clavicle",
                          "Head",
                          "Left Upper Arm",
                          "Right Upper Arm",
                          "Left Lower Arm",
                          "Right Lower Arm",
                          "Left Wrist",
                          "Right Wrist"};
constexpr Names kCmu = {"Hips",        "LeftUpLeg",    "RightUpLeg", "LowerBack",    "LeftLeg",
                        "RightLeg",    "Spine",        "LeftFoot",   "RightFoot",    "Spine1",
                        "LeftToeBase", "RightToeBase", "Neck",       "LeftShoulder", "RightShoulder",
                        "Head",        "LeftArm",      "RightArm",   "LeftForeArm",  "RightForeArm",
                        "LeftHand",    "RightHand"};

/// The end of each joint's tube: the next joint, or a step beyond.
Vec3 end_of(const Joints& joints, int j) {
  const auto at = [&](int k) -> Vec3 { return joints.row(k).transpose(); };
  switch (j) {
    case Pelvis:
      return at(Spine1);
    case Spine3:
      return at(Neck);
    case Head:
      return at(Head) + Vec3(0, 0.2f, 0);
    case LeftFoot:
    case RightFoot:
      return at(j) + Vec3(0, 0, 0.08f);
    case LeftWrist:
    case RightWrist:
      return at(j) + 0.6f * (at(j) - at(j - 2)).normalized() * 0.3f;
    case LeftCollar:
    case RightCollar:
      return at(j + 3);
    default:
      for (int k = j + 1; k < kJointCount; ++k)
        if (kParents[static_cast<size_t>(k)] == j) return at(k);
      return at(j);
  }
}

float radius_of(int j) {
  if (j == Pelvis || j == Spine1 || j == Spine2 || j == Spine3) return 0.13f;
  if (j == Head) return 0.1f;
  return j == LeftHip || j == RightHip ? 0.08f : 0.05f;
}

/// Adds a tube from joint j to its end; half of its first ring goes with the parent.
void add_tube(const Joints& joints, int j, CharacterPart& part, std::vector<float>& vertices,
              std::vector<int>& faces, std::vector<std::array<float, 3>>& skin) {
  const Vec3 from = joints.row(j).transpose(), to = end_of(joints, j);
  const Mat3 R =
      rotation_between(Vec3::UnitY(), (to - from).norm() > 1e-4f ? Vec3(to - from) : Vec3(0, 1, 0));
  const int base = static_cast<int>(vertices.size() / 3), parent = kParents[static_cast<size_t>(j)];
  for (int ring = 0; ring < kRings; ++ring)
    for (int side = 0; side < kSides; ++side) {
      const float t = static_cast<float>(ring) / (kRings - 1),
                  a = 2 * kPi * static_cast<float>(side) / kSides;
      const Vec3 p = from + t * (to - from) + radius_of(j) * (R * Vec3(std::cos(a), 0, std::sin(a)));
      vertices.insert(vertices.end(), {p.x(), p.y(), p.z()});
      const float share = parent < 0 ? 0.0f : std::max(0.0f, 0.5f - 2 * t);
      skin.push_back({static_cast<float>(j), static_cast<float>(std::max(0, parent)), share});
      if (ring == 0) continue;
      const int next = (side + 1) % kSides, low = base + (ring - 1) * kSides, high = low + kSides;
      faces.insert(faces.end(), {low + side, high + side, high + next, low + side, high + next, low + next});
    }
  (void)part;
}

CharacterPart make_part(const Joints& joints, bool upper, bool colored) {
  CharacterPart part;
  part.name = upper ? "Upper" : "Lower";
  std::vector<float> vertices;
  std::vector<int> faces;
  std::vector<std::array<float, 3>> skin;
  for (int j = 0; j < kJointCount; ++j) {
    const bool is_leg = j == LeftHip || j == RightHip || j == LeftKnee || j == RightKnee || j == LeftAnkle ||
                        j == RightAnkle || j == LeftFoot || j == RightFoot || j == Pelvis;
    if (is_leg != upper) add_tube(joints, j, part, vertices, faces, skin);
  }
  const auto count = static_cast<Eigen::Index>(vertices.size() / 3);
  part.vertices = Eigen::Map<const Points>(vertices.data(), count, 3);
  part.faces = Eigen::Map<const Faces>(faces.data(), static_cast<Eigen::Index>(faces.size() / 3), 3);
  part.normals = vertex_normals(part.vertices, part.faces);
  part.uvs.push_back(0.5f * (part.vertices.leftCols<2>().array() + 1).matrix());
  if (colored) part.colors = RowMatrix::Constant(count, 4, 0.5f);
  part.joints.setZero(count, 4);
  part.weights.setZero(count, 4);
  for (Eigen::Index v = 0; v < count; ++v) {
    const auto& s = skin[static_cast<size_t>(v)];
    part.joints(v, 0) = static_cast<int>(s[0]);
    part.weights(v, 0) = 1 - s[2];
    if (s[2] > 0) part.joints(v, 1) = static_cast<int>(s[1]);
    part.weights(v, 1) = s[2];
  }
  return part;
}

Mat4 rigid(const Mat3& R, const Vec3& t) {
  Mat4 M = Mat4::Identity();
  M.topLeftCorner<3, 3>() = R;
  M.topRightCorner<3, 1>() = t;
  return M;
}

/// Bones point along +y, as many programs have it.
std::vector<Mat4> bone_worlds(const Joints& joints) {
  std::vector<Mat4> out;
  for (int j = 0; j < kJointCount; ++j) {
    const Vec3 from = joints.row(j).transpose(), along = end_of(joints, j) - from;
    out.push_back(rigid(rotation_between(Vec3::UnitY(), along.norm() > 1e-4f ? along : Vec3(0, 1, 0)), from));
  }
  return out;
}

void add_bones(const MadeCharacter& options, const Joints& joints, Character& out) {
  const std::vector<Mat4> bind = bone_worlds(joints);
  CharacterSkin skin;
  skin.name = "Armature";
  for (int j = 0; j < kJointCount; ++j) {
    const int p = kParents[static_cast<size_t>(j)];
    CharacterNode node;
    node.name = made_name(options.naming, j);
    node.parent = p < 0 ? 0 : 1 + p;
    node.local = Transform::from(
        p < 0 ? bind[0] : Mat4(bind[static_cast<size_t>(p)].inverse() * bind[static_cast<size_t>(j)]));
    if (options.nodes_posed && (j == LeftShoulder || j == RightHip || j == Spine2))
      node.local.rotation = node.local.rotation * Eigen::Quaternionf(Eigen::AngleAxisf(0.7f, Vec3(1, 0, 0)));
    out.nodes.push_back(node);
    skin.joints.push_back(1 + j);
    skin.inverse_bind.push_back(bind[static_cast<size_t>(j)].inverse());
  }
  for (const int wrist : {LeftWrist, RightWrist}) {
    if (!options.fingers) break;
    CharacterNode finger;
    finger.name = std::string(wrist == LeftWrist ? "Left" : "Right") + "HandIndex1";
    finger.parent = 1 + wrist;
    finger.local.translation = Vec3(0, 0.1f, 0);
    skin.joints.push_back(static_cast<int>(out.nodes.size()));
    skin.inverse_bind.push_back((bind[static_cast<size_t>(wrist)] * finger.local.matrix()).inverse());
    out.nodes.push_back(finger);
  }
  out.skins.push_back(skin);
}

/// Six more bones with 0.5 % each.
void pull_more(int bones, CharacterPart& part) {
  const Eigen::Index count = part.vertices.rows();
  part.joints.conservativeResize(count, 8);
  part.weights.conservativeResize(count, 8);
  for (Eigen::Index v = 0; v < count; ++v) {
    part.weights.row(v).head<2>() *= 0.97f;
    for (int k = 2; k < 8; ++k) {
      part.joints(v, k) = (part.joints(v, 0) + 3 * k) % bones;
      part.weights(v, k) = 0.005f;
    }
  }
}

/// Everything below the armature in units of a hundredth, which the armature takes back.
void nest_scales(Character& out) {
  constexpr float kInner = 100;
  out.nodes[0].local.scale /= kInner;
  for (size_t n = 1; n < out.nodes.size(); ++n) out.nodes[n].local.translation *= kInner;
  for (auto& skin : out.skins)
    for (Mat4& matrix : skin.inverse_bind) matrix.topRightCorner<3, 1>() *= kInner;
  for (auto& part : out.parts) part.vertices *= kInner;
}

}  // namespace

RowMatrix shape_weights(const Mesh& mesh, const Joints& joints) {
  return geometric_weights(mesh, bone_distances(VoxelBody(mesh), joints, mesh.vertices),
                           shape_hints(mesh, joints));
}

std::string made_name(Naming naming, int joint) {
  const auto j = static_cast<size_t>(joint);
  switch (naming) {
    case Naming::Mixamo:
      return std::string("mixamorig:") + kMixamo[j];
    case Naming::Rigify:
      return kRigify[j];
    case Naming::Vrm:
      return kVrm[j];
    case Naming::Unreal:
      return kUnreal[j];
    case Naming::Biped:
      return kBiped[j];
    case Naming::Smpl:
      return kJointNames[j];
    case Naming::Words:
      return kWords[j];
    case Naming::Cmu:
      return kCmu[j];
    case Naming::None:
      return "";
  }
  return "";
}

Joints made_joints(const MadeCharacter& options) {
  Joints joints = 0.85f * human_rest();
  Pose pose;
  const float arm = options.arms_down_deg * kPi / 180, leg = options.legs_apart_deg * kPi / 180;
  pose.local[LeftShoulder] = Eigen::AngleAxisf(-arm, Vec3::UnitZ()).toRotationMatrix();
  pose.local[RightShoulder] = Eigen::AngleAxisf(arm, Vec3::UnitZ()).toRotationMatrix();
  pose.local[LeftHip] = Eigen::AngleAxisf(leg, Vec3::UnitZ()).toRotationMatrix();
  pose.local[RightHip] = Eigen::AngleAxisf(-leg, Vec3::UnitZ()).toRotationMatrix();
  pose.local[LeftAnkle] = pose.local[LeftHip].transpose();
  pose.local[RightAnkle] = pose.local[RightHip].transpose();
  joints = forward_kinematics(joints, pose).joints;
  joints.col(1).array() -= joints.col(1).minCoeff() - radius_of(LeftFoot);
  joints = (joints * rotation_about_y(options.heading_deg * kPi / 180).transpose()).eval();
  return joints;
}

Character make_character(const MadeCharacter& options) {
  MadeCharacter forward = options;  // tubes of feet and hands are made facing forward, then turned
  forward.heading_deg = 0;
  const Joints joints = made_joints(forward);
  Character out;
  out.name = "made";
  CharacterNode armature;
  armature.name = "Armature";
  armature.local.scale.setConstant(1 / options.unit);
  armature.local.rotation = Eigen::Quaternionf(rotation_about_y(options.heading_deg * kPi / 180));
  out.nodes.push_back(armature);
  if (options.rigged) add_bones(options, joints, out);
  for (const bool upper : {true, false}) {
    CharacterPart part = make_part(joints, upper, !upper);
    CharacterNode node;
    node.name = part.name + " node";
    node.parent = 0;
    part.node = static_cast<int>(out.nodes.size());
    part.material = upper ? 0 : 1;
    part.skin = options.rigged ? 0 : -1;
    if (!options.rigged) {
      part.joints.resize(0, 0);
      part.weights.resize(0, 0);
    } else if (options.influences == 8) {
      pull_more(kJointCount, part);
    }
    if (options.rigged && options.separate_skins && !upper) {
      out.skins.push_back(out.skins[0]);
      part.skin = 1;
    }
    out.nodes.push_back(node);
    out.parts.push_back(std::move(part));
  }
  if (options.textured) {
    out.images.push_back({"cloth", "image/png", made_picture()});
    out.samplers.push_back(R"({"wrapS":33071})");
    out.textures.push_back(R"({"sampler":0,"source":0})");
    out.materials.push_back(
        R"({"name":"shirt","pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicFactor":0.0}})");
  } else {
    out.materials.push_back(R"({"name":"shirt"})");
  }
  out.materials.push_back(
      R"({"name":"trousers","pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,1.0]}})");
  if (options.nested_scales) nest_scales(out);
  return out;
}

Character make_robot() {
  Character robot = make_character();
  robot.skins.clear();
  robot.parts.clear();
  for (int j = 0; j < kJointCount; ++j) {
    CharacterPart part;
    part.name = "plate";
    part.node = 1 + j;
    part.vertices = Points{{0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}, {0, 0, 0.1f}};
    part.faces = Faces{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    robot.parts.push_back(part);
  }
  return robot;
}

namespace {

/// The turn about y that takes `from` best to `to`, both centred: its cosine and sine, as long as it fits
/// well.
Eigen::Vector2f best_turn(const Points& from, const Points& to) {
  return {from.col(0).dot(to.col(0)) + from.col(2).dot(to.col(2)),
          from.col(2).dot(to.col(0)) - from.col(0).dot(to.col(2))};
}

}  // namespace

Extraction KnownExtractor::extract(const Mesh& scan) {
  if (first_.rows() == 0) first_ = scan.vertices;
  Extraction out;
  out.joints = joints_;
  if (scan.vertices.rows() != first_.rows()) return out;
  const Points to = scan.vertices.rowwise() - scan.vertices.colwise().mean();
  Points from = first_.rowwise() - first_.colwise().mean();
  const Eigen::Vector2f straight = best_turn(from, to);
  from.col(0) *= -1;
  const Eigen::Vector2f mirrored = best_turn(from, to);
  const bool in_mirror = mirrored.norm() > 1.0001f * straight.norm();
  const Eigen::Vector2f turn = in_mirror ? mirrored : straight;
  if (in_mirror)
    for (int j = 0; j < kJointCount; ++j)
      out.joints.row(j) =
          joints_.row(kMirror[static_cast<size_t>(j)]).cwiseProduct(Eigen::RowVector3f(-1, 1, 1));
  out.joints = (out.joints * rotation_about_y(std::atan2(turn.y(), turn.x())).transpose()).eval();
  return out;
}

void BulgingDeformer::bind(const Points& rest, const Joints& rest_joints) {
  rest_ = rest;
  joints_ = rest_joints;
  Mesh mesh;
  mesh.vertices = rest;
  weights_ = shape_weights(mesh, rest_joints);
}

std::shared_ptr<Deformer> BulgingDeformer::with_weights(RowMatrix weights) const {
  auto other = std::make_shared<BulgingDeformer>(*this);
  other->weights_ = std::move(weights);
  return other;
}

Points BulgingDeformer::offsets(const Pose& pose) const {
  Points out = Points::Zero(rest_.rows(), 3);
  for (const int j : {LeftKnee, RightKnee, LeftElbow, RightElbow}) {
    const float bend = geodesic_angle(Mat3::Identity(), pose.local[static_cast<size_t>(j)]);
    for (Eigen::Index v = 0; v < rest_.rows(); ++v) {
      const Vec3 d = (rest_.row(v) - joints_.row(j)).transpose();
      out.row(v) += (bulge_m_ * bend * std::exp(-d.squaredNorm() / 0.02f) * d.normalized()).transpose();
    }
  }
  return out;
}

Points BulgingDeformer::deform(const Pose& pose) const {
  return linear_blend_skinning(rest_ + offsets(pose), weights_, joints_, forward_kinematics(joints_, pose));
}

std::vector<Pose> made_motion(int count, const Joints& rest) {
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    const float t = static_cast<float>(i) / 10, swing = std::sin(2 * t);
    Pose pose;
    const auto turn = [&](int joint, float angle, const Vec3& axis) {
      pose.local[static_cast<size_t>(joint)] = Eigen::AngleAxisf(angle, axis).toRotationMatrix();
    };
    turn(Pelvis, 0.5f * t, Vec3::UnitY());
    turn(Spine2, 0.2f * swing, Vec3::UnitZ());
    turn(LeftHip, -0.6f * swing, Vec3::UnitX());
    turn(RightHip, 0.6f * swing, Vec3::UnitX());
    turn(LeftKnee, 0.5f + 0.5f * swing, Vec3::UnitX());
    turn(RightKnee, 0.5f - 0.5f * swing, Vec3::UnitX());
    turn(LeftShoulder, -1.0f + 0.3f * swing, Vec3::UnitZ());
    turn(RightShoulder, 1.0f + 0.3f * swing, Vec3::UnitZ());
    turn(LeftElbow, -0.8f + 0.4f * swing, Vec3::UnitY());
    turn(RightElbow, 0.8f + 0.4f * swing, Vec3::UnitY());
    turn(Head, 0.3f * swing, Vec3::UnitY());
    pose.root = rest.row(Pelvis).transpose() + Vec3(0.1f * t, 0.02f * swing, 0.4f * t);
    poses.push_back(pose);
  }
  return poses;
}

std::string made_picture() {
  static const unsigned char kBytes[] = {
      0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
      0x44, 0x52, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x02, 0x00, 0x00,
      0x00, 0x90, 0x77, 0x53, 0xde, 0x00, 0x00, 0x00, 0x0c, 0x49, 0x44, 0x41, 0x54, 0x78,
      0xda, 0x63, 0xf8, 0xff, 0xff, 0x3f, 0x00, 0x05, 0xfe, 0x02, 0xfe, 0x33, 0x12, 0x95,
      0x14, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  return {reinterpret_cast<const char*>(kBytes), sizeof kBytes};
}

}  // namespace understudy::tests
