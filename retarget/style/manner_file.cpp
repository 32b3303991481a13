#include "retarget/style/manner_file.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "retarget/base/error.hpp"
#include "retarget/base/fields.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/text.hpp"

namespace understudy {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kVersion = 1;
constexpr const char* kVersionKey = "understudy_style";
constexpr const char* kJoints = "SMPL 22";
constexpr const char* kCouplingUnit = "degrees and times";
constexpr float kDegree = kPi / 180;
constexpr Within<float> kTurns_deg{-60, 60}, kSizes{0, 4}, kCoupled{-20, 20};

/// A figure that is one number. `unit_is` of it is what the program computes with: radians for degrees.
struct NumberRow {
  const char *name, *unit;
  float Manner::*value;
  Within<float> range;
  float unit_is = 1;
};
constexpr NumberRow kNumbers[] = {{"stride", "times", &Manner::stride, {0.25f, 3}},
                                  {"lift", "times", &Manner::lift, {0, 4}},
                                  {"crouch", "legs", &Manner::crouch, {-0.1f, 0.3f}},
                                  {"lean", "degrees per leg", &Manner::lean, {-60, 60}, kDegree},
                                  {"twist", "degrees per leg", &Manner::twist, {-60, 60}, kDegree},
                                  {"shift", "legs per leg", &Manner::shift, {-1, 1}},
                                  {"look", "degrees per leg", &Manner::look, {-120, 120}, kDegree},
                                  {"bounce", "times", &Manner::bounce, {0, 5}},
                                  {"uneven", "share", &Manner::uneven, {0, 0.5f}},
                                  {"rhythm", "Hz", &Manner::rhythm, {0.1f, 5}},
                                  {"springs", "damping ratio", &Manner::springs, {0.1f, 2}}};
struct TempoRow {
  const char *name, *unit;
  float MannerFile::*value;
  Within<float> range;
};
constexpr TempoRow kTempos[] = {{"stroke", "times the duration", &MannerFile::stroke, {0.1f, 10}},
                                {"spread", "share", &MannerFile::spread, {0, 0.2f}}};

float number(const Json& json, const std::string& where, const Within<float>& range) {
  US_CHECK(json.is_number(), where, " is not a number");
  const float value = json.get<float>();
  US_CHECK(std::isfinite(value) && value >= range.low && value <= range.high, where, " is ", value,
           ", it must be from ", range.low, " to ", range.high);
  return value;
}

std::string text(const Json& json, const char* key, const std::string& path, bool needed) {
  const auto found = json.find(key);
  if (found == json.end()) {
    US_CHECK(!needed, path, ": has no ", key);
    return "";
  }
  US_CHECK(found->is_string(), path, ": ", key, " is not a text");
  std::string value = found->get<std::string>();
  US_CHECK(!needed || !value.empty(), path, ": its ", key, " is empty");
  return value;
}

/// "shoulder" is of both sides.
std::vector<int> joints_called(const std::string& name, const std::string& where) {
  if (const int j = joint_named(name); j >= 0) return {j};
  const int left = joint_named("left_" + name);
  US_CHECK(left >= 0, where, ": there is no joint '", name, "'");
  return {left, kMirror[left]};
}

Vec3 turn_of(const Json& json, const std::string& where) {
  US_CHECK(json.is_array() && json.size() == 3, where, " is not three angles");
  Vec3 turn;
  for (int i = 0; i < 3; ++i) turn[i] = kDegree * number(json[static_cast<size_t>(i)], where, kTurns_deg);
  return turn;
}

/// A figure's members; `value` is among them.
const Json& value_of(const Json& figure, const char* unit, const std::string& where, FigureOrigin& origin) {
  US_CHECK(figure.is_object() && figure.contains("value"), where, " has no value");
  for (const auto& [key, value] : figure.items())
    US_CHECK(key == "value" || key == "unit" || key == "source" || key == "licence", where, ": ", key,
             " is not known");
  const std::string stated = text(figure, "unit", where, true);
  US_CHECK(stated == unit, where, " is in ", unit, ", not in ", stated);
  origin = {text(figure, "source", where, true), text(figure, "licence", where, false)};
  return figure["value"];
}

void read_by_joint(const std::string& name, const Json& value, const std::string& where, Manner& manner) {
  US_CHECK(value.is_object(), where, " has no joints");
  for (const auto& [joint, one] : value.items()) {
    const std::string at = where + "." + joint;
    const std::vector<int> joints = joints_called(joint, at);
    for (const int j : joints) {
      US_CHECK(!is_of_leg(j), at, " is of a leg: legs have stride, lift and crouch");
      if (name == "size") {
        manner.size[j] = number(one, at, kSizes);
        continue;
      }
      const Vec3 turn = turn_of(one, at);  // given of the left side, mirrored to the right
      manner.posture[j] = joints.size() > 1 && j == joints[1] ? Vec3(turn.x(), -turn.y(), -turn.z()) : turn;
    }
  }
}

Coupling read_coupling(const Json& value, const std::string& where) {
  US_CHECK(value.is_object() && value.contains("joints") && value.contains("gains") &&
               value.contains("offsets") && value.size() == 3 && value["joints"].is_array() &&
               value["gains"].is_array() && value["offsets"].is_array(),
           where, " is not joints, offsets and gains");
  Coupling coupling;
  for (const Json& name : value["joints"]) {
    US_CHECK(name.is_string(), where, ": a joint is not a name");
    const int j = joint_named(name.get<std::string>());
    US_CHECK(j >= 0, where, ": there is no joint '", name.get<std::string>(), "'");
    US_CHECK(!coupling.turns(j), where, ": ", kJointNames[j], " is there twice");
    const size_t k = coupling.joints.size();
    US_CHECK(k < value["offsets"].size(), where, " needs offsets of each joint");
    coupling.offsets[j] = turn_of(value["offsets"][k], where + ", offset of " + kJointNames[j]);
    coupling.joints.push_back(j);
  }
  const size_t count = 3 * coupling.joints.size();
  US_CHECK(count > 0 && value["gains"].size() == count, where, " needs ", count, " rows of gains");
  coupling.gains.resize(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(count));
  for (size_t r = 0; r < count; ++r) {
    const Json& row = value["gains"][r];
    US_CHECK(row.is_array() && row.size() == count, where, ": row ", r, " has not ", count, " gains");
    for (size_t c = 0; c < count; ++c)
      coupling.gains(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) =
          number(row[c], where + ", row " + std::to_string(r), kCoupled);
  }
  return coupling;
}

/// Hips and knees go together, left as right; only a coupling turns legs.
void check_legs(const Manner& manner, const std::string& path) {
  const auto turned = [&](int j) { return manner.coupling && manner.coupling->turns(j); };
  for (const int j : {LeftHip, RightHip, LeftKnee, RightKnee, LeftAnkle, RightAnkle, LeftFoot, RightFoot}) {
    const bool is_foot = j >= LeftAnkle;
    US_CHECK(!is_foot || !turned(j), path, ": coupling: ", kJointNames[j], " is of a foot");
    US_CHECK(is_foot || turned(j) == turned(LeftHip), path, ": coupling: has some joints of the legs alone");
  }
}

void read_figure(const std::string& name, const Json& figure, const std::string& path, MannerFile& file) {
  const std::string where = path + ": " + name;
  FigureOrigin& origin = file.origins[name];
  if (name == "posture" || name == "size")
    return read_by_joint(name, value_of(figure, name == "size" ? "times" : "degrees", where, origin), where,
                         file.manner);
  if (name == "coupling") {
    file.manner.coupling = read_coupling(value_of(figure, kCouplingUnit, where, origin), where);
    return;
  }
  for (const NumberRow& row : kNumbers)
    if (name == row.name) {
      file.manner.*row.value =
          row.unit_is * number(value_of(figure, row.unit, where, origin), where, row.range);
      return;
    }
  for (const TempoRow& row : kTempos)
    if (name == row.name) {
      file.*row.value = number(value_of(figure, row.unit, where, origin), where, row.range);
      return;
    }
  throw Error(path + ": there is no figure '" + name + "'");
}

double rounded(double value) {
  return std::round(value * 1e4) / 1e4;
}

Json figure_json(const Json& value, const char* unit, const FigureOrigin& origin) {
  Json figure{{"value", value}, {"unit", unit}, {"source", origin.source}};
  if (!origin.licence.empty()) figure["licence"] = origin.licence;
  return figure;
}

Json turn_json(const Vec3& turn) {
  Json json = Json::array();
  for (const float angle : turn) json.push_back(rounded(static_cast<double>(angle / kDegree)));
  return json;
}

Json posture_json(const Manner& manner) {
  Json json = Json::object();
  for (int j = 0; j < kJointCount; ++j) {
    if (manner.posture[j].isZero()) continue;
    json[kJointNames[j]] = turn_json(manner.posture[j]);
  }
  return json;
}

Json size_json(const Manner& manner) {
  Json json = Json::object();
  for (int j = 0; j < kJointCount; ++j)
    if (manner.size[j] != 1) json[kJointNames[j]] = rounded(static_cast<double>(manner.size[j]));
  return json;
}

Json coupling_json(const Coupling& coupling) {
  Json joints = Json::array(), offsets = Json::array(), gains = Json::array();
  for (const int j : coupling.joints) {
    joints.push_back(kJointNames[j]);
    offsets.push_back(turn_json(coupling.offsets[j]));
  }
  for (Eigen::Index r = 0; r < coupling.gains.rows(); ++r) {
    Json row = Json::array();
    for (const float gain : coupling.gains.row(r)) row.push_back(rounded(static_cast<double>(gain)));
    gains.push_back(row);
  }
  return {{"joints", joints}, {"offsets", offsets}, {"gains", gains}};
}

}  // namespace

