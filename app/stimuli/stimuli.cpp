#include "app/stimuli/stimuli.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <set>
#include <utility>

#include "app/run/interrupt.hpp"
#include "app/run/version.hpp"
#include "app/stimuli/clip_writer.hpp"
#include "app/stimuli/stage_painter.hpp"
#include "app/stimuli/stimuli_manifest.hpp"
#include "app/study/trial_exports.hpp"
#include "render/context/context.hpp"
#include "retarget/base/checksum.hpp"
#include "retarget/base/clock.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

constexpr int kQuality = 18;  // x264's constant rate factor: no difference is seen
constexpr int kDrawing = 1;   // to be raised where the same study gives other pictures than before

/// Changes when the file, or one in the folder, does.
std::string stamp_of(const std::string& path) {
  std::error_code is_gone;
  const auto of_file = [&](const fs::path& file) {
    return printed("%llu %lld ", static_cast<unsigned long long>(fs::file_size(file, is_gone)),
                   static_cast<long long>(fs::last_write_time(file, is_gone).time_since_epoch().count()));
  };
  if (!fs::is_directory(path, is_gone)) return path.empty() ? "" : of_file(path);
  std::set<std::string> files;
  for (const auto& entry : fs::directory_iterator(path, is_gone))
    files.insert(entry.path().filename().string() + ' ' + of_file(entry.path()));
  std::string all;
  for (const std::string& file : files) all += file;
  return all;
}

std::string word_of(const PaneView& view, const Study& study) {
  std::string word = kStudyPaneNames[static_cast<size_t>(view.pane)];
  if (view.pane != StudyPane::Result || study.layout.results == TrialResults::One) return word;
  return word + (view.side == 0 ? " A" : " B");
}

/// Where a pane's own film is: "panes/NAME-result-a.mp4".
std::string pane_path(const std::string& clip, const std::string& pane) {
  std::string word;
  for (const char c : pane) word += c == ' ' ? '-' : c == 'A' ? 'a' : c == 'B' ? 'b' : c;
  return "panes/" + clip + "-" + word + ".mp4";
}

PaneRecord record_of(const PaneView& view, const Study& study) {
  PaneRecord record;
  record.pane = word_of(view, study);
  record.x = view.x, record.y = view.y, record.width = view.size.width, record.height = view.size.height;
  record.yaw_deg = study.picture.yaw_deg, record.pitch_deg = study.picture.pitch_deg;
  record.fov_deg = study.picture.fov_deg, record.distance_m = view.camera.distance;
  record.looks_at = view.camera.target;
  return record;
}

class Maker {
 public:
  Maker(const Study& study, const StimulusServices& services, const StimuliOptions& options)
      : study_(study),
        options_(options),
        services_(services),
        trials_(clip_trials(study)),
        json_(to_json(study, options.study_folder)),
        made_(options.out) {
    services_.progress = [this, told = services.progress](const std::string& what, int64_t done,
                                                          int64_t total) {
      US_CHECK(!interrupted(), "interrupted: ", finished_, " of ", trials_.size(),
               " clips are finished, the same command makes the rest");
      if (told) told(what, done, total);
    };
  }

  StimuliReport make();

 private:
  std::string made_from(const Trial& trial) const;
  const ClipRecord* find(const Trial& trial) const;
  void make_stage(const std::vector<Trial>& trials);
  void make_clip(const Trial& trial, StagePainter& painter, const ClipPlan& plan, const Stage& stage);
  ClipRecord record_of_clip(const Trial& trial, const StagePainter& painter, const ClipPlan& plan,
                            const Stage& stage) const;
  std::vector<ClipWriter::Film> films_of(const ClipRecord& record) const;
  std::string in_out(const std::string& file) const { return options_.out + "/" + file; }

  const Study& study_;
  const StimuliOptions& options_;
  StimulusServices services_;
  std::vector<Trial> trials_;
  Json json_;
  MadeClips made_;
  std::unique_ptr<StageMaker> stages_;
  std::unique_ptr<render::Context> context_;
  ClipRenderers renderers_;
  int finished_ = 0;
  StimuliReport report_;
};

/// All that a clip's pictures depend on: other conditions, too, as they are framed together.
std::string Maker::made_from(const Trial& trial) const {
  const StudyMotion& motion = study_.motions[static_cast<size_t>(trial.motion)];
  const StudyTarget& target = study_.targets[static_cast<size_t>(trial.target)];
  Json all{
      {"program", kProgram}, {"made_by", options_.made_by}, {"quality", kQuality}, {"drawing", kDrawing}};
  for (const char* part : {"conditions", "layout", "clip", "picture"}) all[part] = json_.at(part);
  all["motion"] = json_.at("motions").at(static_cast<size_t>(trial.motion));
  all["target"] = json_.at("targets").at(static_cast<size_t>(trial.target));
  std::string text = all.dump(-1, ' ', false, Json::error_handler_t::replace);
  for (const std::string& path : {motion.source.path, motion.source.motion, target.target.path})
    text += stamp_of(path) + '\n';
  for (const Condition& condition : study_.conditions)
    if (condition.kind != ConditionKind::Method) text += stamp_of(file_for(condition, motion, target)->path);
  return checksum_text(fnv1a(text));
}

const ClipRecord* Maker::find(const Trial& trial) const {
  const ClipRecord* known = made_.find(clip_name(study_, trial), made_from(trial));
  if (known == nullptr) return nullptr;
  const bool has_panes = std::none_of(known->panes.begin(), known->panes.end(),
                                      [](const PaneRecord& pane) { return pane.file.empty(); });
  return options_.separate && !has_panes ? nullptr : known;
}

