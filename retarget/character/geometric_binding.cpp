#include "retarget/character/geometric_binding.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <queue>

#include "retarget/character/voxel_body.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr float kBehind = 2.5f;     // how much further a bone is behind its first end
constexpr float kDetour = 2.0f;     // what a way around costs, over the straight one
constexpr float kSharpness = 5.0f;  // of the fall of weights with distance
constexpr float kBigHead = 0.36f;   // of the leg: width and height of a head that no human has
constexpr float kFar = std::numeric_limits<float>::max();
constexpr int kSlices = 48;  // of the legs, looking for a skirt

float smooth_step(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

Vec3 bone(const Joints& joints, int from, int to) {
  return (joints.row(to) - joints.row(from)).transpose();
}

using Segments = std::array<std::vector<std::pair<Vec3, Vec3>>, kJointCount>;

/// The bones that each joint moves; hands, feet and head go on beyond their joint.
Segments bones_of(const Joints& joints) {
  Segments out;
  const auto at = [&](int j) -> Vec3 { return joints.row(j).transpose(); };
  const auto add = [&](int j, const Vec3& from, const Vec3& to) {
    out[static_cast<size_t>(j)].emplace_back(from, to);
  };
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
    for (int c = 0; c < 3; ++c) p[static_cast<size_t>(c)] = mesh.vertices.row(mesh.faces(f, c)).transpose();
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
    for (int s = first; s < kSlices && static_cast<float>(s) <= legs.slice(low); ++s)
      side[static_cast<size_t>(s)] = true;
  }
  return cut;
}

/// The vertices of the hanging cloth: joined with the cut between hem and hips, and outermost about the legs.
std::vector<bool> cloth_of(const Mesh& mesh, const Legs& legs, const MiddleCut& cut, float hem) {
  const auto in_band = [&](int v) {
    const float y = mesh.vertices(v, 1);
    return y > hem - 0.03f * legs.length && y < legs.top + 0.06f * legs.length;
  };
  std::vector<bool> cloth(static_cast<size_t>(mesh.vertices.rows()), false);
  for (const Eigen::Index f : cut.faces)
    for (int c = 0; c < 3; ++c)
      if (in_band(mesh.faces(f, c))) cloth[static_cast<size_t>(mesh.faces(f, c))] = true;
  for (bool grown = true; grown;) {
    grown = false;
    for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f) {
      int marked = 0;
      for (int c = 0; c < 3; ++c) marked += cloth[static_cast<size_t>(mesh.faces(f, c))] ? 1 : 0;
      if (marked == 0 || marked == 3) continue;
      for (int c = 0; c < 3; ++c) {
        const int v = mesh.faces(f, c);
        if (cloth[static_cast<size_t>(v)] || !in_band(v)) continue;
        cloth[static_cast<size_t>(v)] = grown = true;
      }
    }
  }
  constexpr int kAngles = 24;
  std::array<std::array<float, kAngles>, kSlices + 8> outermost{};
  const auto bin = [&](int v, float& radius) -> float& {
    const float x = mesh.vertices(v, 0) - legs.middle, z = mesh.vertices(v, 2) - legs.depth;
    radius = std::hypot(x, z);
    const int angle = static_cast<int>((std::atan2(z, x) / (2 * kPi) + 0.5f) * kAngles) % kAngles;
    const int slice = std::clamp(static_cast<int>(legs.slice(mesh.vertices(v, 1))) + 4, 0, kSlices + 7);
    return outermost[static_cast<size_t>(slice)][static_cast<size_t>(angle)];
  };
  float radius = 0;
  for (int v = 0; v < mesh.vertices.rows(); ++v)
    if (cloth[static_cast<size_t>(v)]) {
      float& known = bin(v, radius);
      known = std::max(known, radius);
    }
  for (int v = 0; v < mesh.vertices.rows(); ++v)
    if (cloth[static_cast<size_t>(v)] && bin(v, radius) * 0.7f > radius)
      cloth[static_cast<size_t>(v)] = false;
  return cloth;
}

/// A part with these mean weights lies along one bone, or makes up the trunk.
bool lies_along_one_bone(const Eigen::Ref<const Eigen::RowVectorXf>& weights) {
  float trunk = 0;
  for (const int j : {Pelvis, Spine1, Spine2, Spine3, LeftCollar, RightCollar}) trunk += weights[j];
  return weights.maxCoeff() > 0.55f || trunk > 0.75f;
}

