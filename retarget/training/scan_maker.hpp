// Makes training scans: a random person in a random posture, seen by a simulated capture rig, with what is
// true of it.
#pragma once

#include "retarget/body/labelled_points.hpp"
#include "retarget/nn/scan_patches.hpp"
#include "retarget/training/training_data.hpp"

namespace understudy::training {

struct ScanMakerOptions {
  float captured = 0.6f;    ///< share of scans with noise, holes, uneven density, outliers, floor
  float dressed = 0.35f;    ///< share of dressed people
  float mixed = 0.25f;      ///< share with upper and lower body from different postures
  float jittered = 0.5f;    ///< share with every joint turned a little
  float limp = 0;           ///< share with hands, head and feet turned much, as no clip has them
  float t_pose = 0.06f;     ///< share in (nearly) the T-pose: targets
  float tilted = 0.06f;     ///< share of bodies far from upright
  bool mirror = true;       ///< mirror half of the postures
  float yaw = kPi;          ///< headings, +- radians
  float skirts = 0.12f;     ///< share in a wide skirt or dress, its legs hidden
  float coats = 0.06f;      ///< share with thick sleeves and trunk
  float hair = 0.12f;       ///< share with a bun or much hair
  float holding = 0.1f;     ///< share with a thing in a hand
  float one_sided = 0.08f;  ///< share seen by one camera
  float limbless = 0.04f;   ///< share without a hand, forearm, foot or shin
  float stretch = 0;  ///< people made wider, taller, deeper by up to this share: characters beyond the data

  int points = 0;  ///< of a scan before holes, all of them kept; 0: kScanPoints, thinned from more

  /// People near the T-pose, facing about +z: targets.
  static ScanMakerOptions rest();
};

/// One scan of kScanPoints points, or as many as the options say, and its truth, world metres.
struct MadeScan : LabelledPoints {
  PosedSkeleton truth;
};

/// One posture on two people, metres: a scan of the first, and as many places on the second.
struct PosedPair {
  Points source;       ///< [kScanPoints, 3] of the first, in the posture
  Points rest, posed;  ///< [kScanPoints, 3] of the second, in T-pose and in the posture
};

/// Keeps a pool of shaped bodies that is renewed slowly: shaping costs more than posing the sampled points.
/// One thread each; the same seed gives the same scans.
class ScanMaker {
 public:
  ScanMaker(const TrainingData& data, const ScanMakerOptions& options, uint64_t seed);
  MadeScan next();
  /// One person in these poses one after the other, all of them degraded or none.
  std::vector<MadeScan> follow(const std::vector<Pose>& poses);
  PosedPair pair();

 private:
  struct Person {
    ShapedBody body;
    SurfaceSampler sampler;
    int left;  ///< scans until it is replaced
  };
  Person make_person();
  Person& draw_person();
  Pose make_pose();
  Pose turned_pose();
  MadeScan scan_of(const Person& person, const Pose& pose);
  MadeScan sample_posed(const Person& person, const Pose& pose, int count, Points* rest = nullptr);
  void hinder(MadeScan& scan);
  void stretch(MadeScan& scan);
  void degrade(MadeScan& scan);
  void finish(MadeScan& scan, bool captured);
  int raw_points() const;
  void add_clutter(MadeScan& scan, Eigen::Index kept);

  const TrainingData& data_;
  ScanMakerOptions options_;
  Rng rng_;
  std::vector<Person> people_;
};

}  // namespace understudy::training
