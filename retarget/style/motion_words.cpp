#include "retarget/style/motion_words.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/math/time_filter.hpp"

namespace understudy {
namespace {

/// Of a digital filter: y_t = b0 x_t + b1 x_t-1 + b2 x_t-2 - a1 y_t-1 - a2 y_t-2.
struct Biquad {
  double b0, b1, b2, a1, a2;
};

Biquad butterworth(double hertz, double rate) {
  const double k = std::tan(static_cast<double>(kPi) * hertz / rate),
               norm = 1 / (1 + std::sqrt(2.0) * k + k * k);
  return {k * k * norm, 2 * k * k * norm, k * k * norm, 2 * (k * k - 1) * norm,
          (1 - std::sqrt(2.0) * k + k * k) * norm};
}

/// Begins as if the first value had always been there.
void run(const Biquad& f, std::vector<double>& x) {
  double x1 = x[0], x2 = x[0], y1 = x[0], y2 = x[0];
  for (double& value : x) {
    const double y = f.b0 * value + f.b1 * x1 + f.b2 * x2 - f.a1 * y1 - f.a2 * y2;
    x2 = x1, x1 = value, y2 = y1, y1 = y;
    value = y;
  }
}

}  // namespace

std::vector<Rotations> at_word_rate(const std::vector<Rotations>& local, double fps, double smooth_frames) {
  US_CHECK(!local.empty() && fps > 0, "a motion without frames, or without a rate, has no words");
  const auto last = static_cast<double>(local.size() - 1);
  std::vector<size_t> frames;
  for (double at = 0; at <= last + 1e-6; at += fps / static_cast<double>(kWordRate))
    frames.push_back(static_cast<size_t>(std::min(last, at + 0.5)));
  const auto strength =
      static_cast<float>(smooth_frames / static_cast<double>(kWordRate * kSmoothestSeconds));
  const std::vector<float> half = half_gaussian(std::min(1.0f, strength), kWordRate);
  std::vector<Rotations> made(frames.size());
  std::vector<Mat3> turns(frames.size());
  for (int j = 0; j < kJointCount; ++j) {
    for (size_t t = 0; t < frames.size(); ++t) turns[t] = local[frames[t]][j];
    const std::vector<Mat3> smooth = filtered_rotations(turns, half);
    for (size_t t = 0; t < frames.size(); ++t) made[t][j] = smooth[t];
  }
  return made;
}

Eigen::RowVectorXf word_row(const Rotations& local) {
  Eigen::RowVectorXf row(kWordNumbers);
  for (int j = 0; j < kJointCount; ++j) {
    const Mat3 turn =
        j == Pelvis ? Mat3(rotation_about_y(heading_of(local[j])).transpose() * local[j]) : local[j];
    const Eigen::Quaternionf q(turn);
    const float sign = q.w() < 0 ? -1.0f : 1.0f;
    row.segment<4>(4 * j) << sign * q.w(), sign * q.x(), sign * q.y(), sign * q.z();
  }
  return row;
}

Rotations rotations_of_row(const Eigen::RowVectorXf& row, float heading) {
  US_CHECK(row.size() == kWordNumbers && row.allFinite(), "a word's numbers are not finite");
  Rotations local;
  for (int j = 0; j < kJointCount; ++j) {
    Eigen::Quaternionf q(row[4 * j], row[4 * j + 1], row[4 * j + 2], row[4 * j + 3]);
    if (q.norm() < 1e-6f) q.setIdentity();
    local[j] = q.normalized().toRotationMatrix();
  }
  local[Pelvis] = rotation_about_y(heading) * local[Pelvis];
  return local;
}

std::vector<WordRows> cut_words(const WordRows& rows) {
  US_CHECK(rows.rows() > 0, "words are cut from frames, and there is none");
  std::vector<WordRows> words;
  for (Eigen::Index first = 0; first == 0 || first + kWordFrames - kWordStride < rows.rows();
       first += kWordStride) {
    WordRows& word = words.emplace_back(kWordFrames, rows.cols());
    for (Eigen::Index t = 0; t < kWordFrames; ++t)
      word.row(t) = rows.row(std::min(first + t, rows.rows() - 1));
  }
  return words;
}

void remove_peaks(WordRows& rows, float most) {
  const WordRows was = rows;
  for (Eigen::Index t = 2; t + 2 < rows.rows(); ++t)
    for (Eigen::Index c = 0; c < rows.cols(); ++c) {
      std::array<float, 5> around{};
      for (Eigen::Index k = 0; k < 5; ++k) around[static_cast<size_t>(k)] = was(t - 2 + k, c);
      std::nth_element(around.begin(), around.begin() + 2, around.end());
      if (std::abs(was(t, c) - around[2]) > most) rows(t, c) = around[2];
    }
}

void smooth_rows(WordRows& rows, float hertz, float rate) {
  if (rows.rows() < 3) return;
  const Biquad filter = butterworth(static_cast<double>(hertz), static_cast<double>(rate));
  std::vector<double> column(static_cast<size_t>(rows.rows()));
  for (Eigen::Index c = 0; c < rows.cols(); ++c) {
    for (size_t t = 0; t < column.size(); ++t)
      column[t] = static_cast<double>(rows(static_cast<Eigen::Index>(t), c));
    for (int way = 0; way < 2; ++way) {
      run(filter, column);
      std::reverse(column.begin(), column.end());
    }
    for (size_t t = 0; t < column.size(); ++t)
      rows(static_cast<Eigen::Index>(t), c) = static_cast<float>(column[t]);
  }
}

}  // namespace understudy
