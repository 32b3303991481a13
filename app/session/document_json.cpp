// Documents to JSON and back. Each struct's members are listed once, in fields(); what is written and what is
// read is the same list.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>

#include "app/session/document_file.hpp"
#include "retarget/base/error.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr float kAnyFloat = std::numeric_limits<float>::max();
constexpr double kAnyDouble = std::numeric_limits<double>::max();
constexpr int kMostFrames = 1000000000;
constexpr const char* kFormat = "understudy document";

template <class Number>
struct Range {
  Number low, high;
};
constexpr Range<int> kFrames{0, kMostFrames}, kFramesOrNone{-1, kMostFrames}, kJoints{0, kJointCount - 1};
constexpr Range<float> kShare{0, 1}, kAny{-kAnyFloat, kAnyFloat};

/// The names of an enum's values, in their order.
template <size_t N>
using Names = std::array<const char*, N>;
constexpr Names<3> kRootNames{"scaled", "original", "in-place"};
constexpr Names<3> kLimbNames{"arms", "legs", "both"};
constexpr Names<4> kLayoutNames{"side-by-side", "single", "overlay", "wipe"};
constexpr Names<7> kColouringNames{"plain",      "weights",    "offsets", "error",
                                   "difference", "confidence", "doubt"};

std::string indexed(const std::string& where, size_t i) {
  return where + '[' + std::to_string(i) + ']';
}

/// A float with as few digits as give the same float again.
Json shortest(float value) {
  if (value == std::trunc(value) && std::abs(value) < 1e6f) return static_cast<int64_t>(value);
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  double decimal = value;
  std::from_chars(text, end, decimal);
  return static_cast<float>(decimal) == value ? decimal : static_cast<double>(value);
}

template <class Number>
std::string range_text(const Range<Number>& range) {
  const std::string kind = std::is_integral_v<Number> ? "a whole number" : "a finite number";
  if (static_cast<double>(range.high) >= kMostFrames) return kind;
  return kind + " from " + detail::join(range.low) + " to " + detail::join(range.high);
}

/// Throws Error unless these are rows that can replace those of a weight matrix.
void check_rows(const WeightRows& edit, const std::string& where) {
  const std::vector<int>& vertex = edit.vertex;
  const RowMatrix& rows = edit.rows;
  US_CHECK(rows.rows() == static_cast<Eigen::Index>(vertex.size()) && rows.cols() == kJointCount, where,
           " has ", rows.rows(), " rows of ", rows.cols(), " for ", vertex.size(), " vertices and ",
           kJointCount, " joints");
  const bool ascend =
      std::adjacent_find(vertex.begin(), vertex.end(), std::greater_equal<>()) == vertex.end();
  US_CHECK(ascend && (vertex.empty() || vertex[0] >= 0), where, ".vertices must ascend from 0 on");
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const auto row = rows.row(i);  // comparisons that are false for NaN, too
    US_CHECK(row.minCoeff() >= 0 && std::abs(row.sum() - 1) < 1e-3f, where, ".rows[", i,
             "] must be weights with the sum 1");
  }
}

bool is_utf8(const std::string& text) {
  const auto replace = Json::error_handler_t::replace;
  return Json::parse(Json(text).dump(-1, ' ', false, replace)).get<std::string>() == text;
}

/// Members out. Refuses what the reader would refuse, so that no document is saved that cannot be opened.
class Writer {
 public:
  template <class T>
  using Of = const T;

  Writer(Json& json, const std::string& folder, std::string where)
      : json_(json), folder_(folder), where_(std::move(where)) {}

