// Further motions of the found rig: made, looked at, kept as clips, renamed and removed.
#include <algorithm>

#include "app/session/command_sets.hpp"
#include "app/session/made_motions.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

GenerationOptions options_of(const Call& c) {
  GenerationOptions how;
  how.frames = c.number<int>(0, "number of frames");
  for (size_t i = 1; i < c.arguments.size(); ++i) {
    const std::string& word = c.one_of(i, "option", {"between", "loop", "count", "seed", "engine"});
    if (word == "loop") how.loop = true;
    if (word == "engine") how.engine = c.word(++i, "engine");
    if (word == "count") how.count = c.number<int>(++i, "number of motions");
    if (word == "seed") {
      const int seed = c.number<int>(++i, "seed");
      US_CHECK(seed >= 0, "a seed is 0 or more, not ", seed);
      how.seed = static_cast<uint64_t>(seed);
    }
    if (word != "between") continue;
    const int first = c.number<int>(++i, "first frame");
    how.between = FramesBetween{first, c.number<int>(++i, "last frame")};
  }
  return how;
}

/// Of the motions that are offered.
const MadeMotion& offered_of(const Call& c) {
  const std::vector<MadeMotion>& offered = c.session.made_motions.offered;
  const int seed = c.number<int>(0, "seed");
  const auto found = std::find_if(offered.begin(), offered.end(), [&](const MadeMotion& one) {
    return one.how.seed == static_cast<uint64_t>(seed);
  });
  US_CHECK(found != offered.end(), "no motion with the seed ", seed, " is offered");
  return *found;
}

bool is_taken(const Document& document, const std::string& name) {
  const auto& clips = document.bones.clips;
  return name == kFoundClip ||
         std::any_of(clips.begin(), clips.end(), [&](const MadeClip& clip) { return clip.name == name; });
}

void check_clip_name(const Document& document, const std::string& name) {
  US_CHECK(name.find_first_not_of(' ') != std::string::npos, "a clip needs a name");
  US_CHECK(!is_taken(document, name), "there is a clip \"", name, "\" already");
}

void keep_motion(Call& c) {
  const MadeMotion& one = offered_of(c);
  const int kept = clip_of(c.document, one.how);
  US_CHECK(kept < 0, "this motion is a clip already: \"",
           c.document.bones.clips[static_cast<size_t>(std::max(0, kept))].name, "\"");
  const std::string usual = "motion " + std::to_string(one.how.seed);
  std::string name = c.arguments.size() > 1 ? c.arguments[1] : usual;
  for (int i = 2; c.arguments.size() < 2 && is_taken(c.document, name); ++i)
    name = usual + " (" + std::to_string(i) + ")";
  check_clip_name(c.document, name);
  c.document.bones.clips.push_back({name, one.how});
  c.label = "Keep " + name;
}

void rename_clip(Call& c) {
  MadeClip& clip = kept_clip(c);
  const std::string& name = c.word(1, "name");
  if (name == clip.name) return;
  check_clip_name(c.document, name);
  c.label = "Rename " + clip.name;
  std::string& performed = c.document.bones.second.clip;
  if (performed == clip.name) performed = name;
  clip.name = name;
}

void remove_clip(Call& c) {
  const MadeClip& clip = kept_clip(c);
  c.label = "Remove " + clip.name;
  if (std::string& performed = c.document.bones.second.clip; performed == clip.name) performed.clear();
  std::vector<MadeClip>& clips = c.document.bones.clips;
  clips.erase(clips.begin() + (&clip - clips.data()));
}

}  // namespace

MadeClip& kept_clip(Call& c) {
  std::vector<MadeClip>& clips = c.document.bones.clips;
  const std::string& word = c.word(0, "clip");
  for (MadeClip& clip : clips)
    if (clip.name == word) return clip;
  int64_t number = 0;
  US_CHECK(parse_integer(word, number) && number >= 0 && number < ssize(clips), "there is no clip '", word,
           "'");
  return clips[static_cast<size_t>(number)];
}

void add_made_motions_commands(Commands& commands) {
  commands.add({"generate.make", "Make more of its motion",
                "FRAMES [between A B] [loop] [count N] [seed S] [engine NAME]: A, B: frames of the source"},
               [](Call& c) { c.studio.make_motions(options_of(c)); });
  commands.add(
      {"generate.clear", "Drop the motions that were made", "those that were kept stay"},
      [](Call& c) { c.session.made_motions.offered.clear(), c.session.made_motions.remark.clear(); });
  commands.add_edit({"generate.keep", "Keep a made motion", "SEED [NAME]: as a clip of the found rig"},
                    keep_motion);
  commands.add_edit({"generate.rename", "Rename clip", "CLIP NAME: by name or number"}, rename_clip);
  commands.add_edit({"generate.remove", "Remove clip", "CLIP: by name or number"}, remove_clip);
  commands.add(
      {"view.made_motions", "Made motions",
       "off|over|beside: the found body in motions that were made, as ghosts over it or beside it"},
      [](Call& c) { c.session.view.made_motions = c.choice<BoneSurface>(0, "place", kBoneSurfaceNames); });
}

}  // namespace understudy::app
