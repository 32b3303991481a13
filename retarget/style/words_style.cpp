#include "retarget/style/words_style.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/style/skeleton_style.hpp"

namespace understudy {
namespace {

constexpr int kContext = 20;  // rows before those that settle, which the filters see

/// Between two rows of quaternions, each on the nearer side of the other.
Eigen::RowVectorXf between(const Eigen::RowVectorXf& a, const Eigen::RowVectorXf& b, float share) {
  Eigen::RowVectorXf row(a.size());
  for (int j = 0; j < kJointCount; ++j) {
    const Eigen::Vector4f p = a.segment<4>(4 * j).transpose(), q = b.segment<4>(4 * j).transpose();
    row.segment<4>(4 * j) = ((1 - share) * p + (p.dot(q) < 0 ? -share : share) * q).transpose();
  }
  return row;
}

}  // namespace

WordsStyle::WordsStyle(std::shared_ptr<WordTranslator> translator)
    : translator_(std::move(translator)), joints_(translator_->joints()) {
  reset();
}

void WordsStyle::reset() {
  waiting_.clear();
  source_.clear(), sum_.clear(), count_.clear(), settled_.clear();
  now_ = last_at_ = 0;
  rows_ = source_first_ = sum_first_ = settled_first_ = settled_end_ = 0;
  started_ = false;
}

void WordsStyle::push(const StyleFrame& frame) {
  const Eigen::RowVectorXf row = word_row(frame.pose.local);
  if (started_) now_ += static_cast<double>(frame.dt);
  for (; static_cast<double>(rows_) <= now_ * static_cast<double>(kWordRate) + 1e-6; ++rows_) {
    const double at = static_cast<double>(rows_) / static_cast<double>(kWordRate);
    const double span = now_ - last_at_;
    const bool is_between = started_ && span > 1e-9;
    add_row(is_between
                ? between(last_row_, row, static_cast<float>(std::clamp((at - last_at_) / span, 0.0, 1.0)))
                : row);
  }
  last_row_ = row, last_at_ = now_;
  started_ = true;
  waiting_.push_back({frame.pose.local, now_});
}

void WordsStyle::add_row(const Eigen::RowVectorXf& row) {
  source_.push_back(row);
  if (ssize(source_) >= kWordFrames) translate();
}

/// The word at the front. The rows that no later word covers are settled.
void WordsStyle::translate() {
  WordRows word(kWordFrames, kWordNumbers);
  for (int t = 0; t < kWordFrames; ++t) word.row(t) = source_[static_cast<size_t>(t)];
  WordRows made = translator_->translate(word);
  const bool is_good = made.rows() == kWordFrames && made.cols() == kWordNumbers && made.allFinite();
  if (!is_good) {  // the word stays as it is
    log::warn_once("the style's network gave numbers that are not finite");
    made = word;
  }
  for (int j = 0; j < kJointCount; ++j)
    if (!joints_[static_cast<size_t>(j)]) made.middleCols(4 * j, 4) = word.middleCols(4 * j, 4);
  const auto first = static_cast<size_t>(source_first_ - sum_first_);
  for (size_t t = 0; t < kWordFrames; ++t) {
    if (first + t >= sum_.size()) {
      sum_.push_back(Eigen::RowVectorXf::Zero(kWordNumbers));
      count_.push_back(0);
    }
    sum_[first + t] += made.row(static_cast<Eigen::Index>(t));
    count_[first + t] += 1;
  }
  source_.erase(source_.begin(), source_.begin() + kWordStride);
  source_first_ += kWordStride;
  settle(source_first_);
}

/// Rows up to `end`, whose words are all known; those behind are the filters' other side.
void WordsStyle::settle(Eigen::Index end) {
  WordRows rows(ssize(sum_), kWordNumbers);
  for (size_t t = 0; t < sum_.size(); ++t)
    rows.row(static_cast<Eigen::Index>(t)) = sum_[t] / std::max(1.0f, count_[t]);
  remove_peaks(rows);
  smooth_rows(rows);
  for (; settled_end_ < end; ++settled_end_) settled_.push_back(rows.row(settled_end_ - sum_first_));
  while (sum_first_ + kContext < settled_end_) sum_.pop_front(), count_.pop_front(), ++sum_first_;
}

Eigen::RowVectorXf WordsStyle::styled_at(double row) const {
  const auto before =
      std::clamp<int64_t>(static_cast<int64_t>(std::floor(row + 1e-6)), settled_first_, settled_end_ - 1);
  const int64_t after = std::min(before + 1, settled_end_ - 1);
  const auto share = static_cast<float>(std::clamp(row - static_cast<double>(before), 0.0, 1.0));
  return between(settled_[static_cast<size_t>(before - settled_first_)],
                 settled_[static_cast<size_t>(after - settled_first_)], share);
}

std::optional<Rotations> WordsStyle::pop() {
  if (waiting_.empty()) return std::nullopt;
  const double row = waiting_.front().at * static_cast<double>(kWordRate);
  if (static_cast<int64_t>(std::ceil(row - 1e-6)) >= settled_end_) return std::nullopt;
  const Waiting next = std::move(waiting_.front());
  waiting_.pop_front();
  Rotations styled = rotations_of_row(styled_at(row), heading_of(next.local[Pelvis]));
  for (int j = 0; j < kJointCount; ++j)
    if (!joints_[static_cast<size_t>(j)]) styled[j] = next.local[j];
  styled = by_strength(next.local, styled, uprightness(next.local[Pelvis]));
  while (settled_first_ + 1 < static_cast<int64_t>(std::floor(row))) settled_.pop_front(), ++settled_first_;
  return styled;
}

void WordsStyle::finish() {
  if (!started_) return;
  // The last frame again until every row is settled, that of a last frame between two rows too.
  const int64_t wanted = rows_ + 1;
  while (settled_end_ < wanted) add_row(last_row_), ++rows_;
}

}  // namespace understudy
