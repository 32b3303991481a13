// Who is in a scan: what a method says of its points and people, against the truth.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "retarget/metrics/joint_metrics.hpp"

namespace understudy {

constexpr int kNobodysPoint = -1;  ///< owner of a point of ground, furniture, noise
constexpr int kUndecidedPoint =
    -2;  ///< in truths: between a person and what is behind, as cameras give; anybody's

/// Somebody as a method has them in one frame.
struct PredictedPerson {
  int id = 0;  ///< the same in all frames, not negative
  Joints joints = Joints::Zero();
};
/// What a method says of one frame.
struct PredictedPeople {
  std::vector<int> owners;  ///< [N] of each point of the scan: somebody's id, or kNobodysPoint
  std::vector<PredictedPerson> people;
};

/// Somebody as they are; their place in the list is who they are.
struct TruePerson {
  Joints joints = Joints::Zero();
  SeenJoints seen = SeenJoints::Zero();  ///< 1 where the scan shows a joint, else 0
  bool touches = false;                  ///< somebody else
};
struct TruePeople {
  std::vector<int> owners;  ///< [N] place of a person, kNobodysPoint or kUndecidedPoint
  std::vector<TruePerson> people;
};

/// The one-to-one pairs of rows and columns with the greatest sum, zero and below left out: the column of
/// each row, or -1. At most 12 rows; throws Error beyond.
std::vector<int> best_pairs(const RowMatrix& gain);

/// Collects the frames of one scene. In each frame people are paired with those found so that they have the
/// most points in common, at least 30 % of the person's. Half of somebody's joints must be seen before they
/// count as missed.
class SceneScore {
 public:
  /// Throws Error when the owners are of another number of points.
  void push(const PredictedPeople& found, const TruePeople& truth);
  /// Somebody of a frame that was pushed, scanned alone by the same sensors.
  void push_alone(size_t frame, size_t person, const Joints& joints, const TruePerson& truth);

  /// By key, those that are defined: points_owner_right, the share of points; identities_exchanged, how often
  /// somebody is paired with another id than before; people_missed, share of people and frames;
  /// people_invented, a frame; people_mm and people_touching_mm, the error of seen joints of all that were
  /// found and of those who touch somebody; ..._alone_mm the same people, frames and joints scanned alone,
  /// and ..._over_alone the ratios.
  std::map<std::string, double> figures() const;

 private:
  struct Mean {
    double sum = 0;
    int64_t count = 0;  // joints
    void add(double mean, int64_t of) { sum += mean * static_cast<double>(of), count += of; }
  };
  void pair_up(const PredictedPeople& found, const TruePeople& truth);
  void add_owners(const PredictedPeople& found, const TruePeople& truth);
  void add_people(const PredictedPeople& found, const TruePeople& truth);

  std::vector<int> paired_;               // with each person of this frame: an id, or -1
  std::vector<int> before_;               // the last one that was
  std::vector<std::vector<char>> known_;  // frame, person: in the mean errors
  int64_t frames_ = 0, points_ = 0, points_right_ = 0, there_ = 0, missed_ = 0, invented_ = 0, exchanged_ = 0;
  Mean found_, found_touching_, alone_, alone_touching_;  // metres
};

}  // namespace understudy
