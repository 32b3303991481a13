// Who is who from frame to frame.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "retarget/keypoints/flat_pose.hpp"

namespace understudy {

/// A person seen in a frame.
struct PersonSighting {
  std::optional<int64_t> id;  ///< the file's own number
  float score = 1;
  FlatPose pose;
};

/// Follows people online; the same people give the same answers. The file's ids are believed. Everybody
/// else is matched to where each person should be by now, at constant velocity, all at once at the least
/// cost in lengths of the body (the Hungarian method), and within a reach that grows while a person is out
/// of sight. Who was gone for two seconds is found again when only one such person has the size of the
/// newcomer.
class PeopleTracker {
 public:
  /// Index of each one's person, 0, 1 ... as they appear; no two are the same. dt: seconds since the last
  /// frame.
  std::vector<int> push(const std::vector<PersonSighting>& people, double dt);
  /// False: the file's ids were the same for two in one frame.
  bool believes_ids() const { return believes_ids_; }
  int count() const { return static_cast<int>(numbers_.size()); }
  /// What to call the person: the file's id, else the lowest number from 1 that was free.
  int64_t number(int person) const { return numbers_[static_cast<size_t>(person)]; }

 private:
  struct Path {
    int person = 0;
    FlatPose pose;                             // when last seen
    BodyPoints velocity = BodyPoints::Zero();  // pixels a second; the third column is not used
    float size = 0;                            // pixels, the usual
    double unseen = 0;                         // seconds
    int seen = 0;                              // frames
    bool was_alone = true;                     // in the picture when last seen
    bool has_id = false;                       // the file calls it by a number
  };
  double cost(const Path& path, const PersonSighting& person) const;
  std::optional<size_t> returned(const PersonSighting& person, const std::vector<char>& taken,
                                 bool alone) const;
  void match(const std::vector<PersonSighting>& people, std::vector<int>& path_of,
             std::vector<char>& taken) const;
  size_t add_path(std::optional<int64_t> id);
  int add_person(std::optional<int64_t> id);
  void check_ids(const std::vector<PersonSighting>& people);
  void see(Path& path, const PersonSighting& person, bool alone);
  void forget();

  std::vector<Path> paths_;
  std::vector<int64_t> numbers_;
  std::map<int64_t, int> person_of_id_;
  std::set<int64_t> taken_numbers_;
  int64_t next_number_ = 1;
  bool believes_ids_ = true;
};

}  // namespace understudy
