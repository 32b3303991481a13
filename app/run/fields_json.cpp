#include "app/run/fields_json.hpp"

#include <filesystem>

#include "retarget/base/file.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace fs = std::filesystem;

namespace fields_json {

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

}  // namespace fields_json

namespace {

constexpr int64_t kLargestFile = int64_t{1} << 30;
constexpr Within<int> kJoints{0, kJointCount - 1};

/// Objects a member a line, lists of numbers in one line: readable, and without a line for each weight.
void print(const Json& json, size_t depth, std::string& out) {
  const bool object = json.is_object();
  const auto structured = [](const Json& one) { return one.is_object(); };
  if (json.empty() || (!object && !(json.is_array() && std::any_of(json.begin(), json.end(), structured)))) {
    out += json.dump(-1, ' ', false, Json::error_handler_t::replace);
    return;
  }
  out += object ? '{' : '[';
  bool first = true;
  for (const auto& item : json.items()) {
    out += first ? "\n" : ",\n";
    first = false;
    out.append(depth + 1, ' ');
    if (object) out += Json(item.key()).dump() + ": ";
    print(item.value(), depth + 1, out);
  }
  out += '\n';
  out.append(depth, ' ');
  out += object ? '}' : ']';
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

}  // namespace

Json FieldsWriter::json_of(const BoneChoices& choices, const std::string& where) {
  Json object = Json::object();
  for (const auto& [joint, bone] : choices) {
    US_CHECK(is_utf8(joint) && is_utf8(bone), where, " has a name that is not UTF-8");
    object[joint] = bone;
  }
  return object;
}

/// Relative to the folder, unless they have nothing but the root in common.
Json FieldsWriter::json_of(const std::string& value, const std::string& where, FilePath) {
  US_CHECK(is_utf8(value), where, ": a path that is not UTF-8 cannot be saved");
  if (value.empty() || folder_.empty()) return value;
  const fs::path whole = fs::absolute(value).lexically_normal(),
                 base = fs::absolute(folder_).lexically_normal();
  const bool near = whole.root_path() == base.root_path() && !first_folder(whole).empty() &&
                    first_folder(whole) == first_folder(base);
  return (near ? whole.lexically_relative(base) : whole).generic_string();
}

/// The rows as joint, weight, joint, weight ...: most weights are 0.
Json FieldsWriter::json_of(const WeightRows& value, const std::string& where) {
  check_rows(value, where);
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < value.rows.rows(); ++i) {
    Json row = Json::array();
    for (int j = 0; j < kJointCount; ++j) {
      const float weight = value.rows(i, j);
      if (weight == 0) continue;
      row.push_back(j);
      row.push_back(fields_json::shortest(weight));
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

Json FieldsWriter::json_of(const SkeletonEdit& edit, const std::string& where) {
  Json json{{"kind", std::holds_alternative<DragEdit>(edit) ? "drag" : "swap"}};
  FieldsWriter writer(json, folder_, where + '.');
  std::visit([&writer](const auto& kind) { fields(writer, kind); }, edit);
  return json;
}

Json FieldsWriter::json_of(const TrackEdit& edit, const std::string& where) {
  Json json{{"kind", std::holds_alternative<PointDrag>(edit) ? "drag" : "exchange"}};
  FieldsWriter writer(json, folder_, where + '.');
  std::visit([&writer](const auto& kind) { fields(writer, kind); }, edit);
  return json;
}

Json FieldsWriter::json_of(const RigEdit& edit, const std::string& where) {
  Json json{{"kind", kRigEditNames[edit.index()]}};
  FieldsWriter writer(json, folder_, where + '.');
  std::visit([&writer](const auto& kind) { fields(writer, kind); }, edit);
  return json;
}

void FieldsReader::read(const Json& json, BoneChoices& choices, const std::string& where) {
  US_CHECK(json.is_object(), where, " must be an object");
  choices.clear();
  for (const auto& [joint, bone] : json.items()) {
    US_CHECK(bone.is_string(), where, " must name bones");
    choices[joint] = bone.get<std::string>();
  }
}

void FieldsReader::read(const Json& json, std::shared_ptr<const WeightRows>& value,
                        const std::string& where) {
  WeightRows edit;
  FieldsReader reader(json, folder_, where + '.');
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
    const std::string here = fields_json::indexed(where + ".rows", i);
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

void FieldsReader::read(const Json& json, SkeletonEdit& edit, const std::string& where) {
  FieldsReader reader(json, folder_, where + '.');
  std::string kind;
  reader("kind", kind);
  US_CHECK(kind == "drag" || kind == "swap", where, ".kind must be drag or swap");
  if (kind == "swap") edit = SwapEdit{};
  std::visit([&reader](auto& one) { fields(reader, one); }, edit);
}

void FieldsReader::read(const Json& json, TrackEdit& edit, const std::string& where) {
  FieldsReader reader(json, folder_, where + '.');
  std::string kind;
  reader("kind", kind);
  US_CHECK(kind == "drag" || kind == "exchange", where, ".kind must be drag or exchange");
  if (kind == "exchange") edit = SidesExchange{};
  std::visit([&reader](auto& one) { fields(reader, one); }, edit);
}

namespace {

/// The edit of that number among the kinds.
template <size_t I = 0>
RigEdit empty_edit(size_t kind) {
  if constexpr (I + 1 < std::variant_size_v<RigEdit>)
    if (kind != I) return empty_edit<I + 1>(kind);
  return RigEdit(std::in_place_index<I>);
}

}  // namespace

void FieldsReader::read(const Json& json, RigEdit& edit, const std::string& where) {
  FieldsReader reader(json, folder_, where + '.');
  std::string kind, all;
  reader("kind", kind);
  size_t number = 0;
  while (number < kRigEditNames.size() && kind != kRigEditNames[number])
    append_item(all, kRigEditNames[number++]);
  US_CHECK(number < kRigEditNames.size(), where, ".kind must be one of ", all);
  edit = empty_edit(number);
  std::visit([&reader](auto& one) { fields(reader, one); }, edit);
}

void FieldsReader::read(const Json& json, std::string& value, const std::string& where, FilePath) {
  read(json, value, where);
  US_CHECK(value.find('\0') == std::string::npos, where, " must be a path");
  if (!value.empty() && !folder_.empty()) value = (fs::absolute(folder_) / value).lexically_normal().string();
}

void FieldsReader::finish() const {
  if (unknown_ == UnknownMembers::PassedOver) return;
  for (const auto& item : json_.items()) {
    if (known_.count(item.key()) > 0) continue;
    std::string names;
    for (const std::string& name : known_) append_item(names, name);
    throw Error(where_ + excerpt(item.key()) + " is not known, these are: " + names);
  }
}

void check_kind(const Json& json, const std::string& path, const JsonFileKind& kind) {
  const bool named = json.is_object() && json.contains("format") && json["format"] == kind.format;
  US_CHECK(named, path, ": is not ", kind.a_file);
  const std::string no_folder;
  FieldsReader reader(json, no_folder, path + ": ");
  int version = 0;
  reader("version", version, Within<int>{1, kFrameNumbers.high});
  US_CHECK(version >= 1, path, ": version is missing");
  US_CHECK(version <= kind.version, path, ": was saved by a newer Understudy (version ", version, " of ",
           kind.files, ", this program knows ", kind.version, ")");
}

std::string json_text(const Json& json) {
  std::string text;
  print(json, 0, text);
  return text + '\n';
}

Json parse_json(const std::string& text, const std::string& path) {
  US_CHECK(!text.empty(), path, ": is empty");
  try {
    return Json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    throw Error(path + ": is damaged at byte " + std::to_string(error.byte));
  } catch (const nlohmann::json::exception&) {
    throw Error(path + ": holds something that is not a number");
  }
}

Json read_json(const std::string& path) {
  return parse_json(read_file(path, kLargestFile), path);
}

std::string folder_of_file(const std::string& path) {
  US_CHECK(!path.empty(), "a file without a name can be neither read nor written");
  std::error_code error;
  const fs::path whole = fs::absolute(path, error);
  US_CHECK(!error, path, ": cannot be found (", error.message(), ")");
  return whole.parent_path().string();
}

}  // namespace understudy::app
