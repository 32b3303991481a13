#include "app/run/case_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/run/rig_truth_file.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/formats/scan_frames.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

/// The shape must be [T, tail...]; T must agree with the frames already known. Gives the values, or none when
/// absent.
const std::vector<float>* frames_of(const Npz& npz, const std::string& name, const std::vector<int64_t>& tail,
                                    const std::string& path, int64_t& frames) {
  const auto found = npz.find(name);
  if (found == npz.end()) return nullptr;
  const auto& shape = found->second.shape;
  US_CHECK(shape.size() == tail.size() + 1 && std::equal(tail.begin(), tail.end(), shape.begin() + 1), path,
           ": ", name, " has the wrong shape");
  US_CHECK(shape[0] > 0 && (frames == 0 || frames == shape[0]), path, ": ", name, " has ", shape[0],
           " frames, not ", frames);
  frames = shape[0];
  return &found->second.values;
}

Joints joints_at(const float* values) {
  return Eigen::Map<const Joints>(values);
}

std::vector<Joints> joint_frames(const std::vector<float>* values) {
  std::vector<Joints> result;
  for (size_t i = 0; values && i < values->size(); i += kJointCount * 3)
    result.push_back(joints_at(&(*values)[i]));
  return result;
}

std::vector<Rotations> rotation_frames(const std::vector<float>* values) {
  using Row = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;
  std::vector<Rotations> result(values ? values->size() / (kJointCount * 9) : 0);
  for (size_t t = 0; t < result.size(); ++t)
    for (int j = 0; j < kJointCount; ++j)
      result[t][j] = Eigen::Map<const Row>(&(*values)[(t * kJointCount + j) * 9]);
  return result;
}

std::vector<SeenJoints> seen_frames(const std::vector<float>* values) {
  std::vector<SeenJoints> result;
  for (size_t i = 0; values && i < values->size(); i += kJointCount)
    result.emplace_back(Eigen::Map<const SeenJoints>(&(*values)[i]));
  return result;
}

/// `people_joints` [T, P, 22, 3], `people_seen` [T, P, 22], `people_touch` [T, P], `point_counts` [T] and
/// `point_owners` of all frames, one after the other; none where there are no people_joints.
std::vector<TruePeople> scene_frames(const Npz& npz, const std::string& path, int64_t& frames) {
  const auto found = npz.find("people_joints");
  if (found == npz.end()) return {};
  const auto& shape = found->second.shape;
  US_CHECK(shape.size() == 4 && shape[1] >= 1, path, ": people_joints has the wrong shape");
  const int64_t people = shape[1];
  const auto* joints = frames_of(npz, "people_joints", {people, kJointCount, 3}, path, frames);
  const auto* seen = frames_of(npz, "people_seen", {people, kJointCount}, path, frames);
  const auto* touch = frames_of(npz, "people_touch", {people}, path, frames);
  const auto* counts = frames_of(npz, "point_counts", {}, path, frames);
  US_CHECK(seen && touch && counts, path,
           ": has people_joints, but not people_seen, people_touch, point_counts");
  const auto& owners = require(npz, "point_owners", path).values;
  std::vector<TruePeople> scene(frames);
  size_t first = 0;
  for (int64_t t = 0; t < frames; ++t) {
    for (int64_t p = t * people; p < (t + 1) * people; ++p)
      scene[t].people.push_back({joints_at(&(*joints)[p * kJointCount * 3]),
                                 Eigen::Map<const SeenJoints>(&(*seen)[p * kJointCount]), (*touch)[p] != 0});
    const float count = (*counts)[t];
    US_CHECK(count >= 0 && count <= static_cast<float>(owners.size() - first), path,
             ": point_owners ends before frame ", t + 1);
    for (const size_t end = first + static_cast<size_t>(count); first < end; ++first) {
      US_CHECK(owners[first] >= kUndecidedPoint && owners[first] < static_cast<float>(people), path,
               ": point_owners names a person who is not there");
      scene[t].owners.push_back(static_cast<int>(owners[first]));
    }
  }
  return scene;
}

