#include "retarget/character/character_export.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/character/joined_characters.hpp"
#include "retarget/character/own_bones.hpp"

namespace understudy {
namespace {

constexpr float kStill = 1e-5f;  // metres: a translation that moves less is none
constexpr size_t kCompared = 60;

/// How a vertex of the surface is turned from the bind pose to the T-pose.
Mat3 turned_to_t_pose(const PreparedCharacter& c, Eigen::Index vertex) {
  if (c.pose_weights.rows() == 0) return Mat3::Identity();
  Mat3 turned = Mat3::Zero();
  for (int j = 0; j < kJointCount; ++j)
    if (c.pose_weights(vertex, j) > 0) turned += c.pose_weights(vertex, j) * c.pose.to_rest[j];
  return turned;
}

/// The linear part that carries each vertex of a part from the file to the T-pose, metres: [V] of 3 x 3.
std::vector<Mat3> to_t_pose_maps(const PreparedCharacter& c, const CharacterPart& part, Eigen::Index first,
                                 const std::vector<Mat4>& nodes) {
  const Mat3 world = c.to_world.scale * c.to_world.R;
  std::vector<Mat3> bones;
  if (part.skin >= 0) {
    const CharacterSkin& skin = c.character.skins[part.skin];
    for (size_t j = 0; j < skin.joints.size(); ++j)
      bones.push_back((nodes[skin.joints[j]] * skin.inverse_bind[j]).topLeftCorner<3, 3>());
  }
  std::vector<Mat3> out;
  for (Eigen::Index v = 0; v < part.vertices.rows(); ++v) {
    Mat3 bound = Mat3::Zero();
    if (part.skin < 0) bound = nodes[part.node].topLeftCorner<3, 3>();
    for (Eigen::Index k = 0; k < part.joints.cols(); ++k)
      if (part.weights(v, k) > 0) bound += part.weights(v, k) * bones[part.joints(v, k)];
    out.push_back(turned_to_t_pose(c, c.surface.map[first + v]) * world * bound);
  }
  return out;
}

std::string fresh_name(const std::string& name, const std::vector<CharacterAnimation>& taken) {
  std::string out = name;
  for (int i = 2; std::any_of(taken.begin(), taken.end(), [&](const auto& a) { return a.name == out; }); ++i)
    out = name + " " + std::to_string(i);
  return out;
}

/// A node that poses move.
struct MovedNode {
  int node;
  float metres = 1;  // of a unit of its translation
};

/// Frames of one clip as local transforms of the nodes that move.
struct Sampled {
  std::vector<std::vector<Transform>> local;  // [frames][nodes]
  std::vector<std::vector<float>> shapes;     // [frames][shapes]
  std::vector<float> times;
};

/// Of the node that is number `at` of those that move.
CharacterTrack track_of(const Sampled& sampled, size_t at, int node, TrackPath path) {
  CharacterTrack track;
  track.node = node;
  track.path = path;
  track.times = sampled.times;
  Eigen::Vector4f before = Eigen::Vector4f::Zero();
  for (const auto& frame : sampled.local) {
    if (path == TrackPath::Translation) {
      const Vec3& t = frame[at].translation;
      track.values.insert(track.values.end(), t.data(), t.data() + 3);
      continue;
    }
    Eigen::Vector4f q = frame[at].rotation.normalized().coeffs();
    if (q.dot(before) < 0) q = -q;  // q and -q are one rotation; the nearer one keeps interpolation short
    track.values.insert(track.values.end(), q.data(), q.data() + 4);
    before = q;
  }
  return track;
}

CharacterAnimation animation_of(const std::string& name, const Sampled& sampled,
                                const std::vector<MovedNode>& moved, const Character& out) {
  CharacterAnimation animation;
  animation.name = name;
  for (size_t at = 0; at < moved.size(); ++at) {
    const auto& [node, metres] = moved[at];
    float furthest = 0;  // from where the node is without animation, in its units
    for (const auto& frame : sampled.local)
      furthest = std::max(furthest, (frame[at].translation - out.nodes[node].local.translation).norm());
    if (furthest * metres > kStill)
      animation.tracks.push_back(track_of(sampled, at, node, TrackPath::Translation));
    animation.tracks.push_back(track_of(sampled, at, node, TrackPath::Rotation));
  }
  if (sampled.shapes.empty() || sampled.shapes[0].empty()) return animation;
  for (size_t n = 0; n < out.nodes.size(); ++n) {
    const size_t own = out.nodes[n].shape_weights.size(), added = sampled.shapes[0].size();
    if (own < added) continue;  // a node without parts
    CharacterTrack track;
    track.node = n;
    track.path = TrackPath::Shapes;
    track.times = sampled.times;
    const auto still = out.nodes[n].shape_weights.begin();
    for (const auto& weights : sampled.shapes) {
      track.values.insert(track.values.end(), still, still + static_cast<long>(own - added));
      track.values.insert(track.values.end(), weights.begin(), weights.end());
    }
    animation.tracks.push_back(std::move(track));
  }
  return animation;
}

/// What both skeletons have in common: the character without animation, then pose by pose.
class Animator {
 public:
  Animator(const PreparedCharacter& source, const Deformer& screen, const CharacterExportOptions& options)
      : source_(source), screen_(screen), influences_(options.influences), joints_(options.joints) {}
  virtual ~Animator() = default;
  /// Comes first.
  virtual Character still() = 0;
  /// Local transforms of the nodes that move.
  virtual std::vector<Transform> frame(const Pose& pose) const = 0;
  const std::vector<MovedNode>& moved() const { return moved_; }
  /// Offsets in T-pose axes and metres as morph deltas of one part.
  virtual Points shape_of_part(const Points& shape, const CharacterPart& part, Eigen::Index first) const = 0;

