#include "app/run/rig_performance.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "app/run/fields_json.hpp"
#include "app/run/rig_finder.hpp"
#include "retarget/base/clock.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/discovery/first_pose.hpp"
#include "retarget/discovery/rig_figures.hpp"
#include "retarget/discovery/rig_follower.hpp"

namespace understudy::app {
namespace {

/// Keys a second of the longest track.
double key_rate(const Character& character) {
  constexpr double kUsual = 30;
  if (character.animations.empty()) return kUsual;
  const std::vector<float>* longest = nullptr;
  for (const CharacterTrack& track : character.animations[0].tracks)
    if (!longest || track.times.size() > longest->size()) longest = &track.times;
  if (!longest || longest->size() < 2 || longest->back() <= longest->front()) return kUsual;
  return static_cast<double>(longest->size() - 1) / static_cast<double>(longest->back() - longest->front());
}

/// As read from a file.
int known_bone(const understudy::Rig& rig, const std::string& name, const std::string& path) {
  const int j = bone_named(rig, name);
  US_CHECK(j >= 0, path, ": ", rig.name, " has no bone \"", name, "\"");
  return j;
}

}  // namespace

bool is_rig_file(const std::string& path) {
  const std::string suffix = file_suffix(path);
  return suffix == ".glb" || suffix == ".gltf";
}

RiggedMotion read_rig(const std::string& path) {
  US_CHECK(is_rig_file(path), path, ": a rig that was found before is a .glb or .gltf file");
  const Character character = read_character(path);
  RiggedMotion read = from_character(character, character.animations.empty() ? -1 : 0, key_rate(character));
  if (read.rig.name.empty()) read.rig.name = path;
  return read;
}

void check_rig_path(const std::string& path) {
  US_CHECK(is_rig_file(path) || file_suffix(path) == ".bvh", path,
           ": a found rig is written as .glb, .gltf or .bvh");
}

void write_rig(const std::string& path, const RiggedMotion& performed) {
  write_rig(path, performed.rig, {{"motion", performed.motion}});
}

void write_rig(const std::string& path, const understudy::Rig& rig, const std::vector<RigClip>& clips) {
  check_rig_path(path);
  if (is_rig_file(path)) return write_gltf_character(path, to_character(rig, clips));
  US_CHECK(clips.size() == 1, path, ": a .bvh file holds one motion, not ", clips.size());
  write_rig_bvh(path, {rig, clips[0].motion});
}

FollowedScans follow_scans(const RiggedMotion& known, Source& source, const std::string& name,
                           const ScanEdits& edits, const std::function<bool(int64_t)>& going_on) {
  constexpr Eigen::Index kFewest = 30;
  FollowedScans followed;
  DiscoveredRig& rig = followed.rig;
  rig.found.rig = known.rig;
  rig.found.motion.fps = source.fps();
  RigFollower follower(known.rig);
  BoneDistances of_bones(known.rig.count());
  bool begun = false;
  while (auto frame = source.next()) {
    if (frame->usable && !edits.empty()) frame->mesh = apply(edits, frame->mesh);
    RigPose pose = rig.found.motion.poses.empty() ? rest_pose(known.rig) : rig.found.motion.poses.back();
    float off = -1;
    if (frame->usable && finite_count(frame->mesh.vertices) >= kFewest) {
      if (!begun) follower.start_from(first_pose(known, frame->mesh));
      const auto began = std::chrono::steady_clock::now();
      RigFollower::Followed now = follower.follow(frame->mesh);
      if (begun) followed.ms.push_back(ms_since(began));
      begun = true;
      of_bones.add(follower.surface().skin, now.distances);
      pose = std::move(now.pose), off = now.off_m();
    }
    rig.found.motion.poses.push_back(std::move(pose));
    rig.off_m.push_back(off);
    rig.complete = going_on(ssize(rig.off_m));
    if (!rig.complete) break;
  }
  US_CHECK(begun, name, ": no scan has ", kFewest, " points: there is nothing to lay the rig on");
  rig.doubted = doubted_frames(rig.off_m, box_diagonal(known.rig.surface.vertices));
  measure_motion(rig.found, rig.bones);
  of_bones.tell(rig.bones);
  return followed;
}

OtherBody other_body(const std::string& path, const SourceOptions& like, const DiscoveryOptions& how) {
  if (is_rig_file(path)) return {read_rig(path)};
  SourceOptions options = as_it_is(like);
  options.path = path;
  const ScanSequence scans = scan_sequence(open_source(options), path, options.edits);
  OtherBody performing;
  performing.is_scan = scans.count == 1;
  if (performing.is_scan) {
    const std::string wrong = failure_of([&] { performing.body = body_of_one_scan(scans.scan(0)); });
    US_CHECK(wrong.empty(), path, ": ", wrong);
  } else {
    performing.body = discover(scans, how).found;
  }
  performing.body.rig.name = file_name(path);
  return performing;
}

LaidOther laid_other(const RiggedMotion& first, const OtherBody& other) {
  LaidOther second{other.body, other.is_scan, lay_on(first, other.body), {}};
  if (other.is_scan)
    second.body = rig_laid_on(first, other.body, second.laid);
  else
    second.costs = bone_costs(second.laid, first, other.body);
  return second;
}

BoneMatches matches_of(const LaidOther& other, const understudy::Rig& first,
                       const std::vector<ChosenMatch>& chosen) {
  if (other.is_scan) return same_bones(first.count());
  BoneMatches matches = match_bones(other.costs, first, other.body.rig);
  const auto part = [&](size_t k) { matches.partner[k] = -1, matches.cost[k] = 0; };
  for (const ChosenMatch& match : chosen) {
    const int j = bone_named(first, match.bone), k = bone_named(other.body.rig, match.partner);
    if (j < 0 || (k < 0 && !match.partner.empty())) continue;
    if (const int now = performer_of(matches, j); now >= 0) part(static_cast<size_t>(now));
    if (k < 0) continue;
    matches.partner[static_cast<size_t>(k)] = j;
    matches.cost[static_cast<size_t>(k)] = static_cast<float>(other.costs(k, j));
  }
  return matches;
}

Json to_json(const BoneMatches& matches, const understudy::Rig& source, const understudy::Rig& target) {
  Json bones = Json::array();
  for (size_t k = 0; k < matches.partner.size(); ++k) {
    const int partner = matches.partner[k];
    Json& bone = bones.emplace_back();
    bone["bone"] = target.joints[k].name;
    bone["partner"] = partner < 0 ? Json() : Json(source.joints[static_cast<size_t>(partner)].name);
    if (partner >= 0) bone["cost"] = matches.cost[k];
  }
  return {{"source", source.name}, {"target", target.name}, {"bones", bones}};
}

BoneMatches read_matches(const std::string& path, const understudy::Rig& source,
                         const understudy::Rig& target) {
  const Json json = read_json(path);
  US_CHECK(json.is_object() && json.contains("bones") && json["bones"].is_array(), path,
           ": has no list \"bones\"");
  BoneMatches matches;
  matches.partner.assign(target.joints.size(), -1);
  matches.cost.assign(target.joints.size(), 0);
  for (const Json& bone : json["bones"]) {
    US_CHECK(bone.is_object() && bone.contains("bone") && bone["bone"].is_string(), path,
             ": a row without \"bone\"");
    if (!bone.contains("partner") || bone["partner"].is_null()) continue;
    US_CHECK(bone["partner"].is_string(), path, ": a partner is the name of a bone, or null");
    const auto at = static_cast<size_t>(known_bone(target, bone["bone"].get<std::string>(), path));
    matches.partner[at] = known_bone(source, bone["partner"].get<std::string>(), path);
    if (bone.contains("cost") && bone["cost"].is_number()) matches.cost[at] = bone["cost"].get<float>();
  }
  const std::string wrong = failure_of([&] { check_matches(matches, source, target); });
  US_CHECK(wrong.empty(), path, ": ", wrong);
  return matches;
}

}  // namespace understudy::app
