#include "retarget/character/geometric_binding.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <future>
#include <limits>
#include <map>
#include <numeric>
#include <queue>
#include <string_view>
#include <unordered_map>

#include "retarget/base/threads.hpp"
#include "retarget/base/union_find.hpp"
#include "retarget/character/rest_pose.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/math/segment.hpp"
#include "retarget/math/smooth_step.hpp"

namespace understudy {
namespace {

constexpr float kBehind = 2.5f;     // how much further a bone is behind its first end
constexpr float kDetour = 2.0f;     // what a detour costs, over the straight path
constexpr float kSharpness = 5.0f;  // of the fall of weights with distance
constexpr float kBigHead = 0.36f;   // of the leg: width and height of a head that no human has
constexpr float kFar = std::numeric_limits<float>::max();
constexpr int kSlices = 48;  // of the legs, looking for a skirt

using Segments = std::array<std::vector<std::pair<Vec3, Vec3>>, kJointCount>;

/// The bones that each joint moves; hands, feet and head go on beyond their joint.
Segments bones_of(const Joints& joints) {
  Segments out;
  const auto at = [&](int j) -> Vec3 { return joints.row(j).transpose(); };
  const auto add = [&](int j, const Vec3& from, const Vec3& to) { out[j].emplace_back(from, to); };
  const float leg = leg_length(joints);
  for (const int j : {LeftHip, RightHip, LeftKnee, RightKnee, LeftAnkle, RightAnkle})
    add(j, at(j), at(j + 3));
  for (const int j : {LeftShoulder, RightShoulder, LeftElbow, RightElbow}) add(j, at(j), at(j + 2));
  for (const int j : {LeftCollar, RightCollar}) add(j, at(j), at(j + 3));
  for (const int j : {LeftWrist, RightWrist})
    add(j, at(j), at(j) + 0.2f * leg * bone(joints, j - 2, j).normalized());
  for (const int j : {LeftFoot, RightFoot}) {
    const Vec3 along = bone(joints, j - 3, j);
    add(j, at(j), at(j) + 0.08f * leg * Vec3(along.x(), 0, along.z()).normalized());
  }
  add(Pelvis, at(Pelvis), at(Spine1));
  add(Pelvis, at(LeftHip), at(RightHip));
  add(Spine1, at(Spine1), at(Spine2));
  add(Spine2, at(Spine2), at(Spine3));
  add(Spine3, at(Spine3), at(Neck));
  add(Spine3, at(LeftCollar), at(RightCollar));
  add(Neck, at(Neck), at(Head));
  add(Head, at(Head), at(Head) + 0.2f * leg * bone(joints, Neck, Head).normalized());
  return out;
}

float straight_distance(const Vec3& p, const std::pair<Vec3, Vec3>& s) {
  const Vec3 d = s.second - s.first;
  const float length = d.norm();
  if (length < 1e-6f) return (p - s.first).norm();
  const float along = (p - s.first).dot(d) / length;
  const float across = (p - s.first - along / length * d).norm();
  const float beyond = along < 0 ? -kBehind * along : std::max(0.0f, along - length);
  return std::hypot(across, beyond);
}

/// What is found of the surface in the plane between the legs: of each slice of height whether it is closed
/// in front and behind.
struct MiddleCut {
  std::array<bool, kSlices> front{}, back{};
  std::vector<Eigen::Index> faces;  ///< that make it
};

struct Legs {
  float top, bottom, middle, depth, half_width, length;  ///< hips, ankles, between them
  explicit Legs(const Joints& j)
      : top(0.5f * (j(LeftHip, 1) + j(RightHip, 1))),
        bottom(0.5f * (j(LeftAnkle, 1) + j(RightAnkle, 1))),
        middle(0.5f * (j(LeftHip, 0) + j(RightHip, 0))),
        depth(0.25f * (j(LeftHip, 2) + j(RightHip, 2) + j(LeftKnee, 2) + j(RightKnee, 2))),
        half_width(std::max(1e-3f, 0.5f * std::abs(j(LeftHip, 0) - j(RightHip, 0)))),
        length(std::max(1e-3f, top - bottom)) {}
  float slice(float y) const { return (top - y) / length * kSlices; }
};

MiddleCut cut_between(const Mesh& mesh, const Legs& legs) {
  MiddleCut cut;
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f) {
    std::array<Vec3, 3> p;
    for (int c = 0; c < 3; ++c) p[c] = mesh.vertices.row(mesh.faces(f, c)).transpose();
    const Vec3 normal = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
    if (!(std::abs(normal.z()) > 0.55f)) continue;  // the inner sides of thighs look sideways
    float low = 1e9f, high = -1e9f, z = 0;
    int crossings = 0;
    for (size_t c = 0; c < 3; ++c) {
      const Vec3 &a = p[c], &b = p[(c + 1) % 3];
      const float da = a.x() - legs.middle, db = b.x() - legs.middle;
      if ((da < 0) == (db < 0)) continue;
      const Vec3 at = a + da / (da - db) * (b - a);
      low = std::min(low, at.y());
      high = std::max(high, at.y());
      z += at.z();
      ++crossings;
    }
    if (crossings < 2) continue;
    cut.faces.push_back(f);
    auto& side = z / static_cast<float>(crossings) > legs.depth ? cut.front : cut.back;
    const int first = std::max(0, static_cast<int>(legs.slice(high)));
    for (int s = first; s < kSlices && static_cast<float>(s) <= legs.slice(low); ++s) side[s] = true;
  }
  return cut;
}

/// The vertices of the hanging cloth: joined with the cut between hem and hips, and outermost about the legs.
std::vector<bool> cloth_of(const Mesh& mesh, const Legs& legs, const MiddleCut& cut, float hem) {
  const auto in_band = [&](int v) {
    const float y = mesh.vertices(v, 1);
    return y > hem - 0.03f * legs.length && y < legs.top + 0.06f * legs.length;
  };
  UnionFind joined(mesh.vertices.rows());  // neighbours in the band
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f)
    for (int c = 0; c < 3; ++c) {
      const int a = mesh.faces(f, c), b = mesh.faces(f, (c + 1) % 3);
      if (in_band(a) && in_band(b)) joined.join(a, b);
    }
  std::vector<bool> holds_cut(mesh.vertices.rows()), cloth(mesh.vertices.rows());
  for (const Eigen::Index f : cut.faces)
    for (int c = 0; c < 3; ++c) holds_cut[joined.root(mesh.faces(f, c))] = true;
  for (int v = 0; v < mesh.vertices.rows(); ++v) cloth[v] = in_band(v) && holds_cut[joined.root(v)];
  constexpr int kAngles = 24;
  std::array<std::array<float, kAngles>, kSlices + 8> outermost{};
  const auto bin = [&](int v, float& radius) -> float& {
    const float x = mesh.vertices(v, 0) - legs.middle, z = mesh.vertices(v, 2) - legs.depth;
    radius = std::hypot(x, z);
    const int angle = static_cast<int>((std::atan2(z, x) / (2 * kPi) + 0.5f) * kAngles) % kAngles;
    const int slice = std::clamp(static_cast<int>(legs.slice(mesh.vertices(v, 1))) + 4, 0, kSlices + 7);
    return outermost[slice][angle];
  };
  float radius = 0;
  for (int v = 0; v < mesh.vertices.rows(); ++v)
    if (cloth[v]) {
      float& known = bin(v, radius);
      known = std::max(known, radius);
    }
  for (int v = 0; v < mesh.vertices.rows(); ++v)
    if (cloth[v] && bin(v, radius) * 0.7f > radius) cloth[v] = false;
  return cloth;
}

