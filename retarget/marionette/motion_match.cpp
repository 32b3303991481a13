#include "retarget/marionette/motion_match.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/discovery/ground_contacts.hpp"
#include "retarget/marionette/motion_form.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr double kPatchSeconds = 11.0 / 30;  // GenMM's eleven frames
constexpr int kLeastPatch = 3, kMatchRounds = 4;
constexpr double kCoarser = 0.75;       // of the frames, a level
constexpr float kCompleteness = 0.01f;  // alpha of the bidirectional similarity
constexpr float kTempo = 0.12f;         // how much faster and slower pieces are played, at most
constexpr double kTempoSeconds = 1.5;   // of a wave of it
constexpr float kKeyPull = 2;           // times a patch's other frames together
constexpr float kKeyNoise = 0.5f;       // standard deviations, between keys

/// Rows at these times, linearly between neighbours.
RowMatrix rows_at(const RowMatrix& rows, const std::vector<float>& times) {
  RowMatrix taken(ssize(times), rows.cols());
  for (Eigen::Index i = 0; i < taken.rows(); ++i) {
    const float time = std::clamp(times[static_cast<size_t>(i)], 0.0f, static_cast<float>(rows.rows() - 1));
    const auto before = std::min(static_cast<Eigen::Index>(time), std::max<Eigen::Index>(0, rows.rows() - 2));
    const auto after = std::min(before + 1, rows.rows() - 1);
    const float share = time - static_cast<float>(before);
    taken.row(i) = (1 - share) * rows.row(before) + share * rows.row(after);
  }
  return taken;
}

RowMatrix resampled(const RowMatrix& rows, int count) {
  std::vector<float> times;
  times.reserve(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i)
    times.push_back(count < 2 ? 0.0f
                              : static_cast<float>(i) * static_cast<float>(rows.rows() - 1) /
                                    static_cast<float>(count - 1));
  return rows_at(rows, times);
}

/// The same pieces, played now faster, now slower: else a clip that repeats itself could only be copied.
RowMatrix in_own_tempo(const RowMatrix& rows, double fps, Rng& rng) {
  const auto wave = static_cast<float>(2 * kPi / (kTempoSeconds * fps));
  const float phase = rng.uniform(0, 2 * kPi), lean = rng.uniform(-0.5f, 0.5f);
  std::vector<float> times = {0};
  std::vector<float> speeds = {1};
  while (times.back() < static_cast<float>(rows.rows() - 1)) {
    const float speed = 1 + kTempo * (0.5f * std::sin(phase + wave * times.back()) + lean);
    times.push_back(times.back() + speed);
    speeds.push_back(speed);
  }
  RowMatrix played = rows_at(rows, times);
  for (Eigen::Index t = 0; t < played.rows(); ++t) played.row(t).head<3>() *= speeds[static_cast<size_t>(t)];
  return played;
}

/// Windows of `patch` rows, one a line, weighted; of a loop as many as rows.
RowMatrix windows_of(const RowMatrix& rows, const Eigen::RowVectorXf& weights, int patch, bool loop) {
  const Eigen::Index count = loop ? rows.rows() : rows.rows() - patch + 1, width = rows.cols();
  RowMatrix windows(std::max<Eigen::Index>(0, count), patch * width);
  for (Eigen::Index i = 0; i < windows.rows(); ++i)
    for (int k = 0; k < patch; ++k)
      windows.row(i).segment(k * width, width) = rows.row((i + k) % rows.rows()).cwiseProduct(weights);
  return windows;
}

/// Makes the rows of a motion, level by level.
class Matcher {
 public:
  Matcher(const MotionForm& form, const MatchOptions& options, double fps)
      : form_(form), options_(options), fps_(fps), rng_(options.seed) {}

  RowMatrix made_from(std::vector<RowMatrix> examples);

 private:
  void begin(int frames);
  void round();
  Eigen::MatrixXf distances(const RowMatrix& wanted, const RowMatrix& known) const;
  void put_keys();
  void go_to_keys();
  int on_level(int frame, int level_frames) const;

  const MotionForm& form_;
  const MatchOptions& options_;
  double fps_;
  Rng rng_;
  int patch_ = 0, frames_ = 0;
  std::vector<RowMatrix> examples_;  // of this level
  RowMatrix rows_;                   // of the motion, of this level
};

