#include "retarget/motion/bone_shapes.hpp"

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

constexpr float kThickness = 0.09f, kRingAt = 0.15f;  // of the bone's length

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

}  // namespace

void check_bones(const BoneMap& map, const std::string& name) {
  US_CHECK(map.usable(), name, ": only ", map.count(),
           " of the 22 joints were found among its bones, too few to perform; a map can name them, or its "
           "surface be looked at as a scan");
}

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
  CharacterNode carrier;
  carrier.name = "bones";
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
  character.nodes.push_back(std::move(carrier));
  character.parts.push_back(std::move(part));
}

}  // namespace understudy
