#include "retarget/keypoints/people_tracker.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/math/cheapest_pairs.hpp"

namespace understudy {
namespace {

constexpr double kGone = 2;         // seconds out of sight after which nobody guesses where a person is
constexpr size_t kMostPaths = 400;  // whom one can still find again
constexpr double kReach = 0.35;     // lengths of the body within which the same person is looked for
constexpr double kReachPerSecond = 1;
constexpr double kVelocityKept = 0.3;  // seconds: a person out of sight slows down
constexpr double kFarAway = 1e3;       // cost of a pair that cannot be; above all others together
constexpr int kFewFrames = 5;          // seen so shortly, it may have been a false alarm
constexpr float kSizeOfParts = 5;      // a body is so many hands or faces
constexpr float kSizeRatio = 1.5f;     // of somebody who comes back

/// Seconds of travel that are left of `unseen` when the velocity decays.
double travelled(double unseen) {
  return kVelocityKept * (1 - std::exp(-unseen / kVelocityKept));
}

double reach(double unseen) {
  return kReach + kReachPerSecond * unseen;
}

/// Around everything that is seen: of some people only a hand or a face is.
FlatBox whole_box(const FlatPose& pose) {
  FlatBox box = box_of(pose);
  for (const FlatPoints* points : {&pose.left_hand, &pose.right_hand, &pose.face})
    for (Eigen::Index r = 0; r < points->rows(); ++r)
      if ((*points)(r, 2) > 0) box.extend(Vec2(points->row(r).head<2>()));
  return box;
}

bool same_size(float a, float b) {
  return a <= 0 || b <= 0 || (a < kSizeRatio * b && b < kSizeRatio * a);
}

}  // namespace

/// In lengths of the body: the mean distance of the points seen both times, of the boxes' middles where
/// there are none; and how much the sizes differ.
double PeopleTracker::cost(const Path& path, const PersonSighting& person) const {
  const FlatBox before = whole_box(path.pose), now = whole_box(person.pose);
  if (before.isEmpty() || now.isEmpty()) return kFarAway;
  const float part = kSizeOfParts * before.diagonal().norm();
  const double size = std::max(1.0f, path.size > 0 ? path.size : part);
  const auto seconds = static_cast<float>(travelled(path.unseen));
  double sum = 0;
  int common = 0;
  for (int p = 0; p < kBodyPoints; ++p) {
    if (!path.pose.has(p) || !person.pose.has(p)) continue;
    const Vec2 expected = path.pose.at(p) + seconds * Vec2(path.velocity.row(p).head<2>());
    sum += (expected - person.pose.at(p)).norm();
    ++common;
  }
  const double apart = common > 0 ? sum / common : (before.center() - now.center()).norm();
  const float size_now = size_of(person.pose);
  const double sizes = size_now > 0 && path.size > 0 ? std::abs(std::log(size_now / path.size)) : 0;
  return apart / size + 0.2 * sizes;
}

void PeopleTracker::match(const std::vector<PersonSighting>& people, std::vector<int>& path_of,
                          std::vector<char>& taken) const {
  std::vector<size_t> rows, columns;
  for (size_t i = 0; i < people.size(); ++i)
    if (path_of[i] < 0) rows.push_back(i);
  for (size_t p = 0; p < paths_.size(); ++p)
    if (!taken[p] && !paths_[p].has_id && paths_[p].unseen <= kGone) columns.push_back(p);
  Eigen::MatrixXd costs(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns.size()));
  for (size_t r = 0; r < rows.size(); ++r)
    for (size_t c = 0; c < columns.size(); ++c) {
      const Path& path = paths_[columns[c]];
      const double far = cost(path, people[rows[r]]);
      costs(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) =
          far <= reach(path.unseen) ? far : kFarAway;
    }
  const std::vector<int> pairs = cheapest_pairs(costs);
  for (size_t r = 0; r < rows.size(); ++r) {
    if (pairs[r] < 0 || costs(static_cast<Eigen::Index>(r), pairs[r]) >= kFarAway) continue;
    path_of[rows[r]] = static_cast<int>(columns[static_cast<size_t>(pairs[r])]);
    taken[columns[static_cast<size_t>(pairs[r])]] = 1;
  }
}

