// Rigs that were found before: read again, followed through new scans, and performing what another one did.
#pragma once

#include <string>
#include <vector>

#include "app/run/report.hpp"
#include "app/run/source.hpp"
#include "retarget/character/rig_character.hpp"
#include "retarget/discovery/discover.hpp"
#include "retarget/discovery/rig_retarget.hpp"

namespace understudy::app {

/// Whether a path is that of a rigged character: .glb or .gltf.
bool is_rig_file(const std::string& path);
/// A rig and its motion, as often a second as its file has keys; a file without a motion is one pose. Throws
/// Error naming the file.
RiggedMotion read_rig(const std::string& path);

/// Throws Error naming a path that a rig is not written to: .glb, .gltf, or its motion alone as .bvh.
void check_rig_path(const std::string& path);
/// By the suffix. Throws Error when it cannot be written.
void write_rig(const std::string& path, const RiggedMotion& performed);
/// The same with several motions; as .bvh one alone.
void write_rig(const std::string& path, const understudy::Rig& rig, const std::vector<RigClip>& clips);

/// A rig laid on scans one after the other, each as it comes.
struct FollowedScans {
  DiscoveredRig rig;       ///< what was known, with a pose a scan
  std::vector<double> ms;  ///< of each scan that could be used, but the first, which is searched
};
/// Looks only back. name: the source's path; edits: of each scan. going_on: called after each with the number
/// done, false ends it. Throws Error naming the source where no scan can be used.
FollowedScans follow_scans(const RiggedMotion& known, Source& source, const std::string& name,
                           const ScanEdits& edits, const std::function<bool(int64_t)>& going_on);

/// A body that shall perform.
struct OtherBody {
  RiggedMotion body;
  bool is_scan = false;  ///< one scan: it has no bones yet
};
/// A rigged character as it is, one scan, or scans in which a rig is found. `like` says how scans are read.
/// Throws Error naming what cannot be read.
OtherBody other_body(const std::string& path, const SourceOptions& like, const DiscoveryOptions& how);

/// A second body laid on the first one, whose motion it shall perform.
struct LaidOther {
  RiggedMotion body;     ///< one scan has the first one's bones by now
  bool is_scan = false;  ///< so it was one scan
  LaidBody laid;
  Eigen::MatrixXd costs;  ///< bone_costs(); of one scan nothing
};
/// Throws Error as lay_on() does.
LaidOther laid_other(const RiggedMotion& first, const OtherBody& other);

/// Those that are found (of one scan every bone itself), with the chosen ones put over them: what they take
/// from others is missing there. Choices of bones that are not there are left out. May be none at all.
BoneMatches matches_of(const LaidOther& other, const understudy::Rig& first,
                       const std::vector<ChosenMatch>& chosen = {});

/// {"bones": [{"bone": name, "partner": name or null, "cost": 0.1}, ...]}
Json to_json(const BoneMatches& matches, const understudy::Rig& source, const understudy::Rig& target);
/// Reads it again: bones of the target that it does not name have no partner. Throws Error naming the file
/// and the bone that is not there or taken twice.
BoneMatches read_matches(const std::string& path, const understudy::Rig& source,
                         const understudy::Rig& target);

}  // namespace understudy::app