  void operator()(const char* name, bool value) { json_[name] = value; }
  void operator()(const char* name, const std::string& value) { json_[name] = value; }
  template <class Number>
  void number(const char* name, Number value, const Range<Number>& range) {
    US_CHECK(value >= range.low && value <= range.high, where_, name, " is ", value, ", it must be ",
             range_text(range));
    put(name, value);
  }
  /// What is shown, not what is computed: brought into its range.
  template <class Number>
  void clamped(const char* name, Number value, const Range<Number>& range) {
    put(name, value >= range.low ? std::min(value, range.high) : range.low);  // NaN too
  }
  void operator()(const char* name, const Vec3& value) {
    US_CHECK(value.allFinite(), where_, name, " is not finite");
    json_[name] = {shortest(value.x()), shortest(value.y()), shortest(value.z())};
  }
  void operator()(const char* name, const std::vector<float>& values) {
    Json list = Json::array();
    for (const float value : values) {
      US_CHECK(std::isfinite(value), where_, name, " is not finite");
      list.push_back(shortest(value));
    }
    json_[name] = std::move(list);
  }
  template <class Whole>
  void whole_list(const char* name, const Whole& values, const Range<int>&) {
    json_[name] = values;
  }
  void path(const char* name, const std::string& value);
  void optional_number(const char* name, const std::optional<float>& value) {
    if (value) number(name, *value, kAny);
  }
  template <class Enum, size_t N>
  void choice(const char* name, Enum value, const Names<N>& names) {
    json_[name] = names[static_cast<size_t>(value)];
  }
  template <class T>
  void operator()(const char* name, const T& value) {
    put_struct(json_[name], value, where_ + name + '.');
  }
  template <class T>
  void operator()(const char* name, const std::optional<T>& value) {
    if (value) (*this)(name, *value);
  }
  template <class T>
  void operator()(const char* name, const std::vector<T>& values) {
    Json list = Json::array();
    for (size_t i = 0; i < values.size(); ++i)
      put_struct(list.emplace_back(), values[i], indexed(where_ + name, i) + '.');
    json_[name] = std::move(list);
  }
  void operator()(const char* name, const BoneChoices& choices) {
    Json object = Json::object();
    for (const auto& [joint, bone] : choices) {
      US_CHECK(is_utf8(joint) && is_utf8(bone), where_, name, " has a name that is not UTF-8");
      object[joint] = bone;
    }
    json_[name] = std::move(object);
  }
  void weights(const char* name, const std::shared_ptr<const WeightRows>& value);
  void skeleton_edit(const SkeletonEdit& edit);

 private:
  void put(const char* name, float value) { json_[name] = shortest(value); }
  void put(const char* name, double value) { json_[name] = value; }
  void put(const char* name, int value) { json_[name] = value; }
  template <class T>
  void put_struct(Json& json, const T& value, const std::string& where);

  Json& json_;
  const std::string& folder_;
  std::string where_;  // "takes[2].method."
};

/// Members in. What is missing stays as it is, what is not known is passed over.
class Reader {
 public:
  template <class T>
  using Of = T;

  Reader(const Json& json, const std::string& folder, std::string where)
      : json_(json), folder_(folder), where_(std::move(where)) {
    US_CHECK(json.is_object(), where_.substr(0, where_.size() - 1), " must be an object");
  }