int Matcher::on_level(int frame, int level_frames) const {
  return static_cast<int>(std::lround(static_cast<double>(frame) * (level_frames - 1) / (frames_ - 1)));
}

/// Of the coarsest level: random pieces of the examples, or what lies between keys, disturbed.
void Matcher::begin(int frames) {
  rows_.resize(frames, form_.width());
  for (int t = 0; t < frames;) {
    const RowMatrix& from = examples_[static_cast<size_t>(rng_.below(static_cast<int>(ssize(examples_))))];
    const int first = rng_.below(static_cast<int>(std::max<Eigen::Index>(1, from.rows() - patch_ + 1)));
    for (int k = 0; k < patch_ && t < frames; ++k, ++t)
      rows_.row(t) = from.row(std::min<Eigen::Index>(first + k, from.rows() - 1));
  }
  if (options_.keys.size() < 2) return;
  const RowMatrix& known = examples_[0];
  const Eigen::RowVectorXf mean = known.colwise().mean();
  const Eigen::RowVectorXf spread = (known.rowwise() - mean).colwise().squaredNorm().cwiseSqrt() /
                                    std::sqrt(static_cast<float>(known.rows()));
  for (size_t k = 0; k + 1 < options_.keys.size(); ++k) {
    const PoseKey &a = options_.keys[k], &b = options_.keys[k + 1];
    const Eigen::RowVectorXf from = form_.row_of(a.pose), to = form_.row_of(b.pose);
    const int first = on_level(a.frame, frames), last = on_level(b.frame, frames);
    const float freedom = static_cast<float>(last - first) / static_cast<float>(2 * patch_);
    const float noise = kKeyNoise * std::min(1.0f, freedom);  // of short ways there are not many
    for (int t = first; t <= last; ++t) {
      const float share = static_cast<float>(t - first) / static_cast<float>(std::max(1, last - first));
      Eigen::RowVectorXf between = (1 - share) * from + share * to;
      for (Eigen::Index c = 0; c < between.size(); ++c) between[c] += noise * spread[c] * rng_.normal();
      form_.put_pose(between, rows_.row(t));
      rows_.row(t).head<3>().setZero();  // go_to_keys() says how it goes
    }
  }
}

void Matcher::put_keys() {
  const auto frames = static_cast<int>(rows_.rows());
  for (const PoseKey& key : options_.keys)
    form_.put_pose(form_.row_of(key.pose), rows_.row(std::min(on_level(key.frame, frames_), frames - 1)));
}

/// Between two keys the root goes and turns so that it arrives: the same is added in each frame.
void Matcher::go_to_keys() {
  const auto frames = static_cast<int>(rows_.rows());
  const float dt = static_cast<float>((frames_ - 1) / fps_) / static_cast<float>(frames - 1);
  for (size_t k = 0; k + 1 < options_.keys.size(); ++k) {
    const PoseKey &a = options_.keys[k], &b = options_.keys[k + 1];
    const int first = on_level(a.frame, frames), last = on_level(b.frame, frames);
    if (first == last) continue;
    const float seconds = dt * static_cast<float>(last - first);
    const float start = heading_of(a.pose.turns[0]);
    float turned = 0;
    for (int t = first + 1; t <= last; ++t) turned += rows_(t, MotionForm::kTurn) * dt;
    const float wanted = std::remainder(heading_of(b.pose.turns[0]) - start, 2 * kPi);
    const float more = std::remainder(wanted - turned, 2 * kPi) / seconds;
    Vec3 left = (b.pose.root - a.pose.root) / form_.size();
    std::vector<float> headings = {start};
    for (int t = first + 1; t <= last; ++t) {
      left -= rotation_about_y(headings.back()) * form_.way(rows_.row(t)) * dt;
      rows_(t, MotionForm::kTurn) += more;
      headings.push_back(headings.back() + rows_(t, MotionForm::kTurn) * dt);
    }
    for (int t = first + 1; t <= last; ++t) {
      const Vec3 added = rotation_about_y(-headings[static_cast<size_t>(t - first - 1)]) * left / seconds;
      rows_(t, MotionForm::kSpeed) += added.x(), rows_(t, MotionForm::kSpeed + 1) += added.z();
    }
  }
}