/// A part with these mean weights lies along one bone, or makes up the trunk.
bool lies_along_one_bone(const Eigen::Ref<const Eigen::RowVectorXf>& weights) {
  float trunk = 0;
  for (const int j : {Pelvis, Spine1, Spine2, Spine3, LeftCollar, RightCollar}) trunk += weights[j];
  return weights.maxCoeff() > 0.55f || trunk > 0.75f;
}

/// Geodesic distances along the edges from one vertex, [V]; what is not joined with it is out of reach.
std::vector<float> surface_distances(const Mesh& mesh, int from) {
  std::vector<std::vector<int>> next(mesh.vertices.rows());
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f)
    for (int c = 0; c < 3; ++c) {
      next[mesh.faces(f, c)].push_back(mesh.faces(f, (c + 1) % 3));
      next[mesh.faces(f, (c + 1) % 3)].push_back(mesh.faces(f, c));
    }
  std::vector<float> distance(next.size(), kFar);
  using Entry = std::pair<float, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  distance[from] = 0;
  open.push({0.0f, from});
  while (!open.empty()) {
    const auto [here, v] = open.top();
    open.pop();
    if (here > distance[v]) continue;
    for (const int n : next[v]) {
      const float there = here + (mesh.vertices.row(n) - mesh.vertices.row(v)).norm();
      if (there >= distance[n]) continue;
      distance[n] = there;
      open.push({there, n});
    }
  }
  return distance;
}

