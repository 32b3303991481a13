#include "tests/retarget/character/rigs.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <vector>

#include "retarget/base/rng.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "retarget/skeleton/skinning.hpp"

namespace understudy::tests {
namespace {

/// The words of a convention, @ for the side, # for a number from 1; "" where it has no such bone.
struct Vocabulary {
  const char* name;
  const char *left, *right;
  const char *root, *pelvis, *spine, *chest, *neck, *head;
  const char *collar, *shoulder, *elbow, *wrist;
  const char *hip, *knee, *ankle, *toe;
  const char *upper_twist, *lower_twist, *thigh_twist, *calf_twist;
  const char* finger;  // # is the finger, % the bone of it
};

// clang-format off
constexpr std::array<Vocabulary, kConventions> kVocabularies = {{
    {"Mixamo", "Left", "Right", "Armature", "mixamorig:Hips", "mixamorig:Spine#", "", "mixamorig:Neck",
     "mixamorig:Head",
     "mixamorig:@Shoulder", "mixamorig:@Arm", "mixamorig:@ForeArm", "mixamorig:@Hand",
     "mixamorig:@UpLeg", "mixamorig:@Leg", "mixamorig:@Foot", "mixamorig:@ToeBase",
     "mixamorig:@ArmRoll", "mixamorig:@ForeArmRoll", "mixamorig:@UpLegRoll", "mixamorig:@LegRoll",
     "mixamorig:@HandIndex#%"},
    {"Biped", "L", "R", "Bip01", "Bip01 Pelvis", "Bip01 Spine#", "", "Bip01 Neck", "Bip01 Head",
     "Bip01 @ Clavicle", "Bip01 @ UpperArm", "Bip01 @ Forearm", "Bip01 @ Hand",
     "Bip01 @ Thigh", "Bip01 @ Calf", "Bip01 @ Foot", "Bip01 @ Toe0",
     "Bip01 @UpArmTwist", "Bip01 @ForeTwist", "Bip01 @ThighTwist", "Bip01 @CalfTwist", "Bip01 @ Finger#%"},
    {"CAT", "L", "R", "CATRigRoot", "CATRigPelvis", "CATRigSpine#", "CATRigRibcage", "CATRigNeck",
     "CATRigHead",
     "CATRig@ArmCollarbone", "CATRig@Arm1", "CATRig@Arm2", "CATRig@ArmPalm",
     "CATRig@Leg1", "CATRig@Leg2", "CATRig@LegAnkle", "CATRig@LegToe",
     "CATRig@ArmTwist1", "CATRig@ArmTwist2", "CATRig@LegTwist1", "CATRig@LegTwist2", "CATRig@ArmDigit#%"},
    {"Unreal", "l", "r", "root", "pelvis", "spine_0#", "", "neck_01", "head",
     "clavicle_@", "upperarm_@", "lowerarm_@", "hand_@",
     "thigh_@", "calf_@", "foot_@", "ball_@",
     "upperarm_twist_01_@", "lowerarm_twist_01_@", "thigh_twist_01_@", "calf_twist_01_@", "index_#%_@"},
    {"Rigify", "L", "R", "root", "DEF-spine", "DEF-spine.00#", "", "DEF-spine.008", "DEF-spine.010",
     "DEF-shoulder.@", "DEF-upper_arm.@", "DEF-forearm.@", "DEF-hand.@",
     "DEF-thigh.@", "DEF-shin.@", "DEF-foot.@", "DEF-toe.@",
     "DEF-upper_arm.@.001", "DEF-forearm.@.001", "DEF-thigh.@.001", "DEF-shin.@.001", "DEF-f_index.0#.%.@"},
    {"HumanIK", "Left", "Right", "Character1_Reference", "Character1_Hips", "Character1_Spine#", "",
     "Character1_Neck", "Character1_Head",
     "Character1_@Shoulder", "Character1_@Arm", "Character1_@ForeArm", "Character1_@Hand",
     "Character1_@UpLeg", "Character1_@Leg", "Character1_@Foot", "Character1_@ToeBase",
     "Character1_@ArmRoll", "Character1_@ForeArmRoll", "Character1_@UpLegRoll", "Character1_@LegRoll",
     "Character1_@HandRing#%"},
    {"DAZ", "l", "r", "Genesis8Female", "pelvis", "abdomen#", "chestUpper", "neckLower", "head",
     "@Collar", "@ShldrBend", "@ForearmBend", "@Hand",
     "@ThighBend", "@Shin", "@Foot", "@Toe",
     "@ShldrTwist", "@ForearmTwist", "@ThighTwist", "@ShinTwist", "@Carpal#%"},
    {"MakeHuman", "L", "R", "root", "hips", "spine0#", "", "neck01", "head",
     "clavicle.@", "upperarm01.@", "lowerarm01.@", "wrist.@",
     "upperleg01.@", "lowerleg01.@", "foot.@", "toe1-1.@",
     "upperarm02.@", "lowerarm02.@", "upperleg02.@", "lowerleg02.@", "finger#-%.@"},
    {"VRM", "L", "R", "Root", "J_Bip_C_Hips", "J_Bip_C_Spine#", "J_Bip_C_UpperChest", "J_Bip_C_Neck",
     "J_Bip_C_Head",
     "J_Bip_@_Shoulder", "J_Bip_@_UpperArm", "J_Bip_@_LowerArm", "J_Bip_@_Hand",
     "J_Bip_@_UpperLeg", "J_Bip_@_LowerLeg", "J_Bip_@_Foot", "J_Bip_@_ToeBase",
     "J_Sec_@_UpperArmTwist", "J_Sec_@_LowerArmTwist", "J_Sec_@_UpperLegTwist", "J_Sec_@_LowerLegTwist",
     "J_Bip_@_Middle#%"},
    {"MMD", "左", "右", "全ての親", "下半身", "上半身#", "", "首", "頭",
     "@肩", "@腕", "@ひじ", "@手首",
     "@足", "@ひざ", "@足首", "@つま先",
     "@腕捩", "@手捩", "@足捩", "@ひざ捩", "@人指#%"},
    {"MMD English", "L", "R", "ParentNode", "lower body", "upper body#", "", "neck", "head",
     "shoulder_@", "arm_@", "elbow_@", "wrist_@",
     "leg_@", "knee_@", "ankle_@", "toe_@",
     "arm twist_@", "wrist twist_@", "leg twist_@", "knee twist_@", "fore#_%_@"},
    {"Blender", "L", "R", "Bone", "Hips", "Spine.00#", "Chest", "Neck", "Head",
     "Shoulder.@", "UpperArm.@", "LowerArm.@", "Hand.@",
     "UpperLeg.@", "LowerLeg.@", "Foot.@", "Toes.@",
     "UpperArmTwist.@", "LowerArmTwist.@", "UpperLegTwist.@", "LowerLegTwist.@", "Finger#.00%.@"},
    {"joints", "L", "R", "Hero_root", "Hero_pelvis", "Hero_spine0#", "", "Hero_neck", "Hero_head",
     "Hero_@_clavicle", "Hero_@_shoulder", "Hero_@_elbow", "Hero_@_wrist",
     "Hero_@_hip", "Hero_@_knee_01", "Hero_@_ankle", "Hero_@_toeBall",
     "Hero_@_bicep", "Hero_@_forearm", "Hero_@_thigh", "Hero_@_knee_02", "Hero_@_index#_%"},
    {"Source", "L", "R", "ValveBiped", "ValveBiped.Bip01_Pelvis", "ValveBiped.Bip01_Spine#", "",
     "ValveBiped.Bip01_Neck1", "ValveBiped.Bip01_Head1",
     "ValveBiped.Bip01_@_Clavicle", "ValveBiped.Bip01_@_UpperArm", "ValveBiped.Bip01_@_Forearm",
     "ValveBiped.Bip01_@_Hand",
     "ValveBiped.Bip01_@_Thigh", "ValveBiped.Bip01_@_Calf", "ValveBiped.Bip01_@_Foot",
     "ValveBiped.Bip01_@_Toe0",
     "ValveBiped.Bip01_@_Bicep", "ValveBiped.Bip01_@_Ulna", "ValveBiped.Bip01_@_Quad_Twist",
     "ValveBiped.Bip01_@_Shin_Twist", "ValveBiped.Bip01_@_Finger#%"},
    {"Auto-Rig", "l", "r", "c_traj", "root.x", "spine_0#.x", "", "neck.x", "head.x",
     "shoulder.@", "arm_stretch.@", "forearm_stretch.@", "hand.@",
     "thigh_stretch.@", "leg_stretch.@", "foot.@", "toes_01.@",
     "arm_twist.@", "forearm_twist.@", "thigh_twist.@", "leg_twist.@", "c_index#_%.@"},
    {"Maya", "L", "R", "DeformationSystem", "Root_M", "Spine#_M", "Chest_M", "Neck_M", "Head_M",
     "Scapula_@", "Shoulder_@", "Elbow_@", "Wrist_@",
     "Hip_@", "Knee_@", "Ankle_@", "Toes_@",
     "ShoulderPart1_@", "ElbowPart1_@", "HipPart1_@", "KneePart1_@", "IndexFinger#%_@"},
    {"glued", "l", "r", "root", "hips", "lowerback#", "thorax", "neck", "head",
     "@clavicle", "@humerus", "@radius", "@wrist",
     "@femur", "@tibia", "@foot", "@toes",
     "@humerustwist", "@radiustwist", "@femurtwist", "@tibiatwist", "@fingers#%"},
    {"plain", "left", "right", "body_rig", "rig_hero_hip", "rig_hero_back#", "", "rig_hero_neck",
     "rig_hero_head",
     "rig_hero_@_collar_bone", "rig_hero_arm_upper_@", "rig_hero_arm_lower_@", "rig_hero_hand_@",
     "rig_hero_leg_upper_@", "rig_hero_leg_lower_@", "rig_hero_foot_@", "rig_hero_toe_@",
     "rig_hero_arm_upper_twist_@", "rig_hero_arm_lower_twist_@", "rig_hero_leg_upper_twist_@",
     "rig_hero_leg_lower_twist_@", "rig_hero_finger#_%_@"},
    {"SMPL", "left", "right", "root", "pelvis", "spine#", "", "neck", "head",
     "@_collar", "@_shoulder", "@_elbow", "@_wrist",
     "@_hip", "@_knee", "@_ankle", "@_foot",
     "@_shoulder_twist", "@_elbow_twist", "@_hip_twist", "@_knee_twist", "@_index#%"},
    {"numbers", "", "", "bone_00", "bone_0", "bone_1#", "", "bone_2", "bone_3",
     "bone_4@", "bone_5@", "bone_6@", "bone_7@",
     "bone_8@", "bone_9@", "bone_10@", "bone_11@",
     "bone_12@", "bone_13@", "bone_14@", "bone_15@", "bone_16#%@"},
    {"unnamed", "", "", "", "", "", "", "", "", "", "", "", "", "", "", "", "", "", "", "", "", ""},
}};
// clang-format on

/// A bone of the rig, and the tube that it moves.
struct Piece {
  std::string name;
  int parent = -1;
  Vec3 at = Vec3::Zero(), to = Vec3::Zero();
  float radius = 0;  // 0: it moves nothing
  int rings = 5;
};

class RigMaker {
 public:
  RigMaker(Convention convention, unsigned seed)
      : convention_(convention),
        words_(kVocabularies[static_cast<size_t>(convention)]),
        rng_(seed * 977 + static_cast<unsigned>(convention) * 7919 + 13) {
    truth_.fill(-1);
  }
  MadeRig make();

