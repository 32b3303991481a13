#include "retarget/motion/skeletal_motion.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr float kDoubtfulDeg = 75;                    // no bind pose leaves the T-pose so far
constexpr float kPosedCostDeg = 20;                   // the nodes' own pose is the likelier bind pose
constexpr float kNearFloor = 0.04f;                   // of the legs
constexpr int64_t kLookedAt = 500;                    // frames that up and floor are read from
constexpr float kThickness = 0.09f, kRingAt = 0.15f;  // of a bone's length, where it is shown

struct Shapes {
  std::vector<float> vertices;     // [V, 3]
  std::vector<int> bone, corners;  // of each vertex; [F, 3]
};

/// Both ends and a ring of four.
void add_octahedron(Shapes& shapes, int node, const Vec3& from, const Vec3& to) {
  const Vec3 along = to - from;
  const float radius = kThickness * along.norm();
  const Vec3 side = along.unitOrthogonal() * radius, other = along.normalized().cross(side);
  const Vec3 ring = from + kRingAt * along;
  const auto first = static_cast<int>(shapes.bone.size());
  for (const Vec3& v :
       {from, to, Vec3(ring + side), Vec3(ring + other), Vec3(ring - side), Vec3(ring - other)}) {
    shapes.vertices.insert(shapes.vertices.end(), v.data(), v.data() + 3);
    shapes.bone.push_back(node);
  }
  for (int i = 0; i < 4; ++i) {
    const int a = first + 2 + i, b = first + 2 + (i + 1) % 4;
    for (const int v : {first, b, a, first + 1, a, b}) shapes.corners.push_back(v);
  }
}

void check_bones(const BoneMap& map, const std::string& name) {
  US_CHECK(map.usable(), name, ": only ", map.count(),
           " of the 22 joints were found among its bones, too few to retarget; use a map, or its "
           "surface as a scan");
}

/// Something to look at where a file holds bones alone: an octahedron from each bone under the pelvis to each
/// of its children, bound to the bones in the pose of the nodes.
void add_bone_shapes(Character& character, const BoneChoices& choices) {
  const std::vector<Mat4> world = character.world();
  CharacterSkin skin;
  skin.name = "bones";
  for (size_t n = 0; n < world.size(); ++n) {
    skin.joints.push_back(n);
    skin.inverse_bind.push_back(world[n].inverse());
  }
  character.skins.push_back(std::move(skin));
  const BoneMap map = map_bones(character, world, choices);
  check_bones(map, character.called());
  const auto place = [&](size_t n) -> Vec3 { return world[n].topRightCorner<3, 1>(); };
  std::vector<bool> in_body(character.nodes.size(), false);
  Shapes shapes;
  for (size_t n = 0; n < character.nodes.size(); ++n) {
    const int p = character.nodes[n].parent;
    in_body[n] = static_cast<int>(n) == map.node[Pelvis] || (p >= 0 && in_body[p]);
    if (!in_body[n] || static_cast<int>(n) == map.node[Pelvis]) continue;
    const Vec3 from = place(p), to = place(n);
    if ((to - from).norm() > 1e-6f * (1 + to.norm())) add_octahedron(shapes, p, from, to);
  }
  US_CHECK(!shapes.vertices.empty(), character.called(), ": none of its bones has a length");
  CharacterPart part;
  part.name = "bones";
  part.node = character.nodes.size();
  part.skin = static_cast<int>(character.skins.size()) - 1;
  const Eigen::Index count = shapes.bone.size();
  part.vertices = Eigen::Map<const Points>(shapes.vertices.data(), count, 3);
  part.joints.setZero(count, 4);
  part.joints.col(0) = Eigen::Map<const Eigen::VectorXi>(shapes.bone.data(), count);
  part.weights.setZero(count, 4);
  part.weights.col(0).setOnes();
  part.faces =
      Eigen::Map<const Faces>(shapes.corners.data(), static_cast<Eigen::Index>(shapes.corners.size() / 3), 3);
  character.nodes.emplace_back().name = part.name;
  character.parts.push_back(std::move(part));
}

/// The character with its nodes in the pose of an animation's first frame.
Character in_first_frame(Character character, int clip, const ClipTimes& times) {
  const std::vector<Mat4> world = nodes_at(character, clip, times.at(0)).world;
  for (size_t n = 0; n < world.size(); ++n) {
    const int p = character.nodes[n].parent;
    character.nodes[n].local = Transform::from(p < 0 ? world[n] : Mat4(world[p].inverse() * world[n]));
  }
  return character;
}

