#include "retarget/character/prepared_character.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "retarget/base/error.hpp"
#include "retarget/character/careful_deformer.hpp"
#include "retarget/character/geometric_binding.hpp"
#include "retarget/character/stance.hpp"
#include "retarget/character/vertex_colors.hpp"
#include "retarget/formats/import.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "retarget/pipeline/torn_surface.hpp"
#include "retarget/skeleton/skinning.hpp"

namespace understudy {
namespace {

constexpr float kSmallestTurn = 8 * kPi / 180;
constexpr float kBallHeight = 0.25f;   // of the ankle's over the floor
constexpr float kPelvisSlack = 0.03f;  // of the leg
constexpr float kRoughDeg = 4;         // joints that were seen, not given, are not better
constexpr float kRoughLegsDeg = 1.5f;  // the same of both legs together

/// The axis that a rig's spine points along, where that is not y.
std::string up_of_rig(const BoneMap& map, const BindPose& bind) {
  const auto place = [&](int joint) -> Vec3 { return bind.nodes[map.node[joint]].topRightCorner<3, 1>(); };
  const Vec3 up =
      0.5f * (place(LeftShoulder) + place(RightShoulder)) - 0.5f * (place(LeftKnee) + place(RightKnee));
  Eigen::Index axis = 1;
  up.cwiseAbs().maxCoeff(&axis);
  if (std::abs(up[axis]) < 0.8f * up.norm()) axis = 1;
  return std::string(up[axis] < 0 ? "-" : "") + "xyz"[axis];
}

/// The joint that moves each node.
std::vector<int> drivers(const PreparedCharacter& c) {
  const auto& nodes = c.character.nodes;
  std::vector<int> driver(nodes.size(), -1);
  std::vector<bool> carries(nodes.size(), false);
  for (size_t j = 0; j < kJointCount; ++j)
    if (c.map.node[j] >= 0) driver[c.map.node[j]] = j;
  for (const auto& part : c.character.parts) {
    if (part.skin < 0) carries[part.node] = true;
    for (Eigen::Index i = 0; i < part.joints.size(); ++i)
      if (part.weights.data()[i] > 0)
        carries[c.character.skins[part.skin].joints[part.joints.data()[i]]] = true;
  }
  std::vector<bool> moves(nodes.size(), false);
  for (size_t n = 0; n < nodes.size(); ++n) {
    const int p = nodes[n].parent;
    // What bears on the body but hangs on no mapped bone goes with the pelvis.
    if (driver[n] < 0 && carries[n] && (p < 0 || !moves[p])) driver[n] = Pelvis;
    moves[n] = driver[n] >= 0 || (p >= 0 && moves[p]);
  }
  return driver;
}

/// The rig's weights gathered at the joints that move its bones.
RowMatrix gathered_weights(const PreparedCharacter& c) {
  const std::vector<int> joint_of = joints_of_nodes(c);
  RowMatrix weights = RowMatrix::Zero(c.surface.mesh.vertices.rows(), kJointCount);
  size_t at = 0;
  for (const auto& part : c.character.parts)
    for (Eigen::Index v = 0; v < part.vertices.rows(); ++v, ++at) {
      auto row = weights.row(c.surface.map[at]);
      row.setZero();
      if (part.skin < 0) row[joint_of[part.node]] = 1;
      for (Eigen::Index k = 0; k < part.joints.cols(); ++k)
        row[joint_of[c.character.skins[part.skin].joints[part.joints(v, k)]]] += part.weights(v, k);
      row /= row.sum();
    }
  return weights;
}

/// Joints that the rig lacks lie between those it has, as in a mean human.
Joints complete_joints(const BoneMap& map, const Joints& known) {
  const Joints& human = human_rest();
  Joints out = known;
  const float scale = leg_length(known) > 1e-4f && map.has(LeftAnkle) && map.has(RightAnkle)
                          ? leg_length(known)
                          : (known.row(LeftShoulder) - known.row(LeftHip)).norm() /
                                (human.row(LeftShoulder) - human.row(LeftHip)).norm();
  for (int j = 1; j < kJointCount; ++j) {
    if (map.has(j)) continue;
    const int p = kParents[j];
    const auto step = [&](int a, int b) { return (human.row(b) - human.row(a)).norm(); };
    int next = -1;  // the nearest mapped joint below
    for (int d = j + 1; d < kJointCount && next < 0; ++d) {
      if (!map.has(d)) continue;
      for (int a = d; a >= 0; a = kParents[a])
        if (a == j) next = d;
    }
    if (next >= 0) {
      const float t = step(p, j) / (step(p, j) + step(j, next));
      out.row(j) = (1 - t) * out.row(p) + t * known.row(next);
    } else if (const int pp = kParents[p]; j == LeftWrist || j == RightWrist) {
      out.row(j) = out.row(p) + (out.row(p) - out.row(pp)) * step(p, j) / step(pp, p);
    } else {
      out.row(j) = out.row(p) + scale * (human.row(j) - human.row(p));
    }
  }
  return out;
}

/// A file of ours: bound in the very T-pose that it was performed from.
bool on_our_joints(const Character& character) {
  return character.skins.size() == 1 && character.skins[0].name == kOurSkin &&
         character.skins[0].joints.size() >= kJointCount;  // a root bone may come after
}

/// Rigs keep the bone that they call pelvis anywhere from the floor of the hips to the navel, or in front of
/// the belly, and it turns alike about any point. The body is led by one between the hips, where people are
/// seen to have theirs, unless the rig's own lies near it.
Eigen::RowVector3f pelvis_between(const Joints& known, bool has_own) {
  const Joints& human = human_rest();
  const float leg = leg_length(known);
  Eigen::RowVector3f between = 0.5f * (known.row(LeftHip) + known.row(RightHip));
  between.y() += leg * (human(Pelvis, 1) - 0.5f * (human(LeftHip, 1) + human(RightHip, 1)));
  const bool near = has_own && (known.row(Pelvis) - between).norm() < kPelvisSlack * leg;
  return near ? Eigen::RowVector3f(known.row(Pelvis)) : between;
}

Joints rig_joints(const PreparedCharacter& c) {
  Points places = Points::Zero(kJointCount, 3);
  for (int j = 0; j < kJointCount; ++j)
    if (c.map.has(j)) places.row(j) = c.bind.nodes[c.map.node[j]].topRightCorner<3, 1>().transpose();
  const Points moved = c.to_world.apply(places);
  Joints known = moved;
  if (!on_our_joints(c.character)) known.row(Pelvis) = pelvis_between(known, c.map.has(Pelvis));
  Joints joints = complete_joints(c.map, known);
  // Soles may be thinner than a human's: a ball that the rig lacks stays over them.
  for (const int foot : {LeftFoot, RightFoot})
    if (!c.map.has(foot)) joints(foot, 1) = std::max(joints(foot, 1), kBallHeight * joints(foot - 3, 1));
  return joints;
}

/// Turns everything so far.
void turn(PreparedCharacter& c, const Mat3& R) {
  c.to_world.R = R * c.to_world.R;
  c.to_world.t = R * c.to_world.t;
  c.surface.mesh.vertices = (c.surface.mesh.vertices * R.transpose()).eval();
}

void turn_about_y(PreparedCharacter& c, float yaw) {
  turn(c, rotation_about_y(yaw));
  c.notes.push_back("turned by " + std::to_string(std::lround(yaw * 180 / kPi)) + " degrees to face forward");
}

/// Quarter turns where it is nearly one: characters are modelled along the axes.
float tidy(float yaw) {
  const float quarter = std::round(yaw / (kPi / 2)) * kPi / 2;
  return std::abs(std::remainder(yaw - quarter, 2 * kPi)) < 2 * kSmallestTurn ? quarter : yaw;
}

/// The up axis of a body that lies flat with y up.
std::string up_of_lying(const PreparedCharacter& c, ImportOptions import) {
  if (c.rigged) return up_of_rig(c.map, c.bind);
  import.up.clear();
  const ImportDecision decision = decide_import(c.surface.mesh, import);
  Mesh upright = c.surface.mesh;
  decision.apply(upright);
  // Trunk, arms and head are more than the legs.
  return (stance_of(upright).centre < 0.46f ? "-" : "") + decision.up;
}

/// A source may crouch, a character stands: below half a metre it is nobody's size. Millimetres are guessed
/// of people down to there, but a character of a few hundred units has units of its own.
void refit(ImportDecision& decision, const CharacterOptions& options, Mesh mesh) {
  constexpr float kSmallest = 0.5f, kSmallestInMm = 0.84f, kUsual = 1.7f;
  const bool guessed = (options.units.empty() || options.units == "auto") && !options.height;
  const bool in_mm = decision.units == "mm";
  if (!guessed || decision.height >= (in_mm ? kSmallestInMm : kSmallest) || !(decision.height > 1e-9f))
    return;
  decision.apply(mesh);
  if (!in_mm && lies_down(stance_of(mesh))) return;
  const float factor = kUsual / decision.height;
  decision.sentence = "its units are unknown: it is made 1.7 m tall, up: " + decision.up;
  decision.scale *= factor;
  decision.floor *= factor;
  decision.height = kUsual;
  decision.units = "fit";
}

void place_in_world(PreparedCharacter& c, const CharacterOptions& options) {
  const Points& file = c.bind.vertices;
  ImportOptions import;
  import.units = options.units;
  import.up = options.up;
  import.floor = options.floor;
  import.height = options.height;
  if (c.rigged && (import.up.empty() || import.up == "auto")) import.up = up_of_rig(c.map, c.bind);
  c.surface = merged_surface(c.character, file);
  const std::string seen = c.rigged ? up_of_rig(c.map, c.bind) : "";
  if (seen == (import.up[0] == '-' ? import.up.substr(1) : "-" + import.up)) {
    US_CHECK(options.turn_if_lying, c.character.called(), ": is upside down with ", import.up, " up, ", seen,
             " up (--target-up) turns it over");
    c.notes.push_back("it is upside down with " + import.up + " up, so " + seen + " is taken as up");
    import.up = seen;
  } else if (import.up == "y" && lies_down(stance_of(c.surface.mesh))) {
    if (options.turn_if_lying) import.up = up_of_lying(c, import);
    c.notes.push_back(import.up == "y" ? "it lies down with y up"
                                       : "it lies down with y up, so " + import.up + " is taken as up");
  }
  ImportDecision decision = decide_import(c.surface.mesh, import);
  refit(decision, options, c.surface.mesh);
  US_CHECK(decision.height > 1e-9f && std::isfinite(decision.height), c.character.called(),
           ": has no height");
  c.to_world.scale = decision.scale;
  c.to_world.R = decision.axes;
  c.to_world.t = Vec3(0, -decision.floor, 0);
  c.surface.mesh.vertices = c.to_world.apply(c.surface.mesh.vertices);
  paint(c.surface, c.character);
  c.notes.push_back(decision.sentence);
  if (decision.units == "fit" && !options.height) c.doubt = "its size is no person's in any unit";
}

/// Refuses or warns of what does not stand like a person. Bones that are a person's outweigh wide wings, not
/// feet far apart.
void check_stance(PreparedCharacter& c, const CharacterOptions& options) {
  constexpr float kFourFeet = 0.6f;
  const Stance stance = stance_of(c.surface.mesh);
  const std::string why_not = refusal(stance), why_implausible = implausibility(stance);
  const bool refused = !c.rigged || (options.not_a_person == NotAPerson::Refuse && stance.feet > kFourFeet);
  if (!why_not.empty() && refused && options.not_a_person != NotAPerson::Use)
    throw NotAPersonError(c.character.called() + ": does not look like a person: " + why_not);
  if (!(c.rigged ? why_not : why_implausible).empty())
    c.target.warnings.push_back("the target may not be a person: " + why_implausible);
  if (c.doubt.empty()) c.doubt = doubt(stance);
}

/// The same of what no person is recognised in.
void check_person(const PreparedCharacter& c, const SideViews& seen, const CharacterOptions& options) {
  if (options.not_a_person != NotAPerson::Refuse || c.doubt.empty() || !shows_nobody(seen)) return;
  throw NotAPersonError(c.character.called() +
                        ": does not look like a person: no person recognised in it, and " + c.doubt);
}

void note_turns(PreparedCharacter& c) {
  if (c.pose.largest_deg >= 0.5f)
    c.notes.push_back("its limbs are brought to the T-pose by up to " +
                      std::to_string(std::lround(c.pose.largest_deg)) + " degrees");
}

struct Line {
  Vec3 middle, along;
};

/// Through points with a weight over 0.8, in the direction in which they reach furthest, on the side of
/// `like`; none where they are few.
std::optional<Line> long_axis(const Points& points, const Eigen::VectorXf& weights, const Vec3& like) {
  Vec3 mean = Vec3::Zero();
  float count = 0;
  for (Eigen::Index v = 0; v < points.rows(); ++v)
    if (weights[v] > 0.8f) {
      mean += points.row(v).transpose();
      ++count;
    }
  if (count < 10) return std::nullopt;
  mean /= count;
  Mat3 covariance = Mat3::Zero();
  for (Eigen::Index v = 0; v < points.rows(); ++v)
    if (weights[v] > 0.8f) {
      const Vec3 d = points.row(v).transpose() - mean;
      covariance += d * d.transpose();
    }
  const Vec3 axis = Eigen::SelfAdjointEigenSolver<Mat3>(covariance).eigenvectors().col(2);
  return Line{mean, axis.dot(like) < 0 ? Vec3(-axis) : axis};
}

/// Rigs made for posing by the feet keep the ankle's bone at the sole, or in front: where shins do not lie
/// along their bones, it is the shins that stand upright in the T-pose.
RestPose rest_pose_of_rig(const PreparedCharacter& c) {
  if (on_our_joints(c.character)) {
    RestPose bound;
    bound.bind = bound.rest = rig_joints(c);
    return bound;
  }
  constexpr float kLeast = 3 * kPi / 180;
  const Joints joints = rig_joints(c);
  Joints seen = joints;
  for (const int knee : {LeftKnee, RightKnee}) {
    const Vec3 bone = (joints.row(knee + 3) - joints.row(knee)).transpose();
    const auto shin = long_axis(c.surface.mesh.vertices, c.weights.col(knee), bone);
    if (shin && shin->along.cross(bone.normalized()).norm() > std::sin(kLeast))
      seen.row(knee + 3) = joints.row(knee) + bone.norm() * shin->along.transpose();
  }
  return with_joints(to_t_pose(seen), joints);
}

void turn_rig_forward(PreparedCharacter& c, const CharacterOptions& options) {
  const float yaw =
      options.turn_deg ? -*options.turn_deg * kPi / 180 : tidy(heading_of_joints(rig_joints(c)));
  if (std::abs(std::remainder(yaw, 2 * kPi)) > 1e-3f) turn_about_y(c, -yaw);
}

void find_in_rig(PreparedCharacter& c) {
  c.driver = drivers(c);
  c.weights = gathered_weights(c);
  c.pose = rest_pose_of_rig(c);
  c.pose_weights = c.weights;
  Mesh mesh = c.surface.mesh;
  mesh.vertices = in_t_pose(mesh.vertices, c.weights, c.pose);
  note_turns(c);
  const float parted = TornSurface(c.surface.mesh, c.weights).parted(mesh.vertices);
  c.target = prepare_target(mesh, c.pose.rest);
  if (parted > TornSurface::kMost)
    c.target.warnings.push_back("the target falls apart in T-pose: the bones of its joints may be wrong");
}

/// Extracted shoulders of bodies unlike those the network knows are rough, forearms and hands stand free and
/// can be measured. An arm that is nearly straight is taken as straight, and its shoulder put on its line.
Joints with_straight_arms(const VoxelBody& body, const Points& vertices, const Joints& joints) {
  constexpr float kLeast = 15 * kPi / 180, kMost = 60 * kPi / 180;
  constexpr Eigen::Index kEnough = 4000;
  const Eigen::Index step = 1 + vertices.rows() / kEnough;
  Points some((vertices.rows() + step - 1) / step, 3);
  for (Eigen::Index i = 0; i < some.rows(); ++i) some.row(i) = vertices.row(i * step);
  const RowMatrix weights = weights_by_distance(bone_distances(body, joints, some));
  Joints out = joints;
  for (const int right : {0, 1}) {
    const int shoulder = LeftShoulder + right, elbow = LeftElbow + right, wrist = LeftWrist + right;
    const Vec3 upper = (joints.row(elbow) - joints.row(shoulder)).transpose();
    const auto arm = long_axis(some, weights.col(elbow) + weights.col(wrist),
                               (joints.row(wrist) - joints.row(elbow)).transpose());
    if (!arm) continue;
    const Vec3& axis = arm->along;
    const float bend = std::atan2(upper.cross(axis).norm(), upper.dot(axis));
    if (bend < kLeast || bend > kMost) continue;
    const auto onto_arm = [&](int j) -> Vec3 {
      return arm->middle + axis * axis.dot(joints.row(j).transpose() - arm->middle);
    };
    // Relaxed elbows bend forward: seen from the front alone the arm is straight.
    const Vec3 line = Vec3(axis.x(), axis.y(), upper.z() / upper.norm()).normalized();
    // How far out the shoulder lies is seen better than how high.
    const Vec3 hinge = onto_arm(elbow);
    const float out_to = hinge.x() - joints(shoulder, 0);
    const float length = std::abs(line.x()) > 0.3f ? out_to / line.x() : upper.norm();
    out.row(shoulder) = (hinge - std::clamp(length, 0.3f * upper.norm(), upper.norm()) * line).transpose();
    out.row(elbow) = hinge.transpose();
    out.row(wrist) = onto_arm(wrist).transpose();
  }
  return out;
}

/// Networks take a part of a head much larger than a human's for neck and chest.
Joints with_seen_neck(const Mesh& mesh, const Joints& joints) {
  const auto neck = neck_under_big_head(mesh, joints);
  const float bottom = joints(Pelvis, 1), reach = joints(Neck, 1) - bottom;
  if (!neck || joints(Neck, 1) - neck->y() < 0.05f * leg_length(joints)) return joints;
  const float share = (neck->y() - bottom) / reach;
  if (!(share > 0.3f)) return joints;
  Joints out = joints;
  for (const int j : {Spine1, Spine2, Spine3, LeftCollar, RightCollar})
    out(j, 1) = bottom + share * (joints(j, 1) - bottom);
  for (const int j : {LeftShoulder, RightShoulder})
    if (joints(j, 1) > neck->y()) out(j, 1) = bottom + share * (joints(j, 1) - bottom);
  out.row(Neck) = neck->transpose();
  out.row(Head) += out.row(Neck) - joints.row(Neck);
  return out;
}

/// Half a turn about z, onto the same floor.
void turn_over(PreparedCharacter& c, const CharacterOptions& options) {
  turn(c, Eigen::AngleAxisf(kPi, Vec3::UnitZ()).toRotationMatrix());
  Points& vertices = c.surface.mesh.vertices;
  const float lift = options.floor ? -2 * *options.floor : -vertices.col(1).minCoeff();
  vertices.col(1).array() += lift;
  c.to_world.t.y() += lift;
  c.notes.push_back("it is upside down, so it is turned over");
}

void find_in_shape(PreparedCharacter& c, SkeletonExtractor& any_pose, SkeletonExtractor* t_pose,
                   const CharacterOptions& options) {
  SideViews seen = seen_from_sides(c.surface.mesh, any_pose);
  check_person(c, seen, options);
  if (is_upside_down(seen)) {
    US_CHECK(options.turn_if_lying || options.up == "auto", c.character.called(), ": is upside down with ",
             options.up, " up, another up axis (--target-up) turns it over");
    turn_over(c, options);
    seen = seen_from_sides(c.surface.mesh, any_pose);
  }
  if (!options.turn_deg) {
    const float yaw = tidy(body_heading(c.surface.mesh, seen));
    if (std::abs(std::remainder(yaw, 2 * kPi)) > kSmallestTurn) turn_about_y(c, -yaw);
  }
  Mesh mesh = c.surface.mesh;
  auto body = std::make_unique<VoxelBody>(mesh);
  const Joints found =
      with_straight_arms(*body, mesh.vertices, with_seen_neck(mesh, prepare_target(mesh, any_pose).joints));
  c.pose = to_t_pose(found, kRoughDeg);
  spread_legs(c.pose, kRoughLegsDeg);
  if (c.pose.largest_deg > 0) {
    c.pose_weights =
        geometric_weights(mesh, bone_distances(*body, found, mesh.vertices), shape_hints(mesh, found));
    mesh.vertices = in_t_pose(mesh.vertices, c.pose_weights, c.pose);
    body = std::make_unique<VoxelBody>(mesh);
  }
  note_turns(c);
  c.target = prepare_target(mesh, t_pose != nullptr ? *t_pose : any_pose);
  c.target.joints = with_straight_arms(*body, mesh.vertices, with_seen_neck(mesh, c.target.joints));
}

}  // namespace

Joints moved_bind_joints(const RestPose& pose, const Joints& rest) {
  Joints out;
  for (int j = 0; j < kJointCount; ++j)  // in the axes of the bind pose
    out.row(j) = pose.bind.row(j) + (rest.row(j) - pose.rest.row(j)) * pose.to_rest[j];
  return out;
}

std::vector<int> joints_of_nodes(const PreparedCharacter& c) {
  std::vector<int> joint_of = c.driver;
  for (size_t n = 0; n < joint_of.size(); ++n)
    if (const int p = c.character.nodes[n].parent; joint_of[n] < 0)
      joint_of[n] = p >= 0 ? joint_of[p] : static_cast<int>(Pelvis);
  return joint_of;
}

PreparedCharacter load_character(Character character, const CharacterOptions& options) {
  US_CHECK(character.vertex_count() > 0, character.called(), ": holds no mesh");
  PreparedCharacter c;
  c.character = std::move(character);
  // Files are written node by node: the same order here keeps vertices in theirs.
  std::stable_sort(c.character.parts.begin(), c.character.parts.end(),
                   [](const auto& a, const auto& b) { return a.node < b.node; });
  c.bind = bind_pose(c.character);
  US_CHECK(c.bind.vertices.allFinite(), c.character.called(),
           ": its bind pose has numbers that are not finite");
  c.map = map_bones(c.character, c.bind.nodes, options.choices);
  c.rigged = c.map.usable();
  if (!c.rigged && !c.character.skins.empty())
    c.notes.push_back("its bones could not be mapped (" + std::to_string(c.map.count()) +
                      " of 22): its own rig is not used");
  if (const std::string note = guess_note(c.map); c.rigged && !note.empty()) c.notes.push_back(note);
  place_in_world(c, options);
  check_stance(c, options);
  if (c.rigged)
    turn_rig_forward(c, options);
  else if (options.turn_deg && *options.turn_deg != 0)
    turn_about_y(c, *options.turn_deg * kPi / 180);
  return c;
}

void find_t_pose(PreparedCharacter& c, SkeletonExtractor* any_pose, SkeletonExtractor* t_pose,
                 const CharacterOptions& options) {
  const std::vector<std::string> warnings = std::move(c.target.warnings);
  if (c.rigged) {
    find_in_rig(c);
    SkeletonExtractor* const network = t_pose != nullptr ? t_pose : any_pose;
    if (!options.own_joints && network != nullptr) c.target = prepare_target(c.target.mesh, *network);
  } else {
    US_CHECK(any_pose != nullptr, c.character.name, ": has no known rig, and the networks may not be used");
    find_in_shape(c, *any_pose, t_pose, options);
  }
  c.target.warnings.insert(c.target.warnings.end(), warnings.begin(), warnings.end());
}

PreparedCharacter prepare_character(Character character, SkeletonExtractor* any_pose,
                                    SkeletonExtractor* t_pose, const CharacterOptions& options) {
  PreparedCharacter c = load_character(std::move(character), options);
  find_t_pose(c, any_pose, t_pose, options);
  return c;
}

Mesh PreparedCharacter::target_in_file_order() const {
  Mesh out;
  out.vertices = surface.in_file_order(target.mesh.vertices);
  std::vector<int> file_of(target.mesh.vertices.rows(), 0);
  for (size_t i = surface.in_file.size(); i-- > 0;) file_of[surface.in_file[i]] = i;
  out.faces = target.mesh.faces.unaryExpr([&](int v) { return file_of[v]; });
  if (target.mesh.colors.rows() > 0) out.colors = surface.in_file_order(target.mesh.colors);
  return out;
}

FoldingTransfer::FoldingTransfer(std::shared_ptr<MotionTransfer> inner, const BoneMap& map)
    : inner_(std::move(inner)) {
  for (int j = 0; j < kJointCount; ++j) mapped_[j] = map.has(j);
}

Rotations FoldingTransfer::push(const Extraction& source, float dt) {
  const Rotations local = inner_->push(source, dt);
  Rotations wanted, folded;
  for (size_t j = 0; j < kJointCount; ++j) {
    const int p = kParents[j];
    wanted[j] = p < 0 ? local[j] : Mat3(wanted[p] * local[j]);
    folded[j] = mapped_[j] || p < 0 ? wanted[j] : folded[p];
  }
  return local_rotations(folded);
}

namespace {

/// Offsets correct what a network's own weights get wrong: 1 where a rig's are alike, 0 where they are others
/// and the offsets say nothing of them.
Eigen::VectorXf trust_in_offsets(const RowMatrix& own, const RowMatrix& rig) {
  constexpr float kAlike = 0.3f, kUnlike = 1.0f;  // summed differences, 2 at most
  const Eigen::ArrayXf differ = (own - rig).cwiseAbs().rowwise().sum().array();
  return 1 - ((differ - kAlike) / (kUnlike - kAlike)).max(0.0f).min(1.0f);
}

}  // namespace

RigDeformer::RigDeformer(const PreparedCharacter& character, std::shared_ptr<Deformer> inner)
    : inner_(std::move(inner)),
      bind_vertices_(character.surface.mesh.vertices),
      pose_(character.pose),
      rest_joints_(character.pose.rest),
      bind_joints_(character.pose.bind),
      weights_(character.weights) {
  US_CHECK(weights_.rows() == bind_vertices_.rows(), "the character has no rig to deform with");
}

void RigDeformer::bind(const Points& rest, const Joints& rest_joints) {
  US_CHECK(rest.rows() == bind_vertices_.rows(), "the target has ", rest.rows(), " vertices, the character ",
           bind_vertices_.rows());
  rest_joints_ = rest_joints;
  bind_joints_ = moved_bind_joints(pose_, rest_joints);
  if (!inner_) return;
  inner_->bind(rest, rest_joints);
  trust_ = trust_in_offsets(inner_->weights(), weights_);
  inner_ = inner_->with_weights(weights_);
}

std::shared_ptr<Deformer> RigDeformer::with_weights(RowMatrix weights) const {
  US_CHECK(weights.rows() == weights_.rows() && weights.cols() == kJointCount && weights.allFinite() &&
               weights.minCoeff() >= 0 && weights.rowwise().sum().minCoeff() > 1e-6f,
           "skin weights must fit the target and not be negative, and every vertex needs some");
  auto other = std::make_shared<RigDeformer>(*this);
  other->weights_ = weights.array().colwise() / weights.rowwise().sum().array();
  if (inner_) other->inner_ = inner_->with_weights(other->weights_);
  return other;
}

Points RigDeformer::deform(const Pose& pose) const {
  const PosedSkeleton posed = forward_kinematics(rest_joints_, pose);
  PosedSkeleton from_bind = posed;
  for (size_t j = 0; j < kJointCount; ++j) from_bind.global[j] = posed.global[j] * pose_.to_rest[j];
  Points out = linear_blend_skinning(bind_vertices_, weights_, bind_joints_, from_bind);
  if (!inner_) return out;
  // Offsets turn with the joints: skinned as points about joints that stay at the origin.
  PosedSkeleton turned = posed;
  turned.joints.setZero();
  out += linear_blend_skinning(offsets(pose), weights_, Joints::Zero(), turned);
  return out;
}

Points RigDeformer::offsets(const Pose& pose) const {
  if (!inner_) return Points::Zero(bind_vertices_.rows(), 3);
  return inner_->offsets(pose).array().colwise() * trust_.array();
}

Networks networks_for(Networks networks, const PreparedCharacter& character, bool their_rig) {
  if (!character.rigged || !their_rig) {
    networks.deformer = std::make_shared<CarefulDeformer>(character.target.mesh.faces, networks.deformer);
    return networks;
  }
  networks.transfer = std::make_unique<FoldingTransfer>(std::move(networks.transfer), character.map);
  networks.deformer = std::make_shared<RigDeformer>(character, networks.deformer);
  return networks;
}

}  // namespace understudy