/// What a level cuts out of the middle of a body: of nothing, low is over high.
struct Slice {
  float low_x = kFar, high_x = -kFar, low_z = kFar, high_z = -kFar;
  float width() const { return high_x - low_x; }
  float size() const { return high_x < low_x ? 0 : width() + high_z - low_z; }
};

/// Slices from `top` down, `step` apart, of what lies no further than `reach` from the plane x = middle.
std::vector<Slice> slices_down(const Mesh& mesh, float top, float step, int count, float middle,
                               float reach) {
  std::vector<Slice> out(count);
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f)
    for (int c = 0; c < 3; ++c) {
      Vec3 a = mesh.vertices.row(mesh.faces(f, c)).transpose();
      Vec3 b = mesh.vertices.row(mesh.faces(f, (c + 1) % 3)).transpose();
      if (a.y() < b.y()) std::swap(a, b);
      if (!(a.y() > b.y())) continue;
      const float first = std::max(0.0f, std::ceil((top - a.y()) / step));
      for (int k = static_cast<int>(std::min(first, static_cast<float>(count)));
           k < count && top - step * static_cast<float>(k) >= b.y(); ++k) {
        const Vec3 at = a + (a.y() - top + step * static_cast<float>(k)) / (a.y() - b.y()) * (b - a);
        if (std::abs(at.x() - middle) > reach) continue;
        Slice& slice = out[k];
        slice.low_x = std::min(slice.low_x, at.x());
        slice.high_x = std::max(slice.high_x, at.x());
        slice.low_z = std::min(slice.low_z, at.z());
        slice.high_z = std::max(slice.high_z, at.z());
      }
    }
  return out;
}

/// The vertex at the top of the head, -1 for none.
int crown_of(const Mesh& mesh, const Joints& joints) {
  int crown = -1;
  for (int v = 0; v < mesh.vertices.rows(); ++v) {
    const float off = std::abs(mesh.vertices(v, 0) - joints(Head, 0));
    if (off < 0.25f * leg_length(joints) && (crown < 0 || mesh.vertices(v, 1) > mesh.vertices(crown, 1)))
      crown = v;
  }
  return crown;
}

struct HeadAndNeck {
  int crown = 0;
  Vec3 neck;            ///< its middle, where it is narrowest
  float low_x, high_x;  ///< of the head
};

