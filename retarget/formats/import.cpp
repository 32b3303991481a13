#include "retarget/formats/import.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/room.hpp"
#include "retarget/geometry/cells.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

struct Unit {
  const char* name;
  const char* plural;
  float metres;
  float low, high;  // heights of bodies in this unit, as a guess takes them
};

// The ranges lie side by side, so each height has one unit: 52 to 84 might be a toddler in centimetres, but
// an adult in inches is the likelier file.
constexpr std::array<Unit, 5> kUnits = {{{"m", "metres", 1.0f, 0.5f, 2.6f},
                                         {"dm", "decimetres", 0.1f, 5.0f, 26.0f},
                                         {"in", "inches", 0.0254f, 26.0f, 84.0f},
                                         {"cm", "centimetres", 0.01f, 84.0f, 260.0f},
                                         {"mm", "millimetres", 0.001f, 500.0f, 2600.0f}}};

constexpr float kUsualHeight = 1.7f;
constexpr float kBodyCell = 0.04f;  // of the extent: bodies further apart are several

struct Range {
  float low = 0, high = 0;
  float size() const { return high - low; }
};

// The ends of sorted values with stray ones left aside: an end is where the values become dense.
Range dense_range(const std::vector<float>& sorted) {
  const size_t n = sorted.size();
  const auto want = std::max<size_t>(3, n / 250);
  if (n < 4 * want) return {sorted.front(), sorted.back()};
  const float middle_half = sorted[n * 3 / 4] - sorted[n / 4];
  const float reach = std::max(0.05f * middle_half, 1e-9f);
  size_t low = 0, high = n - 1;
  while (low < n / 4 && sorted[low + want] - sorted[low] > reach) ++low;
  while (high > n * 3 / 4 && sorted[high] - sorted[high - want] > reach) --high;
  return {sorted[low], sorted[high]};
}

std::vector<float> sorted(const Eigen::VectorXf& values) {
  std::vector<float> result(values.begin(), values.end());
  std::sort(result.begin(), result.end());
  return result;
}

// What one axis of the scan looks like.
struct AxisView {
  Range range;
  float middle_half = 0;  // between the quartiles of the mass
};

// Points with equal mass each: of a mesh by area, or dense hands would pull. Triangles that are not finite
// have none.
Points even_points(const Mesh& mesh) {
  if (mesh.is_cloud()) return finite_points(mesh.vertices);
  try {
    Rng rng(1);
    return sample_points(mesh, 8000, rng);
  } catch (const Error&) {  // no area
    return finite_points(mesh.vertices);
  }
}

// A floor is a thin slab at one end of an axis that holds many points and reaches further than the rest of
// the scan.
struct FloorSlab {
  bool seen = false;
  bool at_high_end = false;
  float height = 0;  // along the axis
};

float spread(const Points& points, const std::vector<Eigen::Index>& rows, int axis) {
  if (rows.size() < 8) return 0;
  const std::vector<float> values = sorted(points(rows, axis));
  return values[values.size() * 19 / 20] - values[values.size() / 20];
}

FloorSlab find_floor(const Points& points, int axis, const AxisView& view) {
  const float extent = view.range.size(), thickness = 0.03f * extent;
  for (const bool high : {false, true}) {
    const float end = high ? view.range.high : view.range.low;
    std::vector<Eigen::Index> slab, rest;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const float depth = high ? end - points(i, axis) : points(i, axis) - end;
      (depth < thickness ? slab : rest).push_back(i);
    }
    if (slab.size() < static_cast<size_t>(points.rows()) / 20 || rest.size() < slab.size() / 4) continue;
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    const float wide = std::min(spread(points, slab, a), spread(points, slab, b));
    const bool wider = spread(points, slab, a) > 0.9f * spread(points, rest, a) &&
                       spread(points, slab, b) > 0.9f * spread(points, rest, b);
    if (!wider || wide < 0.25f * extent) continue;
    return {true, high, sorted(points(slab, axis))[slab.size() / 2]};
  }
  return {};
}

struct UpGuess : UpAxis {
  FloorSlab floor;
};

