// Paper 4's engine: words of a second are translated by a network, one after the other, and stitched.
#pragma once

#include <deque>
#include <memory>

#include "retarget/style/motion_words.hpp"
#include "retarget/style/pose_style.hpp"

namespace understudy {

/// Online: a frame comes a second later, when all words that it is in are translated. A source of another
/// rate is looked at 30 times a second. In the end what is left is a word that repeats the last frame. Memory
/// is constant.
class WordsStyle final : public PoseStyle {
 public:
  explicit WordsStyle(std::shared_ptr<WordTranslator> translator);
  void reset() override;
  void push(const StyleFrame& frame) override;
  std::optional<Rotations> pop() override;
  void finish() override;
  float lag_s() const override { return kWordFrames / kWordRate; }

 private:
  struct Waiting {
    Rotations local;
    double at = 0;  // seconds since the first
  };
  void add_row(const Eigen::RowVectorXf& row);
  void translate();
  void settle(Eigen::Index rows);
  Eigen::RowVectorXf styled_at(double row) const;

  std::shared_ptr<WordTranslator> translator_;
  std::array<bool, kJointCount> joints_;
  std::deque<Waiting> waiting_;
  double now_ = 0;
  bool started_ = false;
  Eigen::RowVectorXf last_row_;  // of the newest frame
  double last_at_ = 0;
  // Rows of the 30 a second: first_ is the number of the front one of each.
  std::deque<Eigen::RowVectorXf> source_;  // the word that comes next begins with the front one
  std::deque<Eigen::RowVectorXf>
      sum_;  // of translated words, not settled yet, and some before for the filters
  std::deque<float> count_;
  std::deque<Eigen::RowVectorXf> settled_;
  int64_t rows_ = 0, source_first_ = 0, sum_first_ = 0, settled_first_ = 0, settled_end_ = 0;
};

}  // namespace understudy