 protected:
  const PreparedCharacter& source_;
  const Deformer& screen_;
  int influences_;
  std::optional<Joints> joints_;  // of the T-pose, where they are not the character's
  std::vector<MovedNode> moved_;
};

class TheirRig final : public Animator {
 public:
  using Animator::Animator;
  Character still() override;
  std::vector<Transform> frame(const Pose& pose) const override;
  Points shape_of_part(const Points& shape, const CharacterPart& part, Eigen::Index first) const override {
    const std::vector<Mat3> maps = to_t_pose_maps(source_, part, first, source_.bind.nodes);
    Points out(part.vertices.rows(), 3);
    for (Eigen::Index v = 0; v < out.rows(); ++v) {
      const Vec3 d = shape.row(source_.surface.map[first + v]).transpose();
      const Mat3& M = maps[v];
      out.row(v) =
          (std::abs(M.determinant()) > 1e-30f ? Vec3(M.inverse() * d) : Vec3(Vec3::Zero())).transpose();
    }
    return out;
  }

 private:
  std::vector<Mat4> bind_;  // of the nodes of the file that is written, in the world: metres
  std::vector<int> parent_;
};

/// The file's world brought to metres, y up, facing +z.
CharacterNode world_root(const Similarity& to_world) {
  CharacterNode root;
  root.name = "Understudy";
  root.local.scale.setConstant(to_world.scale);
  root.local.rotation = Eigen::Quaternionf(to_world.R).normalized();
  root.local.translation = to_world.t;
  return root;
}

Character TheirRig::still() {
  US_CHECK(source_.rigged, source_.character.called(), ": has no skeleton that could be driven");
  Character out = source_.character;
  apply_painted_weights(source_, screen_.weights(), influences_, out);
  const Similarity& to_world = source_.to_world;
  const Mat4 world = affine(to_world.scale * to_world.R, to_world.t);
  bind_.clear();
  for (const Mat4& node : source_.bind.nodes) bind_.push_back(world * node);
  // The bind pose becomes the pose that the file is opened in.
  for (size_t n = 0; n < out.nodes.size(); ++n) {
    const int p = out.nodes[n].parent;
    const Mat4& above = p < 0 ? Mat4(Mat4::Identity()) : source_.bind.nodes[p];
    const Mat4 local = above.inverse() * source_.bind.nodes[n];
    if (!local.isApprox(out.nodes[n].local.matrix(), 1e-6f)) out.nodes[n].local = Transform::from(local);
  }
  if (!world.isApprox(Mat4::Identity(), 1e-6f)) {
    add_root(out, world_root(to_world));
    bind_.insert(bind_.begin(), world);
  } else {
    bind_ = source_.bind.nodes;
  }
  lift_skinned_nodes(out);
  parent_.clear();
  for (const auto& node : out.nodes) parent_.push_back(node.parent);
  // Later frames depend on what the file really holds, not on matrices that it can only come near to.
  bind_ = out.world();
  const size_t added = bind_.size() - source_.driver.size();  // the root
  for (size_t n = added; n < bind_.size(); ++n)
    if (source_.driver[n - added] >= 0)
      moved_.push_back(
          {static_cast<int>(n), parent_[n] < 0 ? 1 : uniform_scale(bind_[parent_[n]].topLeftCorner<3, 3>())});
  return out;
}

std::vector<Transform> TheirRig::frame(const Pose& pose) const {
  const std::vector<Mat4> of_source = node_motions(source_, joints_.value_or(source_.pose.rest), pose);
  const size_t added = bind_.size() - of_source.size();  // the root
  std::vector<Transform> out;
  for (const auto& [n, metres] : moved_) {
    const auto world = [&](size_t node) {
      return Mat4(node < added ? bind_[node] : Mat4(of_source[node - added] * bind_[node]));
    };
    const Mat4 above = parent_[n] < 0 ? Mat4(Mat4::Identity()) : world(parent_[n]);
    out.push_back(Transform::from(above.inverse() * world(n)));
  }
  return out;
}

class OurRig final : public Animator {
 public:
  using Animator::Animator;
  Character still() override;
  std::vector<Transform> frame(const Pose& pose) const override;
  Points shape_of_part(const Points& shape, const CharacterPart& part, Eigen::Index first) const override {
    return shape(Eigen::VectorXi::Map(&source_.surface.map[first], part.vertices.rows()), Eigen::all);
  }

