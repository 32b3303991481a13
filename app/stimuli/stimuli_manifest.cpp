#include "app/stimuli/stimuli_manifest.hpp"

#include <filesystem>
#include <utility>

#include "app/run/version.hpp"
#include "retarget/base/checksum.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

constexpr JsonFileKind kMade{"understudy-clips", "a list of clips", "lists of clips", 1};

std::string number(double value) {
  return printed("%.9g", value);
}

std::string csv_of(const std::vector<ClipRecord>& clips) {
  std::string text =
      "clip,condition,other,motion,action,target,file,checksum,bytes,width,height,frames,fps,seconds,runs,"
      "motion_s,camera_yaw_deg,camera_pitch_deg,camera_fov_deg,camera_distance_m\n";
  for (const ClipRecord& clip : clips) {
    const PaneRecord camera = clip.panes.empty() ? PaneRecord{} : clip.panes[0];
    std::string line;
    for (const std::string& cell : {clip.clip,
                                    clip.condition,
                                    clip.other,
                                    clip.motion,
                                    clip.action,
                                    clip.target,
                                    clip.file,
                                    clip.checksum,
                                    std::to_string(clip.bytes),
                                    number(clip.width),
                                    number(clip.height),
                                    number(clip.frames),
                                    number(clip.fps),
                                    number(static_cast<double>(clip.seconds)),
                                    number(clip.runs),
                                    number(static_cast<double>(clip.motion_s)),
                                    number(static_cast<double>(camera.yaw_deg)),
                                    number(static_cast<double>(camera.pitch_deg)),
                                    number(static_cast<double>(camera.fov_deg)),
                                    number(static_cast<double>(camera.distance_m))})
      line += (line.empty() ? "" : ",") + csv_cell(cell);
    text += line + '\n';
  }
  return text;
}

Json json_of(const ClipRecord& clip) {
  Json json = Json::object();
  FieldsWriter writer(json, "", "");
  fields(writer, clip);
  return json;
}

}  // namespace

void write_manifest(const std::string& folder, const std::string& name, const std::string& study,
                    const std::vector<ClipRecord>& clips) {
  Json json{{"format", "understudy-stimuli"},
            {"version", 1},
            {"program", kProgram},
            {"study", name},
            {"design", Json::parse(study, nullptr, /*allow_exceptions=*/false)},
            {"clips", Json::array()}};
  for (const ClipRecord& clip : clips) json["clips"].push_back(json_of(clip));
  write_file(folder + "/manifest.csv", csv_of(clips));
  write_file(folder + "/manifest.json", json_text(json));
}

MadeClips::MadeClips(std::string folder) : folder_(std::move(folder)) {
  const std::string path = folder_ + "/made.json";
  std::error_code is_none;
  if (!std::filesystem::exists(path, is_none)) return;
  const std::string problem = failure_of([&] {
    const Json json = read_json(path);
    check_kind(json, path, kMade);
    for (const Json& one : json.at("clips")) {
      Made made;
      made.from = one.at("from").get<std::string>();
      FieldsReader reader(one.at("clip"), "", path + ": ");
      fields(reader, made.clip);
      made_[made.clip.clip] = made;
    }
  });
  if (!problem.empty()) made_.clear();
}

bool MadeClips::is_whole(const std::string& file, const std::string& checksum) const {
  return file.empty() || checksum_of_file(folder_ + "/" + file) == checksum;
}

const ClipRecord* MadeClips::find(const std::string& clip, const std::string& made_from) const {
  const auto found = made_.find(clip);
  if (found == made_.end() || found->second.from != made_from) return nullptr;
  const ClipRecord& known = found->second.clip;
  if (!is_whole(known.file, known.checksum)) return nullptr;
  for (const PaneRecord& pane : known.panes)
    if (!is_whole(pane.file, pane.checksum)) return nullptr;
  return &known;
}

void MadeClips::add(const ClipRecord& clip, const std::string& made_from) {
  made_[clip.clip] = {made_from, clip};
  Json json{{"format", kMade.format}, {"version", kMade.version}, {"clips", Json::array()}};
  for (const auto& [name, made] : made_)
    json["clips"].push_back({{"from", made.from}, {"clip", json_of(made.clip)}});
  write_file(folder_ + "/made.json", json_text(json), /*synced=*/false);
}

}  // namespace understudy::app