  void operator()(const char* name, bool& value) {
    const Json* json = member(name);
    if (!json) return;
    US_CHECK(json->is_boolean(), where_, name, " must be true or false");
    value = json->get<bool>();
  }
  void operator()(const char* name, std::string& value) {
    const Json* json = member(name);
    if (!json) return;
    US_CHECK(json->is_string(), where_, name, " must be text");
    value = json->get<std::string>();
  }
  template <class Number>
  void number(const char* name, Number& value, const Range<Number>& range) {
    if (const Json* json = member(name)) value = number_in(*json, range, where_ + name);
  }
  template <class Number>
  void clamped(const char* name, Number& value, const Range<Number>& range) {
    const Range<double> any{-kAnyDouble, kAnyDouble};
    const Json* json = member(name);
    if (!json) return;
    const double read = number_in(*json, any, where_ + name);
    value = static_cast<Number>(
        std::clamp(read, static_cast<double>(range.low), static_cast<double>(range.high)));
  }
  void operator()(const char* name, Vec3& value) {
    std::vector<float> three{value.x(), value.y(), value.z()};
    (*this)(name, three);
    US_CHECK(three.size() == 3, where_, name, " must be three numbers");
    value = Vec3(three[0], three[1], three[2]);
  }
  void operator()(const char* name, std::vector<float>& values) {
    const Json* json = list(name);
    if (!json) return;
    values.clear();
    for (const Json& one : *json) values.push_back(number_in(one, kAny, where_ + name));
  }
  template <class Whole>
  void whole_list(const char* name, Whole& values, const Range<int>& range) {
    const Json* json = list(name);
    if (!json) return;
    values.clear();
    for (const Json& one : *json) values.insert(values.end(), number_in(one, range, where_ + name));
  }
  void path(const char* name, std::string& value);
  void optional_number(const char* name, std::optional<float>& value) {
    const Json* json = member(name);
    if (json && !json->is_null()) value = number_in(*json, kAny, where_ + name);
  }
  template <class Enum, size_t N>
  void choice(const char* name, Enum& value, const Names<N>& names) {
    std::string text = names[static_cast<size_t>(value)];
    (*this)(name, text);
    const auto found = std::find(names.begin(), names.end(), text);
    std::string all = names[0];
    for (size_t i = 1; i < N; ++i) all += std::string(i + 1 < N ? ", " : " or ") + names[i];
    US_CHECK(found != names.end(), where_, name, " must be ", all);
    value = static_cast<Enum>(found - names.begin());
  }
  template <class T>
  void operator()(const char* name, T& value) {
    if (const Json* json = member(name)) read_struct(*json, value, where_ + name + '.');
  }
  template <class T>
  void operator()(const char* name, std::optional<T>& value) {
    const Json* json = member(name);
    if (json && !json->is_null()) read_struct(*json, value.emplace(), where_ + name + '.');
  }
  template <class T>
  void operator()(const char* name, std::vector<T>& values) {
    const Json* json = list(name);
    if (!json) return;
    values.clear();
    for (const Json& one : *json)
      read_struct(one, values.emplace_back(), indexed(where_ + name, values.size() - 1) + '.');
  }
  void operator()(const char* name, BoneChoices& choices) {
    const Json* json = member(name);
    if (!json) return;
    US_CHECK(json->is_object(), where_, name, " must be an object");
    choices.clear();
    for (const auto& [joint, bone] : json->items()) {
      US_CHECK(bone.is_string(), where_, name, " must name bones");
      choices[joint] = bone.get<std::string>();
    }
  }
  void weights(const char* name, std::shared_ptr<const WeightRows>& value);
  void skeleton_edit(SkeletonEdit& edit);

 private:
  const Json* member(const char* name) const {
    const auto found = json_.find(name);
    return found == json_.end() ? nullptr : &*found;
  }
  const Json* list(const char* name) const {
    const Json* json = member(name);
    US_CHECK(!json || json->is_array(), where_, name, " must be a list");
    return json;
  }
  template <class Number>
  static Number number_in(const Json& json, const Range<Number>& range, const std::string& where) {
    const double value = json.is_number() ? json.get<double>() : std::nan("");
    const bool fits = value >= static_cast<double>(range.low) && value <= static_cast<double>(range.high) &&
                      (!std::is_integral_v<Number> || value == std::trunc(value));
    US_CHECK(fits, where, " must be ", range_text(range));
    return static_cast<Number>(value);
  }
  template <class T>
  void read_struct(const Json& json, T& value, const std::string& where);

  const Json& json_;
  const std::string& folder_;
  std::string where_;
};

// ---- the members ----

template <class A>
void fields(A& a, typename A::template Of<ImportOptions>& import) {
  a("units", import.units);
  a("up", import.up);
  a.number("yaw_deg", import.yaw_deg, kAny);
  a.optional_number("floor_m", import.floor);
}

template <class A>
void fields(A& a, typename A::template Of<SourceOptions>& source) {
  a.path("path", source.path);
  a.path("motion", source.motion);
  a("betas", source.betas);
  a.number("fps", source.fps, Range<double>{0, 1e6});
  a("import", source.import);
  a("follow", source.follow);
  a("as_scan", source.as_scan);
  a("clip", source.clip);
  a("bones", source.bones);
}

template <class A>
void fields(A& a, typename A::template Of<Box>& box) {
  a("low", box.low);
  a("high", box.high);
}

template <class A>
void fields(A& a, typename A::template Of<FloorPlane>& plane) {
  a("normal", plane.normal);
  a.number("height_m", plane.height_m, kAny);
}

