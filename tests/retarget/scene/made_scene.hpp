// Scenes of people and things, made by code, with the truth beside them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "retarget/body/body.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy::test {

constexpr int kGround = 0;  ///< owner of what is nobody's; people are 1 and up

/// A scan, whose each point is, and the true joints of those who are there.
struct MadeScan {
  Mesh scan;
  std::vector<int> owner;
  std::vector<Joints> joints;
};

/// Somebody who performs "walk" or "dance", from a place of the motion on, moved and turned.
struct Actor {
  std::string motion = "walk";
  float stature = 1.7f;
  Vec3 place = Vec3::Zero();
  float turn_deg = 0;
  int first = 0;          ///< frame of the motion in which the scene begins
  bool is_still = false;  ///< stays in it: a mannequin
  int points = 4000;
  Vec3 color = Vec3::Constant(0.5f);
  int enters = 0, leaves = 1 << 30;  ///< is there from frame .. to before frame
  std::optional<float> mirror_x;     ///< an image of them in an upright mirror, the plane x = this
};

class MadeScene {
 public:
  explicit MadeScene(std::vector<Actor> actors);
  /// A level rectangle; noise is its standard deviation, tilt in degrees about z through the middle.
  void add_ground(float half_m, int points, float noise_m = 0.005f, float tilt_deg = 0);
  void add_box(const Vec3& centre, const Vec3& half, int points);
  /// Points that somebody else made; they are the ground's.
  void add_points(Points points);
  void one_camera(const Vec3& eye) { eye_ = eye; }

  MadeScan frame(int t) const;

 private:
  struct Performer {
    Actor actor;
    ShapedBody body;
    Motion motion;
  };
  std::vector<Performer> performers_;
  std::vector<std::function<Points(Rng&)>> things_;
  std::optional<Vec3> eye_;
};

/// Sees the truth: the skeleton that explains most of the points, as sure as they are near its bones and its
/// bones near them. Counts its looks.
class KnowingExtractor final : public SkeletonExtractor {
 public:
  explicit KnowingExtractor(const std::vector<Joints>& truth) : truth_(truth) {}
  Extraction extract(const Mesh& scan) override;
  std::string name() const override { return "knowing"; }
  int looks = 0;

 private:
  const std::vector<Joints>& truth_;
};

}  // namespace understudy::test