/// skin_points [N, 3] and skin_weights [N, 22].
SkinSample skin_sample(const Npz& npz, const std::string& path) {
  SkinSample skin;
  const auto points = npz.find("skin_points"), weights = npz.find("skin_weights");
  if (points == npz.end() && weights == npz.end()) return skin;
  US_CHECK(points != npz.end() && weights != npz.end(), path,
           ": has one of skin_points and skin_weights without the other");
  const auto &p = points->second, &w = weights->second;
  US_CHECK(p.shape.size() == 2 && p.shape[0] > 0 && p.shape[1] == 3, path,
           ": skin_points has the wrong shape");
  US_CHECK(w.shape == (std::vector<int64_t>{p.shape[0], kJointCount}), path,
           ": skin_weights has the wrong shape");
  skin.rest = Eigen::Map<const Points>(p.values.data(), p.shape[0], 3);
  skin.weights = Eigen::Map<const RowMatrix>(w.values.data(), p.shape[0], kJointCount);
  return skin;
}

/// The numbers in the names of a folder's scans where some below `frames` are missing; none otherwise.
std::vector<int> numbers_there(const std::string& folder, int frames) {
  std::vector<int> there;
  if (!fs::is_directory(folder)) return there;
  for (const std::string& file : frame_files(folder, folder_files(folder))) {
    const std::optional<int64_t> number = frame_number(file);
    if (!number || *number < 0 || *number >= frames) return {};
    there.push_back(static_cast<int>(*number));
  }
  std::sort(there.begin(), there.end());
  there.erase(std::unique(there.begin(), there.end()), there.end());
  return ssize(there) < frames ? there : std::vector<int>();
}

/// What case.json says of gaps, or its source's missing numbers.
std::optional<GapPlan> gaps_of(const nlohmann::json& json, const std::string& source,
                               const std::string& path) {
  std::optional<GapPlan> plan = gap_plan(json, path);
  if (plan || !json.contains("frames")) return plan;
  US_CHECK(json["frames"].is_number_integer() && json["frames"] > 0 && json["frames"] <= 1000000, path,
           ": \"frames\" is no number of frames");
  GapPlan missing;
  missing.frames = json["frames"].get<int>();
  missing.known_alone = numbers_there(source, missing.frames);
  if (missing.is_whole()) plan = std::move(missing);
  return plan;
}

std::optional<FlatCase> flat_of(const nlohmann::json& json, const std::string& path) {
  if (!json.contains("flat")) return std::nullopt;
  FlatCase flat;
  for (const auto& [key, lengths] : {std::pair{"source_lengths", &flat.source_lengths},
                                     std::pair{"target_lengths", &flat.target_lengths}}) {
    const auto& json_flat = json["flat"];
    US_CHECK(json_flat.is_object() && json_flat.contains(key) && json_flat[key].is_array() &&
                 json_flat[key].size() == kFlatBoneCount,
             path, ": \"", key, "\" is no list of ", kFlatBoneCount, " lengths");
    for (int b = 0; b < kFlatBoneCount; ++b) {
      const auto& length = json_flat[key][static_cast<size_t>(b)];
      US_CHECK(length.is_number() && length.get<float>() > 0, path, ": \"", key,
               "\" has a length that is not above 0");
      (*lengths)[b] = length.get<float>();
    }
  }
  return flat;
}

std::optional<StyleCase> style_of(const nlohmann::json& json, const std::string& path) {
  if (!json.contains("style")) return std::nullopt;
  const auto& style = json["style"];
  US_CHECK(style.is_object(), path, ": \"style\" is no object");
  const auto text = [&](const char* key) {
    US_CHECK(style.contains(key) && style[key].is_string(), path, ": \"style\" has no text \"", key, "\"");
    return style[key].get<std::string>();
  };
  StyleCase found{text("is"), text("wanted"), {}, text("subject")};
  if (style.contains("contents") && style["contents"].is_array())
    for (const auto& content : style["contents"])
      if (content.is_string()) found.contents.push_back(content.get<std::string>());
  return found;
}

}  // namespace

Points Truth::frame_vertices(int64_t t) const {
  return Eigen::Map<const Points>(vertices.data() + t * vertex_count * 3, vertex_count, 3);
}

std::vector<std::string> case_folders(const std::string& cases) {
  US_CHECK(fs::is_directory(cases), cases, ": not a folder of cases");
  if (fs::exists(fs::path(cases) / "case.json")) return {cases};
  std::vector<std::string> folders;
  for (const auto& entry : fs::directory_iterator(cases))
    if (fs::exists(entry.path() / "case.json")) folders.push_back(entry.path().string());
  US_CHECK(!folders.empty(), cases, ": no folder in it has a case.json");
  std::sort(folders.begin(), folders.end());
  return folders;
}