template <class A>
void fields(A& a, typename A::template Of<FloorCut>& cut) {
  a.number("height_m", cut.height_m, kAny);
  a("plane", cut.plane);
  a.number("tolerance_m", cut.tolerance_m, kAny);
  a.number("sole_radius_m", cut.sole_radius_m, kAny);
  a.number("sole_band_m", cut.sole_band_m, kAny);
}

template <class A>
void fields(A& a, typename A::template Of<ScanEdits>& edits) {
  a("crop", edits.crop);
  a("floor", edits.floor);
  a("largest_cluster", edits.largest_cluster);
  a.number("cluster_gap_m", edits.cluster_gap_m, kAny);
}

template <class A>
void fields(A& a, typename A::template Of<DragEdit>& drag) {
  a.number("frame", drag.frame, kFrames);
  a.number("joint", drag.joint, kJoints);
  a("offset", drag.offset);
  a.number("falloff", drag.falloff, kFrames);
  a("with_children", drag.with_children);
}

template <class A>
void fields(A& a, typename A::template Of<SwapEdit>& swap) {
  a.number("first", swap.first, kFrames);
  a.number("last", swap.last, kFrames);
  a.choice("limbs", swap.limbs, kLimbNames);
}

template <class A>
void fields(A& a, typename A::template Of<SkeletonEdit>& edit) {
  a.skeleton_edit(edit);
}

template <class A>
void fields(A& a, typename A::template Of<TargetOptions>& target) {
  a.path("path", target.path);
  a("betas", target.betas);
  a("import", target.import);
  a("forward", target.forward);
  a("rig", target.rig);
  a("bones", target.bones);
}

template <class A>
void fields(A& a, typename A::template Of<Method>& method) {
  a("engine", method.engine);
  a("extractor", method.extractor);
  a("offsets", method.offsets);
  a("repair_swaps", method.repair_swaps);
  a("smooth_joints", method.smooth_joints);
  a("fix_lengths", method.fix_lengths);
  a("lock_feet", method.lock_feet);
  a.choice("root", method.root, kRootNames);
}

template <class A>
void fields(A& a, typename A::template Of<JointMove>& move) {
  a.number("joint", move.joint, kJoints);
  a("position", move.position);
  a("mirror", move.mirror);
}

template <class A>
void fields(A& a, typename A::template Of<TargetEdits>& edits) {
  a("joints", edits.joints);
  a.weights("weights", edits.weights);
}

template <class A>
void fields(A& a, typename A::template Of<RotateEdit>& edit) {
  a.number("frame", edit.frame, kFrames);
  a.number("joint", edit.joint, kJoints);
  a("axis_angle", edit.axis_angle);
  a.number("falloff", edit.falloff, kFrames);
}

template <class A>
void fields(A& a, typename A::template Of<SmoothEdit>& edit) {
  a.number("strength", edit.strength, kShare);
}

template <class A>
void fields(A& a, typename A::template Of<FloorEdit>& edit) {
  a.number("offset_m", edit.offset_m, kAny);
}

template <class A>
void fields(A& a, typename A::template Of<FootContactOptions>& contact) {
  a.number("begin_height_m", contact.begin_height_m, kAny);
  a.number("end_height_m", contact.end_height_m, kAny);
  a.number("begin_speed", contact.begin_speed, kAny);
  a.number("end_speed", contact.end_speed, kAny);
}

template <class A>
void fields(A& a, typename A::template Of<PinEdit>& edit) {
  a("left", edit.left);
  a("right", edit.right);
  a("contact", edit.contact);
  a.number("blend_s", edit.blend_s, kAny);
  a("keep_soles_up", edit.keep_soles_up);
  a("to_floor", edit.to_floor);
  a.number("max_drop_m", edit.max_drop_m, kAny);
}

template <class A>
void fields(A& a, typename A::template Of<HeadingEdit>& edit) {
  a.number("yaw_deg", edit.yaw_deg, kAny);
}

template <class A>
void fields(A& a, typename A::template Of<Trim>& trim) {
  a.number("first", trim.first, kFrames);
  a.number("last", trim.last, kFrames);
}

