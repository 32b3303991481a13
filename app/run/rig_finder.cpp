#include "app/run/rig_finder.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/formats/npz_writer.hpp"

namespace understudy::app {
namespace {

std::vector<double> flat(const Points& rows) {
  return {rows.data(), rows.data() + rows.size()};
}

/// Rows of points after a 4 x 4 transform.
Points transformed(const Points& points, const Eigen::Matrix4d& by) {
  const Mat3 linear = by.topLeftCorner<3, 3>().cast<float>();
  const Eigen::RowVector3f shift = by.topRightCorner<3, 1>().transpose().cast<float>();
  return (points * linear.transpose()).rowwise() + shift;
}

int length_of(Source& source) {
  if (const auto count = source.count())
    return static_cast<int>(std::min<int64_t>(*count, kFrameNumbers.high));
  int count = 0;
  while (source.next()) ++count;
  source.seek(0);
  return count;
}

}  // namespace

SourceOptions as_it_is(SourceOptions options) {
  const auto guessed = [](const std::string& asked) { return asked.empty() || asked == "auto"; };
  if (guessed(options.import.units)) options.import.units = "m";
  if (guessed(options.import.up)) options.import.up = "y";
  if (!options.import.floor) options.import.floor = 0.0f;
  return options;
}

ScanSequence scan_sequence(std::shared_ptr<Source> source, const std::string& name, const ScanEdits& edits) {
  ScanSequence scans;
  scans.name = name;
  const auto first = source->next();
  US_CHECK(!first || !first->skeleton, name,
           ": a skeletal motion has its bones already: a skeleton is found in scans");
  source->seek(0);
  scans.count = length_of(*source);
  scans.fps = source->fps();
  int next = 0;  // that the source hands out
  scans.scan = [source = std::move(source), edits, next](int frame) mutable {
    if (frame != next) source->seek(frame);
    next = frame + 1;
    const auto read = source->next();
    if (!read || !read->usable) return Mesh{};
    return edits.empty() ? read->mesh : apply(edits, read->mesh);
  };
  return scans;
}

RigFinder rig_finder(std::shared_ptr<KeypointFinder> keypoints) {
  return [keypoints = std::move(keypoints)](const std::vector<Mesh>& frames, double fps) {
    ScanSequence scans;
    scans.count = ssize(frames);
    scans.fps = fps;
    scans.scan = [&frames](int frame) { return frames[static_cast<size_t>(frame)]; };
    DiscoveryOptions options;
    options.keypoints = keypoints;
    DiscoveredRig rig = discover(scans, options);
    return FoundRig{std::move(rig.found), rig.rest_frame};
  };
}

void write_found_rig(const std::string& path, const DiscoveredRig& rig, const Eigen::Matrix4d& to_file) {
  const understudy::Rig& found = rig.found.rig;
  const int64_t vertices = found.surface.vertices.rows(), joints = found.count();
  NpzWriter npz(path);
  const size_t surface = npz.add_frames("vertices", {vertices, 3}),
               places = npz.add_frames("joints", {joints, 3});
  for (const RigPose& pose : rig.found.motion.poses) {
    const BoneMotions bones = bone_motions(found, pose);
    npz.push(surface, transformed(skinned(found.surface.vertices, found.skin, bones), to_file).data());
    npz.push(places, transformed(joint_places(found, bones), to_file).data());
  }
  std::vector<double> parents, kinds, axes, off, doubted;
  const Mat3 axes_to_file = to_file.topLeftCorner<3, 3>().cast<float>();
  for (const RigJoint& joint : found.joints) {
    parents.push_back(joint.parent);
    kinds.push_back(static_cast<int>(joint.kind));
    const Vec3 axis = (axes_to_file * joint.axis).normalized();
    axes.insert(axes.end(), axis.data(), axis.data() + 3);
  }
  off.assign(rig.off_m.begin(), rig.off_m.end());
  doubted.assign(rig.doubted.begin(), rig.doubted.end());
  const RowMatrix weights = found.skin.dense(found.count());
  npz.add("parents", {joints}, parents);
  npz.add("weights", {vertices, joints}, {weights.data(), weights.data() + weights.size()});
  npz.add("faces", {found.surface.faces.rows(), 3},
          {found.surface.faces.data(), found.surface.faces.data() + found.surface.faces.size()});
  npz.add("kinds", {joints}, kinds);
  npz.add("axes", {joints, 3}, axes);
  npz.add("rest_joints", {joints, 3}, flat(transformed(found.rest_joints(), to_file)));
  npz.add("off_m", {ssize(off)}, off);
  npz.add("doubted", {ssize(doubted)}, doubted);
  npz.add("fps", {}, {rig.found.motion.fps});
  npz.finish();
}

Json to_json(const DiscoveredRig& rig) {
  Json report;
  const understudy::Rig& found = rig.found.rig;
  report["frames"] = rig.found.motion.poses.size();
  report["fps"] = rig.found.motion.fps;
  report["rest_frame"] = rig.rest_frame;
  report["key_frames"] = rig.key_frames.size();
  report["complete"] = rig.complete;
  report["bones"] = Json::array();
  for (size_t j = 0; j < found.joints.size(); ++j) {
    const RigJoint& joint = found.joints[j];
    Json bone = {{"name", joint.name},
                 {"parent", joint.parent},
                 {"kind", kJointKindNames[static_cast<size_t>(joint.kind)]},
                 {"turned_deg", rig.bones[j].turned_deg}};
    const float seen = rig.bones[j].seen_share, off = rig.bones[j].off_m;
    bone["off_mm"] = off < 0 ? Json() : Json(1000 * off);
    bone["seen_share"] = seen < 0 ? Json() : Json(seen);
    if (joint.kind == JointKind::Hinge || joint.kind == JointKind::Slider)
      bone["axis"] = {joint.axis.x(), joint.axis.y(), joint.axis.z()};
    if (joint.kind == JointKind::Slider) bone["slid_mm"] = 1000 * rig.bones[j].slid_m;
    report["bones"].push_back(bone);
  }
  report["off_mm"] = Json::array();
  report["doubted"] = Json::array();
  for (size_t t = 0; t < rig.off_m.size(); ++t) {
    report["off_mm"].push_back(rig.off_m[t] < 0 ? Json() : Json(1000 * rig.off_m[t]));
    if (rig.doubted[t]) report["doubted"].push_back(t);
  }
  return report;
}

}  // namespace understudy::app
