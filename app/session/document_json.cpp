// Documents to JSON and back, by the members that fields() lists beside each struct.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "app/session/document_file.hpp"
#include "retarget/base/error.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "understudy document";
constexpr Within<int> kJoints{0, kJointCount - 1};
constexpr Within<float> kAnyFloat{std::numeric_limits<float>::lowest(), std::numeric_limits<float>::max()};

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
Json shortest(Number value) {
  return value;
}

template <class Number>
std::string range_text(const Within<Number>& range) {
  std::string kind = std::is_integral_v<Number> ? "a whole number" : "a finite number";
  if (static_cast<double>(range.high) >= kFrameNumbers.high) return kind;
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
  US_CHECK(ascend && (vertex.empty() || vertex[0] >= 0), where, ".vertices must ascend from 0");
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

/// The first folder below the root, "" for the root itself.
fs::path first_folder(const fs::path& absolute) {
  const fs::path below = absolute.relative_path();
  return below.empty() ? fs::path() : *below.begin();
}

/// Values out. Refuses what the reader would refuse, so that no document is saved that cannot be opened.
class Writer {
 public:
  Writer(Json& json, const std::string& folder, std::string where)
      : json_(json), folder_(folder), where_(std::move(where)) {}

  template <class T, class... Rule>
  void operator()(const char* name, const T& value, const Rule&... rule) {
    const std::string where = where_ + name;
    if constexpr (detail::kIs<std::optional, T>) {
      if (value) json_[name] = json_of(*value, where, rule...);
    } else if constexpr (detail::kIs<std::shared_ptr, T>) {
      if (value && !value->empty()) json_[name] = json_of(*value, where);
    } else {
      json_[name] = json_of(value, where, rule...);
    }
  }

 private:
  Json json_of(bool value, const std::string&) { return value; }
  Json json_of(const std::string& value, const std::string&) { return value; }
  Json json_of(const std::string& value, const std::string& where, FilePath);
  Json json_of(float value, const std::string& where) { return json_of(value, where, kAnyFloat); }
  template <class Number>
  Json json_of(Number value, const std::string& where, const Within<Number>& range) {
    US_CHECK(value >= range.low && value <= range.high, where, " is ", value, ", it must be ",
             range_text(range));
    return shortest(value);
  }
  template <class Number>
  Json json_of(Number value, const std::string&, const Clamped<Number>& range) {
    return shortest(value >= range.low ? std::min(value, range.high) : range.low);  // NaN too
  }
  template <class Enum, size_t N>
  Json json_of(Enum value, const std::string&, const Names<N>& names) {
    return names[static_cast<size_t>(value)];
  }
  Json json_of(const Vec3& value, const std::string& where) {
    return json_of(std::vector<float>(value.begin(), value.end()), where);
  }
  template <class T, class... Rule>
  Json json_of(const std::vector<T>& values, const std::string& where, const Rule&... rule) {
    Json list = Json::array();
    for (size_t i = 0; i < values.size(); ++i) list.push_back(json_of(values[i], indexed(where, i), rule...));
    return list;
  }
  Json json_of(const std::set<int>& values, const std::string& where, const Within<int>& range) {
    return json_of(std::vector<int>(values.begin(), values.end()), where, range);
  }
  Json json_of(const BoneChoices& choices, const std::string& where);
  Json json_of(const WeightRows& value, const std::string& where);
  Json json_of(const SkeletonEdit& edit, const std::string& where);
  template <class T>
  Json json_of(const T& value, const std::string& where) {
    Json json = Json::object();
    Writer writer(json, folder_, where + '.');
    fields(writer, value);
    return json;
  }

  Json& json_;
  const std::string& folder_;
  std::string where_;  // "takes[2].method."
};

Json Writer::json_of(const BoneChoices& choices, const std::string& where) {
  Json object = Json::object();
  for (const auto& [joint, bone] : choices) {
    US_CHECK(is_utf8(joint) && is_utf8(bone), where, " has a name that is not UTF-8");
    object[joint] = bone;
  }
  return object;
}

/// Relative to the folder, unless they have nothing but the root in common.
Json Writer::json_of(const std::string& value, const std::string& where, FilePath) {
  US_CHECK(is_utf8(value), where, ": a path that is not UTF-8 cannot be saved");
  if (value.empty() || folder_.empty()) return value;
  const fs::path whole = fs::absolute(value).lexically_normal(),
                 base = fs::absolute(folder_).lexically_normal();
  const bool near = whole.root_path() == base.root_path() && !first_folder(whole).empty() &&
                    first_folder(whole) == first_folder(base);
  return (near ? whole.lexically_relative(base) : whole).generic_string();
}

/// The rows as joint, weight, joint, weight ...: most weights are 0.
Json Writer::json_of(const WeightRows& value, const std::string& where) {
  check_rows(value, where);
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < value.rows.rows(); ++i) {
    Json row = Json::array();
    for (int j = 0; j < kJointCount; ++j) {
      const float weight = value.rows(i, j);
      if (weight == 0) continue;
      row.push_back(j);
      row.push_back(shortest(weight));
    }
    rows.push_back(std::move(row));
  }
  Json json{{"vertices", value.vertex}, {"rows", std::move(rows)}};
  if (value.places.rows() == 0) return json;  // of a document of before
  json["of"] = value.of;
  json["places"] =
      json_of(std::vector<float>(value.places.data(), value.places.data() + value.places.size()), where);
  return json;
}