/// A head much larger than a human's, over the narrowest slice above the shoulders.
std::optional<HeadAndNeck> find_big_head(const Mesh& mesh, const Joints& joints) {
  const int crown = mesh.is_cloud() ? -1 : crown_of(mesh, joints);
  if (crown < 0) return std::nullopt;
  const float leg = leg_length(joints), step = 0.01f * leg, top = mesh.vertices(crown, 1);
  const int count = std::clamp(static_cast<int>((top - joints(Spine1, 1)) / step), 1, 200);
  const auto slices = slices_down(mesh, top, step, count, joints(Head, 0), 0.45f * leg);
  int neck = -1;
  float largest = 0, smallest = kFar, wide = 0;
  Slice head;
  for (int k = 1; k < count; ++k) {
    const Slice& slice = slices[k];
    if (neck >= 0 && slice.size() > 1.25f * smallest) break;  // the shoulders
    largest = std::max(largest, slice.size());
    if (neck < 0 && slice.width() > wide) {
      wide = slice.width();
      head = slice;
    }
    if (slice.size() <= 0 || slice.size() > 0.7f * largest || slice.size() >= smallest) continue;
    smallest = slice.size();
    neck = k;
  }
  const float across = 0.8f * std::abs(joints(LeftElbow, 0) - joints(RightElbow, 0));
  if (neck < 0 || wide < kBigHead * leg || step * static_cast<float>(neck) < kBigHead * leg || wide > across)
    return std::nullopt;
  const Slice& at = slices[neck];
  const Vec3 middle(0.5f * (at.low_x + at.high_x), top - step * static_cast<float>(neck),
                    0.5f * (at.low_z + at.high_z));
  return HeadAndNeck{crown, middle, head.low_x, head.high_x};
}

/// Does work(first, last) for both halves of 0 .. count at once, where there are threads: nothing else runs
/// while a target is bound.
template <class Work>
void in_halves(Eigen::Index count, const Work& work) {
  if (usable_threads() < 2) return work(Eigen::Index{0}, count);
  auto other = std::async(std::launch::async, [&] { work(count / 2, count); });
  work(0, count / 2);
  other.get();
}

/// A place in a grid, for places that are alike up to rounding.
using GridPlace = std::array<int64_t, 3>;
struct GridPlaceHash {
  size_t operator()(const GridPlace& p) const {
    return std::hash<std::string_view>()({reinterpret_cast<const char*>(p.data()), sizeof p});
  }
};

using BoneFields = std::array<std::vector<float>, kJointCount>;

/// How far a point is from each joint's bones: straight, with detours through the solid added.
Eigen::Matrix<float, 1, kJointCount> distances_at(const Vec3& p, const VoxelBody& body, const Segments& bones,
                                                  const BoneFields& distances, float leg) {
  constexpr float kBeyond = 4;  // times as far as the nearest bone no detour matters any more
  std::array<float, kJointCount> straight, plain;
  std::array<int, kJointCount> order;
  std::iota(order.begin(), order.end(), 0);
  for (size_t j = 0; j < kJointCount; ++j) {
    straight[j] = plain[j] = 1e9f;
    for (const auto& s : bones[j]) {
      straight[j] = std::min(straight[j], straight_distance(p, s));
      plain[j] = std::min(plain[j], from_segment(p, s.first, s.second).norm());
    }
  }
  std::sort(order.begin(), order.end(), [&](int a, int b) { return straight[a] < straight[b]; });
  Eigen::Matrix<float, 1, kJointCount> out;
  float nearest = kFar;
  for (const int joint : order) {
    const size_t j = joint;
    float detour = 0;
    // Paths along a grid are longer than straight ones by a tenth at most.
    if (nearest == kFar || straight[j] < kBeyond * (nearest + 0.06f * leg))
      detour = std::max(0.0f, body.at(distances[j], p) - 1.1f * plain[j] - 1.5f * body.size());
    out[joint] = straight[j] + kDetour * detour;
    nearest = std::min(nearest, out[joint]);
  }
  return out;
}

}  // namespace

