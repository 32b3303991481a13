#include "retarget/keypoints/frame_decoder.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/keypoints/pose_json.hpp"

namespace understudy {
namespace {

constexpr float kFraction = 1.5f;                // places up to here may be in 0..1, a bit off the canvas
constexpr float kFarFraction = 16;               // ... up to here among others that are
constexpr float kFarthest = 2 * kLargestCanvas;  // pixels: what is farther is no place
constexpr double kHighestRate = 1000;

/// Calls `point` for each row that the frame's people have: body, hands, face.
template <class Point>
void each_row(const RawFrame& frame, const Point& point) {
  for (const RawPerson& person : frame.people)
    for (const FlatPoints* points : {&person.points, &person.left_hand, &person.right_hand, &person.face})
      for (Eigen::Index r = 0; r < points->rows(); ++r) point(points->data() + 3 * r);
}

FlatPoints part_of(const FlatPoints& points, Eigen::Index rows, const char* part, const std::string& what) {
  if (points.rows() == 0) return points;
  const bool is_face = rows == kFacePoints && points.rows() == 68;
  US_CHECK(points.rows() == rows || is_face, what, ": a ", part, " has ", points.rows(), " points, not ",
           rows);
  if (points.col(2).maxCoeff() <= 0) return FlatPoints(0, 3);
  FlatPoints out = FlatPoints::Zero(rows, 3);
  out.topRows(points.rows()) = points;
  return out;
}

float sigmoid(float x) {
  return 1 / (1 + std::exp(-x));
}

void forget_unseen(FlatPoints& points) {
  if (points.rows() > 0 && points.col(2).maxCoeff() <= 0) points.resize(0, 3);
}

}  // namespace

FrameDecoder::FrameDecoder(std::string source, const KeypointReaderOptions& options,
                           std::optional<PictureBeside> picture)
    : source_(std::move(source)), options_(options), picture_(std::move(picture)) {
  US_CHECK(options_.layout.empty() || layout_named(options_.layout), "there is no layout '", options_.layout,
           "', only ", layout_labels());
  US_CHECK(options_.fps >= 0 && options_.fps <= kHighestRate, "a rate of ", options_.fps,
           " frames/s is not between 0 and ", kHighestRate);
}

void FrameDecoder::begin(const RawFacts& facts) {
  if (has_begun_) return;
  has_begun_ = true;
  facts_ = facts;
  const bool is_told = facts.fps > 0 && facts.fps <= kHighestRate;
  if (!is_told) facts_.fps = 0;
  fps_ = options_.fps > 0 ? options_.fps : is_told ? facts.fps : fps_;
}

void FrameDecoder::frame(int64_t number, const std::function<RawFrame()>& read) {
  if (!frames_.empty() && number <= frames_.back().number) {
    if (left_out_++ == 0) first_left_out_ = number;
    return;
  }
  US_CHECK(static_cast<int64_t>(frames_.size()) < kMostFrames, source_, ": has more than ", kMostFrames,
           " frames");
  KeypointFrame frame;
  frame.number = number;
  std::vector<PersonSighting> people;
  frame.problem = failure_of([&] { people = decode(read(), number); });
  const double dt = frames_.empty() ? 0
                                    : static_cast<double>(number) / fps_ -
                                          static_cast<double>(frames_.back().number) / fps_;
  frames_.push_back(std::move(frame));
  keep_people(people, dt);
}

void FrameDecoder::keep_people(const std::vector<PersonSighting>& people, double dt) {
  const std::vector<int> persons = tracker_.push(people, dt);
  for (size_t i = 0; i < people.size(); ++i) {
    while (static_cast<int>(tracks_.size()) < tracker_.count())
      tracks_.push_back({tracker_.number(static_cast<int>(tracks_.size())), {}});
    tracks_[static_cast<size_t>(persons[i])].poses.push_back(
        {static_cast<int64_t>(frames_.size()) - 1, people[i].score, people[i].pose});
    for (int p = 0; p < kBodyPoints; ++p)
      if (people[i].pose.has(p)) extent_.extend(people[i].pose.at(p));
  }
}

std::vector<PersonSighting> FrameDecoder::decode(const RawFrame& frame, int64_t number) {
  std::vector<PersonSighting> people;
  const bool is_anybody = std::any_of(frame.people.begin(), frame.people.end(),
                                      [](const RawPerson& person) { return person.points.rows() > 0; });
  if (!decided_) {
    bool any_place = false;
    each_row(frame, [&](const float* row) { any_place |= is_place(row, Scale::Pixels); });
    if (!is_anybody || !any_place) return people;
    decided_ = decide(frame, number);
  } else {
    check_like_first(frame, number);
  }
  for (const RawPerson& person : frame.people) {
    FlatPose pose = pose_of(person, frame_of(source_, number));
    if (!is_nobody(pose)) people.push_back({person.id, person.score, std::move(pose)});
  }
  return people;
}

/// Zeros are never a place, but in -1..1 they are the middle where the confidence says that it is seen.
bool FrameDecoder::is_place(const float* row, Scale scale) const {
  if (!std::isfinite(row[0]) || !std::isfinite(row[1]) || std::isnan(row[2])) return false;
  return row[0] != 0 || row[1] != 0 || (scale == Scale::Signed && row[2] > 0);
}

FrameDecoder::Decisions FrameDecoder::decide(const RawFrame& frame, int64_t number) {
  Decisions decided;
  const auto first = std::find_if(frame.people.begin(), frame.people.end(),
                                  [](const RawPerson& person) { return person.points.rows() > 0; });
  decided.layout = layout_for(*first, number);
  bool any_seen = false;
  each_row(frame, [&](const float* row) {
    if (!is_place(row, Scale::Pixels)) return;
    any_seen |= row[2] > 0;
    if (facts_.confidence == RawConfidence::Logit) decided.is_logit |= row[2] < 0 || row[2] > 1;
  });
  decided.all_are_seen = !any_seen && !decided.is_logit;
  decided.scale = scale_of(frame, decided.all_are_seen || decided.is_logit);
  decided.canvas = canvas_for(frame, decided.canvas_from);
  wants_canvas_ = decided.scale != Scale::Pixels && !decided.canvas.is_known();
  US_CHECK(!wants_canvas_, frame_of(source_, number), ": places are in ",
           decided.scale == Scale::Signed ? "-1..1" : "0..1",
           " of a canvas of unknown size; say its width and height (--canvas 1280x720)");
  return decided;
}

KeypointLayout FrameDecoder::layout_for(const RawPerson& person, int64_t number) const {
  const auto points = static_cast<int64_t>(person.points.rows());
  const std::string what = frame_of(source_, number);
  const std::string name = !options_.layout.empty()                       ? options_.layout
                           : points == 15 && !facts_.layout_of_15.empty() ? facts_.layout_of_15
                                                                          : facts_.layout;
  if (const KeypointLayout* const layout = layout_named(name)) {
    US_CHECK(points == layout->count(), what, ": a person has ", points, " points, ", layout->label, " has ",
             layout->count());
    return *layout;
  }
  if (static_cast<int64_t>(facts_.names.size()) == points) return layout_of_names(facts_.names, source_);
  US_CHECK(points != 15, what,
           ": 15 points may be MPI's or BODY_25's first; say which (--layout mpi15 or body15)");
  const KeypointLayout* const layout = layout_of_count(points);
  US_CHECK(layout, what, ": a person has ", points, " points, which is no known layout (", layout_labels(),
           ")");
  return *layout;
}

FrameDecoder::Scale FrameDecoder::scale_of(const RawFrame& frame, bool all_are_seen) const {
  float lowest = 0, highest = 0;
  each_row(frame, [&](const float* row) {
    if (!is_place(row, Scale::Pixels) || !(all_are_seen || row[2] > 0)) return;
    lowest = std::min({lowest, row[0], row[1]});
    highest = std::max({highest, row[0], row[1]});
  });
  const bool is_fraction = highest <= kFraction && lowest >= -kFraction;
  if (!is_fraction) return Scale::Pixels;
  return facts_.may_be_signed && lowest < 0 ? Scale::Signed : Scale::Fractions;
}

Canvas FrameDecoder::canvas() const {
  std::string from;
  return decided_ ? decided_->canvas : canvas_for({}, from);
}

Canvas FrameDecoder::canvas_for(const RawFrame& frame, std::string& from) const {
  from = "as asked";
  if (options_.canvas.is_known()) return options_.canvas;
  from = "as the file says";
  if (frame.canvas.is_known()) return frame.canvas;
  if (facts_.canvas.is_known()) return facts_.canvas;
  from = picture_ ? "that of " + picture_->path : "";
  return picture_ ? picture_->canvas : Canvas{};
}

void FrameDecoder::check_like_first(const RawFrame& frame, int64_t number) const {
  const std::string what = frame_of(source_, number);
  const bool is_other =
      !options_.canvas.is_known() && frame.canvas.is_known() && !(frame.canvas == decided_->canvas);
  US_CHECK(!is_other, what, " has a canvas of ", canvas_text(frame.canvas), " among others of ",
           canvas_text(decided_->canvas));
  for (const RawPerson& person : frame.people)
    US_CHECK(person.points.rows() == 0 || person.points.rows() == decided_->layout.count(), what,
             ": a person has ", person.points.rows(), " points, those before have ", decided_->layout.count(),
             " (", decided_->layout.label, ")");
  float farthest = 0;
  int places = 0;
  each_row(frame, [&](const float* row) {
    if (!is_place(row, decided_->scale) || !(row[2] > 0 || decided_->all_are_seen || decided_->is_logit))
      return;
    farthest = std::max({farthest, std::abs(row[0]), std::abs(row[1])});
    ++places;
  });
  const bool is_fraction = places >= 3 && farthest <= kFraction;
  US_CHECK(decided_->scale != Scale::Pixels || !is_fraction, what,
           ": places are in 0..1, those before in pixels");
  US_CHECK(decided_->scale == Scale::Pixels || farthest <= kFarFraction, what,
           ": places are in pixels, those before in ", decided_->scale == Scale::Signed ? "-1..1" : "0..1");
}

/// 0 below what counts as seen.
float FrameDecoder::confidence_of(float raw, bool has_confidence) {
  if (decided_->all_are_seen || !has_confidence) return 1;
  if (facts_.confidence == RawConfidence::Visibility)  // 2 is seen, 1 marked behind something
    return raw >= 2 ? 1 : raw >= 1 ? 0.5f : std::max(raw, 0.0f);
  if (decided_->is_logit) return std::max(sigmoid(raw), 1e-6f);
  if (raw > 1) ++odd_.above_one, odd_.highest = std::max(odd_.highest, raw);
  if (raw < 0) ++odd_.below_zero;
  return std::clamp(raw, 0.0f, 1.0f);
}

FlatPoints FrameDecoder::in_pixels(const FlatPoints& raw, bool has_confidence) {
  FlatPoints out = FlatPoints::Zero(raw.rows(), 3);
  const Scale scale = decided_->scale;
  const float last = facts_.to_last_pixel ? 1 : 0;
  const Vec2 span(static_cast<float>(decided_->canvas.width) - last,
                  static_cast<float>(decided_->canvas.height) - last);
  for (Eigen::Index r = 0; r < raw.rows(); ++r) {
    const float* const row = raw.data() + 3 * r;
    if (!is_place(row, scale)) {
      odd_.not_finite += !std::isfinite(row[0]) || !std::isfinite(row[1]) || std::isnan(row[2]);
      continue;
    }
    const float confidence = confidence_of(row[2], has_confidence);
    Vec2 place(row[0], row[1]);
    if (scale == Scale::Signed) place = (place.array() + 1) / 2;
    if (scale != Scale::Pixels) place = place.cwiseProduct(span);
    if (!(confidence > 0)) continue;
    if (place.cwiseAbs().maxCoeff() > kFarthest) {
      ++odd_.far_away;
      continue;
    }
    const Canvas& canvas = decided_->canvas;
    const bool is_off = place.minCoeff() < -0.5f || place.x() > static_cast<float>(canvas.width) ||
                        place.y() > static_cast<float>(canvas.height);
    odd_.off_canvas += canvas.is_known() && is_off;
    out.row(r) << place.x(), place.y(), confidence;
  }
  return out;
}

FlatPose FrameDecoder::pose_of(const RawPerson& person, const std::string& what) {
  FlatPose pose;
  if (person.points.rows() > 0)
    pose = pose_of_layout(decided_->layout, in_pixels(person.points, person.has_confidence));
  const FlatPoints left = part_of(in_pixels(person.left_hand, true), kHandPoints, "hand", what);
  const FlatPoints right = part_of(in_pixels(person.right_hand, true), kHandPoints, "hand", what);
  const FlatPoints face = part_of(in_pixels(person.face, true), kFacePoints, "face", what);
  if (left.rows() > 0) pose.left_hand = left;
  if (right.rows() > 0) pose.right_hand = right;
  if (face.rows() > 0) pose.face = face;
  for (FlatPoints* points : {&pose.left_hand, &pose.right_hand, &pose.face}) forget_unseen(*points);
  return pose;
}

}  // namespace understudy