Json Writer::json_of(const SkeletonEdit& edit, const std::string& where) {
  Json json{{"kind", std::holds_alternative<DragEdit>(edit) ? "drag" : "swap"}};
  Writer writer(json, folder_, where + '.');
  std::visit([&writer](const auto& kind) { fields(writer, kind); }, edit);
  return json;
}

/// Values in. What is missing stays as it is, what is not known is passed over.
class Reader {
 public:
  Reader(const Json& json, const std::string& folder, std::string where)
      : json_(json), folder_(folder), where_(std::move(where)) {
    US_CHECK(json.is_object(), where_.substr(0, where_.size() - 1), " must be an object");
  }

  template <class T, class... Rule>
  void operator()(const MemberName& name, T& value, const Rule&... rule) {
    auto found = json_.find(name.now);
    if (found == json_.end() && name.before != nullptr) found = json_.find(name.before);
    if (found == json_.end()) return;
    if constexpr (detail::kIs<std::optional, T>) {
      if (!found->is_null()) read(*found, value.emplace(), where_ + name.now, rule...);
    } else if constexpr (detail::kIs<std::shared_ptr, T>) {
      if (!found->is_null()) read(*found, value, where_ + name.now);
    } else {
      read(*found, value, where_ + name.now, rule...);
    }
  }

 private:
  void read(const Json& json, bool& value, const std::string& where) {
    US_CHECK(json.is_boolean(), where, " must be true or false");
    value = json.get<bool>();
  }
  void read(const Json& json, std::string& value, const std::string& where) {
    US_CHECK(json.is_string(), where, " must be text");
    value = json.get<std::string>();
  }
  void read(const Json& json, std::string& value, const std::string& where, FilePath) {
    read(json, value, where);
    US_CHECK(value.find('\0') == std::string::npos, where, " must be a path");
    if (!value.empty() && !folder_.empty())
      value = (fs::absolute(folder_) / value).lexically_normal().string();
  }
  void read(const Json& json, float& value, const std::string& where) { read(json, value, where, kAnyFloat); }
  template <class Number>
  void read(const Json& json, Number& value, const std::string& where, const Within<Number>& range) {
    const double number = json.is_number() ? json.get<double>() : std::nan("");
    const bool fits = number >= static_cast<double>(range.low) && number <= static_cast<double>(range.high) &&
                      (!std::is_integral_v<Number> || number == std::trunc(number));
    US_CHECK(fits, where, " must be ", range_text(range));
    value = static_cast<Number>(number);
  }
  template <class Number>
  void read(const Json& json, Number& value, const std::string& where, const Clamped<Number>& range) {
    constexpr double kMost = std::numeric_limits<double>::max();
    double number = 0;
    read(json, number, where, Within<double>{-kMost, kMost});
    value = static_cast<Number>(
        std::clamp(number, static_cast<double>(range.low), static_cast<double>(range.high)));
  }
  template <class Enum, size_t N>
  void read(const Json& json, Enum& value, const std::string& where, const Names<N>& names) {
    std::string text, all = names[0];
    read(json, text, where);
    auto found = std::find(names.begin(), names.end(), text);
    static const std::map<std::string, std::string> kBefore = {// older documents' words
                                                               {"doubt", "uncertainty"},
                                                               {"own", "custom"},
                                                               {"theirs", "own"},
                                                               {"ours", "22"}};
    if (found == names.end() && kBefore.count(text) > 0)
      found = std::find(names.begin(), names.end(), kBefore.at(text));
    for (size_t i = 1; i < N; ++i) all += std::string(i + 1 < N ? ", " : " or ") + names[i];
    US_CHECK(found != names.end(), where, " must be ", all);
    value = static_cast<Enum>(found - names.begin());
  }
  void read(const Json& json, Vec3& value, const std::string& where) {
    std::vector<float> three;
    read(json, three, where);
    US_CHECK(three.size() == 3, where, " must be three numbers");
    value = Vec3(three[0], three[1], three[2]);
  }
  template <class T, class... Rule>
  void read(const Json& json, std::vector<T>& values, const std::string& where, const Rule&... rule) {
    US_CHECK(json.is_array(), where, " must be a list");
    values.clear();
    for (const Json& one : json) {
      const bool plain = std::is_arithmetic_v<T>;
      read(one, values.emplace_back(), plain ? where : indexed(where, values.size() - 1), rule...);
    }
  }
  void read(const Json& json, std::set<int>& values, const std::string& where, const Within<int>& range) {
    std::vector<int> list;
    read(json, list, where, range);
    values = {list.begin(), list.end()};
  }
  void read(const Json& json, BoneChoices& choices, const std::string& where);
  void read(const Json& json, std::shared_ptr<const WeightRows>& value, const std::string& where);
  void read(const Json& json, SkeletonEdit& edit, const std::string& where);
  template <class T>
  void read(const Json& json, T& value, const std::string& where) {
    Reader reader(json, folder_, where + '.');
    fields(reader, value);
  }

