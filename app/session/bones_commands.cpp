// The source's own skeleton: found, looked at, edited, exported.
#include <algorithm>

#include "app/run/exports.hpp"
#include "app/run/rig_performance.hpp"
#include "app/session/command_sets.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/file_formats.hpp"

namespace understudy::app {
namespace {

/// Where the panel is: on the screen, not in tests and scripts without a window.
void show_panel(Studio& studio) {
  if (studio.commands().find("panel.show") != nullptr) studio.run("panel.show", {"bones", "on"});
}

int most_bones(const Call& c) {
  if (c.arguments[0] == "auto") return 0;
  const int most = c.number<int>(0, "number of bones");
  US_CHECK(most >= 1 && most <= kMostBones, "a number of bones is 1 to ", kMostBones, ", not ", most);
  return most;
}

std::vector<std::string> body_kinds() {
  return {kBodyKinds.begin(), kBodyKinds.end()};
}

/// How bones are to be looked for; what the words do not say stays as it is.
BoneSearch asked_search(const Call& c) {
  BoneSearch search = c.document.bones.search;
  if (c.arguments.empty()) return search;
  const std::string& word = c.arguments[0];
  double number = 0;
  const bool is_method = word != "auto" && !parse_number(word, number);
  search.method = (is_method ? rig_method_named(word) : rig_methods().front()).name;
  if (!is_method) search.most = most_bones(c);
  if (c.arguments.size() < 2) return check_search(search), search;
  US_CHECK(is_method && rig_method_named(word).weights, "'", word, "' is for bodies of any kind, not of a ",
           c.arguments[1], " alone");
  search.kind = c.one_of(1, "kind", body_kinds());
  return search;
}

void find_bones(Call& c) {
  const SourceOptions& source = c.document.source;
  US_CHECK(!source.path.empty(), "no scans are open whose bones could be found");
  US_CHECK(
      source.complete == 0 && !source.blend && (c.session.source.clips.empty() || c.document.source.as_scan),
      name_of(source), ": has bones already; they are found in scans");
  OwnBones bones;
  bones.wanted = true;
  bones.search = asked_search(c);
  bones.second.path = c.document.bones.second.path;
  const OwnBones& now = c.document.bones;
  if (now.wanted && same(now.search, bones.search) && now.edits.empty())
    c.studio.look_for_bones_again();
  else
    c.document.bones = std::move(bones);
  show_panel(c.studio);
}

/// By name or number.
int bone(const Call& c, size_t i) {
  return static_cast<int>(bone_number(c, i, rig_of(c).found.rig));
}

const std::string& name_of_bone(const Call& c, int joint) {
  return rig_of(c).found.rig.joints[static_cast<size_t>(joint)].name;
}

/// Those that are near none of a person's joints stay as they are.
void name_bones(Call& c) {
  rig_of(c);
  const std::vector<NearJoint> near = c.session.bones.near;
  const auto named = [](const NearJoint& one) { return one.names; };
  US_CHECK(std::any_of(near.begin(), near.end(), named), "no found bone is near a joint of a person");
  for (size_t j = 0; j < near.size(); ++j) {
    if (!near[j].names) continue;
    const std::string name = kJointNames[near[j].joint];
    if (name_of_bone(c, static_cast<int>(j)) != name)
      c.studio.edit_bones(RenameBone{static_cast<int>(j), name});
  }
}

void export_found(Call& c) {
  const DiscoveredRig& rig = rig_of(c);
  const MadeMotionsState& made = c.session.made_motions;
  std::vector<RigClip> clips = {{kFoundClip, rig.found.motion}};
  for (size_t i = 0; i < c.document.bones.clips.size() && is_rig_file(c.path(0)); ++i) {
    const MadeClip& clip = c.document.bones.clips[i];
    US_CHECK(i < made.clips.size() && made.clips[i], "the clip \"", clip.name, "\" is not made",
             made.problem.empty() ? " yet" : ": " + made.problem);
    clips.push_back({clip.name, made.clips[i]->motion});
  }
  export_rig(c, {c.session.bones.rig, &rig.found}, std::move(clips));
}

void add_finding(Commands& commands) {
  commands.add_edit({"bones.find", "Find its own skeleton",
                     "[MOST|auto|" + names_of(rig_methods(), "|") +
                         " KIND]: by parts so many bones at most, auto as many as the motion shows; by the "
                         "others those of a KIND: " +
                         joined_once(body_kinds())},
                    find_bones);
  commands.add_edit({"bones.drop", "Drop the found skeleton"}, [](Call& c) {
    US_CHECK(c.document.bones.wanted, "there is no found skeleton");
    c.document.bones = {};
  });
  commands.add({"bones.select", "Select bone", "BONE|none: by name or number"},
               [](Call& c) { c.session.bones.selected = c.word(0, "bone") == "none" ? -1 : bone(c, 0); });
  commands.add({"bones.export", "Export the found rig",
                "PATH: .glb or .gltf, with the clips that were kept; its motion alone as .bvh"},
               export_found);
  commands.add_edit({"bones.name_as_joints", "Name bones after a person's joints"}, name_bones);
}

void set_kind(Call& c) {
  SetJointKind edit;
  edit.joint = bone(c, 0);
  edit.kind = c.choice<JointKind>(1, "kind", kJointKindNames);
  if (c.arguments.size() > 2) edit.axis = c.vector(2, "axis");
  c.label = name_of_bone(c, edit.joint) + ": " + kJointKindNames[static_cast<size_t>(edit.kind)];
  c.studio.edit_bones(edit);
}

void split_bone(Call& c) {
  SplitBone edit;
  edit.joint = bone(c, 0);
  edit.at = c.arguments.size() > 1 ? c.vector(1, "place") : middle_of_bone(rig_of(c).found.rig, edit.joint);
  c.label = "Split " + name_of_bone(c, edit.joint);
  c.studio.edit_bones(edit);
}

void paint_bone(Call& c) {
  PaintBone edit;
  edit.joint = bone(c, 0);
  edit.radius_m = c.number(1, "radius");
  edit.strength = c.number(2, "strength");
  edit.mode = c.choice<BrushMode>(3, "mode", kBrushModeNames);
  for (size_t i = 4; i < c.arguments.size(); i += 3) edit.at.push_back(c.vector(i, "place"));
  c.label = "Paint weights of " + name_of_bone(c, edit.joint);
  c.studio.edit_bones(edit);
}

void add_tree_edits(Commands& commands) {
  commands.add_edit({"bones.merge", "Merge bone", "BONE: becomes one with what it hangs on"}, [](Call& c) {
    const int joint = bone(c, 0);
    c.label = "Merge " + name_of_bone(c, joint);
    c.studio.edit_bones(MergeBone{joint});
  });
  commands.add_edit({"bones.split", "Split bone", "BONE [X Y Z]: at rest, metres; else in its middle"},
                    split_bone);
  commands.add_edit({"bones.rename", "Rename bone", "BONE NAME"}, [](Call& c) {
    const int joint = bone(c, 0);
    c.studio.edit_bones(RenameBone{joint, c.word(1, "name")});
  });
  commands.add_edit({"bones.kind", "Kind of joint", "BONE ball|hinge|slider|fixed [AXIS: X Y Z, at rest]"},
                    set_kind);
  commands.add_edit({"bones.root", "Make bone the root", "BONE"}, [](Call& c) {
    const int joint = bone(c, 0);
    c.label = "Root at " + name_of_bone(c, joint);
    c.studio.edit_bones(RootAt{joint});
  });
  commands.add_edit({"bones.move", "Move joint", "BONE X Y Z: at rest, metres"}, [](Call& c) {
    const int joint = bone(c, 0);
    c.label = "Move " + name_of_bone(c, joint);
    c.studio.edit_bones(MoveJoint{joint, c.vector(1, "place")});
  });
  commands.add_edit({"bones.paint", "Paint weights",
                     "BONE RADIUS STRENGTH add|subtract|smooth X Y Z...: a stroke over these places at rest"},
                    paint_bone);
}

void turn_bone(Call& c) {
  TurnBone edit;
  edit.joint = bone(c, 0);
  edit.frame = frame_of_rig(rig_of(c), c.number<int>(1, "frame"));
  US_CHECK(edit.frame >= 0, "the found rig has no frame ", c.word(1, "frame"));
  edit.axis_angle = c.vector(2, "rotation");
  edit.falloff = c.arguments.size() > 5 ? c.number<int>(5, "falloff") : c.session.falloff;
  c.label = "Turn " + name_of_bone(c, edit.joint);
  c.studio.edit_bones(edit);
}

void smooth_bones(Call& c) {
  SmoothBones edit;
  edit.strength = c.number(0, "strength");
  edit.last = static_cast<int>(ssize(rig_of(c).found.motion.poses)) - 1;
  if (c.arguments.size() > 1 && c.arguments[1] != "all") edit.joint = bone(c, 1);
  if (c.arguments.size() > 3) {
    edit.first = c.number<int>(2, "first frame") - rig_of(c).first_frame;
    edit.last = c.number<int>(3, "last frame") - rig_of(c).first_frame;
  }
  c.studio.edit_bones(edit);
}

void add_motion_edits(Commands& commands) {
  commands.add_edit({"bones.turn", "Turn bone", "BONE FRAME X Y Z [FALLOFF]: radians about its own axes"},
                    turn_bone);
  commands.add_edit({"bones.smooth", "Smooth bones", "STRENGTH [BONE|all [FIRST LAST]]"}, smooth_bones);
  commands.add_edit({"bones.trim", "Trim the found rig", "FIRST LAST: the frames that stay"}, [](Call& c) {
    const int before = rig_of(c).first_frame;
    c.studio.edit_bones(
        KeepFrames{c.number<int>(0, "first frame") - before, c.number<int>(1, "last frame") - before});
  });
  commands.add_edit({"bones.fit", "Fit the bones again", "to the scans"},
                    [](Call& c) { c.studio.edit_bones(FitAgain{}); });
}

}  // namespace

void add_bones_commands(Commands& commands) {
  add_finding(commands);
  add_tree_edits(commands);
  add_motion_edits(commands);
  commands.add(
      {"view.bone_surface", "Surface by bone",
       "off|over|beside: what was found, painted by bone, in place of the scan or beside it"},
      [](Call& c) { c.session.view.bone_surface = c.choice<BoneSurface>(0, "place", kBoneSurfaceNames); });
}

const DiscoveredRig& rig_of(const Call& c) {
  US_CHECK(c.session.bones.rig, "no bones have been found yet");
  return *c.session.bones.rig;
}

size_t bone_number(const Call& c, size_t i, const understudy::Rig& rig) {
  const std::string& word = c.word(i, "bone");
  if (const int named = bone_named(rig, word); named >= 0) return static_cast<size_t>(named);
  int64_t number = 0;
  US_CHECK(parse_integer(word, number) && number >= 0 && number < rig.count(), "there is no bone '", word,
           "'");
  return static_cast<size_t>(number);
}

void export_rig(Call& c, const std::shared_ptr<const RiggedMotion>& rig, std::vector<RigClip> clips) {
  const std::string path = c.path(0);
  check_rig_path(path);
  check_not_read(path, files_read_by(c.document));
  check_writable(path);
  c.studio.jobs().start(
      "Exporting " + file_name(path),
      [path, rig, clips = std::move(clips)](JobControl&) { write_rig(path, rig->rig, clips); },
      [&studio = c.studio, path] { studio.notify("Exported " + file_name(path), false, showing(path)); });
  remember_folder(c.studio, path);
}

}  // namespace understudy::app