/// Squared, a frame, of windows; frames that keys fix count more, or the many between would decide.
Eigen::MatrixXf Matcher::distances(const RowMatrix& wanted, const RowMatrix& known) const {
  const auto frames = static_cast<int>(rows_.rows());
  Eigen::VectorXf pulls = Eigen::VectorXf::Ones(frames);
  for (const PoseKey& key : options_.keys)
    pulls[std::min(on_level(key.frame, frames_), frames - 1)] = kKeyPull * static_cast<float>(patch_);
  const Eigen::Index width = wanted.cols() / patch_;
  Eigen::MatrixXf far = Eigen::MatrixXf::Zero(wanted.rows(), known.rows());
  RowMatrix pulled = wanted, squares(known.rows(), patch_), pull(wanted.rows(), patch_);
  for (int k = 0; k < patch_; ++k) {
    squares.col(k) = known.middleCols(k * width, width).rowwise().squaredNorm();
    for (Eigen::Index i = 0; i < wanted.rows(); ++i) {
      pull(i, k) = pulls[(i + k) % frames];
      pulled.row(i).segment(k * width, width) *= pull(i, k);
    }
  }
  far.noalias() = -2.0f * pulled * known.transpose() + pull * squares.transpose();
  far.colwise() += pulled.cwiseProduct(wanted).rowwise().sum();
  return far.cwiseMax(0) / static_cast<float>(patch_);
}

/// Each patch becomes the example's that is nearest by bidirectional similarity; where they overlap they are
/// blended, the middle of a patch most.
void Matcher::round() {
  put_keys();  // patches are chosen by them; what is blended may miss them, evenly, and is bent to them later
  go_to_keys();
  const Eigen::RowVectorXf& weights = form_.weights();
  const RowMatrix wanted = windows_of(rows_, weights, patch_, options_.loop);
  std::vector<RowMatrix> known;
  Eigen::Index count = 0;
  for (const RowMatrix& example : examples_) {
    known.push_back(windows_of(example, weights, patch_, false));
    count += known.back().rows();
  }
  RowMatrix all(count, wanted.cols());
  std::vector<std::pair<size_t, Eigen::Index>> places;
  for (size_t e = 0; e < known.size(); ++e)
    for (Eigen::Index i = 0; i < known[e].rows(); ++i) {
      all.row(ssize(places)) = known[e].row(i);
      places.emplace_back(e, i);
    }
  const Eigen::MatrixXf far = distances(wanted, all);
  const Eigen::RowVectorXf nearest = far.colwise().minCoeff();
  RowMatrix sum = RowMatrix::Zero(rows_.rows(), rows_.cols());
  Eigen::VectorXf pulls = Eigen::VectorXf::Zero(rows_.rows());
  for (Eigen::Index i = 0; i < far.rows(); ++i) {
    Eigen::Index best = 0;
    (far.row(i).array() / (kCompleteness + nearest.array())).minCoeff(&best);
    const auto& [example, first] = places[static_cast<size_t>(best)];
    for (int k = 0; k < patch_; ++k) {
      const auto pull = static_cast<float>(std::min(k + 1, patch_ - k));
      const Eigen::Index t = (i + k) % rows_.rows();
      sum.row(t) += pull * examples_[example].row(first + k);
      pulls[t] += pull;
    }
  }
  rows_ = sum.array().colwise() / pulls.array();
}

RowMatrix Matcher::made_from(std::vector<RowMatrix> examples) {
  Eigen::Index longest = 0;
  for (RowMatrix& example : examples) {
    if (options_.keys.empty()) example = in_own_tempo(example, fps_, rng_);
    longest = std::max(longest, example.rows());
  }
  frames_ = options_.frames - (options_.loop ? 1 : 0);  // a loop's last frame is its first
  patch_ = std::max(kLeastPatch, static_cast<int>(std::lround(kPatchSeconds * fps_)));
  patch_ = static_cast<int>(std::min<Eigen::Index>({patch_, frames_, longest}));
  int levels = 0;
  const auto share = [](int level) { return std::pow(kCoarser, level); };
  while (static_cast<double>(std::min<Eigen::Index>(frames_, longest)) * share(levels + 1) >= 2.0 * patch_)
    ++levels;
  for (int level = levels; level >= 0; --level) {
    examples_.clear();
    for (const RowMatrix& example : examples) {
      const auto count = static_cast<int>(std::lround(static_cast<double>(example.rows()) * share(level)));
      if (count >= patch_) examples_.push_back(resampled(example, count));
    }
    const auto frames = static_cast<int>(std::lround(frames_ * share(level)));
    if (level == levels)
      begin(frames);
    else
      rows_ = resampled(rows_, frames);
    for (int i = 0; i < kMatchRounds; ++i) round();
  }
  if (options_.loop) {
    rows_.conservativeResize(rows_.rows() + 1, Eigen::NoChange);
    rows_.bottomRows<1>() = rows_.row(0);
  }
  return rows_;
}

