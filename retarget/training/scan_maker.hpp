// Makes training scans: a random person in a random pose, captured by a simulated rig, with labels.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "retarget/body/joint_sight.hpp"
#include "retarget/body/posed_surface.hpp"
#include "retarget/networks/scan_patches.hpp"
#include "retarget/training/training_data.hpp"

namespace understudy::training {

struct ScanMakerOptions {
  float captured = 0.6f;      ///< share of scans with noise, holes, uneven density, outliers, floor
  float dressed = 0.35f;      ///< share of dressed people
  float mixed = 0.25f;        ///< share with upper and lower body from different poses
  float jittered = 0.5f;      ///< share with every joint turned a little
  float limp = 0;             ///< share with hands, head and feet turned further than in any clip
  float t_pose = 0.06f;       ///< share in (nearly) the T-pose: targets
  float tilted = 0.06f;       ///< share of bodies far from upright
  bool mirror = true;         ///< mirror half of the poses
  float yaw = kPi;            ///< headings, +- radians
  float skirts = 0.06f;       ///< share in a wide skirt or dress, its legs hidden
  float coats = 0.05f;        ///< share with thick sleeves and trunk
  float hair = 0.08f;         ///< share with a bun or much hair
  float holding = 0.08f;      ///< share with a thing in a hand
  float one_sided = 0.1f;     ///< share seen by one camera
  float limbless = 0.04f;     ///< share without a hand, forearm, foot or shin
  float posed_hands = 0.8f;   ///< share whose fingers are posed, where the data has hand poses
  float moving_hands = 0.5f;  ///< of those: whose fingers move from frame to frame
  float shod = 0.35f;         ///< share in other shoes than their own, or none
  float uneven = 0.25f;       ///< share with limbs too thick or thin and patches that bulge or sink
  float welded = 0.15f;       ///< share with armpits, crotch and what else nearly touches closed
  float fused_hands = 0.15f;  ///< share of each hand as a blob, its fingers merged
  float voxels = 0.1f;        ///< share with points on a grid
  float stretch = 0;  ///< people made wider, taller, deeper by up to this share: characters beyond the data

  int longest = 1;  ///< frames that somebody is followed for, at most

  int points = 0;  ///< of a scan before holes, all of them kept; 0: kScanPoints, thinned from more

  // Half bodies, sensors, things about. Depth cameras see the surface itself, not a fused one.
  float cut_below = 0.06f;   ///< share seen down to the chest, the hips or the knees only
  float cut_beside = 0.03f;  ///< share with an arm out of the picture
  float seated = 0.04f;      ///< share that sits, half of them on a chair that is there
  float desks = 0.04f;       ///< share behind a desk; of those seated half
  float sensors = 0.35f;     ///< of captured scans, those of simulated depth cameras
  float ground = 0.1f;       ///< share with pieces of the ground
  float furniture = 0.06f;   ///< share with pieces of furniture
  float balls = 0.02f;       ///< share with a ball about
  float others = 0.05f;      ///< share with pieces of another person

  /// People near the T-pose, facing about +z: targets.
  static ScanMakerOptions rest();
  /// The same people whole and alone: no half bodies, depth cameras or things about.
  ScanMakerOptions whole_and_alone() const;
};

/// A scan of kScanPoints points, or as many as in the options, and its labels, world metres.
struct MadeScan : LabelledPoints {
  PosedSkeleton truth;
  JointSight sight;
};

/// Keeps a pool of shaped bodies that is renewed slowly: shaping costs more than posing the sampled points.
/// One thread each; the same seed gives the same scans.
class ScanMaker {
 public:
  ScanMaker(const TrainingData& data, const ScanMakerOptions& options, uint64_t seed);
  MadeScan next();

  struct Person {
    ShapedBody body;
    SurfaceSampler sampler;
    int left;                             ///< scans until it is replaced
    const HandVertices* hands = nullptr;  ///< of the body; null: not known
  };
  /// What is seen in a stream, and what lies about.
  struct Setting {
    bool captured = false, sensors = false, seated = false;
    bool below = false, beside = false, desk = false, one_sided = false;  ///< what hides some of it
    bool ground = false, furniture = false, chair = false, ball = false, other = false;
    bool is_partial() const { return below || beside || desk || one_sided; }
  };
  /// Somebody who is near by.
  struct Other {
    std::shared_ptr<const Person> person;
    std::vector<Pose> poses;  ///< the last one first; one is kept
    HandMotion hands = {};
    Vec3 shift = Vec3::Zero();
  };
  /// A person over some frames of a clip, with the same clothes, camera and surroundings.
  struct Stream {
    std::shared_ptr<const Person> person;
    std::vector<Pose> poses;  ///< those that are left, the last one first
    uint64_t seed = 0;        ///< of clothes, camera, fused surfaces and surroundings
    Setting setting = {};
    HandMotion hands = {};
    std::shared_ptr<const Shoes> shoes = {};   ///< null: feet as the body has them
    PosedSkeleton first = {};                  ///< in the first frame
    std::optional<PosedSkeleton> before = {};  ///< in the last frame made
    std::optional<Other> other = {};
  };
  /// Of 1 to options.longest frames.
  Stream start();
  /// The next frame of a stream that has one left.
  MadeScan next(Stream& stream);

 private:
  std::shared_ptr<Person> make_person();
  std::shared_ptr<const Person> draw_person();
  std::vector<Pose> clip_poses(int count);
  std::vector<Pose> mixed_poses(int count);
  Rotations draw_turns();
  std::vector<Pose> make_poses(int count, bool seated);
  Setting draw_setting();
  HandMotion draw_hands();
  void draw_shoes(Stream& stream);
  Other draw_other(const PosedSkeleton& first, int frames);
  OrientedPoints sample_posed(const Person& person, PosedSurface& surface, int count);
  int raw_points(const Setting& setting) const;
  MadeScan make_scan(Stream& stream);
  void fuse(OrientedPoints& cloud, PosedSurface& surface, const Stream& stream);
  void put_on(MadeScan& scan, uint64_t seed);
  void surround(MadeScan& scan, Stream& stream);
  void hide(MadeScan& scan, const Stream& stream);
  void stretch(MadeScan& scan);
  void degrade(MadeScan& scan);
  void sense(MadeScan& scan, const Stream& stream);
  void add_clutter(MadeScan& scan, bool with_floor);

  const TrainingData& data_;
  ScanMakerOptions options_;
  Rng rng_;
  std::vector<std::shared_ptr<Person>> people_;
};

}  // namespace understudy::training
