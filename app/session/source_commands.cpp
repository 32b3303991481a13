#include <algorithm>
#include <filesystem>

#include "app/session/command_sets.hpp"
#include "retarget/base/error.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/formats/scan_source.hpp"
#include "retarget/motion/read_motion.hpp"
#include "retarget/pipeline/method_table.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

/// For another source: drops the edits and settings of the old one's frames.
void set_source(Studio& studio, SourceOptions source) {
  Session& session = studio.session();
  Document& document = session.document;
  const std::string path = source.motion.empty() ? source.path : source.motion;
  document.source = std::move(source);
  document.truth.clear();
  document.scan_edits = {};
  document.skeleton_edits.clear();
  for (Take& take : document.takes) take.pose_edits = {};
  session.playback = Playback{};
  remember(session.settings.recent_sources, path);
}

void add_opening(Commands& commands) {
  commands.add({"source.open", "Open scan",
                "PATH: scans (folder, list, array) or a skeletal motion (" + format_names(kMotion) + ")", "",
                true, false, [](Studio& s, const Arguments& a) {
                  SourceOptions source;
                  source.path = fs::absolute(word(a, 0, "path")).lexically_normal().string();
                  if (!is_motion_file(source.path))
                    ScanSource{source.path};  // throws at once when there is no frame
                  set_source(s, source);
                }});
  commands.add({"source.motion", "Open motion", "BODY MOTION: SMPL-format body, AMASS-format motion", "",
                true, false, [](Studio& s, const Arguments& a) {
                  SourceOptions source;
                  source.path = fs::absolute(word(a, 0, "body")).lexically_normal().string();
                  source.motion = fs::absolute(word(a, 1, "motion")).lexically_normal().string();
                  set_source(s, source);
                }});
  commands.add({"source.fps", "Frame rate", "FRAMES_PER_SECOND; 0: the source's own, or 30", "", true, false,
                [](Studio& s, const Arguments& a) {
                  const double fps = number(a, 0, "frame rate");
                  US_CHECK(fps == 0 || (fps >= 1 && fps <= 1000), "a frame rate is 1 to 1000, not ", fps);
                  s.session().document.source.fps = fps;
                }});
}

void add_import(Commands& commands) {
  commands.add({"source.units", "Units of the scan", "auto|m|dm|cm|mm|in", "", true, false,
                [](Studio& s, const Arguments& a) {
                  choice(a, 0, "unit", {"auto", "m", "dm", "cm", "mm", "in"});
                  s.session().document.source.import.units = a[0];
                }});
  commands.add({"source.up", "Up axis of the scan", "auto|x|y|z|-x|-y|-z", "", true, false,
                [](Studio& s, const Arguments& a) {
                  choice(a, 0, "axis", {"auto", "x", "y", "z", "-x", "-y", "-z"});
                  s.session().document.source.import.up = a[0];
                }});
  commands.add({"source.yaw", "Turn the scan", "DEGREES", "", true, true, [](Studio& s, const Arguments& a) {
                  s.session().document.source.import.yaw_deg = static_cast<float>(number(a, 0, "angle"));
                }});
  commands.add(
      {"source.floor", "Floor of the scan", "METRES|auto", "", true, true, [](Studio& s, const Arguments& a) {
         auto& floor = s.session().document.source.import.floor;
         floor.reset();
         if (word(a, 0, "height") != "auto") floor = static_cast<float>(number(a, 0, "height"));
       }});
  commands.add({"source.extractor", "Skeleton extraction", names_of(extractors(), "|"), "", true, false,
                [](Studio& s, const Arguments& a) {
                  choice(a, 0, "extractor", names_of(extractors()));
                  for (Take& take : s.session().document.takes) take.method.extractor = a[0];
                }});
}

/// Refuses an unknown name at once where the file's animations are known.
void check_clip(const SourceState& source, const std::string& clip) {
  if (source.clips.empty() || clip.empty()) return;
  std::string all;
  for (size_t i = 0; i < source.clips.size(); ++i) {
    const std::string number_of = std::to_string(i + 1);
    if (source.clips[i].name == clip || number_of == clip) return;
    if (i < 20) all += (i > 0 ? ", " : "") + number_of + " " + source.clips[i].name;
  }
  throw Error(source.name + ": has no animation '" + clip + "', only " + all);
}

/// Refuses an option that does not apply to such a source.
void set_skeletal(Studio& studio, SourceOptions source) {
  if (!source.path.empty()) check_source_options(source);
  studio.session().document.source = std::move(source);
}

void add_skeletal(Commands& commands) {
  commands.add({"source.clip", "Animation of the source", "NAME|NUMBER|longest", "", true, false,
                [](Studio& s, const Arguments& a) {
                  const std::string clip = word(a, 0, "animation");
                  const std::string wanted = clip == "longest" ? "" : clip;
                  check_clip(s.session().source, wanted);
                  SourceOptions source = s.session().document.source;
                  source.clip = wanted;
                  set_skeletal(s, std::move(source));
                }});
  commands.add({"source.as_scan", "Use an animated source as a scan", "on|off", "", true, false,
                [](Studio& s, const Arguments& a) {
                  choice(a, 0, "switch", {"on", "off"});
                  SourceOptions source = s.session().document.source;
                  source.as_scan = a[0] == "on";
                  set_skeletal(s, std::move(source));
                }});
  commands.add({"source.bone", "Bone of the source for a joint",
                "JOINT BONE|auto|none; auto: the bone found for it", "", true, false,
                [](Studio& s, const Arguments& a) {
                  SourceOptions source = s.session().document.source;
                  const std::string joint = word(a, 0, "joint"), bone = word(a, 1, "bone");
                  US_CHECK(std::find(kJointNames.begin(), kJointNames.end(), joint) != kJointNames.end(),
                           "there is no joint '", joint, "'");
                  source.bones[joint] = bone == "none" ? "" : bone;
                  if (bone == "auto") source.bones.erase(joint);
                  set_skeletal(s, std::move(source));
                }});
}

}  // namespace

void add_source_commands(Commands& commands) {
  add_opening(commands);
  add_skeletal(commands);
  add_import(commands);
}

}  // namespace understudy::app