/// Ways along the edges from one vertex, [V]; what is not joined with it is out of reach.
std::vector<float> surface_ways(const Mesh& mesh, int from) {
  std::vector<std::vector<int>> next(static_cast<size_t>(mesh.vertices.rows()));
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f)
    for (int c = 0; c < 3; ++c) {
      next[static_cast<size_t>(mesh.faces(f, c))].push_back(mesh.faces(f, (c + 1) % 3));
      next[static_cast<size_t>(mesh.faces(f, (c + 1) % 3))].push_back(mesh.faces(f, c));
    }
  std::vector<float> way(next.size(), kFar);
  using Entry = std::pair<float, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  way[static_cast<size_t>(from)] = 0;
  open.push({0.0f, from});
  while (!open.empty()) {
    const auto [here, v] = open.top();
    open.pop();
    if (here > way[static_cast<size_t>(v)]) continue;
    for (const int n : next[static_cast<size_t>(v)]) {
      const float there = here + (mesh.vertices.row(n) - mesh.vertices.row(v)).norm();
      if (there >= way[static_cast<size_t>(n)]) continue;
      way[static_cast<size_t>(n)] = there;
      open.push({there, n});
    }
  }
  return way;
}

/// Length of the lines on the surface where `way` has each of the levels step, 2 step, ...
std::vector<float> ring_lengths(const Mesh& mesh, const std::vector<float>& way, float step, int levels) {
  std::vector<float> length(static_cast<size_t>(levels), 0.0f);
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f) {
    std::array<float, 3> w{};
    for (int c = 0; c < 3; ++c) w[static_cast<size_t>(c)] = way[static_cast<size_t>(mesh.faces(f, c))];
    const auto [low, high] = std::minmax({w[0], w[1], w[2]});
    if (high == kFar) continue;
    for (int k = std::max(0, static_cast<int>(low / step));
         k < levels && step * static_cast<float>(k) <= high; ++k) {
      const float level = step * static_cast<float>(k);
      std::vector<Vec3> ends;
      for (size_t c = 0; c < 3; ++c) {
        const float a = w[c] - level, b = w[(c + 1) % 3] - level;
        if ((a < 0) == (b < 0)) continue;
        const Vec3 p = mesh.vertices.row(mesh.faces(f, static_cast<int>(c))).transpose();
        const Vec3 q = mesh.vertices.row(mesh.faces(f, static_cast<int>((c + 1) % 3))).transpose();
        ends.emplace_back(p + a / (a - b) * (q - p));
      }
      if (ends.size() == 2) length[static_cast<size_t>(k)] += (ends[1] - ends[0]).norm();
    }
  }
  return length;
}

int root_of(std::vector<int>& parent, int v) {
  while (parent[static_cast<size_t>(v)] != v)
    v = parent[static_cast<size_t>(v)] = parent[static_cast<size_t>(parent[static_cast<size_t>(v)])];
  return v;
}

}  // namespace

BoneDistances bone_distances(const Mesh& mesh, const Joints& joints) {
  const VoxelBody body(mesh);
  const Segments bones = bones_of(joints);
  BoneDistances out;
  out.leg = leg_length(joints);
  out.metres.resize(mesh.vertices.rows(), kJointCount);
  for (size_t j = 0; j < kJointCount; ++j) {
    const std::vector<float> ways = body.ways_from(bones[j]);
    for (Eigen::Index v = 0; v < mesh.vertices.rows(); ++v) {
      const Vec3 p = mesh.vertices.row(v).transpose();
      float straight = 1e9f, plain = 1e9f;
      for (const auto& s : bones[j]) {
        straight = std::min(straight, straight_distance(p, s));
        const Vec3 d = s.second - s.first;
        const float t = std::clamp((p - s.first).dot(d) / std::max(1e-12f, d.squaredNorm()), 0.0f, 1.0f);
        plain = std::min(plain, (p - s.first - t * d).norm());
      }
      // Ways along a grid are longer than straight ones by a tenth at most.
      const float detour = std::max(0.0f, body.at(ways, p) - 1.1f * plain - 1.5f * body.size());
      out.metres(v, static_cast<Eigen::Index>(j)) = straight + kDetour * detour;
    }
  }
  return out;
}