PreparedCharacter prepared(Character character, const SkeletalMotionOptions& options) {
  if (character.vertex_count() == 0) add_bone_shapes(character, options.bones);
  const BoneMap map = map_bones(character, bind_pose(character).nodes, options.bones);
  check_bones(map, character.called());
  CharacterOptions how;
  how.choices = options.bones;
  how.units = options.import.units;
  how.height = options.import.height;
  how.up = "auto";
  return prepare_character(std::move(character), nullptr, nullptr, how);
}

/// A skin knows its bind pose. Bones alone are in it, or take it in the first frame.
PreparedCharacter in_bind_pose(const Character& character, int clip, const ClipTimes& times,
                               const SkeletalMotionOptions& options) {
  PreparedCharacter own = prepared(character, options);
  if (!character.skins.empty()) return own;
  PreparedCharacter first = prepared(in_first_frame(character, clip, times), options);
  const bool is_first = first.pose.largest_deg + kPosedCostDeg < own.pose.largest_deg;
  PreparedCharacter& better = is_first ? first : own;
  if (is_first) better.notes.push_back("its first frame is taken for the T-pose");
  if (better.pose.largest_deg > kDoubtfulDeg)
    better.notes.push_back(
        "neither its bones nor its first frame are in a T- or A-pose: limbs may be twisted");
  return std::move(better);
}

Mat3 linear(const Mat4& matrix) {
  return matrix.topLeftCorner<3, 3>();
}

Vec3 place(const Mat4& matrix) {
  return matrix.topRightCorner<3, 1>();
}

Mat3 upright(const std::string& up) {
  static const std::array<const char*, 6> names = {"x", "y", "z", "-x", "-y", "-z"};
  const auto found = std::find(names.begin(), names.end(), up);
  US_CHECK(found != names.end(), "up is auto, x, y, z, -x, -y or -z, not '", up, "'");
  const auto i = static_cast<int>(found - names.begin());
  return rotation_between(Vec3::Unit(i % 3) * (i < 3 ? 1.0f : -1.0f), Vec3::UnitY());
}

}  // namespace

SkeletalMotion::SkeletalMotion(const Character& character, const SkeletalMotionOptions& options)
    : clip_(chosen_clip(character, options.clip)),
      times_(clip_times(character, clip_, options.fps)),
      c_(in_bind_pose(character, clip_, times_, options)),
      support_(SupportPoints::from(c_.target.mesh.vertices, c_.target.joints)),
      has_skin_(character.vertex_count() > 0) {
  bear_joints();
  find_axes(options.import);
  find_floor(options.import);
  note_decisions();
}

Points SkeletalMotion::to_world(const Points& points) const {
  return ((c_.to_world.scale * points * axes_.transpose()).rowwise() + Eigen::RowVector3f(0, -floor_, 0))
      .eval();
}

void SkeletalMotion::bear_joints() {
  for (int j = 0; j < kJointCount; ++j) {
    int above = j;
    while (above >= 0 && !c_.map.has(above)) above = kParents[above];
    const int node = c_.map.node[std::max(0, above)];
    bearer_[j] = node;
    from_bind_[j] = linear(c_.bind.nodes[node]).inverse();
  }
}

/// The axis that heads point along: of a file of bones alone the offsets may be y up, the motion z up.
std::string SkeletalMotion::up_of_motion() const {
  Vec3 sum = Vec3::Zero();
  const int64_t step = std::max<int64_t>(1, times_.count / kLookedAt);
  for (int64_t f = 0; f < times_.count; f += step) {
    const PosedNodes nodes = posed(f);
    const auto at = [&](int j) { return place(nodes.world[bearer_[j]]); };
    sum += (at(LeftShoulder) + at(RightShoulder) - at(LeftHip) - at(RightHip)).normalized();
  }
  Eigen::Index axis = 1;
  const float most = sum.cwiseAbs().maxCoeff(&axis);
  if (most < 0.8f * sum.norm()) return "";
  return std::string(sum[axis] < 0 ? "-" : "") + "xyz"[axis];
}

void SkeletalMotion::find_axes(const ImportOptions& import) {
  axes_ = c_.to_world.R;
  std::string up = import.up == "auto" ? "" : import.up;
  if (up.empty() && !has_skin_) up = up_of_motion();
  // Where the bind pose has the same up, the heading that it was turned to counts, too.
  if (!up.empty() && (axes_ * upright(up).transpose() * Vec3::UnitY()).y() < 0.9f) axes_ = upright(up);
  axes_ = rotation_about_y(import.turn_deg * kPi / 180) * axes_;
}