 private:
  void to_t_pose(CharacterPart& part, Eigen::Index first) const;
  void add_skin(CharacterPart& part, Eigen::Index first) const;
};

void OurRig::to_t_pose(CharacterPart& part, Eigen::Index first) const {
  const std::vector<Mat3> maps = to_t_pose_maps(source_, part, first, source_.bind.nodes);
  for (Eigen::Index v = 0; v < part.vertices.rows(); ++v) {
    const Mat3& M = maps[v];
    part.vertices.row(v) = source_.target.mesh.vertices.row(source_.surface.map[first + v]);
    if (part.normals.rows() > 0) {
      const Mat3 N = std::abs(M.determinant()) > 1e-30f ? Mat3(M.inverse().transpose()) : M;
      part.normals.row(v) = (N * part.normals.row(v).transpose()).normalized().transpose();
    }
    if (part.tangents.rows() > 0)
      part.tangents.row(v).head<3>() =
          (M * part.tangents.row(v).head<3>().transpose()).normalized().transpose();
    for (auto& shape : part.shapes) shape.row(v) = (M * shape.row(v).transpose()).transpose();
  }
  if (!maps.empty() && maps[0].determinant() < 0)  // seen in a mirror, faces turn over
    part.faces.col(1).swap(part.faces.col(2));
}

void OurRig::add_skin(CharacterPart& part, Eigen::Index first) const {
  const RowMatrix& weights = screen_.weights();
  part.joints.setZero(part.vertices.rows(), influences_);
  part.weights.setZero(part.vertices.rows(), influences_);
  for (Eigen::Index v = 0; v < part.vertices.rows(); ++v) {
    const auto row = weights.row(source_.surface.map[first + v]);
    std::array<int, kJointCount> order;
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return row[a] > row[b]; });
    for (int k = 0; k < influences_; ++k) {
      const float w = std::max(0.0f, row[order[k]]);
      if (w < 1e-5f && k > 0) break;
      part.joints(v, k) = order[k];
      part.weights(v, k) = w;
    }
    part.weights.row(v) /= part.weights.row(v).sum();
  }
  part.skin = 0;
}

Character OurRig::still() {
  const Character& from = source_.character;
  Character out = from;
  out.nodes.clear();
  out.parts.clear();
  out.animations.clear();
  out.file_vertices.clear();
  CharacterSkin skin;
  skin.name = kOurSkin;
  const Joints rest = joints_.value_or(source_.target.joints);
  const Pose back = source_.pose.back();
  for (int j = 0; j < kJointCount; ++j) {
    const int p = kParents[j];
    CharacterNode node;
    node.name = kJointNames[j];
    node.parent = p;
    node.local.translation =
        p < 0 ? Vec3(rest.row(Pelvis).transpose()) : Vec3((rest.row(j) - rest.row(p)).transpose());
    node.local.rotation = Eigen::Quaternionf(back.local[j]).normalized();
    out.nodes.push_back(node);
    skin.joints.push_back(j);
    moved_.push_back({j});
    skin.inverse_bind.push_back(affine(Mat3::Identity(), -rest.row(j).transpose()));
  }
  out.skins = {skin};
  std::map<int, int> node_of;
  Eigen::Index first = 0;
  for (CharacterPart part : from.parts) {
    const auto [entry, is_new] = node_of.try_emplace(part.node, out.nodes.size());
    if (is_new) {
      CharacterNode node;
      node.name = from.nodes[part.node].name;
      node.shape_weights = from.nodes[part.node].shape_weights;
      out.nodes.push_back(node);
    }
    to_t_pose(part, first);
    add_skin(part, first);
    part.node = entry->second;
    first += part.vertices.rows();
    out.parts.push_back(std::move(part));
  }
  return out;
}