 private:
  bool chance(float share) { return rng_.uniform() < share; }
  float between(float low, float high) { return low + (high - low) * rng_.uniform(); }
  Vec3 at(int joint) const { return joints_.row(joint).transpose(); }
  std::string worded(const char* pattern, int right = -1, int number = 0, int second = 0) const;
  int add(const std::string& name, int parent, const Vec3& from, const Vec3& to, float radius, int rings = 5);
  /// A bone of the body, which is the truth for this joint.
  int add_joint(int joint, const std::string& name, int parent, const Vec3& to, float radius) {
    return truth_[static_cast<size_t>(joint)] = add(name, parent, at(joint), to, radius);
  }
  bool exists(const char* word) const { return word[0] != '\0' || convention_ == Convention::Unnamed; }
  void pose_joints();
  void add_trunk();
  std::vector<Vec3> spine_places(int count) const;
  void add_head();
  void add_leg(int right);
  void add_arm(int right);
  void add_fingers(int wrist, int right, const Vec3& along);
  int add_twist(const char* word, int right, int parent, int from, int to);
  void add_chain(const std::string& name, int parent, const Vec3& from, const Vec3& step, int count,
                 int rings = 2);
  void add_extras();
  void add_skirt();
  void place_and_scale();
  Character character() const;

  Convention convention_;
  const Vocabulary& words_;
  Rng rng_;
  Joints joints_;
  std::vector<Piece> pieces_;
  std::array<int, kJointCount> truth_;
  std::string description_;
  bool hip_links_ = false, palms_ = false, one_hand_ = false;
  bool collars_ = true, bare_collars_ = false, toes_ = true, fingers_ = true, twists_ = false,
       twists_between_ = false;
  bool swapped_arms_ = false, swapped_legs_ = false, limb_is_arm_ = false;
  bool thighs_on_spine_ = false, collars_on_neck_ = false;
  int root_ = -1, pelvis_ = -1, on_ = -1, chest_ = -1, neck_ = -1, head_ = -1;
  Mat3 turn_ = Mat3::Identity();
  float scale_ = 1;
};

std::string RigMaker::worded(const char* pattern, int right, int number, int second) const {
  if (convention_ == Convention::Unnamed) return "";
  const bool swapped = limb_is_arm_ ? swapped_arms_ : swapped_legs_;
  const bool called_right = (right > 0) != (swapped && right >= 0);
  std::string out;
  for (const char* c = pattern; *c != '\0'; ++c) {
    if (*c == '@' && convention_ == Convention::Numbers)
      out += std::to_string(right + 1);
    else if (*c == '@')
      out += called_right ? words_.right : words_.left;
    else if (*c == '#')
      out += number > 0 ? std::to_string(number) : "";
    else if (*c == '%')
      out += std::to_string(second);
    else
      out += *c;
  }
  return out;
}

int RigMaker::add(const std::string& name, int parent, const Vec3& from, const Vec3& to, float radius,
                  int rings) {
  pieces_.push_back({name, parent, from, to, radius, rings});
  return static_cast<int>(pieces_.size()) - 1;
}

/// Proportions of children, adults and cartoons; arms between T and A, legs a little apart.
void RigMaker::pose_joints() {
  Joints joints = 0.85f * human_rest();
  const float legs = between(0.5f, 1.2f), arms = between(0.65f, 1.25f), broad = between(0.9f, 1.2f);
  Joints out = joints;
  for (int j = 1; j < kJointCount; ++j) {
    Vec3 step = (joints.row(j) - joints.row(kParents[static_cast<size_t>(j)])).transpose();
    if (j == LeftKnee || j == RightKnee || j == LeftAnkle || j == RightAnkle) step *= legs;
    if (j >= LeftElbow) step *= arms;
    if (j == LeftShoulder || j == RightShoulder) step *= broad;
    out.row(j) = out.row(kParents[static_cast<size_t>(j)]) + step.transpose();
  }
  Pose pose;
  const float down = between(0, 80) * kPi / 180, apart = between(0, 8) * kPi / 180;
  pose.local[LeftShoulder] = Eigen::AngleAxisf(-down, Vec3::UnitZ()).toRotationMatrix();
  pose.local[RightShoulder] = Eigen::AngleAxisf(down, Vec3::UnitZ()).toRotationMatrix();
  pose.local[LeftHip] = Eigen::AngleAxisf(apart, Vec3::UnitZ()).toRotationMatrix();
  pose.local[RightHip] = Eigen::AngleAxisf(-apart, Vec3::UnitZ()).toRotationMatrix();
  joints_ = forward_kinematics(out, pose).joints;
  joints_.col(1).array() -= joints_.col(1).minCoeff() - 0.02f;
  for (int j = 0; j < kJointCount; ++j)
    for (int axis = 0; axis < 3; ++axis) joints_(j, axis) += between(-0.002f, 0.002f);
}

std::vector<Vec3> RigMaker::spine_places(int count) const {
  std::vector<Vec3> out;
  for (int i = 0; i < count; ++i) {
    const float t = count == 1 ? 0.5f : static_cast<float>(i + 1) / static_cast<float>(count + 1) + 0.1f;
    out.push_back(at(Pelvis) + t * (at(Spine3) + Vec3(0, 0.05f, 0) - at(Pelvis)));
  }
  return out;
}

void RigMaker::add_trunk() {
  if (chance(0.5f) || convention_ == Convention::Biped) {
    const bool floor = chance(0.5f) && convention_ != Convention::Biped;
    root_ = add(worded(words_.root), -1, floor ? Vec3::Zero() : at(Pelvis), Vec3::Zero(), 0);
  }
  const bool beside = convention_ == Convention::Mmd || convention_ == Convention::MmdEnglish ||
                      convention_ == Convention::Daz;
  int base = root_;
  if (beside)
    base = add(convention_ == Convention::Mmd   ? "センター"
               : convention_ == Convention::Daz ? "hip"
                                                : "center",
               root_, at(Pelvis) + Vec3(0, 0.02f, 0), Vec3::Zero(), 0);
  const std::vector<Vec3> places = spine_places(1 + static_cast<int>(rng_.uniform() * 5.99f));
  const auto count = static_cast<int>(places.size());
  pelvis_ = add_joint(Pelvis, worded(words_.pelvis), base, places[0], 0.13f);
  on_ = beside ? base : pelvis_;
  int below = on_;
  std::vector<int> spine;
  for (int i = 0; i < count; ++i) {
    const bool is_chest =
        i + 1 == count && exists(words_.chest) && convention_ != Convention::Unnamed && count > 1;
    const int first = convention_ == Convention::Unreal || convention_ == Convention::Rigify ||
                              convention_ == Convention::MakeHuman || convention_ == Convention::Joints ||
                              convention_ == Convention::AutoRig || convention_ == Convention::Smpl
                          ? 1
                          : 0;
    const Vec3 to = i + 1 < count ? places[static_cast<size_t>(i) + 1] : at(Neck);
    below = add(is_chest ? worded(words_.chest) : worded(words_.spine, -1, i + first), below,
                places[static_cast<size_t>(i)], to, 0.13f);
    spine.push_back(below);
  }
  chest_ = below;
  truth_[Spine3] = spine.back();
  if (count > 1) truth_[Spine1] = spine.front();
  if (count > 2) truth_[Spine2] = spine[static_cast<size_t>(count - 1) / 2];
  thighs_on_spine_ = convention_ == Convention::Biped && chance(0.4f) && count > 1;
  if (thighs_on_spine_) on_ = spine.front();
  if (!beside && !thighs_on_spine_) on_ = pelvis_;
  if (beside) on_ = pelvis_;
  description_ += " spine " + std::to_string(count) + (thighs_on_spine_ ? " thighs on spine" : "");
}

void RigMaker::add_chain(const std::string& name, int parent, const Vec3& from, const Vec3& step, int count,
                         int rings) {
  for (int i = 0; i < count; ++i) {
    const Vec3 here = from + static_cast<float>(i) * step;
    const std::string called = convention_ == Convention::Unnamed ? ""
                               : convention_ == Convention::Numbers
                                   ? "bone_7" + std::to_string(pieces_.size())
                                   : name + std::to_string(i + 1);
    parent = add(called, parent, here, here + step, 0.02f, rings);
  }
}

void RigMaker::add_head() {
  const bool has_neck = convention_ == Convention::Biped || chance(0.85f);
  int below = chest_;
  if (has_neck) below = neck_ = add_joint(Neck, worded(words_.neck), chest_, at(Head), 0.05f);
  if (has_neck && chance(0.2f)) {  // a second one
    pieces_.back().to = 0.5f * (at(Neck) + at(Head));
    below = add(worded(words_.neck) + (convention_ == Convention::Unnamed ? "" : "2"), neck_,
                pieces_.back().to, at(Head), 0.05f);
    description_ += " two necks";
  }
  head_ = add_joint(Head, worded(words_.head), below, at(Head) + Vec3(0, 0.2f, 0), 0.1f);
  pieces_.back().rings = 12;
  description_ += has_neck ? "" : " no neck";
  if (chance(0.3f))
    add_chain("Head_End", head_, at(Head) + Vec3(0, 0.22f, 0), Vec3::Zero(), 1), pieces_.back().radius = 0;
  const int rings = chance(0.3f) ? 10 : 2;
  int on = head_;  // some hang the face on a bone of its own
  if (chance(0.25f)) {
    add_chain("Face", head_, at(Head) + Vec3(0, 0.05f, 0.05f), {0, 0, 0.02f}, 1);
    on = static_cast<int>(pieces_.size()) - 1;
  }
  const Vec3 face = at(Head) + Vec3(0, 0.08f, 0.09f), top = at(Head) + Vec3(0, 0.2f, -0.05f);
  for (const int right : {0, 1}) {
    const float side = right > 0 ? -1 : 1;
    const std::string word = right > 0 ? "R" : "L";
    if (chance(0.4f))
      add_chain("Brow_" + word + "_", on, face + Vec3(side * 0.03f, 0.02f, 0), {side * 0.01f, 0, 0}, 2);
    if (chance(0.5f)) add_chain("Eye_" + word, on, face + Vec3(side * 0.03f, 0, 0), {0, 0, 0.01f}, 1);
  }
  if (chance(0.25f)) {  // the face has the skin of the head
    description_ += " face";
    pieces_[static_cast<size_t>(head_)].rings = 3;
    for (int i = 0; i < 12; ++i)
      for (const float side : {0.02f, -0.02f})
        add_chain(
            "Face" + std::string(side > 0 ? "_L_" : "_R_") + std::to_string(i) + "_", on,
            face + Vec3(side * static_cast<float>(1 + i % 3), 0.03f * static_cast<float>(i / 3) - 0.06f, 0),
            {0, 0, 0.005f}, 1);
  }
  if (chance(0.4f)) add_chain("Jaw", on, face - Vec3(0, 0.07f, 0.02f), {0, -0.01f, 0.03f}, 1);
  if (chance(0.4f))
    for (const float side : {1.0f, -1.0f})
      add_chain(side > 0 ? "HairRibbon_L" : "HairRibbon_R", head_, top + Vec3(side * 0.06f, 0, 0),
                {side * 0.03f, -0.07f, -0.01f}, 3 + static_cast<int>(rng_.uniform() * 5));
  if (chance(0.4f))
    add_chain("Ponytail", head_, top, {0, between(-0.12f, -0.04f), -0.03f},
              3 + static_cast<int>(rng_.uniform() * 5), rings);
  if (chance(0.3f)) add_chain("Hat", head_, top + Vec3(0, 0.03f, 0.05f), {0, 0.05f, 0}, 2);
  collars_on_neck_ = convention_ == Convention::Biped;
}

int RigMaker::add_twist(const char* word, int right, int parent, int from, int to) {
  if (!twists_ || !exists(word)) return parent;
  const Vec3 middle = 0.5f * (at(from) + at(to));
  // The upper half stays with the joint's own bone.
  pieces_[static_cast<size_t>(parent)].to = middle;
  const int twist =
      add(worded(word, right), parent, middle, at(to), pieces_[static_cast<size_t>(parent)].radius);
  return twists_between_ ? twist : parent;
}

void RigMaker::add_leg(int right) {
  limb_is_arm_ = false;
  const int hip = LeftHip + right, knee = LeftKnee + right, ankle = LeftAnkle + right,
            foot = LeftFoot + right;
  int below = on_;
  if (hip_links_)
    below = add(worded("Link@Thing", right), on_, 0.6f * at(Pelvis) + 0.4f * at(hip), at(hip), 0.06f, 2);
  below = add_joint(hip, worded(words_.hip, right), below, at(knee), 0.08f);
  below = add_twist(words_.thigh_twist, right, below, hip, knee);
  below = add_joint(knee, worded(words_.knee, right), below, at(ankle), 0.06f);
  below = add_twist(words_.calf_twist, right, below, knee, ankle);
  const Vec3 tip = at(foot) + Vec3(0, 0, 0.08f);
  below = add_joint(ankle, worded(words_.ankle, right), below, toes_ ? at(foot) : tip, 0.05f);
  if (toes_) add_joint(foot, worded(words_.toe, right), below, tip, 0.04f);
}

void RigMaker::add_fingers(int wrist, int right, const Vec3& along) {
  const int count = 3 + static_cast<int>(rng_.uniform() * 2.99f);
  for (int f = 0; f < count; ++f) {
    const Vec3 root = pieces_[static_cast<size_t>(wrist)].at + 0.08f * along +
                      Vec3(0, 0, 0.02f * static_cast<float>(2 - f));
    int below = wrist;
    if (palms_)
      below = add(worded(words_.finger, right, f + 1, 0), wrist, root - 0.05f * along, root, 0.01f, 2);
    for (int k = 0; k < 3; ++k) {
      const Vec3 from = root + 0.03f * static_cast<float>(k) * along;
      below = add(worded(words_.finger, right, f + 1, k + 1), below, from, from + 0.03f * along, 0.01f, 2);
    }
  }
}

void RigMaker::add_arm(int right) {
  limb_is_arm_ = true;
  const int collar = LeftCollar + right, shoulder = LeftShoulder + right, elbow = LeftElbow + right,
            wrist = LeftWrist + right;
  int below = collars_on_neck_ ? neck_ : chest_;
  if (collars_)
    below = add_joint(collar, worded(words_.collar, right), below, at(shoulder), bare_collars_ ? 0 : 0.06f);
  below = add_joint(shoulder, worded(words_.shoulder, right), below, at(elbow), 0.05f);
  below = add_twist(words_.upper_twist, right, below, shoulder, elbow);
  below = add_joint(elbow, worded(words_.elbow, right), below, at(wrist), 0.04f);
  below = add_twist(words_.lower_twist, right, below, elbow, wrist);
  const Vec3 along = (at(wrist) - at(elbow)).normalized();
  below = add_joint(wrist, worded(words_.wrist, right), below, at(wrist) + (fingers_ ? 0.09f : 0.17f) * along,
                    0.03f);
  if (fingers_ && (right == 0 || !one_hand_)) add_fingers(below, right, along);
  if (right > 0 && chance(0.2f)) add_chain("weapon", below, at(wrist) + 0.08f * along, {0, 0, 0.1f}, 2);
}

void RigMaker::add_skirt() {
  constexpr int kStrips = 8;
  const float length = between(0.06f, 0.26f);
  for (int s = 0; s < kStrips; ++s) {
    const float a = 2 * kPi * (static_cast<float>(s) + 0.5f) / kStrips;
    const Vec3 out(std::sin(a), 0, std::cos(a));
    add_chain("skirt_" + std::to_string(s) + "_", pelvis_, at(Pelvis) + 0.14f * out,
              0.04f * out - Vec3(0, length, 0), 3);
  }
}

void RigMaker::add_extras() {
  if (chance(0.3f)) add_chain("tail", pelvis_, at(Pelvis) - Vec3(0, 0, 0.1f), {0, -0.02f, -0.1f}, 6);
  if (chance(0.3f)) add_skirt();
  const float wing = between(0.1f, 0.3f);
  if (chance(0.25f))
    for (const float side : {1.0f, -1.0f})
      add_chain(side > 0 ? "Wing_L_" : "Wing_R_", chest_, at(Spine3) + Vec3(side * 0.06f, 0.05f, -0.12f),
                {side * wing, 0.5f * wing, -0.1f}, 4);
  if (chance(0.2f))
    for (const float side : {1.0f, -1.0f})
      add_chain(side > 0 ? "Breast_L" : "Breast_R", chest_, at(Spine3) + Vec3(side * 0.08f, 0, 0.1f),
                {0, 0, 0.05f}, 1);
  const bool named = convention_ != Convention::Unnamed && convention_ != Convention::Numbers;
  if (named && chance(0.3f))
    for (const int right : {0, 1}) {
      const std::string word = right > 0 ? "_R" : "_L";
      add("foot_ik" + word, root_, at(LeftAnkle + right), Vec3::Zero(), 0);
      add("knee_pole" + word, root_, at(LeftKnee + right) + Vec3(0, 0, 0.5f), Vec3::Zero(), 0);
    }
}

void RigMaker::place_and_scale() {
  scale_ = 0.1f / 1.7f * std::pow(5000.0f, rng_.uniform());
  const bool z_up = chance(0.4f);
  const float heading = std::floor(between(0, 3.99f)) * kPi / 2;
  turn_ = rotation_about_y(chance(0.5f) ? heading : 0);
  if (z_up) turn_ = Eigen::AngleAxisf(kPi / 2, Vec3::UnitX()).toRotationMatrix() * turn_;
  description_ += z_up ? " z up" : " y up";
}

Character RigMaker::character() const {
  constexpr int kAround = 6;
  Character out;
  out.name = words_.name;
  CharacterSkin skin;
  std::vector<Mat4> bind;
  std::vector<Vec3> vertices;
  std::vector<int> owner;
  for (size_t i = 0; i < pieces_.size(); ++i) {
    const Piece& piece = pieces_[i];
    const Mat3 axes = rotation_between(Vec3::UnitY(), Vec3(piece.to - piece.at + Vec3(0, 1e-4f, 0)));
    bind.push_back(affine(turn_ * axes, scale_ * (turn_ * piece.at)));
    CharacterNode node;
    node.name = piece.name;
    node.parent = piece.parent;
    node.local = Transform::from(
        piece.parent < 0 ? bind[i] : Mat4(bind[static_cast<size_t>(piece.parent)].inverse() * bind[i]));
    out.nodes.push_back(node);
    skin.joints.push_back(static_cast<int>(i));
    skin.inverse_bind.push_back(bind[i].inverse());
    for (int ring = 0; piece.radius > 0 && ring < piece.rings; ++ring)
      for (int side = 0; side < kAround; ++side) {
        const float t = (static_cast<float>(ring) + 0.5f) / static_cast<float>(piece.rings),
                    a = 2 * kPi * static_cast<float>(side) / kAround;
        const Vec3 around = axes * Vec3(std::cos(a), 0, std::sin(a));
        vertices.push_back(scale_ * (turn_ * (piece.at + t * (piece.to - piece.at) + piece.radius * around)));
        owner.push_back(static_cast<int>(i));
      }
  }
  CharacterPart part;
  const auto count = static_cast<Eigen::Index>(vertices.size());
  part.vertices.resize(count, 3);
  part.joints.setZero(count, 4);
  part.weights.setZero(count, 4);
  for (Eigen::Index v = 0; v < count; ++v) {
    part.vertices.row(v) = vertices[static_cast<size_t>(v)].transpose();
    part.joints(v, 0) = owner[static_cast<size_t>(v)];
    part.weights(v, 0) = 1;
  }
  part.skin = 0;
  part.node = static_cast<int>(out.nodes.size());
  out.nodes.emplace_back().name = "mesh";
  out.skins.push_back(std::move(skin));
  out.parts.push_back(std::move(part));
  return out;
}

MadeRig RigMaker::make() {
  description_ = words_.name;
  pose_joints();
  collars_ = chance(0.75f);
  bare_collars_ = chance(0.2f);  // they move nothing
  hip_links_ = chance(0.1f);
  palms_ = chance(0.3f);     // bones of the palm before the fingers
  one_hand_ = chance(0.1f);  // the other holds something
  toes_ = chance(0.7f);
  fingers_ = chance(0.6f);
  twists_ = chance(0.5f);
  twists_between_ = chance(0.5f);
  if (chance(0.15f)) swapped_arms_ = swapped_legs_ = true;
  if (chance(0.1f)) swapped_arms_ = true;
  add_trunk();
  add_head();
  const bool arms_first = chance(0.5f);
  for (const bool arm : {arms_first, !arms_first})
    for (const int right : {0, 1}) arm ? add_arm(right) : add_leg(right);
  add_extras();
  place_and_scale();
  for (const auto& [flag, text] : std::initializer_list<std::pair<bool, const char*>>{
           {collars_, bare_collars_ ? "bare collars" : "collars"},
           {toes_, "toes"},
           {fingers_, "fingers"},
           {hip_links_, "hip links"},
           {palms_, "palms"},
           {one_hand_, "one hand"},
           {twists_, twists_between_ ? "twists between" : "twists"},
           {swapped_arms_, "arms' sides swapped"},
           {swapped_legs_, "legs' sides swapped"}})
    if (flag) description_ += std::string(", ") + text;
  return {character(), truth_, description_};
}

}  // namespace

const char* convention_name(Convention convention) {
  return kVocabularies[static_cast<size_t>(convention)].name;
}

MadeRig make_rig(Convention convention, unsigned seed) {
  return RigMaker(convention, seed).make();
}

}  // namespace understudy::tests