// A person in T-pose is as wide as tall, so the extent alone does not tell: but the mass of a body is spread
// along its height, and gathered in the middle of its width. x is up in hardly any file.
UpGuess guess_up(const Points& points, const std::array<AxisView, 3>& views) {
  UpGuess best;
  float best_score = -1;
  for (const int axis : {1, 2, 0}) {
    const FloorSlab floor = find_floor(points, axis, views[axis]);
    if (floor.seen) return {{axis, floor.at_high_end}, floor};
    float score = 2.0f * views[axis].middle_half + views[axis].range.size();
    if (axis == 0) score *= 0.8f;
    if (std::abs(views[axis].range.low) < 0.03f * views[axis].range.size()) score *= 1.15f;  // stands on 0
    if (score > best_score) {
      best_score = score;
      best = {{axis, false}, {}};
    }
  }
  return best;
}

// The rotation that takes the up axis to +y; x stays where it can.
Mat3 to_y_up(const UpAxis& up) {
  Mat3 R;
  const float s = up.negative ? -1.0f : 1.0f;
  if (up.axis == 0)
    R << 0, -s, 0, s, 0, 0, 0, 0, 1;
  else if (up.axis == 1)
    R << 1, 0, 0, 0, s, 0, 0, 0, s;
  else
    R << 1, 0, 0, 0, 0, s, 0, -s, 0;
  return R;
}

float longest(const std::array<AxisView, 3>& views) {
  return std::max({views[0].range.size(), views[1].range.size(), views[2].range.size()});
}

/// The points of the largest of several bodies that stand beside each other; none where there is one.
/// Together they are wider than tall, and would be taken for somebody who lies.
std::optional<Points> largest_body(const Points& points, const std::array<AxisView, 3>& views) {
  const float extent = longest(views);
  if (!(extent > 1e-20f) || extent > 1e30f) return std::nullopt;
  Mesh cloud;
  cloud.vertices = points * (1 / extent);
  const Cells cells(cloud, kBodyCell);
  int count = 0;
  const std::vector<int> set = connected_cells(cells, std::vector<char>(cells.count(), 1), &count);
  std::vector<int> size(count, 0);
  for (const int s : set) ++size[s];
  const auto bodies = std::count_if(size.begin(), size.end(), [&](int n) { return 4 * n >= cells.count(); });
  if (bodies < 2) return std::nullopt;
  const int largest = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (const int cell = cells.of_vertex()[i]; cell >= 0 && set[cell] == largest) rows.push_back(i);
  return points(rows, Eigen::all);
}

std::array<AxisView, 3> views_of(const Points& points) {
  std::array<AxisView, 3> views;
  for (int axis = 0; axis < 3; ++axis) {
    const auto values = sorted(points.col(axis));
    views[axis] = {dense_range(values), values[values.size() * 3 / 4] - values[values.size() / 4]};
  }
  return views;
}

/// As the largest of several bodies has it, where all of them have the same height.
UpGuess guess_up_among(const Points& points, const std::array<AxisView, 3>& views) {
  const UpGuess of_all = guess_up(points, views);
  if (of_all.floor.seen) return of_all;
  const auto body = largest_body(points, views);
  if (!body || body->rows() < 32) return of_all;
  const std::array<AxisView, 3> own = views_of(*body);
  const UpGuess of_one = guess_up(*body, own);
  // Pieces of one body, one above the other, are as long together as they are not alone.
  const bool is_whole = own[of_one.axis].range.size() > 0.7f * views[of_one.axis].range.size();
  return is_whole && !of_one.floor.seen ? of_one : of_all;
}

UpAxis named_up(const std::string& up) {
  const bool negative = !up.empty() && up[0] == '-';
  const std::string letter = negative ? up.substr(1) : up;
  US_CHECK(letter == "x" || letter == "y" || letter == "z", "the up axis '", up,
           "' is not one of x, y, z, -x, -y, -z");
  return {letter[0] - 'x', negative};
}

UpGuess forced_up(const std::string& up, const Points& points, const std::array<AxisView, 3>& views) {
  UpGuess guess{named_up(up), {}};
  const FloorSlab floor = find_floor(points, guess.axis, views[guess.axis]);
  if (floor.seen && floor.at_high_end == guess.negative) guess.floor = floor;
  return guess;
}

std::string short_number(float value) {
  return printed("%.4g", static_cast<double>(value));
}

// No person has this height in any unit. Somebody who lies is still in metres; the rest, small or large, are
// characters of arbitrary size, and become as tall as people are.
std::string decide_odd_size(float height, float extent, ImportDecision& decision) {
  const bool has_size = height > 1e-20f && height < 1e30f;
  const Unit& metres = kUnits[0];
  const bool lies = height < metres.low && extent >= metres.low && extent < metres.high;
  const bool metric = !has_size || lies;
  const std::string what = "a height of " + short_number(height) + " fits no person in any unit";
  decision.units = metric ? "m" : "fit";
  decision.scale = metric ? 1.0f : kUsualHeight / height;
  decision.warning = what + (metric ? ", it is taken as metres" : ", it is made 1.7 m");
  return std::string("units: ") + (metric ? "metres (" : "unknown, made 1.7 m tall (") + what + ")";
}

