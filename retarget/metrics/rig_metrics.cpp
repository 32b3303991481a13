#include "retarget/metrics/rig_metrics.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/geometry/surface_places.hpp"
#include "retarget/math/cheapest_pairs.hpp"
#include "retarget/math/percentile.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/metrics/surface_metrics.hpp"
#include "retarget/metrics/voxel_metrics.hpp"

namespace understudy {
namespace {

constexpr int kPartFrames = 5, kPartPoints = 2000, kTrackPoints = 2000, kSurfacePoints = 4000;
constexpr double kOffSurface = 0.02;  // of s
constexpr double kFarPair = 2 * kJointFound, kBeyondFar = 1e-3;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double share(int part, int whole, double otherwise) {
  return whole > 0 ? static_cast<double>(part) / whole : otherwise;
}

double degrees(double radians) {
  return radians * 180 / M_PI;
}

/// At most `count` rows, evenly; those that are finite.
Points even_rows(const Points& points, int count) {
  Points finite = finite_points(points);
  if (finite.rows() <= count) return finite;
  Points chosen(count, 3);
  for (int i = 0; i < count; ++i) chosen.row(i) = finite.row(i * finite.rows() / count);
  return chosen;
}

double mean_distance(const Points& from, const Points& to) {
  return (from.cast<double>() - to.cast<double>()).rowwise().norm().mean();
}

std::vector<int> largest_of_rows(const RowMatrix& rows) {
  std::vector<int> largest(rows.rows());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) rows.row(i).maxCoeff(&largest[i]);
  return largest;
}

/// Of points near a surface the bone of largest weight.
std::vector<int> labels_of(const RigTruth& body, const SurfacePlaces& places) {
  return largest_of_rows(places.of(body.weights));
}

/// The direction that turns against the parent share most, in the parent's rest; none where nothing turns.
std::optional<Vec3> principal_axis(const RigMotion& motion, int joint) {
  Mat3 spread = Mat3::Zero();
  const Mat3& first = motion.poses.front().turns[joint];
  for (const RigPose& pose : motion.poses) {
    const Vec3 turn = rotation_to_axis_angle(pose.turns[joint] * first.transpose());
    spread += turn * turn.transpose();
  }
  if (spread.trace() < 1e-6f) return {};
  return Vec3(Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors().col(2));
}

double pairs_of(double count) {
  return count * (count - 1) / 2;
}

/// How many points have each label of a (rows) and of b (columns).
Eigen::MatrixXd in_common(const std::vector<int>& a, const std::vector<int>& b) {
  US_CHECK(a.size() == b.size(), "labels of ", a.size(), " and ", b.size(), " points cannot be compared");
  const auto labels = [](const std::vector<int>& of) {
    US_CHECK(of.empty() || *std::min_element(of.begin(), of.end()) >= 0, "a label is negative");
    return of.empty() ? 0 : *std::max_element(of.begin(), of.end()) + 1;
  };
  Eigen::MatrixXd common = Eigen::MatrixXd::Zero(labels(a), labels(b));
  for (size_t i = 0; i < a.size(); ++i) common(a[i], b[i]) += 1;
  return common;
}

/// Edges of a tree as pairs of parts that have points, the lower number first.
std::vector<std::pair<int, int>> edges_between(const std::vector<int>& parents,
                                               const std::vector<int>& labels) {
  std::vector<char> seen(parents.size(), 0);
  for (const int label : labels) seen.at(label) = 1;
  std::vector<int> part(parents.size());
  std::iota(part.begin(), part.end(), 0);
  int root = 0;  // the first part that has points stands for those before it
  while (root + 1 < ssize(parents) && !seen[root]) ++root;
  std::vector<std::pair<int, int>> edges;
  for (int j = 0; j < ssize(parents); ++j) {
    const int above = parents[j] < 0 ? root : part[parents[j]];
    if (!seen[j]) part[j] = above;
    if (part[j] != above) edges.emplace_back(std::minmax(part[j], above));
  }
  return edges;
}

/// 2,000 places, evenly on a true surface as it is in a frame.
SurfacePlaces places_on(const RigTruth& truth, int frame) {
  US_CHECK(frame >= 0 && frame < truth.frames(), "frame ", frame, " is none of ", truth.frames());
  Rng rng(1);
  const SurfaceSampler sampler(truth.vertices[frame], truth.faces);
  SurfacePlaces places{Faces(kTrackPoints, 3), RowMatrix(kTrackPoints, 3)};
  for (int i = 0; i < kTrackPoints; ++i) {
    const SurfaceSampler::Sample sample = sampler.sample(rng);
    places.corners.row(i) = truth.faces.row(sample.face);
    places.share.row(i) = sample.barycentric.transpose();
  }
  return places;
}

void check_frames(const RigTruth& found, const std::vector<Mesh>& scans, const RigTruth& truth) {
  US_CHECK(found.frames() == truth.frames() && ssize(scans) == truth.frames(), "the found rig has ",
           found.frames(), " frames, the scans ", scans.size(), ", the truth ", truth.frames());
}

}  // namespace

