// 2D poses: the source's points put right by hand, and how a person in a picture performs them.
#include <algorithm>
#include <array>
#include <filesystem>

#include "app/run/exports.hpp"
#include "app/run/flat_performance.hpp"
#include "app/session/command_sets.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/keypoints/keypoint_layout.hpp"
#include "retarget/keypoints/keypoint_reader.hpp"

namespace understudy::app {

namespace fs = std::filesystem;

void set_flat_source(Call& c, const std::string& path) {
  SourceOptions source;
  source.path = path;
  set_source(c, source);
  c.document.flat.emplace();
}

std::optional<std::string> flat_target_file(const std::string& path) {
  constexpr std::array<const char*, 4> kPictures = {".png", ".jpg", ".jpeg", ".webp"};
  const std::string suffix = file_suffix(path);
  std::error_code failed;
  if (std::find(kPictures.begin(), kPictures.end(), suffix) != kPictures.end()) {
    const fs::path stem = fs::path(path).parent_path() / fs::path(path).stem();
    for (const char* const tail : {".json", "_keypoints.json"})
      if (const std::string poses = stem.string() + tail;
          fs::exists(poses, failed) && looks_like_keypoints(poses))
        return poses;
    return std::nullopt;
  }
  if (fs::is_directory(path, failed) || !fs::exists(path, failed))
    return only_if(looks_like_keypoints(path), path);
  const bool may_be = suffix == ".json" || suffix == ".npz" || suffix == ".npy";
  return only_if(may_be && (is_proportions_file(path) || looks_like_keypoints(path)), path);
}

void set_flat(FlatTake& take, const std::string& setting, const ArgumentReader& value) {
  ArgumentReader({setting}).one_of(0, "setting", {"engine", "place", "touches", "growth"});
  if (setting == "engine") take.engine = value.one_of(0, "engine", names_of(flat_engines()));
  if (setting == "place") take.place = value.choice<FlatPlace>(0, "place", kFlatPlaceNames);
  if (setting == "touches") take.touches = value.on(0);
  if (setting == "growth") take.growth = value.on(0);
}

void exchange_flat_sides(Call& c) {
  US_CHECK(c.document.flat, "the source is no file of 2D poses");
  auto& edits = c.document.source.point_edits;
  SidesExchange wanted;
  wanted.first = c.number<int>(0, "first frame"), wanted.last = c.number<int>(1, "last frame");
  US_CHECK(wanted.first >= 0 && wanted.last >= wanted.first, "frames ", wanted.first, " to ", wanted.last,
           " are no range");
  if (c.arguments.size() > 2) wanted.limbs = c.choice<SidesExchange::Limbs>(2, "limbs", kExchangedNames);
  const auto is_it = [&](const TrackEdit& edit) {
    const auto* const other = std::get_if<SidesExchange>(&edit);
    return other != nullptr && same(*other, wanted);
  };
  const auto found = std::find_if(edits.begin(), edits.end(), is_it);
  if (found != edits.end())
    edits.erase(found);  // twice is not at all
  else
    edits.emplace_back(wanted);
}

namespace {

SourceOptions& poses_of(Call& c) {
  US_CHECK(c.document.flat, "the source is no file of 2D poses");
  return c.document.source;
}

FlatTake& flat_of(Call& c) {
  Take& take = c.take();
  US_CHECK(take.flat, take.name, " is a character, not a person in a picture");
  return *take.flat;
}

const FlatResult& result_of(const Call& c) {
  const auto& result = c.take_state().flat;
  US_CHECK(result, c.take().name, ": is still being read");
  return *result;
}

int bone_of(const Call& c, size_t i) {
  const std::string& name = c.word(i, "bone");
  std::string all;
  for (int b = 0; b < kFlatBoneCount; ++b) {
    const FlatBone& bone = kFlatBones[static_cast<size_t>(b)];
    if (name == bone.name) return b;
    append_item(all, bone.name);
  }
  throw Error("a bone is one of " + all + ", not '" + name + "'");
}

/// The bone's choice; new ones have its length as it is now.
ChosenLength& choice_of(const Call& c, FlatTake& take, int bone) {
  const std::string name = kFlatBones[static_cast<size_t>(bone)].name;
  for (ChosenLength& one : take.lengths)
    if (one.bone == name) return one;
  take.lengths.push_back({name, result_of(c).lengths.length[bone], false});
  return take.lengths.back();
}

void forget_choice(FlatTake& take, int bone) {
  const std::string name = kFlatBones[static_cast<size_t>(bone)].name;
  auto& all = take.lengths;
  all.erase(std::remove_if(all.begin(), all.end(),
                           [&](const ChosenLength& one) { return one.bone == name && !one.locked; }),
            all.end());
}

/// A person's sides are alike: the other one follows unless it is locked.
void set_length(Call& c) {
  FlatTake& take = flat_of(c);
  const int bone = bone_of(c, 1), other = kFlatBoneMirror[static_cast<size_t>(bone)];
  const FlatBone& names = kFlatBones[static_cast<size_t>(bone)];
  const ChosenLength* const now = chosen_length(take, names.name);
  US_CHECK(now == nullptr || !now->locked, names.label, " is locked");
  c.label = std::string("Length of ") + lower_case(names.label);
  if (c.word(2, "length") == "auto") return forget_choice(take, bone), forget_choice(take, other);
  const float pixels = c.clamped(2, "length", kBonePixels.low, kBonePixels.high);
  choice_of(c, take, bone).pixels = pixels;
  ChosenLength& mirrored = choice_of(c, take, other);
  if (!mirrored.locked) mirrored.pixels = pixels;
}

void set_lock(Call& c) {
  FlatTake& take = flat_of(c);
  const int bone = bone_of(c, 1);
  const bool locks = c.on(2);
  choice_of(c, take, bone).locked = locks;
  c.label =
      std::string(locks ? "Lock " : "Unlock ") + lower_case(kFlatBones[static_cast<size_t>(bone)].label);
}

/// All that are not locked.
void scale_lengths(Call& c) {
  FlatTake& take = flat_of(c);
  const float factor = c.number(1, "factor");
  US_CHECK(factor >= 0.1f && factor <= 10, "a person is made 0.1 to 10 times as large, not ", factor);
  for (int b = 0; b < kFlatBoneCount; ++b) {
    ChosenLength& one = choice_of(c, take, b);
    if (!one.locked) one.pixels = std::clamp(one.pixels * factor, kBonePixels.low, kBonePixels.high);
  }
}

void load_lengths(Call& c) {
  FlatTake& take = flat_of(c);
  const std::string path = c.path(1);
  const Proportions lengths = read_proportions(path);
  remember_folder(c.studio, path);
  for (int b = 0; b < kFlatBoneCount; ++b) {
    ChosenLength& one = choice_of(c, take, b);
    if (!one.locked) one.pixels = std::clamp(lengths.length[b], kBonePixels.low, kBonePixels.high);
  }
}

void save_lengths(Call& c) {
  flat_of(c);
  std::string path = c.path(1);
  if (file_suffix(path) != ".json") path += ".json";
  US_CHECK(!is_one_of(path, files_read_by(c.document)), path, ": is read by this document");
  write_proportions(path, result_of(c).lengths);
  remember_folder(c.studio, path);
  c.studio.notify("Saved " + file_name(path), false, showing(path));
}

void add_proportions(Commands& commands) {
  commands.add_slider({"flat.length", "Length of a bone",
                       "TAKE BONE PIXELS|auto: of the person in the picture, the other side alike"},
                      set_length);
  commands.add_edit({"flat.lock", "Lock a bone's length", "TAKE BONE on|off"}, set_lock);
  commands.add_edit({"flat.scale", "Scale the person", "TAKE FACTOR: all lengths that are not locked"},
                    scale_lengths);
  commands.add_edit({"flat.lengths_clear", "Lengths as read", "TAKE: forgets all that were chosen"},
                    [](Call& c) { flat_of(c).lengths.clear(); });
  commands.add_edit({"flat.load_proportions", "Load proportions", "TAKE PATH"}, load_lengths);
  commands.add({"flat.save_proportions", "Save proportions", "TAKE PATH"}, save_lengths);
}

/// "" for auto. Throws Error for what is no canvas.
std::string canvas_argument(const Call& c, size_t i) {
  const std::string& text = c.word(i, "canvas");
  if (text == "auto") return "";
  parse_canvas(text);
  return text;
}

void add_manner(Commands& commands) {
  commands.add_edit({"flat.place", "Placement", "TAKE reference|source: where the result stands"},
                    [](Call& c) { set_flat(flat_of(c), "place", ArgumentReader({c.word(1, "place")})); });
  commands.add_edit({"flat.touches", "Hands keep touching", "TAKE on|off"},
                    [](Call& c) { set_flat(flat_of(c), "touches", ArgumentReader({c.word(1, "switch")})); });
  commands.add_edit({"flat.growth", "Who comes nearer grows", "TAKE on|off"},
                    [](Call& c) { set_flat(flat_of(c), "growth", ArgumentReader({c.word(1, "switch")})); });
  commands.add_edit({"flat.engine", "Engine of 2D poses", "TAKE " + names_of(flat_engines(), "|")},
                    [](Call& c) { set_flat(flat_of(c), "engine", ArgumentReader({c.word(1, "engine")})); });
  commands.add_edit({"flat.ahead", "Read proportions ahead", "on|off: off the whole file, for them alone"},
                    [](Call& c) {
                      poses_of(c);
                      c.document.flat->ahead = c.on(0);
                    });
  commands.add_slider({"flat.smoothing", "Smoothing of 2D poses", "FACTOR: 0 to 4, 1 as tuned"}, [](Call& c) {
    poses_of(c).smoothing = c.clamped(0, "factor", kFlatSmoothing.low, kFlatSmoothing.high);
  });
  commands.add_edit({"flat.canvas", "Canvas of 2D poses", "WIDTHxHEIGHT|auto"},
                    [](Call& c) { poses_of(c).canvas = canvas_argument(c, 0); });
  commands.add_edit({"flat.target_canvas", "Canvas of the target's 2D poses", "TAKE WIDTHxHEIGHT|auto"},
                    [](Call& c) { flat_of(c).canvas = canvas_argument(c, 1); });
}

int point_of(const Call& c, size_t i) {
  const std::string& name = c.word(i, "point");
  const int point = body_point_named(name);
  US_CHECK(point >= 0, "there is no point '", name, "'");
  return point;
}

/// "left wrist".
std::string words_of(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

PointDrag drag_of(const Call& c) {
  const auto& poses = c.session.flat.poses;
  US_CHECK(poses, "the source is still being read");
  PointDrag drag;
  drag.frame = c.number<int>(0, "frame");
  US_CHECK(drag.frame >= 0 && drag.frame < ssize(poses->clean), "there is no frame ", drag.frame);
  US_CHECK(!is_nobody(poses->clean[static_cast<size_t>(drag.frame)].pose), "nobody is seen in frame ",
           drag.frame);
  drag.point = point_of(c, 1);
  drag.x = c.number(2, "x"), drag.y = c.number(3, "y");
  drag.falloff = c.arguments.size() > 4 ? c.clamped(4, "falloff", 0, 1000) : c.session.falloff;
  return drag;
}

void drag_point(Call& c) {
  auto& edits = poses_of(c).point_edits;
  const PointDrag drag = drag_of(c);
  c.label = std::string("Drag ") + words_of(kBodyPointNames[static_cast<size_t>(drag.point)]);
  add_drag(drag, edits);
  c.session.flat.dragging.reset();
}

void add_by_hand(Commands& commands) {
  commands.add_slider(
      {"flat.drag", "Drag a point", "FRAME POINT X Y [FALLOFF]: to a place of the canvas, pixels"},
      drag_point);
  commands.add({"flat.dragging", "While a point is dragged", "as flat.drag, or none: shown, but no edit yet"},
               [](Call& c) {
                 poses_of(c);
                 auto& dragging = c.session.flat.dragging;
                 dragging.reset();
                 if (c.word(0, "frame") != "none") dragging = drag_of(c);
               });
  commands.add_edit({"flat.exchange", "Exchange left and right", "FIRST LAST [arms|legs|both]: frames"},
                    exchange_flat_sides);
  commands.add_edit({"flat.edit_remove", "Remove an edit of 2D poses", "NUMBER: from 0"}, [](Call& c) {
    auto& edits = poses_of(c).point_edits;
    const auto number = c.number<int>(0, "number");
    US_CHECK(number >= 0 && number < ssize(edits), "there is no edit ", number);
    edits.erase(edits.begin() + number);
  });
  commands.add_edit({"flat.edits_clear", "Points as read", "forgets all edits of the source's points"},
                    [](Call& c) { poses_of(c).point_edits.clear(); });
}

}  // namespace

void add_flat_commands(Commands& commands) {
  add_proportions(commands);
  add_manner(commands);
  add_by_hand(commands);
}

}  // namespace understudy::app
