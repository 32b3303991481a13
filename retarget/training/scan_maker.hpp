// Makes training scans: a random person in a random pose, captured by a simulated rig, with labels.
#pragma once

#include <memory>
#include <vector>

#include "retarget/body/labelled_points.hpp"
#include "retarget/networks/scan_patches.hpp"
#include "retarget/training/training_data.hpp"

namespace understudy::training {

struct ScanMakerOptions {
  float captured = 0.6f;   ///< share of scans with noise, holes, uneven density, outliers, floor
  float dressed = 0.35f;   ///< share of dressed people
  float mixed = 0.25f;     ///< share with upper and lower body from different poses
  float jittered = 0.5f;   ///< share with every joint turned a little
  float limp = 0;          ///< share with hands, head and feet turned further than in any clip
  float t_pose = 0.06f;    ///< share in (nearly) the T-pose: targets
  float tilted = 0.06f;    ///< share of bodies far from upright
  bool mirror = true;      ///< mirror half of the poses
  float yaw = kPi;         ///< headings, +- radians
  float skirts = 0.06f;    ///< share in a wide skirt or dress, its legs hidden
  float coats = 0.05f;     ///< share with thick sleeves and trunk
  float hair = 0.08f;      ///< share with a bun or much hair
  float holding = 0.08f;   ///< share with a thing in a hand
  float one_sided = 0.1f;  ///< share seen by one camera
  float limbless = 0.04f;  ///< share without a hand, forearm, foot or shin
  float stretch = 0;  ///< people made wider, taller, deeper by up to this share: characters beyond the data

  int longest = 1;  ///< frames that somebody is followed for, at most

  int points = 0;  ///< of a scan before holes, all of them kept; 0: kScanPoints, thinned from more

  /// People near the T-pose, facing about +z: targets.
  static ScanMakerOptions rest();
};

/// A scan of kScanPoints points, or as many as in the options, and its labels, world metres.
struct MadeScan : LabelledPoints {
  PosedSkeleton truth;
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
    int left;  ///< scans until it is replaced
  };
  /// A person over some frames of a clip, with the same clothes and camera.
  struct Stream {
    std::shared_ptr<const Person> person;
    std::vector<Pose> poses;  ///< those that are left, the last one first
    uint64_t seed = 0;        ///< of clothes and camera
    bool captured = false;
  };
  /// Of 1 to options.longest frames.
  Stream start();
  /// The next frame of a stream that has one left.
  MadeScan next(Stream& stream);

 private:
  std::shared_ptr<Person> make_person();
  std::shared_ptr<const Person> draw_person();
  std::vector<Pose> clip_poses(int count);
  std::vector<Pose> make_poses(int count);
  MadeScan sample_posed(const Person& person, const Pose& pose);
  void occlude(MadeScan& scan, uint64_t seed);
  void stretch(MadeScan& scan);
  void degrade(MadeScan& scan);
  void add_clutter(MadeScan& scan, Eigen::Index kept);

  const TrainingData& data_;
  ScanMakerOptions options_;
  Rng rng_;
  std::vector<std::shared_ptr<Person>> people_;
};

}  // namespace understudy::training
