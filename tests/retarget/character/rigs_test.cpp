// Whether rigs of many conventions are mapped as a careful rigger would.
#include <gtest/gtest.h>

#include <chrono>

#include "retarget/character/bone_map.hpp"
#include "tests/retarget/character/rigs.hpp"

namespace understudy::tests {
namespace {

class EveryConvention : public testing::TestWithParam<int> {};

TEST_P(EveryConvention, IsMappedAsACarefulRiggerWould) {
  constexpr unsigned kRigs = 60;
  const auto convention = static_cast<Convention>(GetParam());
  int right = 0, all = 0;
  std::string wrong;
  for (unsigned seed = 0; seed < kRigs; ++seed) {
    const MadeRig rig = make_rig(convention, seed);
    const BoneMap map = map_bones(rig.character, bind_pose(rig.character).nodes);
    std::string faults;
    for (size_t j = 0; j < kJointCount; ++j) {
      if (rig.truth[j] < 0 && map.node[j] < 0) continue;
      ++all;
      right += map.node[j] == rig.truth[j] ? 1 : 0;
      const auto name = [&](int n) {
        return n < 0 ? std::string("-")
                     : std::to_string(n) + " " + rig.character.nodes[static_cast<size_t>(n)].name;
      };
      if (map.node[j] != rig.truth[j])
        faults += std::string("  ") + kJointNames[j] + ": " + name(map.node[j]) + ", not " +
                  name(rig.truth[j]) + "\n";
    }
    if (!faults.empty())
      wrong += std::to_string(seed) + ": " + rig.description + " (" + map.how + ")\n" + faults;
  }
  std::printf("%-12s %.2f %% of %d\n", convention_name(convention), 100.0 * right / all, all);
  EXPECT_GE(right, 0.995 * all) << convention_name(convention) << ":\n" << wrong;
}

INSTANTIATE_TEST_SUITE_P(Rigs, EveryConvention, testing::Range(0, kConventions));

/// Four legs, a neck, a head and a tail of bones, all with the same name; the nose towards +z.
Character make_animal(float leg, float body, int segments) {
  Character out;
  CharacterSkin skin;
  CharacterPart part;
  std::vector<Vec3> places;
  const auto add = [&](int parent, const Vec3& at) {
    CharacterNode node;
    node.parent = parent;
    node.local.translation = parent < 0 ? at : Vec3(at - places[static_cast<size_t>(parent)]);
    places.push_back(at);
    skin.joints.push_back(static_cast<int>(out.nodes.size()));
    skin.inverse_bind.push_back(affine(Mat3::Identity(), at).inverse());
    out.nodes.push_back(node);
    return static_cast<int>(out.nodes.size()) - 1;
  };
  const int hips = add(-1, {0, leg, -body / 2});
  const int chest = add(add(hips, {0, leg, 0}), {0, leg, body / 2});
  add(add(chest, {0, leg + 0.1f, body / 2 + 0.1f}), {0, leg + 0.25f, body / 2 + 0.2f});
  for (int i = 0, tail = hips; i < 4; ++i)
    tail = add(tail, {0, leg, -body / 2 - 0.1f * static_cast<float>(i + 1)});
  for (const float side : {1.0f, -1.0f})
    for (const bool front : {true, false}) {
      int below = front ? chest : hips;
      for (int i = 0; i <= segments; ++i) {
        const float down = static_cast<float>(i) / static_cast<float>(segments);
        const float paw = i == segments ? 0.1f : 0;
        below = add(below, {0.1f * side, leg * (1 - down), (front ? body : -body) / 2 + paw});
      }
    }
  const auto count = static_cast<Eigen::Index>(places.size());
  part.vertices.resize(count, 3);
  part.joints.setZero(count, 1);
  part.weights.setOnes(count, 1);
  for (Eigen::Index v = 0; v < count; ++v) {
    part.vertices.row(v) = places[static_cast<size_t>(v)].transpose();
    part.joints(v, 0) = static_cast<int>(v);
  }
  part.skin = 0;
  part.node = static_cast<int>(out.nodes.size());
  out.nodes.emplace_back();
  out.parts.push_back(part);
  out.skins.push_back(skin);
  return out;
}

TEST(Rigs, OfAnimalsAreNotTakenForPeople) {
  for (const float leg : {0.3f, 0.6f, 0.9f})
    for (const float body : {0.5f, 0.8f, 1.2f})
      for (const int segments : {2, 3, 4}) {
        const Character animal = make_animal(leg, body, segments);
        EXPECT_FALSE(map_bones(animal, bind_pose(animal).nodes).usable())
            << leg << " " << body << " " << segments;
      }
}

TEST(Rigs, GuessesAreNamed) {
  MadeRig rig = make_rig(Convention::BlenderLr, 3);
  const auto bind = bind_pose(rig.character).nodes;
  EXPECT_EQ(guess_note(map_bones(rig.character, bind)), "");
  for (const int joint : {LeftElbow, RightElbow})
    rig.character.nodes[static_cast<size_t>(rig.truth[static_cast<size_t>(joint)])].name = "thing";
  const BoneMap map = map_bones(rig.character, bind);
  EXPECT_EQ(map.node, rig.truth);
  EXPECT_EQ(guess_note(map), "guessed by their places, not by name: left elbow, right elbow");
}

TEST(Rigs, ManyEqualBonesAreMappedInShortTime) {
  // A comb: every bone has a pair of chains.
  Character comb;
  comb.nodes.emplace_back();
  for (int i = 0, spine = 0; i < 100; ++i) {
    const auto add = [&](int parent, const Vec3& step) {
      CharacterNode node;
      node.parent = parent;
      node.local.translation = step;
      comb.nodes.push_back(node);
      return static_cast<int>(comb.nodes.size()) - 1;
    };
    spine = add(spine, {0, 0.01f, 0});
    for (const float side : {1.0f, -1.0f})
      for (int k = 0, below = spine; k < 12; ++k) below = add(below, {side * 0.02f, 0, 0});
  }
  const auto began = std::chrono::steady_clock::now();
  map_bones(comb, comb.world());
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(), 20);
}

}  // namespace
}  // namespace understudy::tests