template <class A>
void fields(A& a, typename A::template Of<PoseEdits>& edits) {
  a("rotate", edits.rotate);
  a("smooth", edits.smooth);
  a("floor", edits.floor);
  a("pin", edits.pin);
  a("heading", edits.heading);
  a("trim", edits.trim);
  a.whole_list("skip", edits.skip, kFrames);
}

template <class A>
void fields(A& a, typename A::template Of<Take>& take) {
  a("name", take.name);
  a("target", take.target);
  a("method", take.method);
  a("target_edits", take.target_edits);
  a("pose_edits", take.pose_edits);
}

template <class A>
void fields(A& a, typename A::template Of<CameraState>& camera) {
  a("target", camera.target);
  a.clamped("yaw", camera.yaw, kAny);
  a.clamped("pitch", camera.pitch, kAny);
  a.clamped("distance", camera.distance, Range<float>{1e-3f, 1e6f});
  a.clamped("fov", camera.fov, Range<float>{0.01f, 3});
  a("orthographic", camera.orthographic);
}

template <class A>
void fields(A& a, typename A::template Of<Layers>& layers) {
  a("surface", layers.surface);
  a("as_points", layers.as_points);
  a("skeleton", layers.skeleton);
  a("x_ray", layers.x_ray);
  a("joint_names", layers.joint_names);
  a("ground", layers.ground);
  a("trails", layers.trails);
  a("ghosts", layers.ghosts);
  a.choice("colouring", layers.colouring, kColouringNames);
}

template <class A>
void fields(A& a, typename A::template Of<View>& view) {
  a.choice("layout", view.layout, kLayoutNames);
  a("linked", view.linked);
  a("cameras", view.cameras);
  a("follow", view.follow);
  a.clamped("turntable_deg_s", view.turntable_deg_s, Range<float>{-3600, 3600});
  a("source", view.source);
  a("take", view.take);
  a.clamped("active_pane", view.active_pane, Range<int>{0, 10000});
  a.clamped("weights_joint", view.weights_joint, Range<int>{-1, kJointCount - 1});
  a.whole_list("trail_joints", view.trail_joints, kJoints);
  a.clamped("ghost_count", view.ghost_count, Range<int>{0, 100});
  a.clamped("ghost_step", view.ghost_step, Range<int>{1, kMostFrames});
  a.clamped("error_scale_mm", view.error_scale_mm, Range<float>{1e-3f, 1e6f});
  a.clamped("wipe", view.wipe, kShare);
  a("metric", view.metric);
}

template <class A>
void fields(A& a, typename A::template Of<Playback>& playback) {
  a("loop", playback.loop);
  a.clamped("rate", playback.rate, Range<double>{0.1, 4});
  a.clamped("frame", playback.frame, Range<double>{0, kMostFrames});
  a.clamped("in", playback.in, kFramesOrNone);
  a.clamped("out", playback.out, kFramesOrNone);
}

template <class A>
void fields(A& a, typename A::template Of<SavedDocument>& saved) {
  a("weights", saved.weights);
  a("source", saved.document.source);
  a.path("truth", saved.document.truth);
  a("scan_edits", saved.document.scan_edits);
  a("skeleton_edits", saved.document.skeleton_edits);
  a("takes", saved.document.takes);
  a("view", saved.view);
  a("playback", saved.playback);
}

// ---- what needs more than a line ----

template <class T>
void Writer::put_struct(Json& json, const T& value, const std::string& where) {
  json = Json::object();
  Writer writer(json, folder_, where);
  fields(writer, value);
}

template <class T>
void Reader::read_struct(const Json& json, T& value, const std::string& where) {
  Reader reader(json, folder_, where);
  fields(reader, value);
}

/// The first folder below the root, "" for the root itself.
fs::path first_folder(const fs::path& absolute) {
  const fs::path below = absolute.relative_path();
  return below.empty() ? fs::path() : *below.begin();
}

/// Relative to the folder, unless they have nothing but the root in common.
void Writer::path(const char* name, const std::string& value) {
  US_CHECK(is_utf8(value), where_, name, ": a path that is not UTF-8 cannot be saved");
  json_[name] = value;
  if (value.empty() || folder_.empty()) return;
  const fs::path whole = fs::absolute(value).lexically_normal(),
                 base = fs::absolute(folder_).lexically_normal();
  const bool near = whole.root_path() == base.root_path() && !first_folder(whole).empty() &&
                    first_folder(whole) == first_folder(base);
  json_[name] = (near ? whole.lexically_relative(base) : whole).generic_string();
}

