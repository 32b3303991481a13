// Finds the rig of whatever a source shows, and writes what was found.
#pragma once

#include <memory>
#include <string>

#include "app/run/report.hpp"
#include "app/run/rig_evaluation.hpp"
#include "app/run/source.hpp"
#include "retarget/discovery/discover.hpp"

namespace understudy::app {

/// Options of a source whose scans are taken as they are: nothing is known of the size of what moves, nor
/// which way is up. Units and axes that are asked for are kept.
SourceOptions as_it_is(SourceOptions options);

/// The scans of a source as discover() reads them; it stays open. A source whose length is not known is read
/// through once. name: its path; edits: of each scan. Throws Error naming it where it holds no scans.
ScanSequence scan_sequence(std::shared_ptr<Source> source, const std::string& name,
                           const ScanEdits& edits = {});

/// discover() as an evaluation calls it. keypoints: see DiscoveryOptions.
RigFinder rig_finder(std::shared_ptr<KeypointFinder> keypoints = nullptr);

/// vertices [T, V, 3], joints [T, J, 3], parents [J], weights [V, J], faces [F, 3], kinds [J] (JointKind's
/// numbers), axes [J, 3] and rest_joints [J, 3] at rest, off_m [T] (-1: not known), doubted [T], fps.
/// to_file: from the rig's coordinates to the scans' own. Throws Error when it cannot be written.
void write_found_rig(const std::string& path, const DiscoveredRig& rig, const Eigen::Matrix4d& to_file);

/// Bones, frames and how well they fit: mm, degrees, axes at rest in the rig's own coordinates; null: not
/// known.
Json to_json(const DiscoveredRig& rig);

}  // namespace understudy::app