std::string given_height(float height, float wanted, ImportDecision& decision) {
  US_CHECK(wanted >= kBodyHeights.low && wanted <= kBodyHeights.high, "a height is ", kBodyHeights.low,
           " to ", kBodyHeights.high, " m, not ", wanted);
  US_CHECK(height > 1e-20f && height < 1e30f, "what has no height cannot be made ", wanted, " m tall");
  decision.units = "fit";
  decision.scale = wanted / height;
  return "height: " + short_number(wanted) + " m (given)";
}

bool is_given(const std::string& option) {
  return !option.empty() && option != "auto";
}

// What units are guessed from.
struct BodySize {
  float height = 0, extent = 0;  // of the scan, along up and along any axis
  std::optional<float> stature;  // of somebody whose feet are not in it
  std::optional<Room> room;      // that the height is of somebody in
};

std::string from_room(const Room& room) {
  if (room.people == 0) return " (from what is on the ground)";
  return " (from " + std::string(room.people == 1 ? "a body" : std::to_string(room.people) + " bodies") +
         " on the ground, " + short_number(room.height) + " tall)";
}

// Writes unit and scale into the decision; returns the words about it.
std::string decide_size(const BodySize& size, const ImportOptions& options, ImportDecision& decision) {
  const float height = size.stature.value_or(size.height);
  const std::string& forced = options.units;
  const bool guess = !is_given(forced);
  const Unit* unit = nullptr;
  for (const auto& candidate : kUnits)
    if (!guess      ? forced == candidate.name
        : size.room ? size.room->metres == candidate.metres
                    : height >= candidate.low && height < candidate.high)
      unit = &candidate;
  US_CHECK(guess || unit, "the unit '", forced, "' is not one of m, dm, cm, mm, in");
  if (options.height) return given_height(height, *options.height, decision);
  if (!unit) return decide_odd_size(height, size.stature ? height : size.extent, decision);
  decision.units = unit->name;
  decision.scale = unit->metres;
  return std::string("units: ") + unit->plural +
         (!guess         ? " (given)"
          : size.room    ? from_room(*size.room)
          : size.stature ? " (from a stature of " + short_number(height) + ", by what is seen)"
                         : " (from the height " + short_number(height) + ")");
}

// The first frame, as far as it is decided from.
class FirstView {
 public:
  FirstView(const Mesh& first, const std::string& up);
  explicit FirstView(const Room& room);
  ImportDecision decided(const ImportOptions& forced, const std::optional<UnseenFeet>& cut) const;
  // What a check finds, in the file's units.
  std::optional<UnseenFeet> checked(const Mesh& first, const ImportOptions& forced,
                                    const FeetCheck& check) const;
  bool is_sideways() const { return up_.axis == 0 && !up_.floor.seen; }

 private:
  UpGuess up_;
  float low_ = 0;  // of the body, along up
  BodySize size_;
};

FirstView::FirstView(const Mesh& first, const std::string& up) {
  const Points points = even_points(first);
  US_CHECK(points.rows() > 0, "the first frame has no finite point to decide units and axes from");
  const std::array<AxisView, 3> views = views_of(points);
  up_ = is_given(up) ? forced_up(up, points, views) : guess_up_among(points, views);
  const Range range = views[up_.axis].range;
  low_ = up_.negative ? -range.high : range.low;
  const float high = up_.negative ? -range.low : range.high;
  if (up_.floor.seen) low_ = up_.negative ? -up_.floor.height : up_.floor.height;
  size_.height = high - low_;
  size_.extent = longest(views);
}

FirstView::FirstView(const Room& room)
    : up_{room.up, {true, room.up.negative, room.up.negative ? -room.floor : room.floor}}, low_(room.floor) {
  size_.height = room.height;
  size_.room = room;
}

std::optional<UnseenFeet> FirstView::checked(const Mesh& first, const ImportOptions& forced,
                                             const FeetCheck& check) const {
  const ImportDecision by_height = decided(forced, {});
  Mesh upright = first;
  by_height.apply(upright);
  std::optional<UnseenFeet> cut = check(upright);
  if (!cut) return cut;
  cut->stature /= by_height.scale;
  cut->floor = (cut->floor + by_height.floor) / by_height.scale;
  return cut;
}

