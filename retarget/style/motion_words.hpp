// Motion words of paper 4, section 3.2: one second of a motion as a small picture of rotations; cut, and what
// they go through when they are stitched.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

constexpr int kWordFrames = 30, kWordStride = 10;  ///< one second, a third of one
constexpr float kWordRate = 30;                    ///< frames/s; the paper has 60
constexpr int kWordNumbers = 4 * kJointCount;      ///< of a frame: a quaternion (w, x, y, z; w >= 0) a joint
/// [frames, kWordNumbers]. A word has kWordFrames of them.
using WordRows = RowMatrix;

/// A motion of any rate at kWordRate (the nearest frames), smoothed by a Gaussian of `smooth_frames` of
/// those. Throws Error where it has no frame or no rate.
std::vector<Rotations> at_word_rate(const std::vector<Rotations>& local, double fps, double smooth_frames);

/// Local rotations as a row; the pelvis' without its heading.
Eigen::RowVectorXf word_row(const Rotations& local);
/// The reverse, with this heading (heading_of the pelvis).
Rotations rotations_of_row(const Eigen::RowVectorXf& row, float heading);

/// The overall least and most number of a domain: words are brought to -1 .. 1 by them (paper, section 3.2).
struct WordRange {
  float least = -1, most = 1;
  WordRows to_unit(const WordRows& rows) const {
    return ((rows.array() - least) * (2 / (most - least)) - 1).matrix();
  }
  WordRows from_unit(const WordRows& rows) const {
    return ((rows.array() + 1) * ((most - least) / 2) + least).matrix();
  }
};

/// Words, of one row at least, kWordStride frames apart that cover all frames; the last repeats the last
/// frame where it is too long.
std::vector<WordRows> cut_words(const WordRows& rows);
// What the stitched rows go through (section 3.5). The paper names no peak removal filter; this is Hampel's.

/// A number that is further than `most` from the median of the five frames around it becomes that median.
void remove_peaks(WordRows& rows, float most = 0.1f);
/// Butterworth low-pass of order 2, forwards and backwards.
void smooth_rows(WordRows& rows, float hertz = 7, float rate = kWordRate);

/// Makes words of one domain those of another.
class WordTranslator {
 public:
  virtual ~WordTranslator() = default;
  /// A word of rows as word_row() makes them, in the other manner; quaternions need not have unit length.
  virtual WordRows translate(const WordRows& word) = 0;
  /// The joints that it knows of; others stay as they are.
  virtual std::array<bool, kJointCount> joints() const = 0;
};

}  // namespace understudy