BoneDistances bone_distances(const VoxelBody& body, const Joints& joints, const Points& at) {
  const Segments bones = bones_of(joints);
  BoneFields distances;
  in_halves(kJointCount, [&](Eigen::Index first, Eigen::Index last) {
    for (size_t j = first; j < static_cast<size_t>(last); ++j) distances[j] = body.distances_from(bones[j]);
  });
  BoneDistances out;
  out.leg = leg_length(joints);
  out.metres.resize(at.rows(), kJointCount);
  in_halves(at.rows(), [&](Eigen::Index first, Eigen::Index last) {
    for (Eigen::Index v = first; v < last; ++v)
      out.metres.row(v) = distances_at(at.row(v).transpose(), body, bones, distances, out.leg);
  });
  return out;
}

std::optional<Skirt> find_skirt(const Mesh& mesh, const Joints& joints) {
  if (mesh.is_cloud()) return std::nullopt;
  const Legs legs(joints);
  const MiddleCut cut = cut_between(mesh, legs);
  int last = 2;
  const auto closed = [&](int s, bool both) {
    const bool front = cut.front[s], back = cut.back[s];
    return both ? front && back : front || back;
  };
  while (last < kSlices && closed(last, last < 0.12f * kSlices)) ++last;
  // The crotch of a body, or of trousers, lies higher.
  if (static_cast<float>(last) < 0.22f * kSlices) return std::nullopt;
  Skirt skirt;
  skirt.hem = legs.top - legs.length * static_cast<float>(last) / kSlices;
  const std::vector<bool> cloth = cloth_of(mesh, legs, cut, skirt.hem);
  // Where the cloth is wide, from one thigh to the other is far.
  float widest = 1.3f * legs.half_width;
  for (Eigen::Index v = 0; v < mesh.vertices.rows(); ++v)
    if (cloth[v]) widest = std::max(widest, std::abs(mesh.vertices(v, 0) - legs.middle));
  skirt.share = Eigen::VectorXf::Zero(mesh.vertices.rows());
  skirt.weights = RowMatrix::Zero(mesh.vertices.rows(), kJointCount);
  for (Eigen::Index v = 0; v < mesh.vertices.rows(); ++v) {
    if (!cloth[v]) continue;
    const float down = (legs.top - mesh.vertices(v, 1)) / legs.length;
    const float thighs = 0.9f * smooth_step(-0.02f, 0.28f, down);
    const float lower =
        std::clamp((legs.top - mesh.vertices(v, 1)) / std::max(1e-3f, legs.top - skirt.hem), 0.0f, 1.0f);
    const float wide = 1.3f * legs.half_width + lower * (widest - 1.3f * legs.half_width);
    const float left = smooth_step(-wide, wide, mesh.vertices(v, 0) - legs.middle);
    skirt.share[v] = smooth_step(-0.06f, 0.1f, down);
    skirt.weights(v, Pelvis) = 1 - thighs;
    skirt.weights(v, LeftHip) = thighs * left;
    skirt.weights(v, RightHip) = thighs * (1 - left);
  }
  return skirt;
}

Eigen::VectorXf big_head(const Mesh& mesh, const Joints& joints) {
  Eigen::VectorXf share = Eigen::VectorXf::Zero(mesh.vertices.rows());
  const auto head = find_big_head(mesh, joints);
  if (!head) return share;
  const float step = 0.02f * leg_length(joints);
  // Hair and chins that hang below the neck are nearer to the crown than the neck is.
  const std::vector<float> distance = surface_distances(mesh, head->crown);
  float at_neck = kFar;
  for (Eigen::Index v = 0; v < share.size(); ++v)
    if ((mesh.vertices.row(v) - head->neck.transpose()).norm() < 6 * step &&
        std::abs(mesh.vertices(v, 1) - head->neck.y()) < step)
      at_neck = std::min(at_neck, distance[v]);
  for (Eigen::Index v = 0; v < share.size(); ++v) {
    if (at_neck < kFar) share[v] = 1 - smooth_step(at_neck - 1.5f * step, at_neck, distance[v]);
    if (mesh.vertices(v, 0) > head->low_x && mesh.vertices(v, 0) < head->high_x)
      share[v] =
          std::max(share[v], smooth_step(head->neck.y(), head->neck.y() + 1.5f * step, mesh.vertices(v, 1)));
  }
  return share;
}