ImportDecision FirstView::decided(const ImportOptions& forced, const std::optional<UnseenFeet>& cut) const {
  BodySize size = size_;
  if (cut) size.stature = cut->stature;
  const float low = cut && !up_.floor.seen ? cut->floor : low_;
  ImportDecision decision;
  decision.up = std::string(up_.negative ? "-" : "") + static_cast<char>('x' + up_.axis);
  decision.sentence = decide_size(size, forced, decision);
  decision.height = size.stature.value_or(size.height) * decision.scale;
  decision.axes = rotation_about_y(forced.turn_deg * kPi / 180.0f) * to_y_up(up_);
  const float measured = low * decision.scale;
  // Within 2 cm the file's own zero is the better floor: the lowest points are a noisy measure of it.
  decision.floor = forced.floor ? *forced.floor : std::abs(measured) <= 0.02f ? 0.0f : measured;
  decision.sentence += ", up: " + decision.up + (is_given(forced.up) ? " (given)" : "") +
                       (up_.floor.seen ? " (from the floor)" : "") + ", floor at " +
                       printed("%.2f", static_cast<double>(decision.floor)) + " m";
  if (forced.turn_deg != 0) decision.sentence += ", turned by " + short_number(forced.turn_deg) + " degrees";
  if (!cut) return decision;
  ImportOptions& again = decision.again.emplace(forced);
  again.up = decision.up;
  again.floor = decision.floor;
  if (decision.units == "fit")
    again.height = size.height * decision.scale;
  else
    again.units = decision.units;
  return decision;
}

}  // namespace

void ImportDecision::apply(Mesh& mesh) const {
  mesh.vertices = apply(mesh.vertices);
}

Points ImportDecision::apply(const Points& points) const {
  const Mat3 M = (axes * scale).transpose();
  Points out = points * M;  // rows: p^T (sR)^T
  out.col(1).array() -= floor;
  return out;
}

Eigen::Matrix4d ImportDecision::to_file() const {
  Eigen::Matrix4d to_world = Eigen::Matrix4d::Identity();
  to_world.topLeftCorner<3, 3>() = (axes * scale).cast<double>();
  to_world(1, 3) = -static_cast<double>(floor);
  return to_world.inverse();
}

ImportDecision decide_import(const Mesh& first, const ImportOptions& forced, const FeetCheck& check) {
  FirstView view(first, forced.up);
  std::optional<UnseenFeet> cut;
  if (check && !(is_given(forced.units) && !forced.height && forced.floor)) {
    cut = view.checked(first, forced, check);
    // Whose chest alone is seen is wider than tall.
    if (!is_given(forced.up) && view.is_sideways())
      for (const char* up : {"y", "z"}) {
        const FirstView other(first, up);
        const std::optional<UnseenFeet> found = other.checked(first, forced, check);
        if (!found || (cut && cut->upright >= found->upright)) continue;
        cut = found;
        view = other;
      }
  }
  ImportDecision decision = view.decided(forced, cut);
  if (!decision.warning.empty()) log::warn(decision.warning);
  return decision;
}

std::optional<ImportDecision> decide_scan_import(const Mesh& first, const ImportOptions& forced,
                                                 const FeetCheck& check) {
  const RoomView view = view_room(first);
  std::vector<float> metres;
  for (const char* name : {"m", "mm", "cm", "in", "dm"})
    for (const Unit& unit : kUnits)
      if (unit.name == std::string(name) && (!is_given(forced.units) || forced.units == name))
        metres.push_back(unit.metres);
  std::vector<UpAxis> ups = {{1, false}, {2, false}, {0, false}, {1, true}, {2, true}, {0, true}};
  if (is_given(forced.up)) ups = {named_up(forced.up)};
  if (const auto room = find_room(view, metres, ups)) return FirstView(*room).decided(forced, {});
  const bool is_flat = 20 * view.rest.rows() < view.points.rows();
  if (is_flat && !(is_given(forced.units) && is_given(forced.up))) return std::nullopt;
  const bool is_walled = 2 * view.rest.rows() < view.points.rows();
  if (is_walled && !is_flat)
    return decide_import(Mesh{outside(view.planes, even_points(first))}, forced, check);
  return decide_import(first, forced, check);
}

}  // namespace understudy