std::optional<Skirt> find_skirt(const Mesh& mesh, const Joints& joints) {
  if (mesh.is_cloud()) return std::nullopt;
  const Legs legs(joints);
  const MiddleCut cut = cut_between(mesh, legs);
  int last = 2;
  const auto closed = [&](int s, bool both) {
    const bool front = cut.front[static_cast<size_t>(s)], back = cut.back[static_cast<size_t>(s)];
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
    if (cloth[static_cast<size_t>(v)]) widest = std::max(widest, std::abs(mesh.vertices(v, 0) - legs.middle));
  skirt.share = Eigen::VectorXf::Zero(mesh.vertices.rows());
  skirt.weights = RowMatrix::Zero(mesh.vertices.rows(), kJointCount);
  for (Eigen::Index v = 0; v < mesh.vertices.rows(); ++v) {
    if (!cloth[static_cast<size_t>(v)]) continue;
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
  if (mesh.is_cloud()) return share;
  const float leg = leg_length(joints), step = 0.02f * leg;
  constexpr int kLevels = 100;
  int crown = -1;
  for (int v = 0; v < mesh.vertices.rows(); ++v) {
    const float off = std::abs(mesh.vertices(v, 0) - joints(Head, 0));
    if (off < 0.25f * leg && (crown < 0 || mesh.vertices(v, 1) > mesh.vertices(crown, 1))) crown = v;
  }
  if (crown < 0) return share;
  const std::vector<float> way = surface_ways(mesh, crown);
  const std::vector<float> ring = ring_lengths(mesh, way, step, kLevels);
  // The neck: the narrowest ring before the shoulders.
  float reach = kFar;
  for (const int elbow : {LeftElbow, RightElbow}) {
    Eigen::Index nearest = 0;
    (mesh.vertices.rowwise() - joints.row(elbow)).rowwise().squaredNorm().minCoeff(&nearest);
    reach =
        std::min(reach, way[static_cast<size_t>(nearest)] - 0.25f * bone(joints, elbow - 2, elbow).norm());
  }
  const int last = std::min(kLevels, static_cast<int>(std::clamp(reach / step, 0.0f, 1e4f)));
  int neck = -1;
  float widest = 0, narrowest = kFar;
  for (int k = 1; k < last; ++k) {
    const float length = ring[static_cast<size_t>(k)];
    if (neck >= 0 && length > 1.3f * narrowest) break;  // the shoulders
    widest = std::max(widest, length);
    if (length <= 0 || length > 0.7f * widest || length >= narrowest) continue;
    narrowest = length;
    neck = k;
  }
  if (neck < 0) return share;
  const float at_neck = step * static_cast<float>(neck);
  Vec3 least = Vec3::Constant(kFar), most = Vec3::Constant(-kFar);
  for (Eigen::Index v = 0; v < share.size(); ++v) {
    share[v] = 1 - smooth_step(at_neck - 1.5f * step, at_neck + step, way[static_cast<size_t>(v)]);
    if (share[v] < 0.5f) continue;
    least = least.cwiseMin(mesh.vertices.row(v).transpose());
    most = most.cwiseMax(mesh.vertices.row(v).transpose());
  }
  const bool big = most.x() - least.x() > kBigHead * leg && most.y() - least.y() > kBigHead * leg;
  const bool alone = most.x() - least.x() < 0.8f * std::abs(joints(LeftElbow, 0) - joints(RightElbow, 0));
  if (!big || !alone) return Eigen::VectorXf(0 * share);
  // Ways along edges are rough: what lies over the neck under an overhanging head belongs to it as well.
  float height = 0, count = 0;
  for (Eigen::Index v = 0; v < share.size(); ++v)
    if (std::abs(way[static_cast<size_t>(v)] - at_neck) < 2 * step) height += mesh.vertices(v, 1), ++count;
  if (count < 1) return share;
  height /= count;
  for (Eigen::Index v = 0; v < share.size(); ++v)
    if (way[static_cast<size_t>(v)] < at_neck + 0.3f * leg && mesh.vertices(v, 0) > least.x() &&
        mesh.vertices(v, 0) < most.x())
      share[v] = std::max(share[v], smooth_step(height, height + 1.5f * step, mesh.vertices(v, 1)));
  return share;
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

RowMatrix geometric_weights(const Mesh& mesh, const BoneDistances& distances, const ShapeHints& hints) {
  const float least = 0.01f * distances.leg;
  RowMatrix weights(mesh.vertices.rows(), kJointCount);
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    const float closest = std::max(least, distances.metres.row(v).minCoeff());
    weights.row(v) = (closest / distances.metres.row(v).array().max(closest)).pow(kSharpness);
    weights.row(v) = (weights.row(v).array() < 0.01f).select(0.0f, weights.row(v));
    weights.row(v) /= weights.row(v).sum();
  }
  smooth_along(mesh, 0.03f * distances.leg, weights);
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    if (hints.skirt) weights.row(v) += hints.skirt->share[v] * (hints.skirt->weights.row(v) - weights.row(v));
    weights.row(v) *= 1 - hints.head[v];
    weights(v, Head) += hints.head[v];
  }
  keep_strongest(weights);
  return weights;
}

RowMatrix geometric_weights(const Mesh& mesh, const Joints& joints) {
  return geometric_weights(mesh, bone_distances(mesh, joints), shape_hints(mesh, joints));
}

SurfaceParts surface_parts(const Mesh& mesh) {
  SurfaceParts parts;
  const auto count = static_cast<size_t>(mesh.vertices.rows());
  std::vector<int> parent(count);
  std::iota(parent.begin(), parent.end(), 0);
  const float extent = (mesh.vertices.colwise().maxCoeff() - mesh.vertices.colwise().minCoeff()).maxCoeff();
  const float same = std::max(1e-9f, 2e-5f * extent);
  std::map<std::array<int64_t, 3>, int> places;
  for (size_t v = 0; v < count; ++v) {
    std::array<int64_t, 3> key{};
    for (int a = 0; a < 3; ++a)
      key[static_cast<size_t>(a)] = std::llround(mesh.vertices(static_cast<Eigen::Index>(v), a) / same);
    const auto [at, fresh] = places.try_emplace(key, static_cast<int>(v));
    if (!fresh)
      parent[static_cast<size_t>(root_of(parent, static_cast<int>(v)))] = root_of(parent, at->second);
  }
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f)
    for (int c = 0; c < 2; ++c)
      parent[static_cast<size_t>(root_of(parent, mesh.faces(f, c)))] = root_of(parent, mesh.faces(f, c + 1));
  std::map<int, int> number;
  std::vector<Vec3> low, high;
  for (size_t v = 0; v < count; ++v) {
    const auto [at, fresh] =
        number.try_emplace(root_of(parent, static_cast<int>(v)), static_cast<int>(number.size()));
    const Vec3 p = mesh.vertices.row(static_cast<Eigen::Index>(v)).transpose();
    if (fresh) {
      low.push_back(p);
      high.push_back(p);
    }
    const auto n = static_cast<size_t>(at->second);
    low[n] = low[n].cwiseMin(p);
    high[n] = high[n].cwiseMax(p);
    parts.of.push_back(at->second);
  }
  parts.area.assign(number.size(), 0);
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f) {
    const Vec3 a = mesh.vertices.row(mesh.faces(f, 0)).transpose(),
               b = mesh.vertices.row(mesh.faces(f, 1)).transpose(),
               c = mesh.vertices.row(mesh.faces(f, 2)).transpose();
    parts.area[static_cast<size_t>(parts.of[static_cast<size_t>(mesh.faces(f, 0))])] +=
        0.5f * (b - a).cross(c - a).norm();
  }
  for (size_t n = 0; n < low.size(); ++n) parts.size.push_back((high[n] - low[n]).norm());
  // Triangles that hang together nowhere are no parts.
  parts.torn = mesh.is_cloud() ||
               static_cast<double>(number.size()) > 0.05 * static_cast<double>(mesh.faces.rows()) + 30;
  return parts;
}

