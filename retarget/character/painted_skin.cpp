#include "retarget/character/character_export.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

constexpr float kSame = 1e-5f;

/// The bone that stands for a joint: its own, or that of the next joint above that has one.
int bone_of_joint(const PreparedCharacter& c, int joint) {
  for (int j = joint; j >= 0; j = kParents[j])
    if (c.map.has(j)) return c.map.node[j];
  const auto pelvis = std::find(c.driver.begin(), c.driver.end(), static_cast<int>(Pelvis));
  if (pelvis != c.driver.end()) return static_cast<int>(pelvis - c.driver.begin());
  for (int j = 0; j < kJointCount; ++j)
    if (c.map.has(j)) return c.map.node[j];
  throw Error(c.character.name + ": has no bone that paint could go to");
}

class Painter {
 public:
  Painter(const PreparedCharacter& character, const RowMatrix& weights, int most, Character& out)
      : c_(character), weights_(weights), most_(most), out_(out), joint_of_(joints_of_nodes(character)) {
    for (int j = 0; j < kJointCount; ++j) bone_of_[j] = bone_of_joint(c_, j);
  }

  void paint_all() {
    std::vector<Eigen::Index> first = {0};
    for (const auto& part : out_.parts) first.push_back(first.back() + part.vertices.rows());
    std::vector<bool> changed(out_.parts.size(), false);
    for (size_t p = 0; p < changed.size(); ++p)
      for (Eigen::Index v = first[p]; v < first[p + 1] && !changed[p]; ++v) changed[p] = is_painted(v);
    for (size_t p = 0; p < changed.size(); ++p)
      if (changed[p] && out_.parts[p].skin < 0) give_skin(out_.parts[p].node);
    for (size_t p = 0; p < changed.size(); ++p)
      if (changed[p]) paint(out_.parts[p], first[p]);
  }

 private:
  using Pulls = std::map<int, float>;  // of bones of a skin at one vertex

  Eigen::Index row_of(Eigen::Index vertex) const { return c_.surface.map[vertex]; }
  bool is_painted(Eigen::Index vertex) const {
    const Eigen::Index row = row_of(vertex);
    return (weights_.row(row) - c_.weights.row(row)).cwiseAbs().maxCoeff() > kSame;
  }

  /// All parts that a node carries are skinned to it: they move as before.
  void give_skin(int node) {
    CharacterSkin skin;
    skin.name = out_.nodes[node].name;
    skin.joints = {node};
    skin.inverse_bind = {Mat4::Identity()};
    for (auto& part : out_.parts) {
      if (part.node != node || part.skin >= 0) continue;
      part.skin = out_.skins.size();
      part.joints.setZero(part.vertices.rows(), 1);
      part.weights.setOnes(part.vertices.rows(), 1);
    }
    out_.skins.push_back(std::move(skin));
  }

  /// The number of a node among the joints of a skin, which takes it in where it was none.
  int joint_in_skin(CharacterSkin& skin, int node) {
    const auto found = std::find(skin.joints.begin(), skin.joints.end(), node);
    if (found != skin.joints.end()) return static_cast<int>(found - skin.joints.begin());
    const Mat4 to_bind = c_.bind.nodes[skin.joints[0]] * skin.inverse_bind[0];
    skin.inverse_bind.push_back(c_.bind.nodes[node].inverse() * to_bind);
    skin.joints.push_back(node);
    return skin.joints.size() - 1;
  }

  Pulls pulls_of(const CharacterPart& part, Eigen::Index v, CharacterSkin& skin, Eigen::Index row) {
    Pulls before, after;
    std::array<float, kJointCount> of_joint{};
    for (Eigen::Index k = 0; k < part.joints.cols(); ++k)
      if (part.weights(v, k) > 0) {
        const int bone = part.joints(v, k);
        before[bone] += part.weights(v, k);
        of_joint[joint_of(skin, bone)] += part.weights(v, k);
      }
    for (const auto& [bone, weight] : before) {
      const size_t j = joint_of(skin, bone);
      after[bone] = weight / of_joint[j] * weights_(row, j);
    }
    for (size_t j = 0; j < kJointCount; ++j)
      if (const float wanted = weights_(row, j); wanted > 0 && of_joint[j] <= 0)
        after[joint_in_skin(skin, bone_of_[j])] += wanted;
    return after;
  }

  size_t joint_of(const CharacterSkin& skin, int bone) const {
    return static_cast<size_t>(joint_of_[skin.joints[bone]]);
  }

  void paint(CharacterPart& part, Eigen::Index first) {
    CharacterSkin& skin = out_.skins[part.skin];
    const Eigen::Index had = part.joints.cols(), columns = std::max<Eigen::Index>(most_, had);
    part.joints.conservativeResize(Eigen::NoChange, columns);
    part.weights.conservativeResize(Eigen::NoChange, columns);
    part.joints.rightCols(columns - had).setZero();
    part.weights.rightCols(columns - had).setZero();
    for (Eigen::Index v = 0; v < part.vertices.rows(); ++v) {
      if (!is_painted(first + v)) continue;
      const Pulls pulls = pulls_of(part, v, skin, row_of(first + v));
      std::vector<std::pair<float, int>> order;
      for (const auto& [bone, weight] : pulls) order.emplace_back(weight, bone);
      std::stable_sort(order.begin(), order.end(), [](auto& a, auto& b) { return a.first > b.first; });
      part.joints.row(v).setZero();
      part.weights.row(v).setZero();
      for (size_t k = 0; k < std::min<size_t>(order.size(), columns); ++k) {
        part.weights(v, k) = order[k].first;
        part.joints(v, k) = order[k].second;
      }
      part.weights.row(v) /= part.weights.row(v).sum();
    }
  }

  const PreparedCharacter& c_;
  const RowMatrix& weights_;
  int most_;
  Character& out_;
  std::vector<int> joint_of_;             // of nodes
  std::array<int, kJointCount> bone_of_;  // nodes
};

}  // namespace

void apply_painted_weights(const PreparedCharacter& character, const RowMatrix& weights, int most,
                           Character& out) {
  US_CHECK(weights.rows() == character.weights.rows() && weights.cols() == kJointCount,
           character.character.name, ": has ", character.weights.rows(), " vertices, the weights are of ",
           weights.rows());
  Painter(character, weights, most, out).paint_all();
}

}  // namespace understudy
