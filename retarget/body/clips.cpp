#include "retarget/body/clips.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/body.hpp"
#include "retarget/formats/npz.hpp"

namespace understudy {
namespace {

std::string info_of(const std::string& path) {
  const Npz npz = read_npz(path);
  const auto info = npz.find("info");
  return info == npz.end() ? std::string() : info->second.text;
}

}  // namespace

std::vector<std::string> clip_files(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (file_suffix(entry.path().string()) == ".npz") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

Clip read_clip(const std::string& path) {
  Clip clip{read_amass_motion(path), {}};
  for (int t = 0; t < ssize(clip.motion.poses); ++t)
    if (clip.motion.flags.empty() || clip.motion.flags[t] == 0) clip.good.push_back(t);
  return clip;
}

std::vector<Clip> read_clips(const std::string& folder) {
  std::vector<Clip> clips;
  for (const std::string& file : clip_files(folder)) {
    Clip clip = read_clip(file);
    if (!clip.good.empty()) clips.push_back(std::move(clip));
  }
  return clips;
}

std::vector<ClipRun> good_runs(const std::vector<Clip>& clips, int shortest, int longest) {
  std::vector<ClipRun> runs;
  for (int c = 0; c < ssize(clips); ++c) {
    const std::vector<int>& good = clips[c].good;
    for (size_t i = 0; i < good.size();) {
      size_t end = i + 1;
      while (end < good.size() && static_cast<int>(end - i) < longest && good[end] == good[end - 1] + 1)
        ++end;
      const int count = static_cast<int>(end - i);
      if (count >= shortest) runs.push_back({c, good[i], count});
      i = end;
    }
  }
  return runs;
}

std::vector<std::string> labels_of_info(const std::string& info) {
  const auto json = nlohmann::json::parse(info, nullptr, /*allow_exceptions=*/false);
  std::vector<std::string> labels;
  if (!json.is_object() || !json.contains("actions") || !json["actions"].is_array()) return labels;
  for (const auto& action : json["actions"])
    if (action.is_string()) labels.push_back(action.get<std::string>());
  return labels;
}

std::vector<std::string> clip_labels(const std::string& path) {
  return labels_of_info(info_of(path));
}

std::string clip_description(const std::string& path) {
  const auto json = nlohmann::json::parse(info_of(path), nullptr, /*allow_exceptions=*/false);
  const bool says = json.is_object() && json.contains("desc") && json["desc"].is_string();
  return says ? json["desc"].get<std::string>() : std::string();
}

}  // namespace understudy
