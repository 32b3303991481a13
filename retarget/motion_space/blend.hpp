// Blends: what lies between movements that were captured (paper 2, section 4.5).
#pragma once

#include <vector>

#include "retarget/pipeline/motion_coder.hpp"

namespace understudy {

/// A movement that is blended with others: of one person, from their first pose, above the origin and facing
/// +z (movement_of).
struct BlendInput {
  TimedPoses movement;
  Joints rest = Joints::Zero();  ///< T-pose joints of who moves, metres
};

/// What was made of them.
struct Blended {
  TimedPoses movement;               ///< evenly many poses, above the origin and facing +z at first
  std::vector<float> doubt_m;        ///< of each pose, see Blend::at
  std::vector<Standing> standing{};  ///< of each pose
  Joints rest = Joints::Zero();      ///< of who moves: as far between the others as the movement is
  float decoded_s = 0;               ///< how long the coder by itself would have it take
};

/// Two to four movements that were coded, each of which is a corner of a line, a triangle or a tetrahedron.
/// One thread at a time.
class Blend {
 public:
  static constexpr int kSamples = 100;  ///< poses of a blend, as the paper's sequences have
  static constexpr size_t kFewest = 2, kMost = 4;

  /// Codes them. `coder` must outlive this. Throws Error where there are fewer or more of them, or one cannot
  /// be coded.
  Blend(MotionCoder& coder, std::vector<BlendInput> inputs);

  /// The movement at these weights, of each input one: made to sum to 1. What is decoded from the weighted
  /// mean of the codes, turned by the weighted mean of what each input differs from its own decoded form: an
  /// input that has all of the weight is given as it was captured. Its duration is the weighted mean of
  /// theirs. A foot stands where it stands in more than half of them, by weight; the legs of what lies
  /// between are placed so that it does not slide.
  /// The doubt of a pose, metres: with e_i the mean distance of joints between input i and its decoded form,
  /// d_ij that between the inputs i and j, all about the pelvis and at the same share of the time,
  ///   2 (1 - sum_i w_i^2) sum_i w_i e_i + sum_(i<j) w_i w_j d_ij,
  /// and not below kLeastDoubt_m: an input that is given as it was is sampled anew all the same.
  /// Throws Error for other weights than one each, all finite, none negative, not all zero.
  Blended at(const std::vector<float>& weights) const;
  /// How far apart two inputs are, metres: the mean of d_ij.
  float distance(size_t i, size_t j) const;
  size_t size() const { return inputs_.size(); }
  static constexpr float kLeastDoubt_m = 0.005f;

 private:
  /// An input at kSamples moments.
  struct Corner {
    std::vector<float> code;
    std::vector<Pose> captured, decoded;
    std::vector<float> share;    // of its time, of each decoded pose
    std::vector<float> error_m;  // of the decoded poses
    std::vector<Standing> standing;
    float duration = 0, leg = 1;
  };
  Corner corner_of(const BlendInput& input) const;
  Pose bent(Pose decoded, int k, const std::vector<float>& weights, float leg) const;
  float doubt_at(int k, const std::vector<float>& weights) const;

  MotionCoder& coder_;
  std::vector<BlendInput> inputs_;
  std::vector<Corner> corners_;
  std::vector<std::vector<float>> apart_m_;  // of each pair i < j at each moment
};

/// The weights of `steps` blends, evenly spread from the first of `count` inputs to the last: along the line
/// between two, of more along the edges from each to the next. Throws Error for fewer than two steps.
std::vector<std::vector<float>> weights_along(size_t count, int steps);

/// A movement as it is played: `cycles` times one after the other, each from where the one before came to;
/// several close the seam between their ends over the whole cycle. Feet that stand are held
/// (hold_standing). Throws Error for a rate outside 1 .. 1000, and for fewer than 1 or more than 1,000
/// cycles.
Motion played(const Blended& blended, float fps, int cycles = 1);

/// Which foot strides first: by how far left and right thigh swing against each other in the course of one
/// cycle. Radians; positive: the left one, 0: nobody steps.
float left_lead(const TimedPoses& movement);
/// Of less than this it is not told which foot leads, radians.
constexpr float kLeastLead = 0.1f;

/// The same movement of the person in a mirror.
TimedPoses mirrored(TimedPoses movement);
Joints mirrored(const Joints& rest);

}  // namespace understudy