void Reader::path(const char* name, std::string& value) {
  (*this)(name, value);
  US_CHECK(value.find('\0') == std::string::npos, where_, name, " must be a path");
  if (!value.empty() && !folder_.empty()) value = (fs::absolute(folder_) / value).lexically_normal().string();
}

/// The rows as joint, weight, joint, weight ...: most weights are 0.
void Writer::weights(const char* name, const std::shared_ptr<const WeightRows>& value) {
  if (!value || value->empty()) return;
  check_rows(*value, where_ + name);
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < value->rows.rows(); ++i) {
    Json row = Json::array();
    for (int j = 0; j < kJointCount; ++j) {
      const float weight = value->rows(i, j);
      if (weight == 0) continue;
      row.push_back(j);
      row.push_back(shortest(weight));
    }
    rows.push_back(std::move(row));
  }
  json_[name] = {{"vertices", value->vertex}, {"rows", std::move(rows)}};
}

void Reader::weights(const char* name, std::shared_ptr<const WeightRows>& value) {
  const Json* json = member(name);
  if (!json || json->is_null()) return;
  const std::string where = where_ + name;
  WeightRows read;
  Reader reader(*json, folder_, where + '.');
  reader.whole_list("vertices", read.vertex, {0, std::numeric_limits<int>::max()});
  const Json* rows = reader.list("rows");
  US_CHECK((rows ? rows->size() : 0) == read.vertex.size(), where, " has ", rows ? rows->size() : 0,
           " rows for ", read.vertex.size(), " vertices");
  read.rows = RowMatrix::Zero(static_cast<Eigen::Index>(read.vertex.size()), kJointCount);
  for (size_t i = 0; i < read.vertex.size(); ++i) {
    const Json& row = (*rows)[i];
    const std::string here = indexed(where + ".rows", i);
    US_CHECK(row.is_array() && row.size() % 2 == 0, here, " must be pairs of joint and weight");
    for (size_t k = 0; k < row.size(); k += 2)
      read.rows(static_cast<Eigen::Index>(i), number_in(row[k], kJoints, here)) =
          number_in(row[k + 1], Range<float>{0, 1.001f}, here);
  }
  check_rows(read, where);
  if (!read.empty()) value = std::make_shared<const WeightRows>(std::move(read));
}

void Writer::skeleton_edit(const SkeletonEdit& edit) {
  json_["kind"] = std::holds_alternative<DragEdit>(edit) ? "drag" : "swap";
  std::visit([this](const auto& kind) { fields(*this, kind); }, edit);
}

void Reader::skeleton_edit(SkeletonEdit& edit) {
  std::string kind;
  (*this)("kind", kind);
  US_CHECK(kind == "drag" || kind == "swap", where_, "kind must be drag or swap");
  if (kind == "swap") edit = SwapEdit{};
  std::visit([this](auto& read) { fields(*this, read); }, edit);
}

}  // namespace

nlohmann::ordered_json to_json(const SavedDocument& saved, const std::string& folder) {
  Json json{{"format", kFormat}, {"version", kDocumentVersion}};
  Writer writer(json, folder, "");
  fields(writer, saved);
  return json;
}

SavedDocument from_json(const nlohmann::ordered_json& json, const std::string& folder,
                        const std::string& path) {
  const bool named = json.is_object() && json.contains("format") && json["format"] == kFormat;
  US_CHECK(named, path, ": is no Understudy document");
  Reader reader(json, folder, path + ": ");
  int version = 0;
  reader.number("version", version, {1, kMostFrames});
  US_CHECK(version >= 1, path, ": version is missing");
  US_CHECK(version <= kDocumentVersion, path, ": was saved by a newer Understudy (version ", version,
           " of documents, this program knows ", kDocumentVersion, ")");
  SavedDocument saved;
  fields(reader, saved);
  if (saved.view.cameras.empty()) saved.view.cameras.emplace_back();
  return saved;
}

}  // namespace understudy::app