int JointPairs::good() const {
  return static_cast<int>(std::count_if(e.begin(), e.end(), [](double x) { return x < kJointFound; }));
}

double JointPairs::recall() const {
  return share(good(), static_cast<int>(e.size()) - 1, kNaN);
}

double JointPairs::precision() const {
  return share(good(), found_count, e.size() > 1 ? 0 : kNaN);
}

double JointPairs::error_pct() const {
  std::vector<double> near;
  for (const double x : e)
    if (x < kJointFound) near.push_back(100 * x);
  return near.empty() ? kNaN : percentile(near, 50);
}

JointPairs pair_joints(const RigTruth& found, const RigTruth& truth) {
  US_CHECK(found.frames() == truth.frames(), "joints found in ", found.frames(), " frames, true ones in ",
           truth.frames());
  const double size = body_size(truth.vertices);
  Eigen::MatrixXd e = Eigen::MatrixXd::Zero(truth.count() - 1, found.count() - 1);
  for (int t = 0; t < truth.frames(); ++t)
    for (Eigen::Index j = 0; j < e.rows(); ++j)
      for (Eigen::Index k = 0; k < e.cols(); ++k)
        e(j, k) += static_cast<double>((found.joints[t].row(k + 1) - truth.joints[t].row(j + 1)).norm()) /
                   (size * truth.frames());
  JointPairs pairs{std::vector<int>(truth.count(), -1),
                   std::vector<double>(truth.count(), std::numeric_limits<double>::infinity()),
                   found.count() - 1};
  const std::vector<int> columns = cheapest_pairs(e.cwiseMin(kFarPair) + kBeyondFar * e);
  for (size_t j = 0; j < columns.size(); ++j) {
    if (columns[j] < 0) continue;
    pairs.found[j + 1] = columns[j] + 1;
    pairs.e[j + 1] = e(j, columns[j]);
  }
  return pairs;
}

double hinge_error_deg(const RiggedMotion& found, const RigTruth& truth, const JointPairs& pairs) {
  US_CHECK(ssize(found.motion.poses) == truth.frames(), "a rig found in ", found.motion.poses.size(),
           " frames, a true one of ", truth.frames());
  double sum = 0;
  int count = 0;
  for (int j = 1; j < truth.count(); ++j) {
    if (pairs.e[j] >= kJointFound || truth.axes[j].isZero()) continue;
    const RigJoint& joint = found.rig.joints[pairs.found[j]];
    const std::optional<Vec3> axis =
        joint.kind == JointKind::Hinge ? joint.axis : principal_axis(found.motion, pairs.found[j]);
    for (int t = 0; t < truth.frames(); ++t, ++count) {
      const BoneMotions bones = bone_motions(found.rig, found.motion.poses[t]);
      const Vec3 wanted = truth.bones[t][j].R * truth.axes[j].normalized();
      const Vec3 is = axis ? Vec3(bones[joint.parent].R * axis->normalized()) : Vec3::Zero();
      sum += axis ? std::atan2(static_cast<double>(is.cross(wanted).norm()),
                               static_cast<double>(std::abs(is.dot(wanted))))
                  : M_PI / 2;
    }
  }
  return count > 0 ? degrees(sum / count) : kNaN;
}

RandIndex rand_index(const std::vector<int>& a, const std::vector<int>& b) {
  US_CHECK(a.size() >= 2, "the parts of ", a.size(), " points cannot be compared");
  const Eigen::MatrixXd common = in_common(a, b);
  const double all = pairs_of(static_cast<double>(a.size())), both = common.unaryExpr(&pairs_of).sum(),
               in_a = common.rowwise().sum().unaryExpr(&pairs_of).sum(),
               in_b = common.colwise().sum().unaryExpr(&pairs_of).sum();
  const double chance = in_a * in_b / all, most = (in_a + in_b) / 2;
  return {(all + 2 * both - in_a - in_b) / all, most > chance ? (both - chance) / (most - chance) : 1};
}