std::vector<Transform> OurRig::frame(const Pose& pose) const {
  const Joints rest = joints_.value_or(source_.target.joints);
  std::vector<Transform> out(kJointCount);
  for (int j = 0; j < kJointCount; ++j) {
    const int p = kParents[j];
    out[j].translation = p < 0 ? pose.root : Vec3((rest.row(j) - rest.row(p)).transpose());
    out[j].rotation = Eigen::Quaternionf(pose.local[j]).normalized();
  }
  return out;
}

/// On the spot where the T-pose stands.
Pose on_the_spot(Pose pose, const Vec3& rest) {
  pose.root = Vec3(rest.x(), pose.root.y(), rest.z());
  return pose;
}

Joints joints_of(const CharacterPerformance& performance) {
  return performance.options.joints.value_or(performance.character.target.joints);
}

void check_clips(const CharacterPerformance& performance) {
  US_CHECK(!performance.clips.empty(), performance.character.character.called(),
           ": there is no motion to export");
  for (const auto& clip : performance.clips) {
    US_CHECK(!clip.poses.empty() && clip.fps > 0, "the clip '", clip.name, "' is empty");
    for (const auto& pose : clip.poses) {
      bool finite = pose.root.allFinite();
      for (const Mat3& R : pose.local) finite = finite && R.allFinite();
      US_CHECK(finite, "a pose of the clip '", clip.name, "' is not finite");
    }
  }
}

/// A performance as it is written.
struct StagedPerformance {
  const CharacterPerformance& of;
  Joints rest;
  Vec3 place = Vec3::Zero();         // on the floor
  std::vector<CharacterClip> clips;  // as the options want them, from `place`

  Vec3 root() const { return rest.row(Pelvis).transpose(); }
  /// Where the pose is in the scene.
  Pose in_scene(Pose pose) const {
    pose.root += place;
    return pose;
  }
};

StagedPerformance staged(const CharacterPerformance& performance, bool has_own_place) {
  check_clips(performance);
  StagedPerformance out{performance, joints_of(performance), Vec3::Zero(), performance.clips};
  if (has_own_place)
    out.place = out.clips[0].poses[0].root - on_the_spot(out.clips[0].poses[0], out.root()).root;
  for (auto& clip : out.clips)
    for (auto& pose : clip.poses) {
      pose.root -= out.place;
      if (performance.options.in_place) pose = on_the_spot(pose, out.root());
    }
  if (!performance.options.t_pose_clip) return out;
  CharacterClip rest{"T-pose", out.clips[0].fps, {Pose()}};
  rest.poses[0].root = out.root();
  out.clips.insert(out.clips.begin(), rest);
  return out;
}

/// One alone performs where the scene has it; several each have a place, from which they start.
std::vector<StagedPerformance> staged(const std::vector<CharacterPerformance>& performances) {
  US_CHECK(!performances.empty(), "there is no motion to export");
  std::vector<StagedPerformance> out;
  out.reserve(performances.size());
  for (const auto& one : performances) out.push_back(staged(one, performances.size() > 1));
  return out;
}

/// The topmost bone that poses do not move, but all that they move is below it; -1: there is none.
int root_bone(const Character& character, const std::vector<MovedNode>& moved) {
  std::vector<bool> is_still(character.nodes.size(), false);
  for (const auto& skin : character.skins)
    for (const int joint : skin.joints) is_still[joint] = true;
  for (const MovedNode& one : moved) is_still[one.node] = false;
  int found = -1;
  for (int n = character.nodes[moved.at(0).node].parent; n >= 0; n = character.nodes[n].parent)
    if (is_still[n] && std::all_of(moved.begin(), moved.end(),
                                   [&](const auto& one) { return character.is_at_or_below(one.node, n); }))
      found = n;
  return found;
}