std::optional<Vec3> neck_under_big_head(const Mesh& mesh, const Joints& joints) {
  const auto head = find_big_head(mesh, joints);
  if (!head) return std::nullopt;
  return head->neck;
}

ShapeHints shape_hints(const Mesh& mesh, const Joints& joints) {
  return {find_skirt(mesh, joints), big_head(mesh, joints)};
}

void smooth_along(const Mesh& mesh, float radius, RowMatrix& values) {
  constexpr int kRounds = 6;
  for (int round = 0; round < kRounds; ++round) {
    RowMatrix sum = values;
    Eigen::VectorXf total = Eigen::VectorXf::Ones(values.rows());
    for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f)
      for (int c = 0; c < 3; ++c) {
        const int a = mesh.faces(f, c), b = mesh.faces(f, (c + 1) % 3);
        const float length2 = (mesh.vertices.row(a) - mesh.vertices.row(b)).squaredNorm();
        const float mix = 0.5f * std::min(1.0f, radius * radius / (kRounds * std::max(length2, 1e-12f)));
        sum.row(a) += mix * values.row(b);
        sum.row(b) += mix * values.row(a);
        total[a] += mix;
        total[b] += mix;
      }
    values = sum.array().colwise() / total.array();
  }
}

/// Files and engines know four bones a vertex: what is bound by distances alone needs no more.
void keep_strongest(RowMatrix& weights) {
  constexpr int kBones = 4;
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    std::array<float, kJointCount> sorted;
    Eigen::Map<Eigen::RowVectorXf>(sorted.data(), kJointCount) = weights.row(v);
    std::nth_element(sorted.begin(), sorted.begin() + kBones - 1, sorted.end(), std::greater<float>());
    weights.row(v) = (weights.row(v).array() < sorted[kBones - 1]).select(0.0f, weights.row(v));
    weights.row(v) /= weights.row(v).sum();
  }
}

RowMatrix weights_by_distance(const BoneDistances& distances) {
  const float least = 0.01f * distances.leg;
  RowMatrix weights(distances.metres.rows(), kJointCount);
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    const float closest = std::max(least, distances.metres.row(v).minCoeff());
    weights.row(v) = (closest / distances.metres.row(v).array().max(closest)).pow(kSharpness);
    weights.row(v) = (weights.row(v).array() < 0.01f).select(0.0f, weights.row(v));
    weights.row(v) /= weights.row(v).sum();
  }
  return weights;
}

RowMatrix geometric_weights(const Mesh& mesh, const BoneDistances& distances, const ShapeHints& hints) {
  RowMatrix weights = weights_by_distance(distances);
  smooth_along(mesh, 0.03f * distances.leg, weights);
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    if (hints.skirt) weights.row(v) += hints.skirt->share[v] * (hints.skirt->weights.row(v) - weights.row(v));
    weights.row(v) *= 1 - hints.head[v];
    weights(v, Head) += hints.head[v];
  }
  keep_strongest(weights);
  return weights;
}

