#include "app/session/take_export.hpp"

#include <algorithm>
#include <filesystem>

#include "app/session/command_sets.hpp"
#include "retarget/base/error.hpp"

namespace understudy::app {
namespace {

void set_option(ExportChoice& out, const std::string& key, const std::string& value) {
  const ArgumentReader words({value});
  const auto in_range = [&](float high) {
    const auto number = words.number<double>(0, key.c_str());
    US_CHECK(number >= 0 && number <= high, key, " is between 0 and ", high, ", not ", value);
    return number;
  };
  if (key == "rig")
    out.theirs = words.choice(0, "rig", {"theirs", "ours"}) == 0;
  else if (key == "influences")
    out.file.influences = words.choice(0, "influences", {"4", "8"}) == 0 ? 4 : 8;
  else if (key == "morphs")
    out.file.shapes = static_cast<int>(in_range(64));
  else if (key == "reduce")
    out.file.reduce_mm = static_cast<float>(in_range(1000));
  else if (key == "in_place")
    out.file.in_place = words.on(0);
  else if (key == "t_pose")
    out.file.t_pose_clip = words.on(0);
  else if (key == "keep_clips")
    out.file.keep_clips = words.on(0);
  else if (key == "take")
    out.takes.push_back(value);
  else
    throw Error("there is no export option '" + key + "'");
}

/// Of the clip: what the source is called.
std::string clip_name(const Session& session, const Take& take) {
  const std::string stem = std::filesystem::path(session.source.name).stem().string();
  return stem.empty() ? take.name : stem;
}

void add_clip(ExportInput& out, const Session& session, size_t k, const std::string& name) {
  const Take& take = session.document.takes[k];
  const TakeState& state = session.takes[k];
  CharacterClip clip{name, session.source.fps, {}};
  for (const int frame : kept_frames(take.pose_edits, state.shown.poses.size())) {
    const size_t t = frame;
    clip.poses.push_back(state.shown.poses[t]);
    out.source_joints.push_back(t < state.performed.size() ? state.performed[t].source : Joints::Zero());
  }
  out.source_to_scan = session.source.to_file;
  out.clips.push_back(std::move(clip));
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
  out.format = &export_format(format, path);
  return out;
}

size_t take_called(const Document& document, const std::string& name, int first) {
  const auto& takes = document.takes;
  std::vector<size_t> named;
  std::string all;
  for (size_t k = 0; k < takes.size(); ++k) {
    if (takes[k].name == name) named.push_back(k);
    all += (k > 0 ? ", " : "") + std::to_string(static_cast<int>(k) + first) + " " + takes[k].name;
  }
  US_CHECK(named.size() <= 1, "several takes are called '", name, "': give its number, of ", all);
  if (!named.empty()) return named[0];
  for (size_t k = 0; k < takes.size(); ++k)
    if (std::to_string(static_cast<int>(k) + first) == name) return k;
  throw Error("there is no take '" + name + "'" + (all.empty() ? "" : ", only " + all));
}

std::vector<size_t> takes_of_one_body(const Document& document, size_t take) {
  std::vector<size_t> out;
  const Take& first = document.takes.at(take);
  for (size_t k = 0; k < document.takes.size(); ++k) {
    const Take& other = document.takes[k];
    if (same(other.target, first.target) && same(other.target_edits, first.target_edits) &&
        other.method.offsets == first.method.offsets)
      out.push_back(k);
  }
  return out;
}

ExportInput export_input(const Session& session, const std::vector<size_t>& takes,
                         const ExportChoice& choice) {
  US_CHECK(!takes.empty(), "no take was chosen for export");
  const Take& take = session.document.takes.at(takes[0]);
  const TakeState& state = session.takes[takes[0]];
  const std::vector<size_t> one_body = takes_of_one_body(session.document, takes[0]);
  ExportInput out;
  for (const size_t k : takes) {
    const std::string& name = session.document.takes.at(k).name;
    US_CHECK(std::find(one_body.begin(), one_body.end(), k) != one_body.end(), name, ": is no take of the ",
             "same target as ", take.name,
             ", with the same joints, weights and offsets: it cannot be a clip ", "of the same file");
    US_CHECK(session.takes[k].problem.empty(), name, ": ", session.takes[k].problem);
    US_CHECK(session.takes[k].ready && session.takes[k].character && !session.takes[k].shown.poses.empty(),
             "there is nothing to export yet");
    add_clip(out, session, k, takes.size() > 1 ? name : clip_name(session, take));
  }
  out.body = {state.character, state.deformer, choice.file};
  const bool own = on_their_rig(take.target, *state.character);
  US_CHECK(own || !choice.theirs.value_or(false), take.name, ": does not perform on bones of its own");
  out.body.file.their_rig = choice.theirs.value_or(own);
  out.body.file.joints = state.target->joints;
  return out;
}

}  // namespace understudy::app
