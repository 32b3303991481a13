// The second body: chosen, its bones matched with the first one's, its performance exported.
#include <algorithm>
#include <filesystem>

#include "app/run/rig_performance.hpp"
#include "app/session/command_sets.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/formats/scan_source.hpp"
#include "retarget/motion/read_motion.hpp"

namespace understudy::app {
namespace {

/// What can be seen of it at once. The rest is seen when it is read.
void check_body(const std::string& path) {
  std::error_code failed;
  US_CHECK(std::filesystem::exists(path, failed), path, ": there is no such file or folder");
  if (is_rig_file(path)) return;
  const bool is_folder = std::filesystem::is_directory(path, failed);
  US_CHECK(is_folder || !is_motion_file(path), path, ": is a motion, not a body that could perform");
  US_CHECK(is_folder || can_be(path, kScanFrame | kScanSequence), path,
           ": is neither a rig (.glb, .gltf), nor a scan, nor a folder of scans");
  ScanSource{path};  // throws at once when there is no frame
}

void choose_second(Call& c) {
  rig_of(c);
  const std::string path = c.path(0);
  check_body(path);
  remember_folder(c.studio, path);
  if (c.document.bones.second.path == path) return c.studio.perform_again();
  c.document.bones.second = {path, {}, c.document.bones.second.clip};
}

/// As the second body's bones are known: it has bones of its own, and is laid on the first one.
const LaidOther& matched_body(const Call& c) {
  const SecondBodyState& second = c.session.second;
  US_CHECK(!c.document.bones.second.path.empty(), "no second body performs");
  US_CHECK(second.other, second.problem.empty() ? "the second body is still being read" : second.problem);
  US_CHECK(!second.other->is_scan, file_name(c.document.bones.second.path),
           ": one scan has no bones of its own to match");
  return *second.other;
}

void match_bone(Call& c) {
  const LaidOther& other = matched_body(c);
  const understudy::Rig& first = rig_of(c).found.rig;
  ChosenMatch chosen{first.joints[bone_number(c, 0, first)].name, ""};
  const std::string& word = c.word(1, "bone of the second");
  const bool found_again = word == "auto";
  if (!found_again && word != "none") {
    const size_t k = bone_number(c, 1, other.body.rig);
    chosen.partner = other.body.rig.joints[k].name;
    US_CHECK(!chosen.partner.empty() && bone_named(other.body.rig, chosen.partner) == static_cast<int>(k),
             file_name(c.document.bones.second.path), ": bone ", k, " has no name of its own to keep it by");
  }
  auto& matches = c.document.bones.second.matches;
  const auto gives_way = [&](const ChosenMatch& o) {
    return o.bone == chosen.bone || (!chosen.partner.empty() && o.partner == chosen.partner);
  };
  matches.erase(std::remove_if(matches.begin(), matches.end(), gives_way), matches.end());
  if (!found_again) matches.push_back(chosen);
  check_matches(matches_of(other, first, matches), first, other.body.rig);
  c.label = "Match " + chosen.bone;
}

void perform_clip(Call& c) {
  SecondBody& second = c.document.bones.second;
  US_CHECK(!second.path.empty(), "no second body performs");
  second.clip = c.word(0, "clip") == kFoundClip ? std::string() : kept_clip(c).name;
  c.label = "Perform " + (second.clip.empty() ? "what was found" : second.clip);
}

void export_second(Call& c) {
  const auto& performed = c.session.second.performed;
  const std::string& clip = c.document.bones.second.clip;
  US_CHECK(performed, "no second body performs");
  export_rig(c, performed, {{clip.empty() ? kFoundClip : clip, performed->motion}});
}

void drop_second(Call& c) {
  US_CHECK(!c.document.bones.second.path.empty(), "no second body performs");
  c.document.bones.second = {};
}

}  // namespace

void add_second_body_commands(Commands& commands) {
  commands.add_edit({"bones.perform", "Have a second body perform it",
                     "PATH: a rig found before (.glb, .gltf), one scan, or a folder of scans"},
                    choose_second);
  commands.add_edit({"bones.match", "Match bones",
                     "BONE OTHER|none|auto: the second body's that performs it; by name or number"},
                    match_bone);
  commands.add_edit({"bones.perform_clip", "What the second body performs",
                     "CLIP|motion: one that was kept, by name or number; motion, what was found"},
                    perform_clip);
  commands.add_edit({"bones.perform_drop", "Drop the second body"}, drop_second);
  commands.add({"bones.perform_export", "Export the second body's performance",
                "PATH: .glb or .gltf; its motion alone as .bvh"},
               export_second);
}

}  // namespace understudy::app
