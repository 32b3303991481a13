#include "retarget/body/builtin_shape.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/math/segment.hpp"
#include "retarget/math/smooth_step.hpp"

namespace understudy {
namespace {

struct TemplateJoint {
  Region region;
  float x, y, z;
};
constexpr std::array<TemplateJoint, kJointCount> kTemplateJoints = {{
    {Region::Trunk, 0, 0, 0},               // Pelvis
    {Region::Leg, .101f, -.015f, -.006f},   // LeftHip
    {Region::Leg, -.101f, -.015f, -.006f},  // RightHip
    {Region::Trunk, 0, .071f, -.036f},      // Spine1
    {Region::Leg, .136f, -.405f, .002f},    // LeftKnee
    {Region::Leg, -.136f, -.405f, .002f},   // RightKnee
    {Region::Trunk, 0, .137f, -.023f},      // Spine2
    {Region::Leg, .150f, -.810f, -.015f},   // LeftAnkle
    {Region::Leg, -.150f, -.810f, -.015f},  // RightAnkle
    {Region::Trunk, 0, .213f, -.023f},      // Spine3
    {Region::Foot, .170f, -.866f, .099f},   // LeftFoot
    {Region::Foot, -.170f, -.866f, .099f},  // RightFoot
    {Region::Trunk, 0, .523f, -.003f},      // Neck
    {Region::Trunk, .022f, .454f, .014f},   // LeftCollar
    {Region::Trunk, -.022f, .454f, .014f},  // RightCollar
    {Region::Head, 0, .620f, .031f},        // Head
    {Region::Arm, .167f, .462f, .008f},     // LeftShoulder
    {Region::Arm, -.167f, .462f, .008f},    // RightShoulder
    {Region::Arm, .407f, .462f, .008f},     // LeftElbow
    {Region::Arm, -.407f, .462f, .008f},    // RightElbow
    {Region::Arm, .640f, .462f, .008f},     // LeftWrist
    {Region::Arm, -.640f, .462f, .008f},    // RightWrist
}};
constexpr float kTemplateSole = -.879f, kTemplateCrown = .768f;

float mix(float a, float b, float t) {
  return a + (b - a) * t;
}
float ramp(float x, float from, float to) {
  return std::clamp((x - from) / (to - from), 0.0f, 1.0f);
}
/// Smooth minimum, polynomial: melts over `k` metres.
float smooth_min(float a, float b, float k) {
  const float h = std::max(k - std::abs(a - b), 0.0f) / k;
  return std::min(a, b) - h * h * k * 0.25f;
}

float ellipsoid_distance(const Vec3& p, const Vec3& radii) {
  const float k0 = p.cwiseQuotient(radii).norm();
  const float k1 = p.cwiseQuotient(radii.cwiseProduct(radii)).norm();
  return k1 < 1e-6f ? -radii.minCoeff() : k0 * (k0 - 1) / k1;
}

/// A capsule whose radius changes evenly from one end to the other.
float cone_distance(const Vec3& p, const Primitive& c) {
  const float s = along_segment(p, c.a, c.b);
  return (p - c.a - s * (c.b - c.a)).norm() - mix(c.ra, c.rb, s);
}

Vec3 template_joint(int j) {
  return {kTemplateJoints[j].x, kTemplateJoints[j].y, kTemplateJoints[j].z};
}

Part part_of(Region region) {
  constexpr Part kParts[] = {Part::Trunk, Part::Leg, Part::Leg, Part::Arm, Part::Arm, Part::Head};
  return kParts[static_cast<int>(region)];
}

float box_distance(const Vec3& p, const Vec3& low, const Vec3& high) {
  return (low - p).cwiseMax(p - high).cwiseMax(0.0f).norm();
}

}  // namespace

// ---- proportions

Proportions proportions(const PersonOptions& o) {
  const auto in = [](float v, float low, float high, const char* name) {
    US_CHECK(v >= low && v <= high, "a person's ", name, " is ", v, ", outside ", low, " to ", high);
  };
  in(o.stature, 0.6f, 2.5f, "stature");
  in(o.girth, 0.75f, 1.8f, "girth");
  in(o.sex, 0, 1, "sex");
  in(o.age, 2, 100, "age");

  Proportions p;
  p.child = ramp(o.age, 18, 2);
  p.old = ramp(o.age, 50, 90);
  p.female = o.sex * smooth_step(7, 15, o.age);
  p.fat = o.girth - 1;
  const float c = p.child;
  p.head = 1 + 0.45f * std::pow(c, 1.4f);
  p.leg = (1 - 0.22f * c) * mix(1, 1.02f, p.female);
  p.arm = (1 - 0.13f * c) * mix(1.01f, 0.96f, p.female);
  p.trunk = 1 - 0.05f * p.old;
  p.shoulders = (1 - 0.10f * c) * mix(1.04f, 0.93f, p.female);
  p.hips = (1 - 0.12f * c) * mix(0.98f, 1.04f, p.female);
  p.foot = (1 - 0.08f * c) * mix(1.02f, 0.93f, p.female);
  p.hand = (1 - 0.12f * c) * mix(1.03f, 0.93f, p.female);
  p.stature = o.stature;
  return p;
}

Vec3 BodyMap::operator()(Region region, const Vec3& q) const {
  const auto around = [&](Joint joint, Region frame, float scale) {
    const Vec3 centre = template_joint(joint);
    return Vec3((*this)(frame, centre) + scale * (q - centre));
  };
  switch (region) {
    case Region::Trunk: {
      const float width = mix(p_.hips, p_.shoulders, smooth_step(0.05f, 0.40f, q.y()));
      return Vec3(q.x() * width, q.y() > 0 ? q.y() * p_.trunk : q.y(), q.z());
    }
    case Region::Leg: {
      const float x = .101f * p_.hips + (q.x() - .101f) * (q.x() > .101f ? p_.leg : 1.0f);
      return Vec3(x, q.y() > -.015f ? q.y() : -.015f + (q.y() + .015f) * p_.leg, q.z());
    }
    case Region::Foot:
      return around(LeftAnkle, Region::Leg, p_.foot);
    case Region::Arm: {
      const float x = q.x() < .167f ? q.x() * p_.shoulders : .167f * p_.shoulders + (q.x() - .167f) * p_.arm;
      return Vec3(x, .462f * p_.trunk + (q.y() - .462f), q.z());
    }
    case Region::Hand:
      return around(LeftWrist, Region::Arm, p_.hand);
    case Region::Head:
      return Vec3(q.x(), q.y() - .523f, q.z()) * p_.head + Vec3(0, .523f * p_.trunk, 0);
  }
  return q;
}

float BodyMap::thickness(Region region) const {
  switch (region) {
    case Region::Foot:
      return p_.foot;
    case Region::Hand:
      return p_.hand;
    case Region::Head:
      return p_.head;
    default:
      return 1;
  }
}

Joints mapped_joints(const Proportions& p) {
  const BodyMap map(p);
  Joints joints;
  for (int j = 0; j < kJointCount; ++j) {
    Vec3 q = template_joint(j);
    const float side = q.x() < 0 ? -1.0f : 1.0f;
    q.x() = std::abs(q.x());
    const Vec3 mapped = map(kTemplateJoints[j].region, q);
    joints.row(j) << side * mapped.x(), mapped.y(), mapped.z();
  }
  return joints;
}

// ---- lofts

Loft::Loft(int axis, std::vector<Section> s, float cap_low, float cap_high, float exponent)
    : axis_(axis), low_(s.front().t), high_(s.back().t), exponent_(exponent) {
  const auto field = [&s](int i, int k) { return (&s[i].t)[k]; };
  const int last = s.size() - 1;
  const auto slope = [&](int i, int k) {
    const int a = std::max(i - 1, 0), b = std::min(i + 1, last);
    return (field(b, k) - field(a, k)) / (s[b].t - s[a].t);
  };
  int i = 0;
  for (int n = 0; n <= kSamples; ++n) {
    const float t = low_ + (high_ - low_) * static_cast<float>(n) / kSamples;
    while (i + 1 < last && t > s[i + 1].t) ++i;
    const float d = s[i + 1].t - s[i].t, x = (t - s[i].t) / d, x2 = x * x, x3 = x2 * x;
    Section section{};
    section.t = t;
    for (int k = 1; k < 6; ++k)  // cubic Hermite
      (&section.t)[k] = (2 * x3 - 3 * x2 + 1) * field(i, k) + (x3 - 2 * x2 + x) * d * slope(i, k) +
                        (3 * x2 - 2 * x3) * field(i + 1, k) + (x3 - x2) * d * slope(i + 1, k);
    const auto rounding = [](float depth, float cap) {
      const float r = 1 - std::min(depth / cap, 1.0f);
      return cap <= 0 ? 1.0f : std::sqrt(std::max(1 - r * r, 0.0f));
    };
    const float shrink = rounding(t - low_, cap_low) * rounding(high_ - t, cap_high);
    section.ru = std::max(section.ru * shrink, 1e-4f);
    section.v_plus = std::max(section.v_plus * shrink, 1e-4f);
    section.v_minus = std::max(section.v_minus * shrink, 1e-4f);
    table_.push_back(section);
  }
}

Loft::Section Loft::at(float t) const {
  const float x = std::clamp((t - low_) / (high_ - low_), 0.0f, 1.0f) * kSamples;
  const int i = std::min(static_cast<int>(x), kSamples - 1);
  const float s = x - static_cast<float>(i);
  const Section &a = table_[i], &b = table_[i + 1];
  return {t,
          mix(a.u, b.u, s),
          mix(a.v, b.v, s),
          mix(a.ru, b.ru, s),
          mix(a.v_plus, b.v_plus, s),
          mix(a.v_minus, b.v_minus, s)};
}

float Loft::value(const Vec3& p) const {
  constexpr int kAxes[3][2] = {{2, 1}, {0, 2}, {0, 1}};
  const float t = p[axis_];
  const Section s = at(t);
  const float u = p[kAxes[axis_][0]] - s.u, v = p[kAxes[axis_][1]] - s.v;
  const float rv = v > 0 ? s.v_plus : s.v_minus;
  const float r = std::sqrt(u * u + v * v);
  const float a = std::abs(u) / s.ru, b = std::abs(v) / rv;
  const float rho = exponent_ == 2 ? std::sqrt(a * a + b * b)
                                   : std::pow(std::pow(a, exponent_) + std::pow(b, exponent_), 1 / exponent_);
  // along the ray from the centre
  const float radial = rho < 1e-4f ? -std::min(s.ru, rv) : r * (1 - 1 / rho);
  const float excess = std::max({low_ - t, t - high_, 0.0f});
  if (excess == 0) return radial;
  return std::sqrt(excess * excess + std::max(radial, 0.0f) * std::max(radial, 0.0f));
}

// ---- the person

PersonShape::PersonShape(const PersonOptions& options)
    : who_(proportions(options)), map_(who_), joints_(mapped_joints(who_)) {
  sole_ = map_(Region::Foot, Vec3(.15f, kTemplateSole, 0)).y();
  crown_ = map_(Region::Head, Vec3(0, kTemplateCrown, 0)).y();
  add_trunk();
  add_breasts_and_seat();
  add_leg();
  add_foot();
  add_arm();
  add_hand();
  add_head();
  add_face();
}

void PersonShape::loft(Region region, int axis, const std::vector<Loft::Section>& sections,
                       const Eigen::Array4f& caps_exponent_blend) {
  constexpr int kAxes[3][2] = {{2, 1}, {0, 2}, {0, 1}};
  const float thick = map_.thickness(region);
  std::vector<Loft::Section> mapped;
  Primitive primitive{Primitive::Kind::Loft};
  primitive.low.setConstant(1e9f);
  primitive.high.setConstant(-1e9f);
  for (const Loft::Section& s : sections) {
    Vec3 q;
    q[axis] = s.t, q[kAxes[axis][0]] = s.u, q[kAxes[axis][1]] = s.v;
    const Vec3 p = map_(region, q);
    mapped.push_back(
        {p[axis], p[kAxes[axis][0]], p[kAxes[axis][1]], s.ru * thick, s.v_plus * thick, s.v_minus * thick});
    Vec3 reach = Vec3::Zero();
    reach[kAxes[axis][0]] = 1.1f * s.ru * thick;
    reach[kAxes[axis][1]] = 1.1f * std::max(s.v_plus, s.v_minus) * thick;
    primitive.low = primitive.low.cwiseMin(p - reach);
    primitive.high = primitive.high.cwiseMax(p + reach);
  }
  if (mapped.front().t > mapped.back().t) std::reverse(mapped.begin(), mapped.end());
  primitive.blend = caps_exponent_blend[3];
  primitive.loft = lofts_.size();
  lofts_.emplace_back(axis, std::move(mapped), caps_exponent_blend[0] * thick, caps_exponent_blend[1] * thick,
                      caps_exponent_blend[2]);
  add(region, primitive);
}

void PersonShape::ellipsoid(Region region, const Vec3& centre, const Vec3& radii, float blend,
                            const Vec3& turn_deg, Primitive::Join join) {
  const float thick = map_.thickness(region);
  Primitive primitive{Primitive::Kind::Ellipsoid, join, blend * thick};
  primitive.a = map_(region, centre);
  primitive.b = radii * thick;
  primitive.to_local = rotation_from_axis_angle(turn_deg * (kPi / 180)).transpose();
  const Vec3 reach = Vec3::Constant(primitive.b.maxCoeff());
  primitive.low = primitive.a - reach, primitive.high = primitive.a + reach;
  add(region, primitive);
}

void PersonShape::cone(Region region, const Vec3& a, const Vec3& b, const Eigen::Array3f& radii_blend) {
  const float thick = map_.thickness(region);
  Primitive primitive{Primitive::Kind::Cone};
  primitive.blend = radii_blend[2] * thick;
  primitive.a = map_(region, a), primitive.b = map_(region, b);
  primitive.ra = radii_blend[0] * thick, primitive.rb = radii_blend[1] * thick;
  const Vec3 reach = Vec3::Constant(std::max(primitive.ra, primitive.rb));
  primitive.low = primitive.a.cwiseMin(primitive.b) - reach;
  primitive.high = primitive.a.cwiseMax(primitive.b) + reach;
  add(region, primitive);
}

void PersonShape::add_trunk() {
  struct Row {
    float y, m_side, m_front, m_back, f_side, f_front, f_back, fat_side, fat_front, fat_back;
  };
  constexpr Row kRows[] = {{-.115f, .040f, .030f, .050f, .040f, .030f, .050f, .1f, .1f, .2f},
                           {-.080f, .095f, .066f, .088f, .098f, .064f, .092f, .3f, .2f, .3f},
                           {-.040f, .150f, .084f, .102f, .158f, .082f, .112f, .65f, .4f, .5f},
                           {.000f, .161f, .094f, .108f, .174f, .092f, .120f, .75f, .6f, .6f},
                           {.050f, .156f, .101f, .098f, .168f, .100f, .104f, .8f, 1.f, .55f},
                           {.100f, .146f, .104f, .088f, .149f, .104f, .087f, .85f, 1.3f, .6f},
                           {.160f, .136f, .103f, .082f, .123f, .099f, .078f, .95f, 1.3f, .7f},
                           {.220f, .137f, .103f, .086f, .118f, .095f, .081f, .9f, 1.1f, .6f},
                           {.280f, .150f, .106f, .096f, .128f, .096f, .090f, .6f, .7f, .5f},
                           {.340f, .168f, .108f, .106f, .141f, .096f, .099f, .5f, .5f, .5f},
                           {.400f, .170f, .095f, .108f, .143f, .084f, .101f, .4f, .4f, .5f},
                           {.440f, .154f, .071f, .103f, .132f, .064f, .096f, .3f, .3f, .4f},
                           {.475f, .118f, .047f, .091f, .103f, .043f, .083f, .3f, .3f, .4f},
                           {.505f, .074f, .036f, .072f, .066f, .034f, .066f, .3f, .3f, .4f},
                           {.535f, .045f, .030f, .050f, .042f, .028f, .046f, .3f, .3f, .4f}};
  const float f = who_.female, fat = who_.fat;
  std::vector<Loft::Section> sections;
  for (const Row& r : kRows) {
    const float width = mix(who_.hips, who_.shoulders, smooth_step(0.05f, 0.40f, r.y));
    const float belly = smooth_step(0, .12f, r.y) * smooth_step(.30f, .18f, r.y);
    const float straight = 1 + 0.07f * who_.child * belly;  // a small child has no waist, but a belly
    const float side = mix(r.m_side, r.f_side, f) * width * straight * (1 + r.fat_side * fat);
    const float front = (mix(r.m_front, r.f_front, f) + (.010f * who_.child + .014f * who_.old) * belly) *
                        (1 + r.fat_front * fat);
    const float back = mix(r.m_back, r.f_back, f) * (1 + r.fat_back * fat) * (1 - .06f * who_.child);
    sections.push_back({r.y, 0, .020f, side, front, back});
  }
  loft(Region::Trunk, 1, sections, {.03f, .02f, 2.35f, .01f});
  // The slope from neck to shoulder, and the collar bones.
  const float m = 1 - f, child = who_.child;
  cone(Region::Trunk, {.018f, .535f, -.014f}, {.140f, .482f, -.010f},
       {.036f + .006f * m - .010f * child + .02f * fat, .026f + .004f * m + .012f * fat, .035f});
  cone(Region::Trunk, {.026f, .470f, .056f}, {.135f, .491f, .024f}, {.012f, .012f, .025f});
}

void PersonShape::add_breasts_and_seat() {
  const float f = who_.female, fat = who_.fat, m = (1 - f) * (1 - who_.child);
  const float breast = f * (1 + .6f * fat), sag = .018f * who_.old + .012f * std::max(fat, 0.0f);
  if (breast > .05f)
    ellipsoid(Region::Trunk, {.070f, .338f - sag, .082f + .05f * fat},
              Vec3(.052f, .050f, .054f) * (.55f + .45f * breast), .03f);
  if (m > .05f)  // chest muscle, flat
    ellipsoid(Region::Trunk, {.066f, .366f, .082f + .03f * fat}, Vec3(.060f, .040f, .032f) * (.6f + .4f * m),
              .035f, {0, 20, 0});
  const float seat = 1 + .5f * fat - .18f * who_.child - .10f * who_.old;
  ellipsoid(Region::Trunk, {.062f, -.030f, -.042f - .02f * fat},
            Vec3(.066f + .006f * f, .068f, .054f + .006f * f) * seat, .025f);
  if (fat > 0)  // the belly hangs forward
    ellipsoid(Region::Trunk, {0, .100f, .050f + .10f * fat}, Vec3(.110f, .095f, .080f) * (.75f + .6f * fat),
              .06f);
  ellipsoid(Region::Trunk, {0, .118f, .137f + .134f * fat}, {.010f, .013f, .014f}, .014f, Vec3::Zero(),
            Primitive::Join::Cut);
}

void PersonShape::add_leg() {
  struct Row {
    float y, x, z, side, front, back, fat;
  };
  constexpr Row kRows[] = {
      {.070f, .075f, .015f, .045f, .050f, .045f, .6f},    {.030f, .086f, .017f, .066f, .068f, .066f, .65f},
      {-.020f, .092f, .018f, .080f, .078f, .082f, .75f},  {-.080f, .097f, .018f, .085f, .080f, .086f, .75f},
      {-.140f, .102f, .018f, .080f, .078f, .080f, .7f},   {-.220f, .111f, .018f, .072f, .074f, .073f, .5f},
      {-.300f, .122f, .012f, .062f, .066f, .062f, .4f},   {-.360f, .131f, .004f, .054f, .058f, .055f, .3f},
      {-.405f, .136f, -.001f, .050f, .053f, .050f, .25f}, {-.450f, .138f, -.010f, .048f, .048f, .052f, .25f},
      {-.520f, .142f, -.020f, .053f, .045f, .060f, .3f},  {-.590f, .146f, -.022f, .050f, .043f, .057f, .3f},
      {-.670f, .149f, -.022f, .039f, .037f, .043f, .25f}, {-.740f, .150f, -.020f, .031f, .032f, .034f, .15f},
      {-.790f, .150f, -.018f, .031f, .033f, .036f, .1f},  {-.830f, .150f, -.020f, .033f, .038f, .038f, .0f},
      {-.862f, .150f, -.022f, .030f, .030f, .034f, .0f}};
  std::vector<Loft::Section> sections;
  for (const Row& r : kRows) {
    const float thigh = smooth_step(-.40f, -.15f, r.y);
    const float female = 1 + who_.female * mix(-.06f, .06f, thigh);
    const float child = 1 - who_.child * mix(-.02f, .06f, thigh) - .06f * who_.old * (1 - thigh);
    const float k = female * child * (1 + r.fat * who_.fat);
    const float foot = r.y < -.78f ? mix(1, who_.foot, ramp(r.y, -.78f, -.83f)) : 1;
    sections.push_back({r.y, r.x + .9f * r.side * std::max(0.0f, k - 1) * thigh, r.z, r.side * k * foot,
                        r.front * k * foot, r.back * k * foot});
  }
  // Template heights below the ankle belong to the foot's scale: carry the end of the loft there.
  const float below = who_.foot / who_.leg;
  for (Loft::Section& s : sections)
    if (s.t < -.81f) s.t = -.81f + (s.t + .81f) * below;
  loft(Region::Leg, 1, sections, {.02f, .07f, 2.1f, .02f});
  ellipsoid(Region::Leg, {.137f, -.402f, .036f}, {.026f, .034f, .020f}, .02f);  // knee cap
  ellipsoid(Region::Leg, {.128f, -.515f, -.050f}, Vec3(.030f, .075f, .030f) * (1 + .2f * who_.fat),
            .03f);                                                                 // calf, inner head
  ellipsoid(Region::Foot, {.119f, -.800f, -.014f}, {.009f, .014f, .013f}, .015f);  // ankle bones
  ellipsoid(Region::Foot, {.181f, -.812f, -.020f}, {.009f, .014f, .013f}, .015f);
}

void PersonShape::add_foot() {
  // z, x, y, side, up, down: the sole is flat at -.879
  const std::vector<Loft::Section> sections = {
      {-.078f, .150f, -.850f, .026f, .028f, .029f}, {-.055f, .150f, -.850f, .033f, .036f, .029f},
      {-.025f, .151f, -.852f, .034f, .050f, .027f}, {.010f, .154f, -.853f, .034f, .055f, .024f},
      {.040f, .158f, -.856f, .037f, .046f, .021f},  {.070f, .163f, -.860f, .043f, .034f, .019f},
      {.100f, .168f, -.863f, .046f, .024f, .016f},  {.125f, .171f, -.866f, .044f, .017f, .013f},
      {.145f, .172f, -.868f, .034f, .012f, .010f}};
  loft(Region::Foot, 2, sections, {.022f, .02f, 2.4f, .02f});
  struct Toe {
    float x, z, tip_x, tip_z, r;
  };
  constexpr Toe kToes[] = {{.142f, .120f, .143f, .157f, .0125f},
                           {.160f, .128f, .163f, .160f, .0090f},
                           {.176f, .124f, .180f, .153f, .0085f},
                           {.191f, .116f, .195f, .143f, .0080f},
                           {.204f, .106f, .208f, .130f, .0080f}};
  for (const Toe& t : kToes)
    cone(Region::Foot, {t.x, -.866f, t.z}, {t.tip_x, -.879f + t.r, t.tip_z}, {t.r, t.r, .005f});
}

void PersonShape::add_arm() {
  struct Row {
    float x, y, z, wide, up, down, fat;  // wide: in z
  };
  constexpr Row kRows[] = {
      {.075f, .448f, .006f, .056f, .040f, .060f, .3f},  {.130f, .455f, .004f, .056f, .046f, .056f, .35f},
      {.180f, .460f, .004f, .052f, .046f, .052f, .4f},  {.230f, .462f, .005f, .047f, .041f, .048f, .5f},
      {.290f, .462f, .007f, .042f, .038f, .043f, .5f},  {.350f, .462f, .008f, .038f, .036f, .038f, .45f},
      {.407f, .462f, .008f, .036f, .034f, .036f, .3f},  {.450f, .462f, .009f, .039f, .036f, .037f, .3f},
      {.500f, .462f, .010f, .037f, .034f, .034f, .3f},  {.560f, .461f, .010f, .032f, .028f, .028f, .2f},
      {.610f, .460f, .009f, .028f, .022f, .022f, .12f}, {.640f, .459f, .008f, .027f, .019f, .020f, .1f},
      {.665f, .457f, .008f, .028f, .017f, .018f, .05f}};
  std::vector<Loft::Section> sections;
  for (const Row& r : kRows) {
    const float hand = mix(1, who_.hand, smooth_step(.55f, .64f, r.x));
    const float build = mix(1.10f, .92f, who_.female) * (1 - .10f * who_.child - .06f * who_.old);
    const float k = mix(build, 1, smooth_step(.45f, .64f, r.x)) * hand * (1 + r.fat * who_.fat);
    sections.push_back({r.x, r.z, r.y, r.wide * k, r.up * k, r.down * k});
  }
  loft(Region::Arm, 0, sections, {.03f, .015f, 2.0f, .02f});
  const float muscle = (1 - .5f * who_.female) * (1 - who_.child) * (1 - .5f * who_.old);
  ellipsoid(Region::Arm, {.190f, .468f, .006f},
            Vec3(.046f, .044f, .050f) * (.92f + .12f * muscle + .3f * who_.fat), .03f);
  ellipsoid(Region::Arm, {.295f, .478f, .014f}, Vec3(.058f, .026f, .028f) * (.9f + .15f * muscle),
            .025f);  // biceps
  ellipsoid(Region::Arm, {.290f, .448f, -.006f}, Vec3(.065f, .028f, .030f) * (.9f + .12f * muscle),
            .025f);                                                             // triceps
  ellipsoid(Region::Arm, {.412f, .447f, -.016f}, {.016f, .014f, .014f}, .02f);  // elbow
}

void PersonShape::add_hand() {
  const std::vector<Loft::Section> palm = {
      {.640f, .008f, .459f, .026f, .017f, .017f}, {.665f, .009f, .457f, .030f, .016f, .018f},
      {.690f, .009f, .454f, .036f, .014f, .017f}, {.715f, .008f, .452f, .039f, .013f, .015f},
      {.735f, .006f, .450f, .039f, .012f, .012f}, {.748f, .005f, .449f, .034f, .009f, .009f}};
  loft(Region::Hand, 0, palm, {.01f, .012f, 2.5f, .01f});
  ellipsoid(Region::Hand, {.677f, .449f, .032f}, {.026f, .015f, .015f}, .012f,
            {0, -25, 0});  // ball of the thumb
  struct Finger {
    float z, base_x, length, fan_deg, r;
  };
  constexpr Finger kFingers[] = {{.036f, .728f, .074f, 9.5f, .0088f},
                                 {.0145f, .733f, .083f, 2.5f, .0090f},
                                 {-.0065f, .730f, .076f, -4.5f, .0085f},
                                 {-.0265f, .722f, .060f, -12.5f, .0076f}};
  for (const Finger& f : kFingers) {
    const float c = std::cos(f.fan_deg * kPi / 180), s = std::sin(f.fan_deg * kPi / 180);
    const auto at = [&](float d) {
      return Vec3(f.base_x + d * c, .450f - .10f * d - 1.6f * d * d, f.z + d * s);
    };
    cone(Region::Hand, at(0), at(.5f * f.length), {f.r, .94f * f.r, .005f});
    cone(Region::Hand, at(.5f * f.length), at(f.length - .8f * f.r), {.94f * f.r, .80f * f.r, .003f});
  }
  cone(Region::Hand, {.668f, .450f, .030f}, {.703f, .444f, .058f}, {.0125f, .0108f, .010f});
  cone(Region::Hand, {.703f, .444f, .058f}, {.734f, .440f, .070f}, {.0108f, .0084f, .004f});
}

void PersonShape::add_head() {
  const float m = 1 - who_.female, child = who_.child, fat = who_.fat;
  const float neck =
      (mix(.056f, .047f, who_.female) - .006f * child) * (1 + .45f * fat) / who_.head * (1 + .30f * child);
  const std::vector<Loft::Section> neck_sections = {
      {.440f, 0, -.002f, neck * 1.25f, neck * .95f, neck * 1.15f},
      {.490f, 0, .000f, neck * 1.10f, neck * .95f, neck * 1.05f},
      {.530f, 0, .006f, neck, neck * .92f, neck},
      {.570f, 0, .012f, neck * .97f, neck * .95f, neck},
      {.610f, 0, .018f, neck, neck * .90f, neck}};
  loft(Region::Head, 1, neck_sections, {.02f, .02f, 2.0f, .02f});

  const float jaw = .94f + .09f * m * (1 - child) + .22f * fat + .05f * child;
  const float skull = 1 + .03f * child;
  const std::vector<Loft::Section> sections = {
      // y, x, z, side, front, back
      {.541f, 0, .050f, .026f * jaw, .050f, .025f},   {.556f, 0, .048f, .040f * jaw, .064f, .036f},
      {.575f, 0, .040f, .054f * jaw, .073f, .052f},   {.600f, 0, .032f, .063f * jaw, .082f, .072f},
      {.625f, 0, .028f, .066f, .086f, .086f},         {.650f, 0, .026f, .070f * skull, .087f, .093f},
      {.680f, 0, .026f, .073f * skull, .090f, .096f}, {.705f, 0, .026f, .073f * skull, .089f, .095f},
      {.735f, 0, .026f, .073f * skull, .086f, .093f}, {.768f, 0, .026f, .072f * skull, .083f, .090f}};
  loft(Region::Head, 1, sections, {.012f, .078f, 2.2f, .012f});
  ellipsoid(Region::Head, {0, .556f, .094f}, Vec3(.021f + .003f * m, .014f, .015f),
            .014f);  // chin
  if (fat > 0) ellipsoid(Region::Head, {0, .548f, .062f}, Vec3(.040f, .018f, .034f) * (.8f + fat), .02f);
}

void PersonShape::add_face() {
  using Join = Primitive::Join;
  const float m = (1 - who_.female) * (1 - who_.child), child = who_.child;
  const auto blob = [this](const Vec3& c, const Vec3& r, float blend, const Vec3& turn = Vec3::Zero(),
                           Join join = Join::Add) { ellipsoid(Region::Head, c, r, blend, turn, join); };
  blob({.028f, .6695f, .1045f}, Vec3(.025f, .008f, .008f + .004f * m), .012f, {0, 22, 0});  // brow
  blob({.041f, .627f, .079f}, {.020f, .017f, .018f}, .020f);                                // cheek bone
  blob({.0315f, .6495f, .1245f}, {.0180f, .0105f, .0135f}, .010f, {0, 20, 0}, Join::Cut);   // eye socket
  blob({.031f, .6490f, .1025f}, Vec3::Constant(.0125f + .001f * child), .003f);             // eye
  blob({.031f, .6570f, .1040f}, {.0145f, .0036f, .0095f}, .004f, {0, 15, 0});               // upper lid

  const float nose = 1 + .10f * m - .15f * child + .05f * who_.old;
  cone(Region::Head, {0, .658f, .104f}, {0, .617f, .104f + .018f * nose}, {.0085f, .0105f * nose, .012f});
  blob({0, .6125f, .108f + .017f * nose}, Vec3(.0105f, .0100f, .0110f) * nose, .008f);  // tip
  blob({.0115f, .6100f, .115f}, Vec3(.0080f, .0080f, .0110f) * nose, .007f);            // wing
  blob({0, .5955f, .111f}, {.016f, .009f, .010f}, .010f);                               // upper lip's bed
  blob({.0075f, .5915f, .1155f}, {.0145f, .0048f, .0072f}, .003f, {0, 22, 0});          // upper lip
  blob({0, .5822f, .1135f}, {.0190f, .0056f, .0080f}, .003f);                           // lower lip
  blob({0, .5872f, .1245f}, {.0250f, .0014f, .0085f}, .003f, Vec3::Zero(), Join::Cut);  // mouth
  const float ear = 1 + .10f * who_.old + .05f * m;
  blob({.0745f, .640f, .020f}, Vec3(.0070f, .0310f, .0190f) * ear, .006f, {-8, 18, -8});
  blob({.0845f, .643f, .024f}, Vec3(.0050f, .0190f, .0100f) * ear, .006f, {-8, 18, -8}, Join::Cut);
}

// ---- evaluation

float PersonShape::primitive_value(const Primitive& primitive, const Vec3& p) const {
  switch (primitive.kind) {
    case Primitive::Kind::Loft:
      return lofts_[primitive.loft].value(p);
    case Primitive::Kind::Ellipsoid:
      return ellipsoid_distance(primitive.to_local * (p - primitive.a), primitive.b);
    case Primitive::Kind::Cone:
      return cone_distance(p, primitive);
  }
  return 0;
}

float PersonShape::part_value(Part part, const Vec3& p) const {
  float value = 1e3f;
  for (const Primitive& primitive : parts_[static_cast<int>(part)].primitives) {
    const float bound = box_distance(p, primitive.low, primitive.high);
    if (primitive.join == Primitive::Join::Add) {
      if (bound > value + primitive.blend && bound > 0) continue;
      value = smooth_min(value, primitive_value(primitive, p), primitive.blend);
    } else if (-bound > value - primitive.blend) {
      value = -smooth_min(-value, primitive_value(primitive, p), primitive.blend);
    }
  }
  return value;
}

void PersonShape::add(Region region, const Primitive& primitive) {
  PartShape& shape = parts_[static_cast<int>(part_of(region))];
  shape.primitives.push_back(primitive);
  shape.low = shape.low.cwiseMin(primitive.low);
  shape.high = shape.high.cwiseMax(primitive.high);
}

float PersonShape::part_bound(Part part, const Vec3& p) const {
  const PartShape& shape = parts_[static_cast<int>(part)];
  return box_distance(p, shape.low, shape.high);
}

float PersonShape::value(const Vec3& q) const {
  constexpr std::pair<Part, float> kJoined[] = {
      {Part::Trunk, .03f}, {Part::Leg, .040f}, {Part::Arm, .040f}, {Part::Head, .025f}};
  const Vec3 p(std::abs(q.x()), q.y(), q.z());
  float value = 1e3f;
  for (const auto& [part, blend] : kJoined)
    if (part_bound(part, p) < value + blend) value = smooth_min(value, part_value(part, p), blend);
  return value;
}

float PersonShape::detail(const Vec3& p) const {
  const float wrist = joints_(LeftWrist, 0), ankle = joints_(LeftAnkle, 1), neck = joints_(Neck, 1);
  const float x = std::abs(p.x());
  const float hand = mix(1, .38f, smooth_step(wrist - .10f, wrist + .03f, x));
  const float foot = mix(1, .58f, smooth_step(ankle + .03f, ankle - .04f, p.y()));
  const float face = smooth_step(.03f, .09f, p.z());
  const float head = mix(1, mix(.60f, .34f, face), smooth_step(neck - .02f, neck + .05f, p.y()));
  return std::min({hand, foot, head});
}

/// The grid is squeezed towards the arm's axis at the hand, towards the neck's axis at the head, and at the
/// feet: only those parts of the body are there, so nothing else sees it.
Vec3 PersonShape::warp(const Vec3& g) const {
  const float wrist = joints_(LeftWrist, 0), ankle = joints_(LeftAnkle, 1), neck = joints_(Neck, 1);
  const auto eased = [](float x, float from, float to,
                        float s) {  // integral of a ramp from slope 1 to slope s
    const float d = to - from, t = std::clamp(x - from, 0.0f, d), over = std::max(x - to, 0.0f);
    return std::min(x, from) + t - (1 - s) * t * t / (2 * d) + s * over;
  };
  Vec3 p(eased(g.x(), wrist - .12f, wrist, .42f), g.y(), g.z());
  const float hand = mix(1, .42f, ramp(g.x(), wrist - .12f, wrist));
  const float up = eased(g.y(), neck, neck + .06f, .60f), down = -eased(-g.y(), -ankle - .06f, -ankle, .60f);
  p.y() = g.y() > 0 ? up : down;
  const float shrink = g.y() > 0 ? mix(1, .60f, ramp(g.y(), neck, neck + .06f))
                                 : mix(1, .60f, ramp(-g.y(), -ankle - .06f, -ankle));
  // Beside the head and feet only: farther out the same heights are above the arms and must not fold onto
  // them.
  const float beside = 1 - ramp(g.x(), .20f, std::clamp(wrist - .12f, .26f, .45f));
  p.x() *= mix(1, shrink, beside);
  p.z() *= mix(1, shrink, beside);
  const float arm_y = joints_(LeftWrist, 1) - .01f, arm_z = joints_(LeftWrist, 2);
  p.y() = arm_y + (p.y() - arm_y) * hand;
  p.z() = arm_z + (p.z() - arm_z) * hand;
  return p;
}

ImplicitSolid PersonShape::solid() const {
  ImplicitSolid solid;
  solid.value = [this](const Vec3& p) { return value(p); };
  solid.warp = [this](const Vec3& g) { return warp(g); };
  solid.detail = [this](const Vec3& p) { return detail(p); };
  const float reach = joints_(LeftWrist, 0) + .21f / .42f * std::max(1.0f, who_.hand);
  solid.low = Vec3(0, joints_(LeftAnkle, 1) - .16f, -.30f - .1f * std::max(who_.fat, 0.0f));
  solid.high =
      Vec3(reach, joints_(Neck, 1) + .30f * who_.head / .60f, .34f + .25f * std::max(who_.fat, 0.0f));
  return solid;
}

}  // namespace understudy
