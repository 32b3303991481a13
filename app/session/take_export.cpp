#include "app/session/take_export.hpp"

#include <filesystem>

#include "app/session/command_sets.hpp"
#include "retarget/base/error.hpp"

namespace understudy::app {
namespace {

bool is_on(const std::string& value) {
  return choice({value}, 0, "switch", {"off", "on"}) == 1;
}

double in_range(const std::string& key, const std::string& value, double low, double high) {
  const double number_of = number({value}, 0, key.c_str());
  US_CHECK(number_of >= low && number_of <= high, key, " is between ", low, " and ", high, ", not ", value);
  return number_of;
}

void set_option(ExportChoice& out, const std::string& key, const std::string& value) {
  if (key == "rig")
    out.theirs = choice({value}, 0, "rig", {"theirs", "ours"}) == 0;
  else if (key == "influences")
    out.file.influences = choice({value}, 0, "influences", {"4", "8"}) == 0 ? 4 : 8;
  else if (key == "morphs")
    out.file.shapes = static_cast<int>(in_range(key, value, 0, 64));
  else if (key == "reduce")
    out.file.reduce_mm = static_cast<float>(in_range(key, value, 0, 1000));
  else if (key == "in_place")
    out.file.in_place = is_on(value);
  else if (key == "t_pose")
    out.file.t_pose_clip = is_on(value);
  else if (key == "keep_clips")
    out.file.keep_clips = is_on(value);
  else
    throw Error("an export knows no option '" + key + "'");
}

/// Of the clip: what the source is called.
std::string clip_name(const Session& session, const Take& take) {
  const std::string stem = std::filesystem::path(session.source.name).stem().string();
  return stem.empty() ? take.name : stem;
}

}  // namespace

ExportChoice export_choice(const std::string& path, const std::vector<std::string>& words) {
  ExportChoice out;
  std::string format;
  for (const std::string& text : words) {
    const size_t equals = text.find('=');
    US_CHECK(equals != std::string::npos, "an option of an export is key=value, not '", text, "'");
    const std::string key = text.substr(0, equals), value = text.substr(equals + 1);
    if (key == "format")
      format = value;
    else
      set_option(out, key, value);
  }
  out.format = export_format(format, path);
  return out;
}

ExportInput export_input(const Session& session, size_t k, const ExportChoice& choice) {
  const Take& take = session.document.takes[k];
  const TakeState& state = session.takes[k];
  US_CHECK(state.problem.empty(), take.name, ": ", state.problem);
  US_CHECK(state.ready && state.character && !state.shown.poses.empty(), "there is nothing to export yet");
  ExportInput out;
  out.body = {state.character, state.deformer, choice.file};
  const bool own = on_their_rig(take.target, *state.character);
  US_CHECK(own || !choice.theirs.value_or(false), take.name, ": does not perform on bones of its own");
  out.body.file.their_rig = choice.theirs.value_or(own);
  out.body.file.joints = state.target->joints;
  CharacterClip clip{clip_name(session, take), session.source.fps, {}};
  for (const int frame : kept_frames(take.pose_edits, static_cast<int>(state.shown.poses.size()))) {
    const size_t t = static_cast<size_t>(frame);
    clip.poses.push_back(state.shown.poses[t]);
    const auto& frames = session.source.frames;
    out.source_joints.push_back(t < frames.size() ? frames[t].joints : Joints::Zero());
  }
  out.clips.push_back(std::move(clip));
  return out;
}

}  // namespace understudy::app
