// Shoes of many shapes, as a deformation of the points of feet and shins in T-pose. Joints stay where they
// are.
#pragma once

#include <array>
#include <vector>

#include "retarget/base/rng.hpp"
#include "retarget/body/body.hpp"

namespace understudy {

/// Metres for a foot 25 cm long; other feet have shoes of their size.
struct ShoeOptions {
  float sole = 0.015f;        ///< thickness
  float heel = 0;             ///< what the heel has beyond the sole
  float heel_width = 1;       ///< of the heel's lower end against its upper one
  bool wedge = false;         ///< the heel goes on under the arch
  float upper = 0.004f;       ///< thickness of what is around the foot
  float longer = 0.01f;       ///< beyond the toes
  float pointed = 0.2f;       ///< how much narrower the tip is than the foot, 0 .. 1
  float corner = 2.5f;        ///< exponent of the toe's outline from ahead: 2 is an ellipse, more is a box
  float toe_height = 0;       ///< least height of the toe box; 0: the foot's own
  float shaft = 0;            ///< height of a boot's shaft over the ankle, share of the shin; 0: a low shoe
  float shaft_width = 0.01f;  ///< of the shaft's air and leather
};

/// Socks, slippers, low shoes, heels up to 8 cm, boots up to the middle of the shin.
ShoeOptions random_shoe(Rng& rng);

/// A pair of shoes on the feet of one person.
class Shoes {
 public:
  Shoes(const ShapedBody& body, const ShoeOptions& options);
  /// Moves T-pose points [N, 3] of feet and shins onto the shoes; weights [N, 22] are their skin weights.
  void wear(Points& points, const RowMatrix& weights) const;
  /// Feet as high heels hold them: soles as they were, heels lifted, toes as they were.
  void lift_heels(Pose& pose) const;

 private:
  static constexpr int kSlices = 16;
  /// From heel to toe a foot is slices across, each as wide and as high as its skin.
  struct Slice {
    float middle = 0, half_width = 0, height = 0;
  };
  struct Foot {
    Vec3 forwards, sideways;  // horizontal, unit
    float heel, ball, tip;    // where they are along `forwards`
    float floor;              // y of the sole
    float size;               // against a foot of 25 cm
    Vec3 knee, ankle;
    std::array<Slice, kSlices> slices;
    Slice slice(float along) const;
  };
  static Foot measured(const ShapedBody& body, int side);
  Vec3 toe_box(const Foot& foot, const Vec3& own) const;
  Vec3 heel_and_sole(const Foot& foot, const Vec3& own) const;
  Vec3 shod(const Foot& foot, const Vec3& x, float shin) const;

  ShoeOptions options_;
  std::array<Foot, 2> feet_;
};

}  // namespace understudy
