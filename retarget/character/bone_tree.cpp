#include "retarget/character/bone_tree.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace understudy {
namespace {

constexpr size_t kMostBones = 2000;
constexpr Eigen::Index kMostPoints = 20000;

Vec3 place_of(const Mat4& matrix) {
  return matrix.topRightCorner<3, 1>();
}

/// Which nodes may be joints.
std::vector<bool> candidates(const Character& character) {
  const auto& nodes = character.nodes;
  std::vector<bool> out(nodes.size(), character.skins.empty());
  for (const auto& skin : character.skins)
    for (const int joint : skin.joints) out[joint] = true;
  std::vector<bool> below(nodes.size(), false);
  for (size_t n = 0; n < nodes.size(); ++n) {
    const int p = nodes[n].parent;
    below[n] = p >= 0 && (below[p] || out[p]);
  }
  for (size_t n = nodes.size(); n-- > 0;)  // children come after their parents
    if (out[n] && nodes[n].parent >= 0) out[nodes[n].parent] = true;
  for (size_t n = 0; n < nodes.size(); ++n)
    if (below[n] && !out[n]) out[n] = !parse_bone_name(nodes[n].name).what.empty();
  return out;
}

/// The candidates, depth first. Names without what they share.
std::vector<int> add_bones(const Character& character, const std::vector<Mat4>& bind, BoneTree& tree) {
  const std::vector<bool> is_candidate = candidates(character);
  std::vector<std::vector<int>> below(bind.size());
  std::vector<int> open;
  for (size_t n = bind.size(); n-- > 0;)
    (character.nodes[n].parent < 0 ? open : below[character.nodes[n].parent]).push_back(static_cast<int>(n));
  std::vector<std::string> names;
  for (size_t n = 0; n < bind.size(); ++n)
    if (is_candidate[n]) names.push_back(character.nodes[n].name);
  const auto common = common_words(names);
  std::vector<int> bone_of(bind.size(), -1);  // the node's own, or the nearest above
  while (!open.empty() && tree.bones.size() < kMostBones) {
    const int n = open.back(), p = character.nodes[n].parent;
    open.pop_back();
    open.insert(open.end(), below[n].begin(), below[n].end());
    bone_of[n] = p < 0 ? -1 : bone_of[p];
    if (!is_candidate[n]) continue;
    TreeBone bone;
    bone.node = n;
    bone.parent = bone_of[n];
    bone.at = bone.middle = place_of(bind[n]);
    bone.name = parse_bone_name(character.nodes[n].name, common);
    bone_of[n] = static_cast<int>(tree.bones.size());
    if (bone.parent >= 0) {
      bone.depth = tree.bones[bone.parent].depth + 1;
      tree.bones[bone.parent].below.push_back(bone_of[n]);
    }
    tree.bones.push_back(std::move(bone));
  }
  for (size_t b = tree.bones.size(); b-- > 0;) {
    TreeBone& bone = tree.bones[b];
    bone.end = static_cast<int>(b) + 1;
    for (const int child : bone.below) bone.end = std::max(bone.end, tree.bones[child].end);
  }
  return bone_of;
}

/// What bones move: a sample of all vertices, each with the bone that pulls it most.
void add_surface(const Character& character, const std::vector<Mat4>& bind, const std::vector<int>& bone_of,
                 BoneTree& tree) {
  const Eigen::Index step = 1 + character.vertex_count() / kMostPoints;
  std::vector<Vec3> points;
  std::vector<int> owner;
  for (const auto& part : character.parts)
    for (Eigen::Index v = 0; v < part.vertices.rows(); v += step) {
      int node = part.node;
      Mat4 M = node >= 0 ? bind[node] : Mat4(Mat4::Identity());
      if (part.skin >= 0 && part.weights.cols() > 0) {
        Eigen::Index most = 0;
        part.weights.row(v).maxCoeff(&most);
        const auto& skin = character.skins[part.skin];
        const int joint = part.joints(v, most);
        node = skin.joints[joint];
        M = bind[node] * skin.inverse_bind[joint];
      }
      if (node < 0 || bone_of[node] < 0) continue;
      const Vec3 vertex = part.vertices.row(v).transpose();
      points.push_back(M.topLeftCorner<3, 3>() * vertex + place_of(M));
      owner.push_back(bone_of[node]);
    }
  tree.has_surface = !points.empty();
  tree.surface.resize(static_cast<Eigen::Index>(points.size()), 3);
  std::vector<Vec3> sum(tree.bones.size(), Vec3::Zero());
  for (size_t i = 0; i < points.size(); ++i) {
    tree.surface.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
    tree.bones[owner[i]].mass += 1 / static_cast<float>(points.size());
    for (int b = owner[i]; b >= 0; b = tree.bones[b].parent) {
      TreeBone& bone = tree.bones[b];
      bone.total += 1;
      sum[b] += points[i];
      bone.reach = std::max(bone.reach, (points[i] - bone.at).norm());
    }
  }
  for (size_t b = 0; b < tree.bones.size(); ++b) {
    TreeBone& bone = tree.bones[b];
    if (bone.total > 0) bone.middle = sum[b] / bone.total;
    bone.total /= std::max<float>(1, static_cast<float>(points.size()));
    if (!tree.has_surface)
      for (int a = bone.parent; a >= 0; a = tree.bones[a].parent)
        tree.bones[a].reach = std::max(tree.bones[a].reach, (bone.at - tree.bones[a].at).norm());
  }
}

void measure(BoneTree& tree) {
  if (tree.bones.empty()) return;
  const bool skinned = tree.has_surface;
  Vec3 low = Vec3::Constant(1e30f), high = -low;
  for (const TreeBone& bone : tree.bones) {
    if (skinned && bone.total <= 0) continue;  // a root far away
    low = low.cwiseMin(bone.at);
    high = high.cwiseMax(bone.at);
  }
  const float size = (high - low).maxCoeff();
  tree.size = std::isfinite(size) && size > 0 ? size : 0;
  std::map<std::pair<int, std::string>, std::vector<int>> numbers;
  for (const TreeBone& bone : tree.bones)
    if (!bone.name.what.empty()) numbers[{bone.name.side, bone.name.what}].push_back(bone.name.number);
  for (TreeBone& bone : tree.bones) {
    const auto found = numbers.find({bone.name.side, bone.name.what});
    if (bone.name.what.empty() || found == numbers.end()) continue;
    std::vector<int>& all = found->second;
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    bone.rank = static_cast<float>(std::lower_bound(all.begin(), all.end(), bone.name.number) - all.begin());
  }
}

struct Plane {
  Vec3 normal = Vec3::UnitX();
  float offset = 0;
  float vote = 0;
  float across(const Vec3& p) const { return normal.dot(p) - offset; }
  Vec3 mirrored(const Vec3& p) const { return p - 2 * across(p) * normal; }
};

bool names_mirror(const TreeBone& a, const TreeBone& b) {
  return a.name.side * b.name.side < 0 && a.name.key == b.name.key;
}

/// Between branches that are alike: they hang on one bone, as far from it and as large.
std::vector<Plane> likely_planes(const BoneTree& tree) {
  constexpr size_t kMost = 40, kMostChildren = 24;
  constexpr float kAlike = 0.05f;
  std::vector<Plane> out;
  for (const TreeBone& parent : tree.bones)
    for (size_t i = 0; i < std::min(kMostChildren, parent.below.size()); ++i)
      for (size_t k = 0; k < i; ++k) {
        const TreeBone &a = tree.bones[parent.below[i]], &b = tree.bones[parent.below[k]];
        const auto large = [&](const TreeBone& bone, int n) { return static_cast<float>(bone.end - n); };
        const float sa = large(a, parent.below[i]), sb = large(b, parent.below[k]);
        const float apart = (a.at - b.at).norm();
        const float differ = std::abs((a.at - parent.at).norm() - (b.at - parent.at).norm());
        if (apart < 1e-3f * tree.size || differ > kAlike * tree.size ||
            2 * std::min(sa, sb) < std::max(sa, sb))
          continue;
        Plane plane;
        plane.normal = (a.at - b.at) / apart;
        plane.offset = plane.normal.dot(a.at + b.at) / 2;
        plane.vote = std::min(sa, sb) * (names_mirror(a, b) ? 2 : 1);
        out.push_back(plane);
      }
  std::stable_sort(out.begin(), out.end(), [](const Plane& x, const Plane& y) { return x.vote > y.vote; });
  if (out.size() > kMost) out.resize(kMost);
  return out;
}

/// How many bones have another one across the plane, each by how near it is.
float symmetric_bones(const BoneTree& tree, const Plane& plane) {
  constexpr float kNear = 0.03f, kOff = 0.02f;
  float sum = 0;
  for (size_t a = 0; a < tree.bones.size(); ++a) {
    if (std::abs(plane.across(tree.bones[a].at)) < kOff * tree.size) continue;
    const Vec3 there = plane.mirrored(tree.bones[a].at);
    float least = kNear * tree.size;
    for (size_t b = 0; b < tree.bones.size(); ++b)
      if (b != a) least = std::min(least, (tree.bones[b].at - there).norm());
    sum += 1 - least / (kNear * tree.size);
  }
  return sum;
}

/// How unlike the mirror image of a the bone b is; above 1 they are no pair.
float unlike(const BoneTree& tree, const Plane& plane, int ia, int ib) {
  constexpr float kFar = 0.12f, kFarNamed = 0.3f;
  const TreeBone &a = tree.bones[ia], &b = tree.bones[ib];
  const bool named = names_mirror(a, b);
  if (!tree.has_plane && !named) return 2;
  if (tree.is_above(ia, ib) || tree.is_above(ib, ia)) return 2;
  float cost = named ? 0 : 0.05f;
  if (!named && a.name.key != b.name.key) cost += 0.02f;
  cost += 0.03f * static_cast<float>(std::abs(a.depth - b.depth));
  const float larger = std::log(static_cast<float>(a.end - ia) / static_cast<float>(b.end - ib));
  cost += 0.01f * std::abs(larger);
  if (!tree.has_plane) return cost;
  if (std::abs(a.across) < 0.005f * tree.size && !named) return 2;
  const float far = (plane.mirrored(a.at) - b.at).norm() / tree.size;
  return far > (named ? kFarNamed : kFar) ? 2 : cost + far;
}

void find_mirrors(BoneTree& tree) {
  constexpr float kFewest = 3;
  Plane best;
  float most = 0;
  for (const Plane& plane : likely_planes(tree)) {
    const float count = symmetric_bones(tree, plane);
    if (count > most) best = plane;
    most = std::max(most, count);
  }
  tree.has_plane = most >= kFewest;
  tree.normal = best.normal;
  const auto count = static_cast<int>(tree.bones.size());
  for (TreeBone& bone : tree.bones) bone.across = best.across(bone.at);
  std::vector<int> likest(tree.bones.size(), -1);
  for (int a = 0; a < count; ++a) {
    float least = 1;
    for (int b = 0; b < count; ++b)
      if (const float cost = a == b ? 2 : unlike(tree, best, a, b); cost < least) {
        least = cost;
        likest[a] = b;
      }
  }
  for (int a = 0; a < count; ++a)
    if (const int b = likest[a]; b >= 0 && likest[b] == a) tree.bones[a].mirror = b;
}

}  // namespace

int BoneTree::common(int a, int b) const {
  if (a < 0 || b < 0) return -1;
  while (a >= 0 && !is_above(a, b)) a = bones[a].parent;
  return a;
}

std::vector<int> BoneTree::path(int top, int end) const {
  std::vector<int> out;
  for (int b = end; b >= 0 && b != top; b = bones[b].parent) out.push_back(b);
  std::reverse(out.begin(), out.end());
  return out;
}

BoneTree make_bone_tree(const Character& character, const std::vector<Mat4>& bind) {
  BoneTree tree;
  const std::vector<int> bone_of = add_bones(character, bind, tree);
  add_surface(character, bind, bone_of, tree);
  measure(tree);
  if (tree.size > 0) find_mirrors(tree);
  return tree;
}

}  // namespace understudy