std::vector<bool> keep_parts_rigid(const Mesh& mesh, float leg, RowMatrix& weights) {
  const SurfaceParts parts = surface_parts(mesh);
  std::vector<bool> rigid(parts.of.size(), false);
  const size_t count = parts.size.size();
  if (parts.torn || count < 2) return rigid;
  RowMatrix sums = RowMatrix::Zero(static_cast<Eigen::Index>(count), kJointCount);
  for (size_t v = 0; v < parts.of.size(); ++v)
    sums.row(parts.of[v]) += weights.row(static_cast<Eigen::Index>(v));
  std::vector<bool> along_one(count, false), keep(count, false);
  float area = 0, area_along_one = 0;
  for (size_t n = 0; n < count; ++n) {
    auto row = sums.row(static_cast<Eigen::Index>(n));
    row /= std::max(1e-6f, row.sum());
    along_one[n] = lies_along_one_bone(row);
    area += parts.area[n];
    area_along_one += along_one[n] ? parts.area[n] : 0;
  }
  const bool pieces =
      count >= 6 && area_along_one > 0.8f * area;  // of hard parts, nothing reaches over a joint
  for (size_t n = 0; n < count; ++n) {
    auto row = sums.row(static_cast<Eigen::Index>(n));
    Eigen::Index top = 0;
    const float share = row.maxCoeff(&top);
    keep[n] = (pieces && along_one[n]) || parts.size[n] < 0.1f * leg ||
              (parts.size[n] < 0.3f * leg && share > 0.97f);
    if ((pieces && along_one[n]) || share > 0.8f) row = Eigen::RowVectorXf::Unit(kJointCount, top);
  }
  for (size_t v = 0; v < parts.of.size(); ++v) {
    const auto n = static_cast<size_t>(parts.of[v]);
    if (!keep[n]) continue;
    rigid[v] = true;
    weights.row(static_cast<Eigen::Index>(v)) = sums.row(static_cast<Eigen::Index>(n));
  }
  return rigid;
}

}  // namespace understudy