/// Of a skin the floor under its bind pose or the file's zero, where the soles come near to one of them; else
/// where the soles are mostly at their lowest.
void SkeletalMotion::find_floor(const ImportOptions& import) {
  floor_ = import.floor.value_or(-c_.to_world.t.y());
  if (import.floor) return;
  std::vector<float> soles;
  const int64_t step = std::max<int64_t>(1, times_.count / kLookedAt);
  for (int64_t f = 0; f < times_.count; f += step) soles.push_back(lowest(joints(posed(f))));
  std::sort(soles.begin(), soles.end());
  const float low = soles[soles.size() / 20];
  US_CHECK(std::isfinite(low), c_.character.called(), ": its animation has numbers that are not finite");
  const float near = kNearFloor * leg_length(c_.target.joints), over_zero = low + floor_;
  if (has_skin_ && std::abs(over_zero) < std::min(near, std::abs(low)))
    floor_ = 0;
  else if (!has_skin_ || std::abs(low) > near)
    floor_ += low;
}

PosedSkeleton SkeletalMotion::joints(const PosedNodes& nodes) const {
  PosedSkeleton out;
  Points places(kJointCount, 3);
  std::array<Mat3, kJointCount> moved;  // from the bind pose in the program's world to now
  for (size_t j = 0; j < kJointCount; ++j) {
    const Mat4& node = nodes.world[bearer_[j]];
    moved[j] = axes_ * nearest_rotation(linear(node) * from_bind_[j]) * c_.to_world.R.transpose();
    out.global[j] = moved[j] * c_.pose.to_rest[j].transpose();
    places.row(j) = place(node).transpose();
  }
  out.joints = to_world(places);
  for (int j = 1; j < kJointCount; ++j) {
    const int p = kParents[j];
    if (!c_.map.has(j))  // fixed to what is above it
      out.joints.row(j) =
          out.joints.row(p) + (c_.pose.bind.row(j) - c_.pose.bind.row(p)) * moved[j].transpose();
  }
  return out;
}

void SkeletalMotion::note_decisions() {
  const auto& all = c_.character.animations;
  std::string text = "animation '" + excerpt(all[clip_].name) + "'";
  if (all.size() > 1) text += " (" + std::to_string(clip_ + 1) + " of " + std::to_string(all.size()) + ")";
  text += ", " + std::to_string(times_.count) + " frames at " + printed("%g frames/s", times_.fps);
  // What was decided of the bind pose gives way to what is so of the motion.
  const auto of_bind = [](const std::string& note) { return starts_with(note, "units: "); };
  c_.notes.erase(std::remove_if(c_.notes.begin(), c_.notes.end(), of_bind), c_.notes.end());
  c_.notes.insert(c_.notes.begin(), text);
  Eigen::Index up = 1;
  const Vec3 direction = axes_.transpose() * Vec3::UnitY();
  direction.cwiseAbs().maxCoeff(&up);
  c_.notes.push_back("a unit is " + printed("%g m", static_cast<double>(c_.to_world.scale)) +
                     ", up: " + (direction[up] < 0 ? "-" : "") + "xyz"[up] + ", floor at " +
                     printed("%.2f m", static_cast<double>(floor_)));
  c_.notes.push_back(std::to_string(c_.map.count()) + " of 22 joints are mapped " + c_.map.how);
}

Eigen::Matrix4d SkeletalMotion::to_file() const {
  ImportDecision decision;
  decision.scale = c_.to_world.scale;
  decision.axes = axes_;
  decision.floor = floor_;
  return decision.to_file();
}

Extraction SkeletalMotion::skeleton(int64_t frame) const {
  const PosedSkeleton skeleton = joints(posed(frame));
  Extraction out = exact_extraction(skeleton);
  out.sole_height = lowest(skeleton);
  for (int j = 0; j < kJointCount; ++j) out.confidence[j] = c_.map.has(j) ? 1.0f : 0.5f;
  return out;
}

Mesh SkeletalMotion::surface(int64_t frame) const {
  Mesh mesh;
  mesh.vertices = to_world(c_.surface.merged(vertices_at(c_.character, clip_, times_.at(frame))));
  mesh.faces = c_.surface.mesh.faces;
  return mesh;
}

}  // namespace understudy
