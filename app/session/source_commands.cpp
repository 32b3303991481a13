#include <filesystem>
#include <optional>

#include "app/run/completed_source.hpp"
#include "app/session/command_sets.hpp"
#include "retarget/base/error.hpp"
#include "retarget/body/body.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/formats/scan_source.hpp"
#include "retarget/keypoints/keypoint_reader.hpp"
#include "retarget/motion/read_motion.hpp"
#include "retarget/pipeline/method_table.hpp"

namespace understudy::app {

void set_source(Call& c, SourceOptions source) {
  Document& document = c.document;
  remember_folder(c.studio, source.motion.empty() ? source.path : source.motion);
  document.source = std::move(source);
  document.truth.clear();
  document.scan_edits = {};
  document.skeleton_edits.clear();
  document.flat.reset();
  document.bones = {};
  for (Take& take : document.takes) take.pose_edits = {}, take.person.clear();
  c.session.playback = Playback{};
}

namespace {

void check_file(const std::string& path) {
  std::error_code failed;
  US_CHECK(std::filesystem::exists(path, failed), path, ": there is no such file");
}

void add_opening(Commands& commands) {
  commands.add_edit({"source.open", "Open source",
                     "PATH: scans (folder, list, array), 2D poses, or a skeletal motion (" +
                         format_names(kMotion) + ") | PATH WIDTHxHEIGHT: 2D poses in a picture of that size"},
                    [](Call& c) {
                      SourceOptions source;
                      source.path = c.path(0);
                      if (looks_like_keypoints(source.path)) {
                        const std::string canvas = c.arguments.size() > 1 ? c.word(1, "canvas") : "";
                        if (!canvas.empty()) parse_canvas(canvas);
                        set_flat_source(c, source.path);
                        c.document.source.canvas = canvas;
                        return;
                      }
                      opened({&c.session.settings.recent_sources}, source.path, [&] {
                        US_CHECK(!is_smpl_body(source.path), source.path,
                                 ": is a body; choose the motion that it performs as well");
                        if (!is_motion_file(source.path))
                          ScanSource{source.path};  // throws at once when there is no frame
                      });
                      set_source(c, source);
                    });
  commands.add_edit(
      {"source.motion", "Open body and motion", "BODY MOTION: SMPL-format body, AMASS-format motion"},
      [](Call& c) {
        SourceOptions source;
        source.path = c.path(0, "body");
        source.motion = c.path(1, "motion");
        opened({&c.session.settings.recent_sources}, recent_source(source.path, source.motion), [&] {
          for (const std::string& path : {source.path, source.motion}) check_file(path);
        });
        set_source(c, source);
      });
  commands.add_edit({"source.fps", "Frame rate", "FRAMES_PER_SECOND; 0: the source's own, or 30"},
                    [](Call& c) {
                      const auto fps = c.number<double>(0, "frame rate");
                      US_CHECK(fps == 0 || (fps >= 1 && fps <= 1000), "a frame rate is 1 to 1000, not ", fps);
                      c.document.source.fps = fps;
                    });
}

/// Refuses an option that does not apply to such a source.
void set_options(Call& c, SourceOptions source) {
  if (!source.path.empty()) check_source_options(source);
  c.document.source = std::move(source);
}

/// What cannot be the times of these scans is refused at once.
void add_times(Commands& commands) {
  commands.add_edit(
      {"source.times", "Times of the scans", "FILE|off: a CSV of scan or frame number, and seconds"},
      [](Call& c) {
        SourceOptions source = c.document.source;
        const bool is_off = c.word(0, "file of times") == "off";
        source.times = is_off ? "" : c.path(0, "file of times");
        if (is_off) c.label = "No times of the scans";
        US_CHECK(is_off || !source.path.empty(), "no scans are open that have times");
        US_CHECK(is_off || c.session.source.clips.empty(), source.path,
                 ": is a skeletal motion, a table of times is for scans");
        check_source_options(source);
        if (!is_off) {
          remember_folder(c.studio, source.times);
          ScanSourceOptions options;
          options.times = source.times, options.fps = source.fps;
          ScanSource{source.path, options};
        }
        set_options(c, std::move(source));
      });
}

/// Markers that cannot be read are refused at once.
void add_completing(Commands& commands) {
  commands.add_edit({"source.complete", "Complete the scans",
                     "FRAMES_PER_SECOND|off: fits one body to all scans and makes a motion of them"},
                    [](Call& c) {
                      SourceOptions source = c.document.source;
                      const bool is_off = c.word(0, "frame rate") == "off";
                      source.complete = is_off ? 0 : c.number<double>(0, "frame rate");
                      US_CHECK(is_off || (source.complete >= 1 && source.complete <= 1000),
                               "a frame rate is 1 to 1000, not ", source.complete);
                      if (is_off) source.markers.clear(), c.label = "Do not complete the scans";
                      US_CHECK(is_off || !source.path.empty(), "no scans are open that could be completed");
                      US_CHECK(is_off || c.session.source.clips.empty(), source.path,
                               ": is a motion already, only scans are completed");
                      set_options(c, std::move(source));
                    });
  commands.add_edit({"source.markers", "Markers of the scans", "FILE|off: a CSV of seconds, name, x, y, z"},
                    [](Call& c) {
                      SourceOptions source = c.document.source;
                      const bool is_off = c.word(0, "file of markers") == "off";
                      source.markers = is_off ? "" : c.path(0, "file of markers");
                      if (is_off) c.label = "No markers";
                      check_source_options(source);
                      if (!is_off) {
                        remember_folder(c.studio, source.markers);
                        known_markers(source.markers);
                      }
                      set_options(c, std::move(source));
                    });
}

/// Of 2D poses, where they are read.
void check_performer(const Call& c, const std::string& person) {
  const auto& poses = c.session.flat.poses;
  if (!c.document.flat || !poses || person_number(person) <= 0) return;
  US_CHECK(poses->reading.track_of(person_number(person)) >= 0, name_of(c.document.source),
           ": nobody in it is number ", person);
}

void add_import(Commands& commands) {
  commands.add_edit({"source.units", "Units of the scan", "auto|m|dm|cm|mm|in"},
                    [](Call& c) { c.document.source.import.units = c.one_of(0, "unit", kUnitNames); });
  commands.add_edit({"source.up", "Up axis of the scan", "auto|x|y|z|-x|-y|-z"},
                    [](Call& c) { c.document.source.import.up = c.one_of(0, "axis", kAxisNames); });
  commands.add_edit(
      {"source.height", "Height of the person in the source", "METRES|auto: by its units, else 1.7 m"},
      [](Call& c) {
        SourceOptions source = c.document.source;
        source.import.height = c.body_height(0);
        set_options(c, std::move(source));
      });
  commands.add_slider({"source.turn", "Turn the scan", "DEGREES", "", "source.yaw"},
                      [](Call& c) { c.document.source.import.turn_deg = c.number(0, "angle"); });
  commands.add_slider({"source.floor", "Floor of the scan", "METRES|auto"}, [](Call& c) {
    auto& floor = c.document.source.import.floor;
    floor.reset();
    if (c.word(0, "height") != "auto") floor = c.number(0, "height");
  });
  commands.add_edit(
      {"source.person", "Choose the person", "NUMBER|largest|best: who of the scan performs"}, [](Call& c) {
        SourceOptions source = c.document.source;
        source.person = c.word(0, "person");
        US_CHECK(source.person != "all", "the source is one person; take.person gives a take another");
        if (person_number(source.person) > 0) c.label = "Choose person " + source.person;
        if (source.person == "best") source.person.clear();
        check_performer(c, source.person);
        set_options(c, std::move(source));
      });
  commands.add_edit({"source.extractor", "Skeleton extraction", names_of(extractors(), "|")}, [](Call& c) {
    const std::string& extractor = c.one_of(0, "extractor", names_of(extractors()));
    for (Take& take : c.document.takes) take.method.extractor = extractor;
  });
}

/// A motion that is blended, by its whole path. What cannot be one is refused at once.
BlendPart part_of(const std::string& text) {
  BlendPart part = blend_part(text);
  part.path = std::filesystem::absolute(part.path).lexically_normal().string();
  US_CHECK(is_motion_file(part.path) || may_hold_motion(part.path), part.path,
           ": is no skeletal motion, only these are blended");
  return part;
}

/// The blend that is open, or one of the motion that is.
BlendRecipe open_blend(const Call& c) {
  const SourceOptions& source = c.document.source;
  if (source.blend) return *source.blend;
  US_CHECK(!source.path.empty(), "no motion is open that could be blended with another");
  US_CHECK(source.motion.empty() && !source.as_scan, name_of(source),
           ": is no skeletal motion, only these are blended");
  BlendRecipe blend;
  blend.parts.push_back(part_of(source.path));
  const Playback& playback = c.session.playback;
  if (playback.in >= 0 && playback.out > playback.in && source.fps == 0)
    blend.parts[0].range = BlendRange{playback.in, playback.out};
  return blend;
}

void check_blend_size(size_t parts) {
  constexpr size_t kFewest = 2, kMost = 4;
  US_CHECK(parts >= kFewest && parts <= kMost, "a blend is made of ", kFewest, " to ", kMost,
           " movements, not of ", parts);
}

BlendRecipe& blend_of(Call& c) {
  US_CHECK(c.document.source.blend, "the source is no blend of motions");
  return *c.document.source.blend;
}

void blend_files(Call& c) {
  Arguments words = c.arguments;
  std::optional<std::vector<float>> weights;
  if (!words.empty() && words.back().find_first_not_of("0123456789.,") == std::string::npos) {
    weights = blend_weights(words.back());
    words.pop_back();
  }
  check_blend_size(words.size());
  BlendRecipe blend;
  for (const std::string& word : words) blend.parts.push_back(part_of(word));
  set_weights(weights.value_or(std::vector<float>(words.size(), 1)), blend);
  set_source(c, blended_source(std::move(blend)));
}

void add_blends(Commands& commands) {
  commands.add_edit({"source.blend", "Blend motions",
                     "MOTION MOTION ... [WEIGHTS]: two to four files, or FILE@FIRST:LAST for some of its "
                     "frames, else its best step; 0.3,0.7 for more of the second"},
                    blend_files);
  commands.add_edit({"source.blend_with", "Blend with another motion",
                     "MOTION: a file, or FILE@FIRST:LAST; of the open one the frames between the loop marks, "
                     "else its best step"},
                    [](Call& c) {
                      BlendRecipe blend = open_blend(c);
                      blend.parts.push_back(part_of(c.word(0, "motion")));
                      check_blend_size(blend.parts.size());
                      set_weights(std::vector<float>(blend.parts.size(), 1), blend);
                      set_source(c, blended_source(std::move(blend)));
                    });
  commands.add_slider(
      {"source.blend_weight", "Weight in the blend", "PART SHARE: from 0, of 1 in all"}, [](Call& c) {
        const auto part = c.number<int>(0, "part");
        const float share = c.number(1, "share");
        US_CHECK(part >= 0 && share >= 0 && share <= 1, "a share of a blend is 0 to 1, not ", share);
        set_share(static_cast<size_t>(part), share, blend_of(c));
      });
  commands.add_edit({"source.blend_cycles", "Cycles of the blend", "COUNT"}, [](Call& c) {
    const auto cycles = c.number<int>(0, "count");
    US_CHECK(cycles >= 1 && cycles <= 1000, "a blend is played 1 to 1000 times, not ", cycles);
    blend_of(c).cycles = cycles;
  });
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

void add_skeletal(Commands& commands) {
  commands.add_edit({"source.clip", "Animation of the source", "NAME|NUMBER|longest"}, [](Call& c) {
    SourceOptions source = c.document.source;
    source.clip = c.word(0, "animation");
    if (source.clip == "longest") source.clip.clear();
    check_clip(c.session.source, source.clip);
    set_options(c, std::move(source));
  });
  commands.add_edit({"source.as_scan", "Use an animated source as a scan", "on|off"}, [](Call& c) {
    SourceOptions source = c.document.source;
    source.as_scan = c.one_of(0, "switch", {"on", "off"}) == "on";
    set_options(c, std::move(source));
  });
  commands.add_edit(
      {"source.bone", "Bone of the source for a joint", "JOINT BONE|auto|none; auto: the bone found for it"},
      [](Call& c) {
        SourceOptions source = c.document.source;
        const std::string joint = c.word(0, "joint"), bone = c.word(1, "bone");
        US_CHECK(joint_named(joint) >= 0, "there is no joint '", joint, "'");
        source.bones[joint] = bone == "none" ? "" : bone;
        if (bone == "auto") source.bones.erase(joint);
        set_options(c, std::move(source));
      });
}

}  // namespace

void add_source_commands(Commands& commands) {
  add_opening(commands);
  add_times(commands);
  add_completing(commands);
  add_skeletal(commands);
  add_import(commands);
  add_blends(commands);
}

}  // namespace understudy::app
