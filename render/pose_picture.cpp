#include "render/pose_picture.hpp"

#include <algorithm>
#include <cmath>

namespace understudy::render {
namespace {

namespace body = body25;

constexpr float kUsualHalfWidth = 4, kUsualSide = 512;
constexpr float kHandLine = 1, kFaceDot = 3;  // half-width, radius at the usual size
constexpr int kHandBones = 20;

struct Colour {
  uint8_t rgb[3];
};

void set_pixel(Image& image, int x, int y, const uint8_t* rgb) {
  std::copy_n(rgb, 3, image.at(x, y));
}

/// Calls inside(x, y) of the pixels of a box and colours those for which it is true. Coordinates are of the
/// pixels' middles.
template <class Inside>
void fill_where(Image& image, const FlatBox& box, const uint8_t* rgb, const Inside& inside) {
  const float right = static_cast<float>(image.width - 1), bottom = static_cast<float>(image.height - 1);
  if (!box.min().allFinite() || !box.max().allFinite()) return;
  const int x0 = static_cast<int>(std::ceil(std::clamp(box.min().x(), 0.f, right + 1)));
  const int y0 = static_cast<int>(std::ceil(std::clamp(box.min().y(), 0.f, bottom + 1)));
  const int x1 = static_cast<int>(std::floor(std::clamp(box.max().x(), -1.f, right)));
  const int y1 = static_cast<int>(std::floor(std::clamp(box.max().y(), -1.f, bottom)));
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x)
      if (inside(Vec2(static_cast<float>(x), static_cast<float>(y)))) set_pixel(image, x, y, rgb);
}

FlatBox box_about(const Vec2& a, const Vec2& b, float reach) {
  return {a.cwiseMin(b) - Vec2::Constant(reach), a.cwiseMax(b) + Vec2::Constant(reach)};
}

void fill_disc(Image& image, const Vec2& middle, float radius, const uint8_t* rgb) {
  fill_where(image, box_about(middle, middle, radius), rgb,
             [&](const Vec2& at) { return (at - middle).squaredNorm() <= radius * radius; });
}

/// An ellipse from end to end.
void fill_stick(Image& image, const Vec2& a, const Vec2& b, float half_width, const uint8_t* rgb) {
  const Vec2 middle = (a + b) / 2;
  const float half_length = std::max((b - a).norm() / 2, 0.5f);
  const Vec2 along = (b - a).norm() > 0 ? Vec2((b - a).normalized()) : Vec2(1, 0);
  fill_where(image, box_about(a, b, half_width), rgb, [&](const Vec2& at) {
    const float u = (at - middle).dot(along) / half_length;
    const float v = ((at - middle).x() * along.y() - (at - middle).y() * along.x()) / half_width;
    return u * u + v * v <= 1;
  });
}

/// A line with round ends.
void fill_line(Image& image, const Vec2& a, const Vec2& b, float half_width, const uint8_t* rgb) {
  const float length = (b - a).squaredNorm();
  fill_where(image, box_about(a, b, half_width), rgb, [&](const Vec2& at) {
    const float t = length > 0 ? std::clamp((at - a).dot(b - a) / length, 0.f, 1.f) : 0;
    return (a + t * (b - a) - at).squaredNorm() <= half_width * half_width;
  });
}

/// Hue 0..1 at full saturation and value.
Colour of_hue(float hue) {
  Colour colour{};
  for (int k = 0; k < 3; ++k) {
    const float away = std::abs(std::remainder(6 * hue - 2.0f * static_cast<float>(k), 6.0f));
    colour.rgb[k] = static_cast<uint8_t>(std::lround(255 * std::clamp(2 - away, 0.f, 1.f)));
  }
  return colour;
}

Vec2 place_of(const FlatPoints& points, int k) {
  return points.row(k).head<2>().transpose();
}

void draw_hand(Image& image, const FlatPoints& hand, float half_width) {
  if (hand.rows() != kHandPoints) return;
  const float scale = half_width / kUsualHalfWidth;
  for (int k = 0; k < kHandBones; ++k) {
    const int to = k + 1, from = k % 4 == 0 ? 0 : k;  // five fingers of four bones, from the wrist
    if (!(hand(from, 2) > 0) || !(hand(to, 2) > 0)) continue;
    const Colour colour = of_hue(static_cast<float>(k) / kHandBones);
    fill_line(image, place_of(hand, from), place_of(hand, to), kHandLine * scale, colour.rgb);
  }
  const Colour blue{{0, 0, 255}};
  for (int k = 0; k < kHandPoints; ++k)
    if (hand(k, 2) > 0) fill_disc(image, place_of(hand, k), half_width, blue.rgb);
}

void draw_face(Image& image, const FlatPoints& face, float half_width) {
  const Colour white{{255, 255, 255}};
  for (Eigen::Index k = 0; k < face.rows(); ++k)
    if (face(k, 2) > 0)
      fill_disc(image, place_of(face, static_cast<int>(k)), kFaceDot * half_width / kUsualHalfWidth,
                white.rgb);
}

}  // namespace