/// A bone of all skins above everything, number 0.
void add_root_bone(Character& out, std::vector<CharacterAnimation>& own) {
  CharacterNode root;
  root.name = "Root";
  add_root(out, root);
  lift_skinned_nodes(out);
  for (CharacterSkin& skin : out.skins) {
    skin.joints.push_back(0);
    skin.inverse_bind.push_back(Mat4::Identity());
  }
  for (CharacterAnimation& animation : own)
    for (CharacterTrack& track : animation.tracks) ++track.node;
}

/// Lets a root bone go the way over the floor that the clips go from `rest`; the animations are on the spot.
/// own: the file's animations, which are added later.
void carry_path(const std::vector<CharacterClip>& clips, const Vec3& rest,
                const std::vector<MovedNode>& moved, Character& out, std::vector<CharacterAnimation>& own) {
  int root = root_bone(out, moved);
  if (root < 0) add_root_bone(out, own), root = 0;
  const std::vector<Mat4> world = out.world();
  const int p = out.nodes[root].parent;
  const Mat4 above = p < 0 ? Mat4(Mat4::Identity()) : Mat4(world[p].inverse());
  for (size_t a = 0; a < clips.size(); ++a) {
    CharacterTrack track;
    track.node = root;
    track.path = TrackPath::Translation;
    float furthest = 0;
    for (size_t i = 0; i < clips[a].poses.size(); ++i) {
      const Pose& pose = clips[a].poses[i];
      const Vec3 way = pose.root - on_the_spot(pose, rest).root;
      const Mat4 placed = above * affine(Mat3::Identity(), way) * world[root];
      const Vec3 t = placed.topRightCorner<3, 1>();
      track.times.push_back(clips[a].seconds(i));
      track.values.insert(track.values.end(), t.data(), t.data() + 3);
      furthest = std::max(furthest, way.norm());
    }
    if (furthest > kStill) out.animations[a].tracks.push_back(std::move(track));
  }
}

std::unique_ptr<Animator> animator_for(const PreparedCharacter& character, const Deformer& screen,
                                       const CharacterExportOptions& options) {
  US_CHECK(options.influences == 4 || options.influences == 8, "a vertex can have 4 or 8 influences, not ",
           options.influences);
  if (options.their_rig) return std::make_unique<TheirRig>(character, screen, options);
  return std::make_unique<OurRig>(character, screen, options);
}

/// Goes on from `from` to `to`.
std::function<void(float)> part_of(const std::function<void(float)>& progress, float from, float to) {
  if (!progress) return {};
  return [&progress, from, to](float done) { progress(from + (to - from) * std::min(done, 1.0f)); };
}

CorrectiveShapes shapes_for(const StagedPerformance& staged, const std::function<void(float)>& progress) {
  if (staged.of.options.shapes <= 0) return {};
  std::vector<Pose> poses;
  for (const auto& clip : staged.clips) poses.insert(poses.end(), clip.poses.begin(), clip.poses.end());
  return corrective_shapes(staged.of.screen, poses, staged.of.options.shapes, progress);
}

void add_shapes(const CorrectiveShapes& shapes, const Animator& animator, const PreparedCharacter& source,
                Character& out) {
  Eigen::Index first = 0;
  std::vector<bool> seen(out.nodes.size(), false);
  for (size_t p = 0; p < out.parts.size(); ++p) {
    CharacterPart& part = out.parts[p];
    std::vector<float>& weights = out.nodes[part.node].shape_weights;
    if (!seen[part.node]) weights.resize(weights.size() + shapes.shapes.size(), 0.0f);
    seen[part.node] = true;
    part.shapes.resize(weights.size() - shapes.shapes.size(), Points::Zero(part.vertices.rows(), 3));
    for (const Points& shape : shapes.shapes)
      part.shapes.push_back(animator.shape_of_part(shape, source.character.parts[p], first));
    first += part.vertices.rows();
  }
}