namespace {

/// The connected parts of a surface; vertices in one place are one.
struct SurfaceParts {
  std::vector<int> of;      ///< [V]
  std::vector<float> area;  ///< of each part, m^2
  std::vector<float> size;  ///< of each part, the diagonal of its box, metres
  bool torn = false;        ///< no parts that mean anything: loose triangles, or a cloud
};

SurfaceParts surface_parts(const Mesh& mesh) {
  SurfaceParts parts;
  const size_t count = mesh.vertices.rows();
  UnionFind joined(count);
  const float extent = (mesh.vertices.colwise().maxCoeff() - mesh.vertices.colwise().minCoeff()).maxCoeff();
  const float same = std::max(1e-9f, 2e-5f * extent);
  std::unordered_map<GridPlace, int, GridPlaceHash> places;
  places.reserve(count);
  for (size_t v = 0; v < count; ++v) {
    GridPlace key{};
    for (int a = 0; a < 3; ++a) key[a] = std::llround(mesh.vertices(v, a) / same);
    const auto [at, fresh] = places.try_emplace(key, v);
    if (!fresh) joined.join(v, at->second);
  }
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f)
    for (int c = 0; c < 2; ++c) joined.join(mesh.faces(f, c), mesh.faces(f, c + 1));
  std::map<int, int> number;
  std::vector<Vec3> low, high;
  for (size_t v = 0; v < count; ++v) {
    const auto [at, fresh] = number.try_emplace(joined.root(v), number.size());
    const Vec3 p = mesh.vertices.row(v).transpose();
    if (fresh) {
      low.push_back(p);
      high.push_back(p);
    }
    const size_t n = at->second;
    low[n] = low[n].cwiseMin(p);
    high[n] = high[n].cwiseMax(p);
    parts.of.push_back(at->second);
  }
  parts.area.assign(number.size(), 0);
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f) {
    const Vec3 a = mesh.vertices.row(mesh.faces(f, 0)).transpose(),
               b = mesh.vertices.row(mesh.faces(f, 1)).transpose(),
               c = mesh.vertices.row(mesh.faces(f, 2)).transpose();
    parts.area[parts.of[mesh.faces(f, 0)]] += 0.5f * (b - a).cross(c - a).norm();
  }
  for (size_t n = 0; n < low.size(); ++n) parts.size.push_back((high[n] - low[n]).norm());
  // Triangles that hang together nowhere are no parts.
  parts.torn = mesh.is_cloud() ||
               static_cast<double>(number.size()) > 0.05 * static_cast<double>(mesh.faces.rows()) + 30;
  return parts;
}

}  // namespace

std::vector<bool> keep_parts_rigid(const Mesh& mesh, float leg, RowMatrix& weights) {
  const SurfaceParts parts = surface_parts(mesh);
  std::vector<bool> rigid(parts.of.size(), false);
  const size_t count = parts.size.size();
  if (parts.torn || count < 2) return rigid;
  RowMatrix sums = RowMatrix::Zero(count, kJointCount);
  for (size_t v = 0; v < parts.of.size(); ++v) sums.row(parts.of[v]) += weights.row(v);
  std::vector<bool> along_one(count, false), keep(count, false);
  float area = 0, area_along_one = 0;
  for (size_t n = 0; n < count; ++n) {
    auto row = sums.row(n);
    row /= std::max(1e-6f, row.sum());
    along_one[n] = lies_along_one_bone(row);
    area += parts.area[n];
    area_along_one += along_one[n] ? parts.area[n] : 0;
  }
  // of hard parts, nothing reaches over a joint
  const bool pieces = count >= 6 && area_along_one > 0.8f * area;
  for (size_t n = 0; n < count; ++n) {
    auto row = sums.row(n);
    Eigen::Index top = 0;
    const float share = row.maxCoeff(&top);
    keep[n] = (pieces && along_one[n]) || parts.size[n] < 0.1f * leg ||
              (parts.size[n] < 0.3f * leg && share > 0.97f);
    if ((pieces && along_one[n]) || share > 0.8f) row = Eigen::RowVectorXf::Unit(kJointCount, top);
  }
  for (size_t v = 0; v < parts.of.size(); ++v) {
    const size_t n = parts.of[v];
    if (!keep[n]) continue;
    rigid[v] = true;
    weights.row(v) = sums.row(n);
  }
  return rigid;
}

}  // namespace understudy