Case read_case(const std::string& folder) {
  const fs::path root(folder);
  const std::string path = (root / "case.json").string();
  const auto json = nlohmann::json::parse(read_file(path), nullptr, /*allow_exceptions=*/false);
  US_CHECK(json.is_object(), path, ": not a JSON object");
  const auto text = [&](const char* key) -> std::string {
    if (!json.contains(key)) return {};
    US_CHECK(json[key].is_string(), path, ": \"", key, "\" is not a string");
    return (root / json[key].get<std::string>()).string();
  };
  Case result;
  result.name = file_name(fs::absolute(root).lexically_normal().string());
  result.source = text("source");
  result.gaps = gaps_of(json, result.source, path);
  result.rig = text("rig");
  US_CHECK(!result.source.empty() || result.gaps || !result.rig.empty(), path, ": has no \"source\"");
  result.times = text("times");
  result.markers = text("markers");
  result.target = text("target");
  result.target_truth = text("target_truth");
  result.performed_truth = text("performed_truth");
  if (json.contains("alone")) {
    US_CHECK(json["alone"].is_array(), path, ": \"alone\" is not a list of paths");
    for (const auto& one : json["alone"]) {
      US_CHECK(one.is_string(), path, ": \"alone\" is not a list of paths");
      result.alone.push_back((root / one.get<std::string>()).string());
    }
  }
  result.truth = text("truth");
  result.style = style_of(json, path);
  result.flat = flat_of(json, path);
  result.lifted = json.contains("lifted") && json["lifted"] == true;
  if (json.contains("fps")) {
    US_CHECK(json["fps"].is_number() && json["fps"].get<double>() > 0, path,
             ": \"fps\" is not a positive number");
    result.fps = json["fps"].get<double>();
  }
  if (json.contains("tags") && json["tags"].is_array())
    for (const auto& tag : json["tags"])
      if (tag.is_string()) result.tags.push_back(tag.get<std::string>());
  return result;
}

Truth read_truth(const std::string& path) {
  const Npz npz = read_npz(path);
  Truth truth;
  if (is_rig_truth(npz)) {
    truth.rig = rig_truth_of(npz, path);
    truth.frames = truth.rig->frames();
    return truth;
  }
  const auto vertices = npz.find("vertices");
  if (vertices != npz.end()) {
    US_CHECK(vertices->second.shape.size() == 3 && vertices->second.shape[1] > 0, path,
             ": vertices has the wrong shape");
    truth.vertex_count = vertices->second.shape[1];
    truth.vertices = *frames_of(npz, "vertices", {truth.vertex_count, 3}, path, truth.frames);
  }
  truth.joints = joint_frames(frames_of(npz, "joints", {kJointCount, 3}, path, truth.frames));
  truth.source_joints = joint_frames(frames_of(npz, "source_joints", {kJointCount, 3}, path, truth.frames));
  truth.rotations = rotation_frames(frames_of(npz, "rotations", {kJointCount, 3, 3}, path, truth.frames));
  if (const auto* values = frames_of(npz, "source_gaps", {2, kTouchedParts}, path, truth.frames))
    for (size_t i = 0; i < values->size(); i += 2 * kTouchedParts) {
      HandGaps& gaps = truth.source_gaps.emplace_back();
      for (size_t k = 0; k < 2 * kTouchedParts; ++k)
        gaps[k / kTouchedParts][k % kTouchedParts] = (*values)[i + k];
    }
  if (const auto* values = frames_of(npz, "source_buried", {}, path, truth.frames))
    truth.source_buried = *values;
  truth.source_seen = seen_frames(frames_of(npz, "source_seen", {kJointCount}, path, truth.frames));
  truth.scene = scene_frames(npz, path, truth.frames);
  const auto rest = npz.find("target_joints");
  if (rest != npz.end()) {
    US_CHECK(rest->second.shape == (std::vector<int64_t>{kJointCount, 3}), path,
             ": target_joints has the wrong shape");
    truth.target_joints = joints_at(rest->second.values.data());
  }
  truth.skin = skin_sample(npz, path);
  US_CHECK(truth.frames > 0, path, ": has none of the known ground-truth arrays");
  return truth;
}

}  // namespace understudy::app