float usual_half_width(const Canvas& canvas) {
  return kUsualHalfWidth *
         std::max(1.0f, static_cast<float>(std::min(canvas.width, canvas.height)) / kUsualSide);
}

int wide_stick_factor(const Canvas& canvas) {
  const int side = std::max(canvas.width, canvas.height);
  return side < 500 ? 1 : std::min(2 + side / 1000, 7);
}

uint8_t dimmed(uint8_t value) {
  return static_cast<uint8_t>(value * 6 / 10);
}

const std::vector<PoseStick>& pose_sticks(PoseLayout layout) {
  // from, to, and the colours of a rainbow in ControlNet's order
  static const std::vector<PoseStick> openpose18 = {{body::Neck, body::RightShoulder, {255, 0, 0}},
                                                    {body::Neck, body::LeftShoulder, {255, 85, 0}},
                                                    {body::RightShoulder, body::RightElbow, {255, 170, 0}},
                                                    {body::RightElbow, body::RightWrist, {255, 255, 0}},
                                                    {body::LeftShoulder, body::LeftElbow, {170, 255, 0}},
                                                    {body::LeftElbow, body::LeftWrist, {85, 255, 0}},
                                                    {body::Neck, body::RightHip, {0, 255, 0}},
                                                    {body::RightHip, body::RightKnee, {0, 255, 85}},
                                                    {body::RightKnee, body::RightAnkle, {0, 255, 170}},
                                                    {body::Neck, body::LeftHip, {0, 255, 255}},
                                                    {body::LeftHip, body::LeftKnee, {0, 170, 255}},
                                                    {body::LeftKnee, body::LeftAnkle, {0, 85, 255}},
                                                    {body::Neck, body::Nose, {0, 0, 255}},
                                                    {body::Nose, body::RightEye, {85, 0, 255}},
                                                    {body::RightEye, body::RightEar, {170, 0, 255}},
                                                    {body::Nose, body::LeftEye, {255, 0, 255}},
                                                    {body::LeftEye, body::LeftEar, {255, 0, 170}}};
  // a stick has the colour of its outer end
  static const std::vector<PoseStick> with_feet = {{body::Neck, body::MidHip, {255, 0, 0}},
                                                   {body::Neck, body::RightShoulder, {255, 85, 0}},
                                                   {body::Neck, body::LeftShoulder, {170, 255, 0}},
                                                   {body::RightShoulder, body::RightElbow, {255, 170, 0}},
                                                   {body::RightElbow, body::RightWrist, {255, 255, 0}},
                                                   {body::LeftShoulder, body::LeftElbow, {85, 255, 0}},
                                                   {body::LeftElbow, body::LeftWrist, {0, 255, 0}},
                                                   {body::MidHip, body::RightHip, {0, 255, 85}},
                                                   {body::RightHip, body::RightKnee, {0, 255, 170}},
                                                   {body::RightKnee, body::RightAnkle, {0, 255, 255}},
                                                   {body::MidHip, body::LeftHip, {0, 170, 255}},
                                                   {body::LeftHip, body::LeftKnee, {0, 85, 255}},
                                                   {body::LeftKnee, body::LeftAnkle, {0, 0, 255}},
                                                   {body::Neck, body::Nose, {255, 0, 85}},
                                                   {body::Nose, body::RightEye, {255, 0, 170}},
                                                   {body::RightEye, body::RightEar, {255, 0, 255}},
                                                   {body::Nose, body::LeftEye, {170, 0, 255}},
                                                   {body::LeftEye, body::LeftEar, {85, 0, 255}},
                                                   {body::LeftAnkle, body::LeftBigToe, {0, 0, 255}},
                                                   {body::LeftBigToe, body::LeftSmallToe, {0, 0, 255}},
                                                   {body::LeftAnkle, body::LeftHeel, {0, 0, 255}},
                                                   {body::RightAnkle, body::RightBigToe, {0, 255, 255}},
                                                   {body::RightBigToe, body::RightSmallToe, {0, 255, 255}},
                                                   {body::RightAnkle, body::RightHeel, {0, 255, 255}}};
  return layout == PoseLayout::Body25 ? with_feet : openpose18;
}

