#include "retarget/discovery/bone_matching.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/math/cheapest_pairs.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr int kLaidPoints = 1200, kRoughPoints = 250;
constexpr int kLaidPoses = 7, kHeadings = 12, kTried = 16;
constexpr uint64_t kLaidSeed = 20240614;
constexpr double kMirrorCosts = 1.2;    // a body is rather itself than its mirror image
constexpr double kHeadingCosts = 0.01;  // of its size: where nothing tells, bodies face alike
constexpr double kStrainCosts = 0.01;   // of its size, for a mean strain of 1
constexpr double kFewInCommon = 0.12;   // of two bones' surfaces: less makes no partners

/// A rig's surface in some of its poses.
class PosedShapes {
 public:
  struct Pose {
    int frame;
    ThinnedFrame surface;  // all points are spread
    ThinnedFrame rough;    // the first of them
    Points joints;
    Vec3 middle;
    float size;  // root of the mean square distance of the points from it
  };
  explicit PosedShapes(const RiggedMotion& body)
      : thin_(thinned(body.rig.surface, kLaidPoints, kLaidPoints, kLaidSeed)) {
    US_CHECK(!body.motion.poses.empty(), body.rig.name, ": a body without a pose");
    skin = weights_between(thin_.points, body.rig.surface.vertices, body.rig.skin, body.rig.count());
    const int frames = static_cast<int>(ssize(body.motion.poses)), count = std::min(kLaidPoses, frames);
    for (int i = 0; i < count; ++i) {
      const int t = i * (frames - 1) / std::max(1, count - 1);
      poses.push_back(posed(body.rig, t, bone_motions(body.rig, body.motion.poses[static_cast<size_t>(t)])));
    }
  }

  SkinWeights skin;  // of the points
  std::vector<Pose> poses;

 private:
  Pose posed(const Rig& rig, int frame, const BoneMotions& bones) const {
    const Points points = skinned(thin_.points, skin, bones);
    const Points normals = posed_normals({thin_.points, thin_.normals, skin}, bones);
    const auto few = std::min<Eigen::Index>(kRoughPoints, points.rows());
    const Vec3 middle = points.colwise().mean().transpose();
    return {
        frame,
        {points, normals, static_cast<int>(points.rows()), PointTree(points)},
        {points.topRows(few), normals.topRows(few), static_cast<int>(few), PointTree(points.topRows(few))},
        joint_places(rig, bones),
        middle,
        std::sqrt((points.rowwise() - middle.transpose()).rowwise().squaredNorm().mean())};
  }

  ThinnedFrame thin_;
};

/// A way to lay one body on the other.
struct Look {
  const PosedShapes::Pose *source, *target;
  Mat3 turn;
  double cost;  // in the target's sizes

  float scale() const { return target->size / source->size; }
  /// From the source's space to the target's.
  Points there(const Points& points) const {
    return (scale() * (points.rowwise() - source->middle.transpose()) * turn.transpose()).rowwise() +
           target->middle.transpose();
  }
  double besides() const {
    const Vec3 ahead = turn.col(2);
    return kHeadingCosts * static_cast<double>(0.5f - 0.5f * ahead.z());
  }
  double times() const { return turn.determinant() < 0 ? kMirrorCosts : 1; }
};

/// Mean distance of both surfaces, both ways; points that face another way count as some way off.
double rough_cost(const Look& look) {
  const Points here = look.there(look.source->rough.points),
               normals = look.source->rough.normals * look.turn.transpose();
  const float size = look.target->size;
  const ThinnedFrame& on = look.target->rough;
  const auto off = [&](float squared, float alike) {
    const float d = std::min(std::sqrt(squared) / size, 0.6f);
    return static_cast<double>(d + 0.1f * (1 - alike));
  };
  double sum = 0;
  for (Eigen::Index i = 0; i < here.rows(); ++i) {
    const PointTree::Near near = on.tree.nearest(here.row(i).transpose());
    sum += off(near.squared, normals.row(i).dot(on.normals.row(near.point)));
  }
  const Points back =
      ((on.points.rowwise() - look.target->middle.transpose()) * look.turn / look.scale()).rowwise() +
      look.source->middle.transpose();
  for (Eigen::Index q = 0; q < back.rows(); ++q) {
    const PointTree::Near near = look.source->rough.tree.nearest(back.row(q).transpose());
    sum += off(near.squared * look.scale() * look.scale(), normals.row(near.point).dot(on.normals.row(q)));
  }
  return (sum / static_cast<double>(here.rows() + back.rows()) + look.besides()) * look.times();
}