/// The one person who may have come back or, alone in the picture all the time, jumped (a cut in the
/// video); none when there are several.
std::optional<size_t> PeopleTracker::returned(const PersonSighting& person, const std::vector<char>& taken,
                                              bool alone) const {
  std::optional<size_t> found;
  for (size_t p = 0; p < paths_.size(); ++p) {
    const Path& path = paths_[p];
    const bool may_be = path.unseen > kGone || (alone && path.was_alone);
    if (taken[p] || path.has_id || !may_be || path.seen < kFewFrames ||
        !same_size(path.size, size_of(person.pose)))
      continue;
    if (found) return {};
    found = p;
  }
  return found;
}

size_t PeopleTracker::add_path(std::optional<int64_t> id) {
  Path path;
  path.has_id = id.has_value();
  const auto known = id ? person_of_id_.find(*id) : person_of_id_.end();
  path.person = known != person_of_id_.end() ? known->second : add_person(id);
  if (id) person_of_id_[*id] = path.person;
  paths_.push_back(path);
  return paths_.size() - 1;
}

/// Called by its id where that is free, else by the next free number.
int PeopleTracker::add_person(std::optional<int64_t> id) {
  while (taken_numbers_.count(next_number_) > 0) ++next_number_;
  const int64_t number = id && taken_numbers_.count(*id) == 0 ? *id : next_number_;
  taken_numbers_.insert(number);
  numbers_.push_back(number);
  return count() - 1;
}

void PeopleTracker::see(Path& path, const PersonSighting& person, bool alone) {
  const double dt = std::max(path.unseen, 1e-3);
  for (int p = 0; p < kBodyPoints && path.seen > 0; ++p) {
    if (!path.pose.has(p) || !person.pose.has(p)) continue;
    const Eigen::RowVector3f measured =
        (person.pose.body.row(p) - path.pose.body.row(p)) / static_cast<float>(dt);
    path.velocity.row(p) += 0.5f * (measured - path.velocity.row(p));
  }
  const FlatPose before = path.pose;
  path.pose = person.pose;
  for (int p = 0; p < kBodyPoints; ++p)  // a point that is missing now is looked for where it was
    if (!path.pose.has(p) && before.has(p) && path.seen > 0) path.velocity.row(p).setZero();
  const float size = size_of(person.pose);
  if (size > 0) path.size = path.size > 0 ? path.size + 0.1f * (size - path.size) : size;
  path.unseen = 0;
  path.was_alone = alone;
  ++path.seen;
}

/// Those who are gone the longest, when they are too many.
void PeopleTracker::forget() {
  if (paths_.size() <= kMostPaths) return;
  std::stable_sort(paths_.begin(), paths_.end(),
                   [](const Path& a, const Path& b) { return a.unseen < b.unseen; });
  paths_.resize(kMostPaths);
}

/// AlphaPose numbers everybody 0 where it does not follow people.
void PeopleTracker::check_ids(const std::vector<PersonSighting>& people) {
  std::set<int64_t> ids;
  for (const PersonSighting& person : people)
    if (person.id && !ids.insert(*person.id).second) believes_ids_ = false;
  if (believes_ids_) return;
  for (Path& path : paths_) path.has_id = false;
}

std::vector<int> PeopleTracker::push(const std::vector<PersonSighting>& people, double dt) {
  if (believes_ids_) check_ids(people);
  for (Path& path : paths_) path.unseen += dt;
  std::vector<int> path_of(people.size(), -1);
  std::vector<char> taken(paths_.size(), 0);
  const bool alone = people.size() == 1;
  for (size_t i = 0; i < people.size(); ++i) {
    if (!people[i].id || !believes_ids_) continue;
    const auto known = person_of_id_.find(*people[i].id);
    const auto is_it = [&](const Path& path) {
      return known != person_of_id_.end() && path.person == known->second;
    };
    const auto path = std::find_if(paths_.begin(), paths_.end(), is_it);
    const size_t p = static_cast<size_t>(path - paths_.begin());
    path_of[i] = static_cast<int>(path != paths_.end() ? p : add_path(people[i].id));
    taken.resize(paths_.size(), 0);
    taken[static_cast<size_t>(path_of[i])] = 1;
  }
  match(people, path_of, taken);
  for (size_t i = 0; i < people.size(); ++i) {
    if (path_of[i] >= 0) continue;
    const auto back = returned(people[i], taken, alone);
    path_of[i] = static_cast<int>(back ? *back : add_path({}));
    taken.resize(paths_.size(), 0);
    taken[static_cast<size_t>(path_of[i])] = 1;
  }
  std::vector<int> persons;
  for (size_t i = 0; i < people.size(); ++i) {
    Path& path = paths_[static_cast<size_t>(path_of[i])];
    see(path, people[i], alone);
    persons.push_back(path.person);
  }
  forget();
  return persons;
}

}  // namespace understudy