PartLabels part_labels(const RigTruth& found, const RigTruth& truth, const std::vector<Mesh>& scans) {
  check_frames(found, scans, truth);
  const double reach = kOffSurface * body_size(truth.vertices);
  const int frames = std::min(kPartFrames, truth.frames());
  PartLabels labels;
  for (int i = 0; i < frames; ++i) {
    const int t = frames == 1 ? 0 : i * (truth.frames() - 1) / (frames - 1);
    const Points points = even_rows(scans[t].vertices, kPartPoints);
    const SurfacePlaces on_truth = nearest_places({truth.vertices[t], truth.faces}, points);
    const SurfacePlaces on_found = nearest_places({found.vertices[t], found.faces}, points);
    const std::vector<int> is = labels_of(found, on_found), should = labels_of(truth, on_truth);
    const Points there = on_truth.on(truth.vertices[t]);
    for (Eigen::Index p = 0; p < points.rows(); ++p) {
      if (static_cast<double>((points.row(p) - there.row(p)).norm()) > reach) continue;
      labels.found.push_back(is[p]);
      labels.truth.push_back(should[p]);
    }
  }
  return labels;
}

double tree_f1(const std::vector<int>& found_parents, const std::vector<int>& true_parents,
               const PartLabels& labels) {
  const Eigen::MatrixXd common = in_common(labels.found, labels.truth);
  std::vector<int> partner = cheapest_pairs(-common);
  for (size_t k = 0; k < partner.size(); ++k)
    if (partner[k] >= 0 && common(k, partner[k]) == 0) partner[k] = -1;
  const auto found = edges_between(found_parents, labels.found);
  const auto wanted = edges_between(true_parents, labels.truth);
  if (found.empty() && wanted.empty()) return 1;
  int right = 0;
  for (const auto& [a, b] : found) {
    if (partner.at(a) < 0 || partner.at(b) < 0) continue;
    const std::pair<int, int> edge = std::minmax(partner[a], partner[b]);
    right += std::find(wanted.begin(), wanted.end(), edge) != wanted.end();
  }
  return 2.0 * right / static_cast<double>(found.size() + wanted.size());
}

double track_error_pct(const RigTruth& found, int rest_frame, const RigTruth& truth) {
  US_CHECK(found.frames() == truth.frames(), "a surface found in ", found.frames(), " frames, a true one in ",
           truth.frames());
  const SurfacePlaces true_places = places_on(truth, rest_frame);
  const SurfacePlaces places =
      nearest_places({found.vertices[rest_frame], found.faces}, true_places.on(truth.vertices[rest_frame]));
  double sum = 0;
  for (int t = 0; t < truth.frames(); ++t)
    sum += mean_distance(places.on(found.vertices[t]), true_places.on(truth.vertices[t]));
  return 100 * sum / (truth.frames() * body_size(truth.vertices));
}

double surface_error_pct(const std::vector<Points>& vertices, const Faces& faces,
                         const std::vector<Mesh>& scans, double size) {
  US_CHECK(vertices.size() == scans.size(), "a surface in ", vertices.size(), " frames and ", scans.size(),
           " scans");
  US_CHECK(size > 0, "a size of ", size, " metres");
  double sum = 0;
  int count = 0;
  for (size_t t = 0; t < scans.size(); ++t) {
    const Mesh scan = scans[t].is_cloud() ? Mesh{finite_points(scans[t].vertices)} : scans[t];
    if (scan.vertices.rows() == 0) continue;
    const Mesh surface{vertices[t], faces};
    Rng rng(1);
    const Points of_scan =
        scan.is_cloud() ? even_rows(scan.vertices, kSurfacePoints) : sample_points(scan, kSurfacePoints, rng);
    const Points of_surface = sample_points(surface, kSurfacePoints, rng);
    sum += mean_distance(of_scan, nearest_places(surface, of_scan).on(surface.vertices)) / 2;
    sum += mean_distance(of_surface, nearest_places(scan, of_surface).on(scan.vertices)) / 2;
    ++count;
  }
  return count > 0 ? 100 * sum / (count * size) : kNaN;
}

double retarget_error_pct(const std::vector<Points>& vertices, const std::vector<Points>& truth) {
  US_CHECK(vertices.size() == truth.size(), "a performance of ", vertices.size(), " frames, a true one of ",
           truth.size());
  double sum = 0;
  for (size_t t = 0; t < truth.size(); ++t) sum += aligned_vertex_error(vertices[t], truth[t]);
  return 100 * sum / (static_cast<double>(truth.size()) * body_size(truth));
}

