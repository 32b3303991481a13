// A character made ready for the pipeline: its size, heading, bones, T-pose and joints found.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/base/fields.hpp"
#include "retarget/character/bone_map.hpp"
#include "retarget/character/character.hpp"
#include "retarget/character/rest_pose.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/target.hpp"

namespace understudy {

/// The name of the skin on the 22 joints, in files that we write.
constexpr const char* kOurSkin = "22 joints";

/// What happens to a character that does not look like a person.
enum class NotAPerson {
  RefuseClear,  ///< refused where no person can be so, else a warning: of documents of before, and of cases
  Refuse,       ///< refused where it is doubtful and no person is recognised in it, too
  Use           ///< used all the same, with a warning
};
constexpr Names<3> kNotAPersonNames{"refuse-clear", "refuse", "use"};

/// A character that does not look like a person is not used unasked.
struct NotAPersonError : Error {
  using Error::Error;
};

struct CharacterOptions {
  BoneChoices choices;            ///< the user's corrections of the map
  std::string units, up = "y";    ///< as in ImportOptions; empty: guessed
  bool turn_if_lying = true;      ///< who lies or is upside down with y up is turned upright, with a note
  std::optional<float> floor;     ///< its height after scale and axes, metres; none: the lowest points
  std::optional<float> turn_deg;  ///< turns it about y; none: so that it faces +z
  std::optional<float> height;    ///< metres that it is made tall; none: see decide_import()
  NotAPerson not_a_person = NotAPerson::RefuseClear;
  bool own_joints = true;  ///< false: the T-pose joints are found by the network, not the bones
};

/// Everything in metres, y up, facing +z, the floor at 0. The vertices of surface, weights and target are the
/// merged ones; in_file_order() gives them as the file has them.
struct PreparedCharacter {
  Character character;      ///< as it came
  BindPose bind;            ///< in the file's world
  Similarity to_world;      ///< from the file's world
  BoneMap map;              ///< none mapped where there is no usable rig
  bool rigged = false;      ///< the map is usable: `weights` and `driver` are filled
  MergedSurface surface;    ///< as it was bound
  RowMatrix weights;        ///< [V, 22] of its own skin, gathered at the joints; without a rig empty
  RestPose pose;            ///< from the bind pose to the T-pose and back
  RowMatrix pose_weights;   ///< [V, 22] that brought the surface to the T-pose: the rig's, or geometric ones;
                            ///< none where it stood so
  Target target;            ///< in T-pose
  std::vector<int> driver;  ///< of each node the joint that moves it, -1: it keeps its place on its parent
  std::vector<std::string> notes;  ///< what was decided, a sentence each
  std::string doubt;  ///< why it may be no person, by size and shape; empty: nothing speaks against it
  /// The target's T-pose with the file's own vertices, in its count and order.
  Mesh target_in_file_order() const;
};

/// any_pose finds the joints of bodies in any pose and heading; in_t_pose, where given, those of
/// the T-pose. Neither is used for a rig that is mapped. Throws Error where no body can be found.
PreparedCharacter prepare_character(Character character, SkeletonExtractor* any_pose,
                                    SkeletonExtractor* in_t_pose, const CharacterOptions& options = {});

/// The first half of it, which uses no network: size, axes, floor and bones are known, `surface` is as
/// the character came, with its colours; a rig faces forward. Throws Error for what is clearly no person.
PreparedCharacter load_character(Character character, const CharacterOptions& options = {});
/// The second half: its T-pose and joints, with the same options.
void find_t_pose(PreparedCharacter& character, SkeletonExtractor* any_pose, SkeletonExtractor* in_t_pose,
                 const CharacterOptions& options = {});

/// Of each node of a rigged character the joint that it moves with.
std::vector<int> joints_of_nodes(const PreparedCharacter& character);

/// Joints of the bind pose, each moved as `rest` moved it in the T-pose.
Joints moved_bind_joints(const RestPose& pose, const Joints& rest);

/// The joints that a rig lacks do not turn on their own: what they would have done is done by the joints
/// after them. Global directions of mapped bones stay.
class FoldingTransfer final : public MotionTransfer {
 public:
  FoldingTransfer(std::shared_ptr<MotionTransfer> inner, const BoneMap& map);
  void reset(const Joints& rest_b) override { inner_->reset(rest_b); }
  Rotations push(const Extraction& source, float dt) override;
  std::any memory() const override { return inner_->memory(); }
  void restore(const std::any& memory) override { inner_->restore(memory); }
  std::string name() const override { return inner_->name(); }

 private:
  std::shared_ptr<MotionTransfer> inner_;
  std::array<bool, kJointCount> mapped_;
};

/// Deforms as the character's own skin does: from its bind pose at once, not via the T-pose. `inner`,
/// which may be null, gives the pose-corrective offsets, where its own weights are like the rig's. Joints
/// that are bound elsewhere than the rig has them move the points that its bones turn about.
class RigDeformer final : public Deformer {
 public:
  RigDeformer(const PreparedCharacter& character, std::shared_ptr<Deformer> inner);
  void bind(const Points& rest, const Joints& rest_joints) override;
  const RowMatrix& weights() const override { return weights_; }
  std::shared_ptr<Deformer> with_weights(RowMatrix weights) const override;
  Points deform(const Pose& pose) const override;
  Points offsets(const Pose& pose) const override;
  std::string name() const override { return "the rig's own skin"; }

 private:
  std::shared_ptr<Deformer> inner_;
  Points bind_vertices_;
  RestPose pose_;
  Joints rest_joints_, bind_joints_;
  RowMatrix weights_;
  Eigen::VectorXf trust_;  // [V] 0..1: the share of the offsets that is taken
};

/// The networks for a character that performs on its own rig: folding, and its own skin.
Networks networks_for(Networks networks, const PreparedCharacter& character, bool their_rig);

}  // namespace understudy