/// Weights of shapes that the file had, followed by those of the new ones: none of them.
void leave_room(size_t added, CharacterTrack& track) {
  if (track.path != TrackPath::Shapes || track.times.empty()) return;
  const size_t chunks = track.times.size() * (track.interpolation == TrackInterpolation::Cubic ? 3 : 1);
  const size_t width = track.values.size() / chunks;
  RowMatrix wider = RowMatrix::Zero(chunks, width + added);
  wider.leftCols(width) = Eigen::Map<const RowMatrix>(track.values.data(), chunks, width);
  track.values.assign(wider.data(), wider.data() + wider.size());
}

/// The longest way from a node to a vertex that it could move, metres: the height of the character at most.
float lever(const PreparedCharacter& character) {
  const Points& v = character.target.mesh.vertices;
  return 0.6f * (v.col(1).maxCoeff() - v.col(1).minCoeff());
}

void reduce_animation(const CharacterAnimation& full, float metres, float lever_m,
                      const std::vector<float>& metres_of, CharacterAnimation& out) {
  out.tracks.clear();
  for (const auto& track : full.tracks) {
    const float tolerance = track.path == TrackPath::Rotation      ? metres / lever_m
                            : track.path == TrackPath::Translation ? metres / metres_of[track.node]
                                                                   : 0.002f;
    out.tracks.push_back(reduced(track, tolerance));
  }
}

/// Fewer keys until vertices move too far: errors of the bones above add up, so the first guess is tried out.
void reduce_keys(const PreparedCharacter& source, float limit_mm, Character& out) {
  std::vector<float> metres_of;
  for (const Mat4& M : out.world()) metres_of.push_back(uniform_scale(M.topLeftCorner<3, 3>()));
  for (size_t n = out.nodes.size(); n-- > 0;)
    metres_of[n] = out.nodes[n].parent < 0 ? 1.0f : metres_of[out.nodes[n].parent];
  const Character full = out;
  float tolerance = 0.5f * limit_mm / 1000;
  for (int round = 0; round < 8; ++round) {
    for (size_t a = 0; a < out.animations.size(); ++a)
      reduce_animation(full.animations[a], tolerance, lever(source), metres_of, out.animations[a]);
    float worst = 0;
    for (size_t a = 0; a < out.animations.size(); ++a) {
      const auto& times = full.animations[a].tracks[0].times;
      const size_t step = std::max<size_t>(1, times.size() / kCompared);
      for (size_t i = 0; i < times.size(); i += step) {
        const Points difference = vertices_at(out, a, times[i]) - vertices_at(full, a, times[i]);
        worst = std::max(worst, 1000 * difference.rowwise().norm().maxCoeff());
      }
    }
    if (worst <= limit_mm) return;
    tolerance *= std::clamp(0.8f * limit_mm / worst, 0.1f, 0.7f);
  }
  out = full;
}

Character animated(const StagedPerformance& staged, const std::function<void(float)>& progress) {
  const PreparedCharacter& character = staged.of.character;
  const CharacterExportOptions& options = staged.of.options;
  const auto animator = animator_for(character, staged.of.screen, options);
  Character out = animator->still();
  std::vector<CharacterAnimation> own = std::move(out.animations);
  out.animations.clear();
  const CorrectiveShapes shapes = shapes_for(staged, progress);
  if (!shapes.shapes.empty()) add_shapes(shapes, *animator, character, out);
  const Vec3 rest = staged.root();
  size_t at = 0;
  for (const auto& clip : staged.clips) {
    Sampled sampled;
    for (size_t i = 0; i < clip.poses.size(); ++i) {
      const Pose& pose = clip.poses[i];
      sampled.local.push_back(animator->frame(options.root_motion ? on_the_spot(pose, rest) : pose));
      sampled.times.push_back(clip.seconds(i));
      if (!shapes.shapes.empty()) sampled.shapes.push_back(shapes.weights[at++]);
    }
    out.animations.push_back(
        animation_of(fresh_name(clip.name, out.animations), sampled, animator->moved(), out));
    out.animations.back().made = clip.made;
  }
  if (options.root_motion) carry_path(staged.clips, rest, animator->moved(), out, own);
  if (options.reduce_mm > 0) reduce_keys(character, options.reduce_mm, out);
  if (options.keep_clips && options.their_rig)
    for (CharacterAnimation animation : own) {
      animation.name = fresh_name(animation.name, out.animations);
      for (CharacterTrack& track : animation.tracks) leave_room(shapes.shapes.size(), track);
      out.animations.push_back(std::move(animation));
    }
  return out;
}