double performance_error_pct(const RiggedMotion& performed, const Points& found_there, const RigTruth& own,
                             int frame, const std::vector<Points>& truth) {
  US_CHECK(performed.motion.poses.size() == truth.size(), "a performance of ", performed.motion.poses.size(),
           " frames, a true one of ", truth.size());
  const understudy::Rig& rig = performed.rig;
  const SurfacePlaces true_places = places_on(own, frame);
  const SurfacePlaces places =
      nearest_places({found_there, rig.surface.faces}, true_places.on(own.vertices[frame]));
  std::vector<Points> is, wanted;
  for (size_t t = 0; t < truth.size(); ++t) {
    is.emplace_back(
        places.on(skinned(rig.surface.vertices, rig.skin, bone_motions(rig, performed.motion.poses[t]))));
    wanted.emplace_back(true_places.on(truth[t]));
  }
  return retarget_error_pct(is, wanted);
}

void SemanticConsistency::push(const Points& keypoints, const Points& joints) {
  US_CHECK(keypoints.rows() > 0 && joints.rows() > 0, "there are ", keypoints.rows(), " keypoints and ",
           joints.rows(), " joints");
  if (frames_ == 0) nearest_.setZero(joints.rows(), keypoints.rows());
  US_CHECK(nearest_.rows() == joints.rows() && nearest_.cols() == keypoints.rows(), keypoints.rows(),
           " keypoints and ", joints.rows(), " joints; before there were ", nearest_.cols(), " and ",
           nearest_.rows());
  for (Eigen::Index j = 0; j < joints.rows(); ++j) {
    Eigen::Index nearest = 0;
    (keypoints.rowwise() - joints.row(j)).rowwise().squaredNorm().minCoeff(&nearest);
    nearest_(j, nearest) += 1;
  }
  ++frames_;
}

std::vector<SemanticConsistency::Steadiest> SemanticConsistency::joints() const {
  std::vector<Steadiest> of;
  for (Eigen::Index j = 0; j < nearest_.rows(); ++j) {
    Eigen::Index keypoint = 0;
    const double frames = nearest_.row(j).maxCoeff(&keypoint);
    of.push_back({static_cast<int>(keypoint), frames / frames_});
  }
  return of;
}

double SemanticConsistency::value() const {
  return frames_ > 0 ? nearest_.rowwise().maxCoeff().mean() / frames_ : kNaN;
}

std::vector<std::pair<std::string, double>> rig_figures(const RiggedMotion& found, int rest_frame,
                                                        const std::vector<Mesh>& scans,
                                                        const RigTruth& truth) {
  const RigTruth parts = merged_truth(truth), is = truth_of(found);
  check_frames(is, scans, truth);
  const JointPairs pairs = pair_joints(is, parts);
  const PartLabels labels = part_labels(is, parts, scans);
  const bool has_labels = labels.truth.size() >= 2;
  const RandIndex rand = has_labels ? rand_index(labels.found, labels.truth) : RandIndex{kNaN, kNaN};
  SemanticConsistency sc;
  for (int t = 0; t < truth.frames(); ++t) sc.push(is.joints[t], truth.joints[t]);
  const VoxelErrors voxels = voxel_errors(is.vertices, is.faces, truth.vertices, truth.faces);
  std::vector<std::pair<std::string, double>> figures;
  const auto add = [&](const char* key, double value) {
    if (std::isfinite(value)) figures.emplace_back(key, value);
  };
  add("joint_recall", pairs.recall());
  add("joint_precision", pairs.precision());
  add("joint_error_pct", pairs.error_pct());
  add("hinge_deg", hinge_error_deg(found, parts, pairs));
  add("part_ri", rand.plain);
  add("part_ari", rand.adjusted);
  add("tree_f1", has_labels ? tree_f1(is.parents, parts.parents, labels) : kNaN);
  add("track_pct", track_error_pct(is, rest_frame, truth));
  add("surface_pct", surface_error_pct(is.vertices, is.faces, scans, body_size(truth.vertices)));
  add("sc", sc.value());
  add("sc_keypoints", is.count());
  add("cd_1e4", voxels.cd_1e4);
  add("m_cd", voxels.m_cd);
  add("true_parts", parts.count());
  add("found_parts", is.count());
  return figures;
}

}  // namespace understudy