std::vector<Look> looks_at(const PosedShapes& source, const PosedShapes& target) {
  std::vector<Look> looks;
  for (const PosedShapes::Pose& a : source.poses)
    for (const PosedShapes::Pose& b : target.poses)
      for (const float side : {1.0f, -1.0f})
        for (int i = 0; i < kHeadings; ++i) {
          const Mat3 mirror = Vec3(side, 1, 1).asDiagonal();
          looks.push_back(
              {&a, &b, rotation_about_y(2 * kPi * static_cast<float>(i) / kHeadings) * mirror, 0});
          looks.back().cost = rough_cost(looks.back());
        }
  std::stable_sort(looks.begin(), looks.end(), [](const Look& x, const Look& y) { return x.cost < y.cost; });
  return looks;
}

/// The source's points on the target's as a look has them; rough: only the first ones, in fewer rounds.
ProportionFit fitted(const Look& look, const Rig& source, const SkinWeights& skin, bool rough) {
  const ThinnedFrame& points = rough ? look.source->rough : look.source->surface;
  PosedBody body;
  body.surface = {look.there(points.points), points.normals * look.turn.transpose(), {}};
  body.surface.skin.bones = skin.bones.topRows(points.points.rows());
  body.surface.skin.weights = skin.weights.topRows(points.points.rows());
  body.joints = look.there(look.source->joints);
  for (const RigJoint& joint : source.joints) body.parents.push_back(joint.parent);
  ProportionFitOptions options;
  options.rounds = rough ? 8 : 30;
  options.first_radius_m = 0.25f * look.target->size;
  options.last_radius_m = (rough ? 0.1f : 0.04f) * look.target->size;
  return fit_proportions(body, rough ? look.target->rough : look.target->surface, options);
}

/// Not one that a program gave by counting, which is another bone's in another rig. Keypoints are numbered as
/// their network has them, the same in all bodies of a kind.
bool tells_a_bone(const Rig& rig, int j) {
  const std::string& name = rig.joints[static_cast<size_t>(j)].name;
  const std::string word = lower_case(name.substr(0, name.find_first_of(" ._-0123456789")));
  const bool counted = word.empty() || word == "bone" || word == "joint" || word == "node";
  const bool numbers = name.find_first_not_of(" ._-0123456789", word.size()) == std::string::npos;
  const auto same = [&](const RigJoint& joint) { return joint.name == name; };
  return !(counted && numbers) && std::count_if(rig.joints.begin(), rig.joints.end(), same) == 1;
}

/// [J of the target] the source's bone of the same name, -1: none; all -1 where the trees contradict most.
std::vector<int> same_names(const Rig& source, const Rig& target) {
  std::vector<int> named(target.joints.size(), -1), believed(target.joints.size(), -1);
  for (int k = 0; k < target.count(); ++k) {
    const int j = bone_named(source, target.joints[static_cast<size_t>(k)].name);
    if (j >= 0 && tells_a_bone(target, k) && tells_a_bone(source, j)) named[static_cast<size_t>(k)] = j;
  }
  ptrdiff_t known = 0, agreeing = 0;
  for (size_t k = 0; k < named.size(); ++k) {
    if (named[k] < 0) continue;
    const int above = target.joints[k].parent, other = source.joints[static_cast<size_t>(named[k])].parent;
    const bool agrees = above < 0 || other < 0 ? above == other : named[static_cast<size_t>(above)] == other;
    if (agrees) believed[k] = named[k];
    if (above >= 0) ++known, agreeing += agrees;  // that both have a root tells nothing
  }
  if (2 * agreeing <= known) std::fill(believed.begin(), believed.end(), -1);
  return believed;
}

}  // namespace

int performer_of(const BoneMatches& matches, int bone) {
  const auto at = std::find(matches.partner.begin(), matches.partner.end(), bone);
  return bone < 0 || at == matches.partner.end() ? -1 : static_cast<int>(at - matches.partner.begin());
}

void check_matches(const BoneMatches& matches, const Rig& source, const Rig& target) {
  US_CHECK(ssize(matches.partner) == target.count() && ssize(matches.cost) == target.count(), "partners for ",
           matches.partner.size(), " bones; ", target.name, " has ", target.count());
  std::vector<char> taken(source.joints.size(), 0);
  bool any = false;
  for (const int partner : matches.partner) {
    if (partner < 0) continue;
    US_CHECK(partner < source.count(), "a partner is bone ", partner, "; ", source.name, " has ",
             source.count());
    char& is_taken = taken[static_cast<size_t>(partner)];
    US_CHECK(!is_taken, source.joints[static_cast<size_t>(partner)].name, " is the partner of two bones");
    is_taken = any = true;
  }
  US_CHECK(any, "no bone has a partner: nothing can be performed");
}