/// progress: gets `share` of 0..1 for each of them.
Character animated(const std::vector<StagedPerformance>& cast, const std::function<void(float)>& progress) {
  if (cast.size() == 1) return animated(cast[0], progress);
  std::vector<CastMember> members;
  for (const auto& one : cast) {
    const auto count = static_cast<float>(cast.size()), at = static_cast<float>(members.size());
    members.push_back({one.of.name, one.place, animated(one, part_of(progress, at / count, (at + 1) / count)),
                       one.clips.size()});
  }
  return joined(std::move(members));
}

/// Millimetres between vertices in a file and on screen.
struct Difference {
  double sum = 0, count = 0, largest = 0;
  void add(double mm) {
    sum += mm;
    ++count;
    largest = std::max(largest, mm);
  }
};

/// written: with the parts of this performer alone. Gives the number of frames that were compared.
int64_t compare(const Character& written, const StagedPerformance& staged,
                const std::function<void(float)>& progress, Difference& difference) {
  int64_t frames = 0;
  for (size_t a = 0; a < staged.clips.size(); ++a) {
    const auto& poses = staged.clips[a].poses;
    const size_t step = (poses.size() + kCompared - 1) / kCompared;
    for (size_t i = 0; i < poses.size(); i += step, ++frames) {
      if (progress)
        progress((static_cast<float>(a) + static_cast<float>(i) / static_cast<float>(poses.size())) /
                 static_cast<float>(staged.clips.size()));
      const Points shown = staged.of.screen.deform(staged.in_scene(poses[i]));
      const Points seen = vertices_at(written, a, staged.clips[a].seconds(i));
      const auto& map = staged.of.character.surface.map;
      for (Eigen::Index v = 0; v < seen.rows(); ++v)
        difference.add(1000.0 * static_cast<double>((seen.row(v) - shown.row(map[v])).norm()));
    }
  }
  return frames;
}

/// Takes the first of the parts that are left, up to so many vertices.
std::vector<CharacterPart> take_parts(Eigen::Index vertices, std::vector<CharacterPart>& parts) {
  size_t count = 0;
  for (; vertices > 0 && count < parts.size(); ++count) vertices -= parts[count].vertices.rows();
  const auto end = parts.begin() + static_cast<std::ptrdiff_t>(count);
  std::vector<CharacterPart> out(std::make_move_iterator(parts.begin()), std::make_move_iterator(end));
  parts.erase(parts.begin(), end);
  return out;
}

ExportCost measure(Character written, const std::vector<StagedPerformance>& cast,
                   const std::function<void(float)>& progress) {
  ExportCost cost;
  cost.measured = true;
  Difference difference;
  std::vector<CharacterPart> parts = std::move(written.parts);
  for (size_t k = 0; k < cast.size(); ++k) {
    written.parts = take_parts(cast[k].of.character.character.vertex_count(), parts);
    const auto count = static_cast<float>(cast.size()), at = static_cast<float>(k);
    cost.frames += compare(written, cast[k], part_of(progress, at / count, (at + 1) / count), difference);
  }
  cost.largest_mm = difference.largest;
  cost.mean_mm = difference.sum / std::max(1.0, difference.count);
  for (const auto& animation : written.animations)
    for (const auto& track : animation.tracks) cost.keys += ssize(track.times);
  return cost;
}

/// Of all who perform, each once.
std::string rights_of(const std::vector<CharacterPerformance>& performances) {
  std::vector<std::string> all;
  all.reserve(performances.size());
  for (const CharacterPerformance& one : performances) all.push_back(one.options.rights);
  return joined_once(all, "; ");
}

}  // namespace

Character animated_character(const std::vector<CharacterPerformance>& performances) {
  const std::vector<StagedPerformance> cast = staged(performances);
  Character character = animated(cast, performances[0].options.progress);
  character.rights = rights_of(performances);
  return character;
}

ExportCost export_character(const std::string& path, const std::vector<CharacterPerformance>& performances) {
  const std::vector<StagedPerformance> cast = staged(performances);
  const auto& progress = performances[0].options.progress;
  Character character = animated(cast, part_of(progress, 0, 0.6f));
  character.rights = rights_of(performances);
  const std::string bytes = gltf_bytes(character, path);
  ExportCost cost = measure(parse_gltf_character(bytes, path), cast, part_of(progress, 0.6f, 1));
  cost.bytes = static_cast<int64_t>(bytes.size());
  write_file(path, bytes);
  return cost;
}

}  // namespace understudy
