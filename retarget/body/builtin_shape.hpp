// The shape of the built-in person as an implicit solid: lofts and blobs placed by anatomy, smoothly joined.
#pragma once

#include <vector>

#include "retarget/body/builtin_person.hpp"
#include "retarget/geometry/implicit_surface.hpp"

namespace understudy {

/// The parts of the body that skin weights tell apart. Of arms and legs only the left ones exist; x -> |x|.
enum class Part : int { Trunk, Leg, Arm, Head };
constexpr int kPartCount = 4;

/// How this person differs from the template (a mean adult, 1.647 m tall): factors on lengths and
/// thicknesses.
struct Proportions {
  float female = 0, child = 0, old = 0, fat = 0;  ///< 0..1; fat is girth - 1
  float leg = 1, arm = 1, trunk = 1, head = 1, shoulders = 1, hips = 1, foot = 1, hand = 1;
  float stature = 1.7f;
};
Proportions proportions(const PersonOptions& options);

/// The regions that stretch differently. Maps template coordinates to the person's (before the scale to
/// stature).
enum class Region : int { Trunk, Leg, Foot, Arm, Hand, Head };
struct BodyMap {
  explicit BodyMap(const Proportions& p) : p_(p) {}
  Vec3 operator()(Region region, const Vec3& q) const;
  /// Factor on the radii of a blob of this region.
  float thickness(Region region) const;

 private:
  Proportions p_;
};

/// The template's joints carried over to the person, before the scale to stature.
Joints mapped_joints(const Proportions& p);

/// A tube along one axis with asymmetric super-elliptic sections, tabulated densely.
class Loft {
 public:
  /// One section: centre (u, v) and radii of the two section axes; v has one radius to each side.
  struct Section {
    float t, u, v, ru, v_plus, v_minus;
  };
  /// axis 0 (x): u = z, v = y. axis 1 (y): u = x, v = z. axis 2 (z): u = x, v = y. The ends are rounded off
  /// over `cap` metres; exponent 2 is an ellipse, more is squarer.
  Loft(int axis, std::vector<Section> sections, float cap_low, float cap_high, float exponent);
  float value(const Vec3& p) const;

 private:
  Section at(float t) const;
  static constexpr int kSamples = 192;
  int axis_;
  float low_, high_, exponent_;
  std::vector<Section> table_;
};

/// One solid and how it joins what came before it in its part.
struct Primitive {
  enum class Kind { Loft, Ellipsoid, Cone } kind;
  enum class Join { Add, Cut } join = Join::Add;
  float blend = 0.01f;    ///< metres over which it melts into the part
  int loft = -1;          ///< Kind::Loft
  Vec3 a = Vec3::Zero();  ///< centre, or first end of the cone
  Vec3 b = Vec3::Zero();  ///< radii, or second end
  float ra = 0, rb = 0;   ///< radii of the cone's ends
  Mat3 to_local = Mat3::Identity();
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< box that holds it
};

class PersonShape {
 public:
  explicit PersonShape(const PersonOptions& options);
  /// About the distance to the skin, x >= 0; metres of the person before `scale`.
  float value(const Vec3& p) const;
  float part_value(Part part, const Vec3& p) const;
  /// Where the surface needs finer triangles, 1 elsewhere.
  float detail(const Vec3& p) const;
  Vec3 warp(const Vec3& grid) const;
  ImplicitSolid solid() const;                      ///< refers to this object
  const Joints& joints() const { return joints_; }  ///< before `scale`
  /// To the person's stature.
  float scale() const { return who_.stature / (crown_ - sole_); }

 private:
  void add_trunk();
  void add_breasts_and_seat();
  void add_leg();
  void add_foot();
  void add_arm();
  void add_hand();
  void add_head();
  void add_face();

  void loft(Region region, int axis, const std::vector<Loft::Section>& sections,
            const Eigen::Array4f& caps_exponent_blend);
  void ellipsoid(Region region, const Vec3& centre, const Vec3& radii, float blend,
                 const Vec3& turn_deg = Vec3::Zero(), Primitive::Join join = Primitive::Join::Add);
  void cone(Region region, const Vec3& a, const Vec3& b, const Eigen::Array3f& radii_blend);
  float primitive_value(const Primitive& primitive, const Vec3& p) const;

  Proportions who_;
  BodyMap map_;
  Joints joints_;
  float sole_ = 0, crown_ = 0;
  std::vector<Loft> lofts_;
  struct PartShape {
    std::vector<Primitive> primitives;
    Vec3 low = Vec3::Constant(1e9f), high = Vec3::Constant(-1e9f);  ///< box that holds it
  };
  std::array<PartShape, kPartCount> parts_;
  void add(Region region, const Primitive& primitive);
  float part_bound(Part part, const Vec3& p) const;
};

}  // namespace understudy