bool StyleNote::non_commercial() const {
  const std::string lower = lower_case(licence);
  return lower.find("-nc") != std::string::npos || lower.find("non-commercial") != std::string::npos ||
         lower.find("noncommercial") != std::string::npos;
}

std::string StyleNote::rights() const {
  if (!non_commercial() && attribution.empty()) return "";
  const std::string words = "Performed in the style " + label + ", " + licence;
  return words + (non_commercial() ? " (non-commercial)" : "") +
         (attribution.empty() ? "" : ", " + attribution);
}

MannerFile parse_manner(const std::string& source, const std::string& path) {
  const Json json = Json::parse(source, nullptr, false);
  US_CHECK(!json.is_discarded() && json.is_object(), path, ": is not the JSON of a style");
  const auto version = json.find(kVersionKey);
  US_CHECK(version != json.end() && version->is_number_integer(), path, ": is not a style: it has no ",
           kVersionKey);
  US_CHECK(version->get<int64_t>() <= kVersion, path, ": is of version ", version->get<int64_t>(),
           ", this program knows ", kVersion, ": a newer Understudy wrote it");
  US_CHECK(version->get<int64_t>() == kVersion, path, ": is of version ", version->get<int64_t>(),
           ", there is none");
  MannerFile file;
  const std::string joints = text(json, "joints", path, true);
  US_CHECK(joints == kJoints, path, ": is of the joints ", joints, ", not of ", kJoints);
  StyleNote& note = file.note;
  note.label = text(json, "label", path, true);
  note.sentence = text(json, "sentence", path, true);
  note.licence = text(json, "licence", path, true);
  note.made_from = text(json, "made_from", path, true);
  note.attribution = text(json, "attribution", path, false);
  for (const auto& [key, value] : json.items())
    US_CHECK(key == kVersionKey || key == "joints" || key == "label" || key == "sentence" ||
                 key == "licence" || key == "made_from" || key == "attribution" || key == "figures",
             path, ": ", key, " is not known");
  const auto figures = json.find("figures");
  US_CHECK(figures != json.end() && figures->is_object(), path, ": has no figures");
  for (const auto& [name, figure] : figures->items()) read_figure(name, figure, path, file);
  check_legs(file.manner, path);
  const size_t slash = path.find_last_of('/') + 1;  // 0 where there is none
  note.name = path.substr(slash, path.find_last_of('.') - slash);
  return file;
}