const std::vector<PoseDisc>& pose_discs(PoseLayout layout) {
  static const std::vector<PoseDisc> openpose18 = {{body::Nose, {255, 0, 0}},
                                                   {body::Neck, {255, 85, 0}},
                                                   {body::RightShoulder, {255, 170, 0}},
                                                   {body::RightElbow, {255, 255, 0}},
                                                   {body::RightWrist, {170, 255, 0}},
                                                   {body::LeftShoulder, {85, 255, 0}},
                                                   {body::LeftElbow, {0, 255, 0}},
                                                   {body::LeftWrist, {0, 255, 85}},
                                                   {body::RightHip, {0, 255, 170}},
                                                   {body::RightKnee, {0, 255, 255}},
                                                   {body::RightAnkle, {0, 170, 255}},
                                                   {body::LeftHip, {0, 85, 255}},
                                                   {body::LeftKnee, {0, 0, 255}},
                                                   {body::LeftAnkle, {85, 0, 255}},
                                                   {body::RightEye, {170, 0, 255}},
                                                   {body::LeftEye, {255, 0, 255}},
                                                   {body::RightEar, {255, 0, 170}},
                                                   {body::LeftEar, {255, 0, 85}}};
  static const std::vector<PoseDisc> with_feet = {
      {body::Nose, {255, 0, 85}},          {body::Neck, {255, 0, 0}},
      {body::RightShoulder, {255, 85, 0}}, {body::RightElbow, {255, 170, 0}},
      {body::RightWrist, {255, 255, 0}},   {body::LeftShoulder, {170, 255, 0}},
      {body::LeftElbow, {85, 255, 0}},     {body::LeftWrist, {0, 255, 0}},
      {body::MidHip, {255, 0, 0}},         {body::RightHip, {0, 255, 85}},
      {body::RightKnee, {0, 255, 170}},    {body::RightAnkle, {0, 255, 255}},
      {body::LeftHip, {0, 170, 255}},      {body::LeftKnee, {0, 85, 255}},
      {body::LeftAnkle, {0, 0, 255}},      {body::RightEye, {255, 0, 170}},
      {body::LeftEye, {170, 0, 255}},      {body::RightEar, {255, 0, 255}},
      {body::LeftEar, {85, 0, 255}},       {body::LeftBigToe, {0, 0, 255}},
      {body::LeftSmallToe, {0, 0, 255}},   {body::LeftHeel, {0, 0, 255}},
      {body::RightBigToe, {0, 255, 255}},  {body::RightSmallToe, {0, 255, 255}},
      {body::RightHeel, {0, 255, 255}}};
  return layout == PoseLayout::Body25 ? with_feet : openpose18;
}

void draw_pose(Image& image, const FlatPose& pose, const PosePictureOptions& options) {
  const Canvas canvas{image.width, image.height};
  const float radius = options.half_width > 0 ? options.half_width
                       : options.wide_sticks  ? kUsualHalfWidth
                                              : usual_half_width(canvas);
  const float stick = options.wide_sticks ? radius * static_cast<float>(wide_stick_factor(canvas)) : radius;
  for (const PoseStick& one : pose_sticks(options.layout)) {
    if (!pose.has(one.from) || !pose.has(one.to)) continue;
    const uint8_t rgb[3] = {dimmed(one.rgb[0]), dimmed(one.rgb[1]), dimmed(one.rgb[2])};
    fill_stick(image, pose.at(one.from), pose.at(one.to), stick, rgb);
  }
  for (const PoseDisc& one : pose_discs(options.layout))
    if (pose.has(one.point)) fill_disc(image, pose.at(one.point), radius, one.rgb);
  if (options.hands)
    for (const FlatPoints* hand : {&pose.left_hand, &pose.right_hand}) draw_hand(image, *hand, radius);
  if (options.face) draw_face(image, pose.face, radius);
}

Image pose_picture(const std::vector<FlatPose>& people, const Canvas& canvas,
                   const PosePictureOptions& options) {
  Image image(canvas.width, canvas.height, Vec3::Zero());
  for (const FlatPose& pose : people) draw_pose(image, pose, options);
  return image;
}

}  // namespace understudy::render