ClipRecord Maker::record_of_clip(const Trial& trial, const StagePainter& painter, const ClipPlan& plan,
                                 const Stage& stage) const {
  const StudyMotion& motion = study_.motions[static_cast<size_t>(trial.motion)];
  ClipRecord record;
  record.clip = clip_name(study_, trial);
  record.condition = study_.conditions[static_cast<size_t>(trial.condition)].name;
  if (trial.other >= 0) record.other = study_.conditions[static_cast<size_t>(trial.other)].name;
  record.motion = motion.name, record.action = action_of(motion);
  record.target = study_.targets[static_cast<size_t>(trial.target)].name;
  record.file = clip_path(study_, trial);
  record.width = study_.picture.width, record.height = study_.picture.height;
  record.fps = study_.picture.fps, record.frames = plan.frames(), record.runs = plan.runs();
  record.seconds = static_cast<float>(plan.frames()) / static_cast<float>(record.fps);
  record.motion_s = static_cast<float>(stage.motion_s);
  for (const PaneView& view : painter.panes()) {
    record.panes.push_back(record_of(view, study_));
    if (options_.separate) record.panes.back().file = pane_path(record.clip, record.panes.back().pane);
  }
  return record;
}

std::vector<ClipWriter::Film> Maker::films_of(const ClipRecord& record) const {
  render::VideoOptions options;
  options.fps = record.fps, options.quality = kQuality;
  options.repeatable = true;
  options.width = record.width, options.height = record.height;
  std::vector<ClipWriter::Film> films = {{in_out(record.file), options}};
  for (const PaneRecord& pane : record.panes) {
    if (pane.file.empty()) continue;
    options.width = pane.width, options.height = pane.height;
    films.push_back({in_out(pane.file), options});
  }
  return films;
}

void Maker::make_clip(const Trial& trial, StagePainter& painter, const ClipPlan& plan, const Stage& stage) {
  ClipRecord record = record_of_clip(trial, painter, plan, stage);
  ClipWriter writer(films_of(record));
  const std::string what = printed("clip %d of %zu", finished_ + 1, trials_.size());
  for (int frame = 0; frame < plan.frames(); ++frame) {
    const ClipMoment moment = plan.at(frame);
    std::vector<render::Image> pictures = {painter.picture(trial, moment)};
    for (size_t pane = 0; options_.separate && pane < painter.panes().size(); ++pane)
      pictures.push_back(painter.pane_picture(trial, pane, moment));
    writer.push(std::move(pictures));
    services_.progress(what, frame + 1, plan.frames());
  }
  writer.finish();
  record.checksum = checksum_of_file(in_out(record.file));
  record.bytes = static_cast<int64_t>(fs::file_size(in_out(record.file)));
  for (PaneRecord& pane : record.panes)
    if (!pane.file.empty()) pane.checksum = checksum_of_file(in_out(pane.file));
  made_.add(record, made_from(trial));
  ++finished_, ++report_.made;
  report_.frames += plan.frames();
}

/// The clips of one motion on one target.
void Maker::make_stage(const std::vector<Trial>& trials) {
  auto began = std::chrono::steady_clock::now();
  if (stages_ == nullptr) stages_ = std::make_unique<StageMaker>(study_, services_);
  const auto stage = stages_->stage(trials[0].motion, trials[0].target);
  report_.stage_s += ms_since(began) / 1000;
  began = std::chrono::steady_clock::now();
  if (context_ == nullptr) context_ = render::make_offscreen_context();
  StagePainter painter(study_, stage, {study_.picture.width, study_.picture.height}, renderers_);
  const ClipPlan plan(study_.clip, study_.picture.fps, stage->motion_s);
  for (const Trial& trial : trials) make_clip(trial, painter, plan, *stage);
  report_.render_s += ms_since(began) / 1000;
}

StimuliReport Maker::make() {
  for (const char* folder : {"clips", "panes"}) {
    if (!options_.separate && std::string(folder) == "panes") continue;
    std::error_code why;
    fs::create_directories(in_out(folder), why);
    US_CHECK(!why, options_.out, ": cannot be made a folder, ", why.message());
  }
  std::vector<std::pair<std::pair<int, int>, std::vector<Trial>>> stages;  // in their first trials' order
  for (const Trial& trial : trials_) {
    if (find(trial) != nullptr) {
      ++finished_;
      continue;
    }
    const std::pair<int, int> key{trial.motion, trial.target};
    const auto known =
        std::find_if(stages.begin(), stages.end(), [&](auto& one) { return one.first == key; });
    if (known == stages.end())
      stages.push_back({key, {trial}});
    else
      known->second.push_back(trial);
  }
  if (!stages.empty()) {  // nothing is retargeted that could not be written
    render::VideoOptions options;
    options.width = study_.picture.width, options.height = study_.picture.height;
    options.fps = study_.picture.fps;
    const render::VideoWriter can_be_written(in_out(clip_path(study_, stages[0].second[0])), options);
  }
  for (const auto& [key, trials] : stages) make_stage(trials);
  std::vector<ClipRecord> records;
  for (const Trial& trial : trials_)
    records.push_back(*made_.find(clip_name(study_, trial), made_from(trial)));
  write_manifest(options_.out, study_.name, digest_of(study_, options_.study_folder), records);
  report_.clips = static_cast<int>(trials_.size());
  return report_;
}

}  // namespace

StimuliReport make_stimuli(const Study& study, const StimulusServices& services,
                           const StimuliOptions& options) {
  return Maker(study, services, options).make();
}

}  // namespace understudy::app
