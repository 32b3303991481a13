#include "retarget/metrics/scene_score.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

constexpr float kLeastInCommon = 0.3f;  // of somebody's points
constexpr int kMostPeople = 12;

int64_t seen_joints(const TruePerson& person) {
  return (person.seen >= 0.5f).count();
}

/// Ids in a frame: those of its people, then those that only points have.
std::vector<int> ids_of(const PredictedPeople& found) {
  std::vector<int> ids;
  const auto add = [&ids](int id) {
    if (id >= 0 && std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
  };
  for (const PredictedPerson& person : found.people) add(person.id);
  for (const int owner : found.owners) add(owner);
  return ids;
}

/// Points that people (rows) and ids (columns) have in common; below the least share none.
RowMatrix in_common(const PredictedPeople& found, const TruePeople& truth, const std::vector<int>& ids) {
  const auto people = static_cast<Eigen::Index>(truth.people.size());
  RowMatrix common = RowMatrix::Zero(people, static_cast<Eigen::Index>(ids.size()));
  Eigen::VectorXf all = Eigen::VectorXf::Zero(people);
  for (size_t i = 0; i < truth.owners.size(); ++i) {
    const int person = truth.owners[i];
    if (person < 0) continue;
    US_CHECK(person < people, "a point is of person ", person, " of ", people);
    all[person] += 1;
    const auto id = std::find(ids.begin(), ids.end(), found.owners[i]);
    if (id != ids.end()) common(person, id - ids.begin()) += 1;
  }
  for (Eigen::Index p = 0; p < people; ++p)
    common.row(p) = (common.row(p).array() < kLeastInCommon * all[p]).select(0, common.row(p));
  return common;
}

}  // namespace

std::vector<int> best_pairs(const RowMatrix& gain) {
  US_CHECK(gain.rows() <= kMostPeople, gain.rows(), " people cannot be paired, at most ", kMostPeople,
           " can");
  // best[c][rows]: of the first c columns, with just these rows paired.
  const size_t sets = size_t{1} << gain.rows();
  std::vector<std::vector<float>> best(gain.cols() + 1, std::vector<float>(sets, -1));
  std::vector<std::vector<int>> row_of(gain.cols(), std::vector<int>(sets, -1));
  best[0][0] = 0;
  for (Eigen::Index c = 0; c < gain.cols(); ++c)
    for (size_t rows = 0; rows < sets; ++rows) {
      best[c + 1][rows] = best[c][rows];
      for (int r = 0; r < gain.rows(); ++r) {
        const size_t one = size_t{1} << r;
        if ((rows & one) == 0 || gain(r, c) <= 0 || best[c][rows ^ one] < 0) continue;
        const float sum = best[c][rows ^ one] + gain(r, c);
        if (sum > best[c + 1][rows]) best[c + 1][rows] = sum, row_of[c][rows] = r;
      }
    }
  std::vector<int> pairs(gain.rows(), -1);
  size_t rows = std::max_element(best.back().begin(), best.back().end()) - best.back().begin();
  for (Eigen::Index c = gain.cols(); c-- > 0;) {
    const int r = row_of[c][rows];
    if (r < 0) continue;
    pairs[r] = static_cast<int>(c);
    rows ^= size_t{1} << r;
  }
  return pairs;
}

void SceneScore::push(const PredictedPeople& found, const TruePeople& truth) {
  US_CHECK(found.owners.size() == truth.owners.size(), "owners of ", found.owners.size(),
           " points in a scan of ", truth.owners.size());
  pair_up(found, truth);
  add_owners(found, truth);
  add_people(found, truth);
  ++frames_;
}

void SceneScore::pair_up(const PredictedPeople& found, const TruePeople& truth) {
  const std::vector<int> ids = ids_of(found);
  paired_ = best_pairs(in_common(found, truth, ids));
  for (int& id : paired_)
    if (id >= 0) id = ids[id];
  before_.resize(paired_.size(), -1);
  for (size_t p = 0; p < paired_.size(); ++p) {
    if (paired_[p] < 0) continue;
    exchanged_ += before_[p] >= 0 && before_[p] != paired_[p];
    before_[p] = paired_[p];
  }
}

void SceneScore::add_owners(const PredictedPeople& found, const TruePeople& truth) {
  for (size_t i = 0; i < truth.owners.size(); ++i) {
    const int owner = truth.owners[i];
    if (owner == kUndecidedPoint) continue;
    ++points_;
    const bool is_nobodys = found.owners[i] < 0;
    points_right_ += owner < 0 ? is_nobodys : !is_nobodys && found.owners[i] == paired_[owner];
  }
}

void SceneScore::add_people(const PredictedPeople& found, const TruePeople& truth) {
  std::vector<char>& known = known_.emplace_back(truth.people.size(), 0);
  for (const PredictedPerson& person : found.people)
    invented_ += std::find(paired_.begin(), paired_.end(), person.id) == paired_.end();
  for (size_t p = 0; p < truth.people.size(); ++p) {
    const TruePerson& person = truth.people[p];
    const auto one = std::find_if(found.people.begin(), found.people.end(),
                                  [&](const PredictedPerson& f) { return f.id == paired_[p]; });
    const bool is_found = paired_[p] >= 0 && one != found.people.end(),
               is_there = 2 * seen_joints(person) >= kJointCount;
    there_ += is_there;
    missed_ += is_there && !is_found;
    const double error = is_found ? seen_joint_error({one->joints}, {person.joints}, {person.seen}) : NAN;
    if (!std::isfinite(error)) continue;
    known[p] = 1;
    found_.add(error, seen_joints(person));
    if (person.touches) found_touching_.add(error, seen_joints(person));
  }
}

void SceneScore::push_alone(size_t frame, size_t person, const Joints& joints, const TruePerson& truth) {
  US_CHECK(frame < known_.size() && person < known_[frame].size(), "person ", person, " of frame ", frame,
           " is in no scene");
  if (!known_[frame][person]) return;
  const double error = seen_joint_error({joints}, {truth.joints}, {truth.seen});
  alone_.add(error, seen_joints(truth));
  if (truth.touches) alone_touching_.add(error, seen_joints(truth));
}

std::map<std::string, double> SceneScore::figures() const {
  std::map<std::string, double> figures;
  const auto share = [&](const char* key, int64_t part, int64_t all) {
    if (all > 0) figures[key] = static_cast<double>(part) / static_cast<double>(all);
  };
  share("points_owner_right", points_right_, points_);
  share("people_missed", missed_, there_);
  share("people_invented", invented_, frames_);
  if (frames_ > 0) figures["identities_exchanged"] = static_cast<double>(exchanged_);
  const auto error = [&](const std::string& key, const Mean& found, const Mean& alone) {
    if (found.count == 0) return;
    figures[key + "_mm"] = 1000 * found.sum / static_cast<double>(found.count);
    if (alone.count == 0) return;
    figures[key + "_alone_mm"] = 1000 * alone.sum / static_cast<double>(alone.count);
    if (alone.sum > 0 && alone.count == found.count) figures[key + "_over_alone"] = found.sum / alone.sum;
  };
  error("people", found_, alone_);
  error("people_touching", found_touching_, alone_touching_);
  return figures;
}

}  // namespace understudy