/// What stands in each of the examples, and the ground.
struct ExampleContacts {
  std::vector<std::vector<std::vector<char>>> touches;
  float ground = 0;
};
ExampleContacts contacts_of(const Rig& rig, const std::vector<RigMotion>& examples) {
  ExampleContacts contacts;
  contacts.touches.resize(examples.size());
  if (rig.surface.vertices.rows() == 0) return contacts;
  RiggedMotion all{rig, {examples[0].fps, {}}};  // of one ground
  for (const RigMotion& example : examples)
    all.motion.poses.insert(all.motion.poses.end(), example.poses.begin(), example.poses.end());
  const GroundContacts found = ground_contacts(all);
  contacts.ground = found.ground;
  auto at = found.touches.begin();
  for (size_t e = 0; e < examples.size(); ++e) {
    contacts.touches[e].assign(at, at + ssize(examples[e].poses));
    at += ssize(examples[e].poses);
  }
  return contacts;
}

/// The first and the last pose become one, wherever the last one is.
void close_loop(const Rig& rig, double fps, std::vector<RigPose>& poses) {
  RigPose last = poses.front();
  const float turn = heading_of(poses.back().turns[0]) - heading_of(last.turns[0]);
  last.turns[0] = rotation_about_y(turn) * last.turns[0];
  last.root.x() = poses.back().root.x(), last.root.z() = poses.back().root.z();
  meet_keys(rig, fps, {{0, poses.front()}, {static_cast<int>(ssize(poses)) - 1, last}}, poses);
}

}  // namespace

RigMotion matched_motion(const Rig& rig, const std::vector<RigMotion>& examples,
                         const MatchOptions& options) {
  US_CHECK(options.frames >= 2, "a motion has two frames or more, not ", options.frames);
  check_keys(rig, options.frames, options.keys);
  const auto enough = [](const RigMotion& example) { return example.poses.size() >= 2; };
  US_CHECK(std::any_of(examples.begin(), examples.end(), enough), rig.name,
           ": no motion of two frames or more to learn from");
  const double fps = examples[0].fps;
  const MotionForm form(rig);
  const ExampleContacts contacts = contacts_of(rig, examples);
  std::vector<RowMatrix> rows;
  for (size_t e = 0; e < examples.size(); ++e)
    if (enough(examples[e])) rows.push_back(form.rows(examples[e], contacts.touches[e]));
  const RowMatrix made = Matcher(form, options, fps).made_from(std::move(rows));
  const auto first = std::find_if(examples.begin(), examples.end(), enough);
  RiggedMotion performed{rig, form.motion(made, first->poses.front(), fps)};
  meet_keys(rig, fps, options.keys, performed.motion.poses);
  if (rig.surface.vertices.rows() > 0) {
    // Between keys the path is known; without, the body goes as those that stand push it.
    const auto stands = options.keys.empty() ? stand_on : bend_onto;
    stands(contacts.ground, form.touches(made), performed);
  }
  if (options.loop) close_loop(rig, fps, performed.motion.poses);
  meet_keys(rig, fps, options.keys, performed.motion.poses);
  return std::move(performed.motion);
}

double distance_to_nearest(const Rig& rig, const std::vector<RigPose>& motion,
                           const std::vector<RigPose>& example) {
  const std::vector<Points> a = own_places(rig, motion), b = own_places(rig, example);
  const std::vector<Points>&shorter = a.size() <= b.size() ? a : b, &longer = a.size() <= b.size() ? b : a;
  double nearest = std::numeric_limits<double>::infinity();
  for (size_t first = 0; first + shorter.size() <= longer.size(); ++first) {
    double sum = 0;
    for (size_t t = 0; t < shorter.size(); ++t)
      sum += static_cast<double>((shorter[t] - longer[first + t]).rowwise().norm().mean());
    nearest = std::min(nearest, sum / static_cast<double>(std::max<size_t>(1, shorter.size())));
  }
  return nearest;
}

}  // namespace understudy