MannerFile read_manner(const std::string& path) {
  return parse_manner(read_file(path), path);
}

std::string to_json(const MannerFile& file) {
  Json json{{kVersionKey, kVersion},        {"joints", kJoints},
            {"label", file.note.label},     {"sentence", file.note.sentence},
            {"licence", file.note.licence}, {"made_from", file.note.made_from}};
  if (!file.note.attribution.empty()) json["attribution"] = file.note.attribution;
  Json& figures = json["figures"] = Json::object();
  for (const auto& [name, origin] : file.origins) {
    if (name == "posture") figures[name] = figure_json(posture_json(file.manner), "degrees", origin);
    if (name == "coupling" && file.manner.coupling)
      figures[name] = figure_json(coupling_json(*file.manner.coupling), kCouplingUnit, origin);
    if (name == "size") figures[name] = figure_json(size_json(file.manner), "times", origin);
    for (const NumberRow& row : kNumbers)
      if (name == row.name)
        figures[name] =
            figure_json(rounded(static_cast<double>(file.manner.*row.value / row.unit_is)), row.unit, origin);
    for (const TempoRow& row : kTempos)
      if (name == row.name)
        figures[name] = figure_json(rounded(static_cast<double>(file.*row.value)), row.unit, origin);
  }
  // names of folders may be no Unicode
  std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  parse_manner(text, "the style");
  return text;
}

}  // namespace understudy
