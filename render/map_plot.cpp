#include "render/map_plot.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "render/plot_axis.hpp"
#include "render/strokes.hpp"
#include "render/text.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/rng.hpp"

namespace understudy::render {
namespace {

using Eigen::Vector2f;

constexpr int kLeftRoom = 84, kRightRoom = 230, kTopRoom = 92, kBottomRoom = 70;  // pixels about the axes
constexpr float kPixelsAMetre = 40, kWidestWay = 62;  // of a figure; pixels that it goes at most
constexpr size_t kMostFigures = 140;
const Vec3 kMapInk(0.13f, 0.15f, 0.18f), kMapDim(0.42f, 0.45f, 0.50f), kMapGrid(0.91f, 0.92f, 0.94f);

/// Bones of a figure: joints of its ends and how thick it is there, metres.
struct Limb {
  int from, to;
  float width_from, width_to;
};
constexpr Limb kTrunk[] = {{Pelvis, Spine3, 0.24f, 0.27f},
                           {Spine3, Neck, 0.27f, 0.12f},
                           {LeftHip, RightHip, 0.18f, 0.18f},
                           {LeftShoulder, RightShoulder, 0.13f, 0.13f},
                           {Neck, Head, 0.10f, 0.10f}};
constexpr Limb kLeftLimbs[] = {{LeftHip, LeftKnee, 0.17f, 0.12f},
                               {LeftKnee, LeftAnkle, 0.12f, 0.08f},
                               {LeftAnkle, LeftFoot, 0.09f, 0.07f},
                               {LeftShoulder, LeftElbow, 0.11f, 0.085f},
                               {LeftElbow, LeftWrist, 0.085f, 0.065f}};
constexpr float kHead_m = 0.22f;  // across

struct MapFrame {
  PlotAxis x, y;
  int width, height;
  Vector2f at(const Vector2f& p) const {
    return {kLeftRoom + x.share(p.x()) * static_cast<float>(width - kLeftRoom - kRightRoom),
            static_cast<float>(height - kBottomRoom) -
                y.share(p.y()) * static_cast<float>(height - kTopRoom - kBottomRoom)};
  }
};

MapFrame map_frame(const std::vector<MapPoint>& points, const MapPlotOptions& options) {
  US_CHECK(!points.empty(), options.title, ": there is nothing to plot");
  Vector2f low = points[0].at, high = points[0].at;
  for (const MapPoint& point : points) {
    US_CHECK(point.at.allFinite(), options.title, ": a place is not finite");
    low = low.cwiseMin(point.at), high = high.cwiseMax(point.at);
  }
  const Vector2f air = 0.04f * (high - low) + Vector2f(1e-6f, 1e-6f);
  low -= air, high += air;
  return {PlotAxis(low.x(), high.x()), PlotAxis(low.y(), high.y()), options.width, options.height};
}

void line(Image& image, const Vector2f& a, const Vector2f& b, float width, const Vec3& color) {
  paint(image, {{a, b, width, width}}, color);
}

void draw_map_axes(Image& image, const Font& font, const MapFrame& frame, const MapPlotOptions& options) {
  const auto at = [&](double x, double y) {
    return frame.at({static_cast<float>(x), static_cast<float>(y)});
  };
  for (double v = frame.y.low; v <= frame.y.high + 0.5 * frame.y.step; v += frame.y.step) {
    const Vector2f from = at(frame.x.low, v);
    line(image, from, at(frame.x.high, v), 1, kMapGrid);
    const std::string text = axis_number(v);
    font.draw(image, text, {from.x() - 10 - font.width(text, 15), from.y() + 5}, 15, kMapDim);
  }
  for (double v = frame.x.low; v <= frame.x.high + 0.5 * frame.x.step; v += frame.x.step) {
    const Vector2f from = at(v, frame.y.low);
    line(image, from, at(v, frame.y.high), 1, kMapGrid);
    const std::string text = axis_number(v);
    font.draw(image, text, {from.x() - 0.5f * font.width(text, 15), from.y() + 22}, 15, kMapDim);
  }
  font.draw(image, options.title, {24, 36}, 24, kMapInk);
  font.draw(image, options.subtitle, {24, 60}, 16, kMapDim);
  font.draw(image, options.y_label, {24, 83}, 15, kMapInk);
  const float right = static_cast<float>(frame.width - kRightRoom);
  font.draw(image, options.x_label,
            {right - font.width(options.x_label, 15), static_cast<float>(frame.height - 20)}, 15, kMapInk);
}

void draw_scale(Image& image, const Font& font, const MapPlotOptions& options) {
  const float left = static_cast<float>(options.width - kRightRoom + 36), top = kTopRoom + 34,
              bottom = top + 240;
  font.draw(image, options.scale.label, {left, top - 14}, 16, kMapInk);
  for (float y = top; y <= bottom; ++y)
    line(image, {left + 10, y}, {left + 18, y}, 3, options.scale.color((bottom - y) / (bottom - top)));
  for (int i = 0; i <= 4; ++i) {
    const double share = 0.25 * i;
    const double value = options.scale.low + share * (options.scale.high - options.scale.low);
    const float y = bottom - static_cast<float>(share) * (bottom - top);
    font.draw(image, axis_number(std::round(100 * value) / 100), {left + 34, y + 5}, 15, kMapInk);
  }
}

void draw_map_legend(Image& image, const Font& font, const MapPlotOptions& options) {
  if (options.scale.color != nullptr) return draw_scale(image, font, options);
  const float left = static_cast<float>(options.width - kRightRoom + 36);
  const float room = static_cast<float>(kRightRoom - 36 - 24 - 12);
  float y = kTopRoom + 24;
  for (const auto& [name, color] : options.legend) {
    line(image, {left, y - 5}, {left, y - 5}, 13, color);
    std::string shown = name;
    while (shown.size() > 4 && font.width(shown, 16) > room) {
      size_t end = shown.size() - (shown.size() < name.size() ? 4 : 1);  // the dots are three bytes
      while (end > 0 && (static_cast<unsigned char>(shown[end]) & 0xC0) == 0x80) --end;
      shown = shown.substr(0, end) + "\u2026";
    }
    font.draw(image, shown, {left + 16, y}, 16, kMapInk);
    y += 27;
  }
}

/// Seen from their right side and a little from the front; x and y in pixels from the point above the floor
/// that the figure is about, y down.
Vector2f projected(const Eigen::RowVector3f& joint) {
  constexpr float kAside = 0.34f;
  return kPixelsAMetre * Vector2f(joint.z() * std::sqrt(1 - kAside * kAside) - joint.x() * kAside,
                                  -joint.y() - 0.05f * joint.x());
}

template <size_t N>
void add_limbs(std::vector<Stroke>& strokes, const Limb (&limbs)[N], const Joints& joints, const Vector2f& at,
               bool mirror = false) {
  for (const Limb& limb : limbs) {
    const int from = mirror ? kMirror[limb.from] : limb.from, to = mirror ? kMirror[limb.to] : limb.to;
    strokes.push_back({at + projected(joints.row(from)), at + projected(joints.row(to)),
                       kPixelsAMetre * limb.width_from, kPixelsAMetre * limb.width_to});
  }
}

/// `at`: where the floor below the body's middle is. Far limbs are paler.
void draw_person(Image& image, const Joints& joints, const Vector2f& at, const Vec3& color, float opacity) {
  std::vector<Stroke> far, near;
  add_limbs(far, kLeftLimbs, joints, at);
  add_limbs(near, kTrunk, joints, at);
  add_limbs(near, kLeftLimbs, joints, at, /*mirror=*/true);
  const Eigen::RowVector3f up = joints.row(Head) - joints.row(Neck);
  const Vector2f head = at + projected(joints.row(Head) + 0.35f * up);
  near.push_back({head, head, kPixelsAMetre * kHead_m, kPixelsAMetre * kHead_m});
  paint(image, far, 0.55f * color + Vec3::Constant(0.45f), opacity);
  paint(image, near, color, opacity);
}

/// The last moment where the point is, those before it behind it on its way, fainter.
struct DrawnFigure {
  DrawnFigure(std::vector<Joints> moments_of, const Vector2f& point) : moments(std::move(moments_of)) {
    if (moments.empty()) return;
    const Eigen::RowVector3f last = moments.back().row(Pelvis);
    float way = 0;
    for (const Joints& joints : moments)
      way = std::max(way, std::abs(projected(joints.row(Pelvis) - last).x()));
    const float share = way > kWidestWay ? kWidestWay / way : 1;
    low = high = point;
    for (Joints& joints : moments) {
      const Eigen::RowVector3f place = joints.row(Pelvis), over(place.x(), 0, place.z());
      joints.rowwise() -= over;
      Vector2f at =
          point + Vector2f(share * projected(over - Eigen::RowVector3f(last.x(), 0, last.z())).x(), 0);
      at.y() += kPixelsAMetre * last.y();  // the pelvis is at the point
      places.push_back(at);
      for (Eigen::Index j = 0; j < joints.rows(); ++j) {
        const Vector2f seen = at + projected(joints.row(j));
        low = low.cwiseMin(seen), high = high.cwiseMax(seen);
      }
    }
    low.array() -= 7, high.array() += 7;
  }
  bool meets(const DrawnFigure& other) const {
    return (low.array() < other.high.array()).all() && (other.low.array() < high.array()).all();
  }
  bool inside(const MapFrame& frame) const {
    return low.x() > kLeftRoom - 30 && high.x() < static_cast<float>(frame.width - kRightRoom + 24) &&
           low.y() > kTopRoom - 6 && high.y() < static_cast<float>(frame.height - kBottomRoom + 12);
  }
  void draw(Image& image, const Vec3& color) const {
    for (size_t k = 0; k < moments.size(); ++k) {
      const float age = static_cast<float>(moments.size() - 1 - k);
      draw_person(image, moments[k], places[k], color, age == 0 ? 0.95f : 0.42f * std::pow(0.6f, age - 1));
    }
  }

