// Characters made by the tests: a body of tubes on a rig of any naming, pose, unit and heading.
#pragma once

#include <string>

#include "retarget/character/character.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy::tests {

enum class Naming { Mixamo, Rigify, Vrm, Unreal, Biped, Smpl, Words, Cmu, None };

struct MadeCharacter {
  Naming naming = Naming::Mixamo;
  float arms_down_deg = 0;  ///< 0: T-pose, 50: A-pose
  float legs_apart_deg = 0;
  float unit = 1;  ///< of the file in metres: 0.01 for centimetres
  float heading_deg = 0;
  bool nodes_posed = false;  ///< the nodes stand in another pose than the bind pose
  bool fingers = true;       ///< a finger on each hand, which no joint stands for
  bool rigged = true;
  bool textured = true;
  bool nested_scales = false;   ///< bones and vertices in centimetres under a node that is scaled by 0.01
  bool separate_skins = false;  ///< each part has a skin of its own, with the same bones
  int influences = 4;           ///< 8: six more bones pull a little at every vertex
};

/// About 1.7 m tall, two parts with two materials (one textured), normals, UVs, colours on one of them.
Character make_character(const MadeCharacter& options = {});
/// The joints that make_character puts the bones at, metres, the floor at 0, turned by the heading.
Joints made_joints(const MadeCharacter& options);
/// What a bone is called.
std::string made_name(Naming naming, int joint);

/// Skin weights by the shape alone, [V, 22].
RowMatrix shape_weights(const Mesh& mesh, const Joints& joints);

/// Gives the joints it was made with, whatever it sees.
class KnownExtractor final : public SkeletonExtractor {
 public:
  explicit KnownExtractor(const Joints& joints) : joints_(joints) {}
  Extraction extract(const Mesh& scan) override;
  std::string name() const override { return "known"; }

 private:
  Joints joints_;
  Points first_;  // the scan that was seen first: others are it, turned about y
};

/// Linear blend skinning by distance, with offsets that grow with the bend of the knees and elbows.
class BulgingDeformer final : public Deformer {
 public:
  explicit BulgingDeformer(float bulge_m = 0) : bulge_m_(bulge_m) {}
  void bind(const Points& rest, const Joints& rest_joints) override;
  const RowMatrix& weights() const override { return weights_; }
  std::shared_ptr<Deformer> with_weights(RowMatrix weights) const override;
  Points deform(const Pose& pose) const override;
  Points offsets(const Pose& pose) const override;
  std::string name() const override { return "bulging"; }

 private:
  float bulge_m_;
  Points rest_;
  Joints joints_;
  RowMatrix weights_;
};

/// Hard plates that hang on the nodes of a rig, each on its own; nothing is skinned.
Character make_robot();

/// Poses of someone who walks, bends knees and elbows and turns, `count` of them; root heights for `rest`.
std::vector<Pose> made_motion(int count, const Joints& rest);

/// A picture of one pixel as PNG.
std::string made_picture();

}  // namespace understudy::tests