LaidBody lay_on(const RiggedMotion& source, const RiggedMotion& target) {
  const PosedShapes a(source), b(target);
  std::vector<Look> looks = looks_at(a, b);
  looks.resize(std::min<size_t>(looks.size(), kTried));
  const auto refined = [&](Look& look) {
    const ProportionFit fit = fitted(look, source.rig, a.skin, true);
    look.cost =
        (fit.off_m / static_cast<double>(look.target->size) + kStrainCosts * fit.strained + look.besides()) *
        look.times();
  };
  for (Look& look : looks) refined(look);
  const Look& best = *std::min_element(looks.begin(), looks.end(),
                                       [](const Look& x, const Look& y) { return x.cost < y.cost; });
  const ProportionFit fit = fitted(best, source.rig, a.skin, false);
  LaidBody laid;
  laid.source_frame = best.source->frame;
  laid.target_frame = best.target->frame;
  laid.turn = best.turn;
  laid.scale = best.scale();
  for (const StretchedBone& bone : fit.bones) laid.corrections.push_back(bone.R.transpose());
  laid.points = fit.points;
  laid.joints = fit.joints;
  laid.skin = a.skin;
  return laid;
}

Eigen::MatrixXd bone_costs(const LaidBody& laid, const RiggedMotion& source, const RiggedMotion& target) {
  const BoneMotions bones =
      bone_motions(target.rig, target.motion.poses[static_cast<size_t>(laid.target_frame)]);
  const ThinnedFrame thin = thinned(target.rig.surface, kLaidPoints, kLaidPoints, kLaidSeed);
  const SkinWeights own =
      weights_between(thin.points, target.rig.surface.vertices, target.rig.skin, target.rig.count());
  const RowMatrix of_target = own.dense(target.rig.count()),
                  of_source = weights_between(skinned(thin.points, own, bones), laid.points, laid.skin,
                                              source.rig.count())
                                  .dense(source.rig.count());
  Eigen::MatrixXd cost(target.rig.count(), source.rig.count());
  for (Eigen::Index k = 0; k < cost.rows(); ++k)
    for (Eigen::Index j = 0; j < cost.cols(); ++j) {
      const float common = of_target.col(k).cwiseMin(of_source.col(j)).sum(),  // points
          both = of_target.col(k).sum() + of_source.col(j).sum();
      cost(k, j) = 1 - 2 * common / std::max(1e-6f, both);
    }
  return cost;
}

BoneMatches match_bones(const Eigen::MatrixXd& costs, const Rig& source, const Rig& target) {
  const std::vector<int> named = same_names(source, target);
  Eigen::MatrixXd wanted = costs;
  for (size_t k = 0; k < named.size(); ++k)  // cheaper than all others together
    if (named[k] >= 0)
      wanted(static_cast<Eigen::Index>(k), named[k]) = -2 * static_cast<double>(costs.size());
  BoneMatches matches;
  matches.partner = cheapest_pairs(wanted);
  for (Eigen::Index k = 0; k < costs.rows(); ++k) {
    const auto at = static_cast<size_t>(k);
    int& partner = matches.partner[at];
    if (named[at] < 0 && partner >= 0 && costs(k, partner) > 1 - kFewInCommon) partner = -1;
    matches.cost.push_back(partner < 0 ? 0 : static_cast<float>(costs(k, partner)));
  }
  return matches;
}

std::vector<int> led_by(const Rig& target, const BoneMatches& matches) {
  std::vector<int> leader(target.joints.size(), -1);
  const auto parent_of = [&](int k) {
    return static_cast<size_t>(target.joints[static_cast<size_t>(k)].parent);
  };
  for (int k = 0; k < target.count(); ++k) {
    const auto at = static_cast<size_t>(k);
    if (matches.partner[at] >= 0)
      leader[at] = k;
    else if (k > 0)
      leader[at] = leader[parent_of(k)];
  }
  for (int k = target.count() - 1; k > 0; --k)  // above all that have one
    if (leader[parent_of(k)] < 0) leader[parent_of(k)] = leader[static_cast<size_t>(k)];
  for (int k = 1; k < target.count(); ++k)
    if (leader[static_cast<size_t>(k)] < 0) leader[static_cast<size_t>(k)] = leader[parent_of(k)];
  return leader;
}

}  // namespace understudy