  std::vector<Joints> moments;
  std::vector<Vector2f> places;
  Vector2f low = Vector2f::Zero(), high = Vector2f::Zero();
};

/// In an order in which no part of the map comes first, where there is room.
void draw_figures(Image& image, const std::vector<MapPoint>& points, const MapFrame& frame,
                  const MapPlotOptions& options) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  Rng rng(1);
  for (int i = static_cast<int>(ssize(order)) - 1; i > 0; --i) std::swap(order[i], order[rng.below(i + 1)]);
  order.insert(order.begin(), options.marked.begin(), options.marked.end());
  std::vector<std::pair<int, DrawnFigure>> drawn;
  for (size_t i = 0; i < order.size() && drawn.size() < kMostFigures; ++i) {
    const Vector2f at = frame.at(points[order[i]].at);
    const bool must = i < options.marked.size();
    const auto near = [&](const auto& one) {
      return (at.array() > one.second.low.array() - 12).all() &&
             (at.array() < one.second.high.array() + 12).all();
    };
    if (!must && std::any_of(drawn.begin(), drawn.end(), near)) continue;  // without asking for the figure
    DrawnFigure figure(options.figure(order[i]), at);
    const bool free =
        std::none_of(drawn.begin(), drawn.end(), [&](const auto& one) { return one.second.meets(figure); });
    if (!figure.moments.empty() && (must || (free && figure.inside(frame))))
      drawn.emplace_back(order[i], std::move(figure));
  }
  for (auto one = drawn.rbegin(); one != drawn.rend(); ++one) {
    one->second.draw(image, points[one->first].color);
  }
}

void draw_marks(Image& image, const Font& font, const std::vector<MapPoint>& points, const MapFrame& frame,
                const MapPlotOptions& options) {
  for (size_t k = 0; k < options.marked.size(); ++k) {
    const Vector2f at = frame.at(points[options.marked[k]].at);
    line(image, at, at, 26, kMapInk);
    line(image, at, at, 21, Vec3::Ones());
    const std::string number = std::to_string(k + 1);
    font.draw(image, number, {at.x() - 0.5f * font.width(number, 15), at.y() + 5}, 15, kMapInk);
  }
}

}  // namespace

Image map_plot(const std::vector<MapPoint>& points, const MapPlotOptions& options) {
  const MapFrame frame = map_frame(points, options);
  const Font font = Font::system();
  Image image(options.width, options.height, Vec3::Ones());
  draw_map_axes(image, font, frame, options);
  for (const MapPoint& point : points) {
    const Vector2f at = frame.at(point.at);
    paint(image, {{at, at, 5, 5}}, point.color, points.size() > 4000 ? 0.25f : 0.5f);
  }
  if (options.figure) draw_figures(image, points, frame, options);
  draw_marks(image, font, points, frame, options);
  draw_map_legend(image, font, options);
  return image;
}

}  // namespace understudy::render