  const Json& json_;
  const std::string& folder_;
  std::string where_;
};

void Reader::read(const Json& json, BoneChoices& choices, const std::string& where) {
  US_CHECK(json.is_object(), where, " must be an object");
  choices.clear();
  for (const auto& [joint, bone] : json.items()) {
    US_CHECK(bone.is_string(), where, " must name bones");
    choices[joint] = bone.get<std::string>();
  }
}

void Reader::read(const Json& json, std::shared_ptr<const WeightRows>& value, const std::string& where) {
  WeightRows edit;
  Reader reader(json, folder_, where + '.');
  reader("vertices", edit.vertex, Within<int>{0, std::numeric_limits<int>::max()});
  const Json none = Json::array();
  const auto found = json.find("rows");
  const Json& rows = found == json.end() ? none : *found;
  US_CHECK(rows.is_array(), where, ".rows must be a list");
  US_CHECK(rows.size() == edit.vertex.size(), where, " has ", rows.size(), " rows for ", edit.vertex.size(),
           " vertices");
  edit.rows = RowMatrix::Zero(static_cast<Eigen::Index>(edit.vertex.size()), kJointCount);
  for (size_t i = 0; i < edit.vertex.size(); ++i) {
    const Json& row = rows[i];
    const std::string here = indexed(where + ".rows", i);
    US_CHECK(row.is_array() && row.size() % 2 == 0, here, " must be pairs of joint and weight");
    for (size_t k = 0; k < row.size(); k += 2) {
      int joint = 0;
      read(row[k], joint, here, kJoints);
      read(row[k + 1], edit.rows(static_cast<Eigen::Index>(i), joint), here, Within<float>{0, 1.001f});
    }
  }
  std::vector<float> places;
  reader("of", edit.of, Within<int>{0, std::numeric_limits<int>::max()});
  reader("places", places);
  US_CHECK(places.empty() || places.size() == 3 * edit.vertex.size(), where,
           ".places must be three numbers a vertex");
  if (!places.empty()) edit.places = Eigen::Map<const Points>(places.data(), edit.rows.rows(), 3);
  check_rows(edit, where);
  if (!edit.empty()) value = std::make_shared<const WeightRows>(std::move(edit));
}

void Reader::read(const Json& json, SkeletonEdit& edit, const std::string& where) {
  Reader reader(json, folder_, where + '.');
  std::string kind;
  reader("kind", kind);
  US_CHECK(kind == "drag" || kind == "swap", where, ".kind must be drag or swap");
  if (kind == "swap") edit = SwapEdit{};
  std::visit([&reader](auto& one) { fields(reader, one); }, edit);
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
  US_CHECK(named, path, ": is not an Understudy document");
  Reader reader(json, folder, path + ": ");
  int version = 0;
  reader("version", version, Within<int>{1, kFrameNumbers.high});
  US_CHECK(version >= 1, path, ": version is missing");
  US_CHECK(version <= kDocumentVersion, path, ": was saved by a newer Understudy (version ", version,
           " of documents, this program knows ", kDocumentVersion, ")");
  SavedDocument saved;
  fields(reader, saved);
  if (saved.view.cameras.empty()) saved.view.cameras.emplace_back();
  return saved;
}

}  // namespace understudy::app
