// Structs to JSON and back, by the members that fields() lists beside each struct.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/base/fields.hpp"
#include "retarget/character/bone_map.hpp"
#include "retarget/editing/skeleton_edits.hpp"
#include "retarget/editing/target_edits.hpp"
#include "retarget/keypoints/track_edits.hpp"
#include "retarget/rig/rig_edits.hpp"

namespace understudy::app {

using Json = nlohmann::ordered_json;

namespace fields_json {
using understudy::detail::join;

constexpr Within<float> kAnyFloat{std::numeric_limits<float>::lowest(), std::numeric_limits<float>::max()};

std::string indexed(const std::string& where, size_t i);
/// A float with as few digits as give the same float again.
Json shortest(float value);
template <class Number>
Json shortest(Number value) {
  return value;
}

template <class Number>
std::string range_text(const Within<Number>& range) {
  std::string kind = std::is_integral_v<Number> ? "a whole number" : "a finite number";
  if (static_cast<double>(range.high) >= kFrameNumbers.high) return kind;
  return kind + " from " + join(range.low) + " to " + join(range.high);
}

}  // namespace fields_json

/// Values out. Refuses what the reader would refuse, so that no document is saved that cannot be opened.
class FieldsWriter {
 public:
  FieldsWriter(Json& json, const std::string& folder, std::string where)
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
  Json json_of(float value, const std::string& where) {
    return json_of(value, where, fields_json::kAnyFloat);
  }
  template <class Number>
  Json json_of(Number value, const std::string& where, const Within<Number>& range) {
    US_CHECK(value >= range.low && value <= range.high, where, " is ", value, ", it must be ",
             fields_json::range_text(range));
    return fields_json::shortest(value);
  }
  template <class Number>
  Json json_of(Number value, const std::string&, const Clamped<Number>& range) {
    return fields_json::shortest(value >= range.low ? std::min(value, range.high) : range.low);  // NaN too
  }
  template <class Enum, size_t N, class = std::enable_if_t<std::is_enum_v<Enum>>>
  Json json_of(Enum value, const std::string&, const Names<N>& names) {
    return names[static_cast<size_t>(value)];
  }
  Json json_of(const Vec3& value, const std::string& where) {
    return json_of(std::vector<float>(value.begin(), value.end()), where);
  }
  template <class T, class... Rule>
  Json json_of(const std::vector<T>& values, const std::string& where, const Rule&... rule) {
    Json list = Json::array();
    for (size_t i = 0; i < values.size(); ++i)
      list.push_back(json_of(values[i], fields_json::indexed(where, i), rule...));
    return list;
  }
  Json json_of(const std::set<int>& values, const std::string& where, const Within<int>& range) {
    return json_of(std::vector<int>(values.begin(), values.end()), where, range);
  }
  Json json_of(const BoneChoices& choices, const std::string& where);
  Json json_of(const WeightRows& value, const std::string& where);
  Json json_of(const SkeletonEdit& edit, const std::string& where);
  Json json_of(const RigEdit& edit, const std::string& where);
  Json json_of(const TrackEdit& edit, const std::string& where);
  template <class T>
  Json json_of(const T& value, const std::string& where) {
    Json json = Json::object();
    FieldsWriter writer(json, folder_, where + '.');
    fields(writer, value);
    return json;
  }

  Json& json_;
  std::string folder_;
  std::string where_;  // "takes[2].method."
};

/// What is done with members that nobody asks for.
enum class UnknownMembers { PassedOver, Refused };

/// Values in. What is missing stays as it is. `where` is what sentences name the object by, with the point or
/// blank that its members' names follow. Throws Error naming the member.
class FieldsReader {
 public:
  FieldsReader(const Json& json, const std::string& folder, std::string where,
               UnknownMembers unknown = UnknownMembers::PassedOver)
      : json_(json), folder_(folder), where_(std::move(where)), unknown_(unknown) {
    US_CHECK(json.is_object(), where_.substr(0, where_.size() - 1), " must be an object");
  }

  template <class T, class... Rule>
  void operator()(const MemberName& name, T& value, const Rule&... rule) {
    known_.insert(name.now);
    if (name.before != nullptr) known_.insert(name.before);
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
  /// A member that somebody else reads.
  void know(const char* name) { known_.insert(name); }
  /// To be called after the last member: throws Error where members are refused that were not asked for.
  void finish() const;

 private:
  void read(const Json& json, bool& value, const std::string& where) {
    US_CHECK(json.is_boolean(), where, " must be true or false");
    value = json.get<bool>();
  }
  void read(const Json& json, std::string& value, const std::string& where) {
    US_CHECK(json.is_string(), where, " must be text");
    value = json.get<std::string>();
  }
  void read(const Json& json, std::string& value, const std::string& where, FilePath);
  void read(const Json& json, float& value, const std::string& where) {
    read(json, value, where, fields_json::kAnyFloat);
  }
  template <class Number>
  void read(const Json& json, Number& value, const std::string& where, const Within<Number>& range) {
    const double number = json.is_number() ? json.get<double>() : std::nan("");
    const bool fits = number >= static_cast<double>(range.low) && number <= static_cast<double>(range.high) &&
                      (!std::is_integral_v<Number> || number == std::trunc(number));
    US_CHECK(fits, where, " must be ", fields_json::range_text(range));
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
  template <class Enum, size_t N, class = std::enable_if_t<std::is_enum_v<Enum>>>
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
      read(one, values.emplace_back(), plain ? where : fields_json::indexed(where, values.size() - 1),
           rule...);
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
  void read(const Json& json, RigEdit& edit, const std::string& where);
  void read(const Json& json, TrackEdit& edit, const std::string& where);
  template <class T>
  void read(const Json& json, T& value, const std::string& where) {
    FieldsReader reader(json, folder_, where + '.', unknown_);
    fields(reader, value);
    reader.finish();
  }

  const Json& json_;
  std::string folder_;
  std::string where_;
  UnknownMembers unknown_;
  std::set<std::string> known_;
};

/// A kind of JSON file that is ours.
struct JsonFileKind {
  const char* format;          ///< its member "format"
  const char *a_file, *files;  ///< in sentences: "an Understudy document", "documents"
  int version;                 ///< the newest that is known
};
/// Throws Error naming `path`: another kind of file, no version, a newer one.
void check_kind(const Json& json, const std::string& path, const JsonFileKind& kind);

/// JSON as text: indented, but for lists of numbers.
std::string json_text(const Json& json);
/// Throws Error, one sentence that names `path`: empty, damaged.
Json parse_json(const std::string& text, const std::string& path);
/// Throws Error, one sentence: no such file, too large, damaged.
Json read_json(const std::string& path);
/// The folder that a file's relative paths start from. Throws Error.
std::string folder_of_file(const std::string& path);

}  // namespace understudy::app
