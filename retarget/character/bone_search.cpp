#include "retarget/character/bone_search.hpp"

#include <algorithm>
#include <cmath>

namespace understudy {
namespace {

using Role = BoneRole;

constexpr float kImpossible = -100;
constexpr size_t kLimbs = 60, kWholes = 80;
constexpr int kBudget = 2000000;  // chains looked at, for rigs that are made to be slow

/// What a score is made of: what names say, and what everything else says.
struct Score {
  float names = 0, shape = 0;
  float sum() const { return names + shape; }
};

/// A penalty that grows from 0 at `free` and ends at `most`.
float penalty(float excess, float slope, float most) {
  return -std::min(most, slope * std::max(0.0f, excess));
}

/// Of a ratio that should be `usual`, free within a factor of e^`slack`.
float ratio_penalty(float ratio, float usual, float slack, float slope, float most) {
  if (!(ratio > 1e-6f)) return -most;
  return penalty(std::abs(std::log(ratio / usual)) - slack, slope, most);
}

/// The bones of a limb on one side; of a leg hip, knee, ankle, toe, of an arm collar, shoulder, elbow, wrist.
struct Limb {
  std::array<int, 4> bone = {-1, -1, -1, -1};
  Score score;
};

/// A whole body. Sides are still unknown: `leg` and `arm` are those of one of them.
struct Whole {
  Limb leg, arm;
  std::array<int, kJointCount> trunk;  // the joints on the middle alone
  Score score;
};

class Search {
 public:
  explicit Search(const BoneTree& tree) : tree_(tree) { find_pairs(); }
  FoundBones best();

 private:
  struct Step {
    int bone;
    int skipped;  // pairs between
  };
  const TreeBone& bone(int b) const { return tree_.bones[b]; }
  Vec3 at(int b) const { return bone(b).at; }
  Vec3 other(int b) const { return bone(bone(b).mirror).at; }
  Vec3 mid(int b) const { return 0.5f * (at(b) + other(b)); }
  float length(int a, int b) const { return (at(a) - at(b)).norm(); }

  void find_pairs();
  std::vector<Step> below(int b, int levels) const;
  std::vector<Step> below_or_named(int b, int levels, Role role) const;
  float named(int b, Role role) const;
  float named_pair(int b, Role role) const;
  float moves_something(int b) const;
  float moves_much(int b) const;
  float passed_over(int hip) const;
  std::vector<Limb> legs();
  std::vector<Limb> arms();
  void add_feet(int hip, int knee, const Score& so_far, std::vector<Limb>& out);
  float foot_shape(int knee, int ankle, int toe, float leg) const;
  void add_hands(int shoulder, int elbow, const Score& so_far, std::vector<Limb>& out);
  float wrist_shape(int elbow, int wrist) const;
  Limb with_collar(Limb arm) const;
  float stands(const Limb& leg, const Limb& arm) const;
  std::vector<Whole> limb_pairs();
  void add_trunk(Whole& whole) const;
  void add_pelvis(const Whole& whole, int above_legs, int junction,
                  std::vector<std::pair<int, Score>>& out) const;
  Score with_spine(int base, int top, bool neck_is_top, Whole& whole) const;
  Score with_head(int top, int neck, Whole& whole) const;
  Score head_score(const Whole& whole, int head) const;
  Score neck_of(const Whole& whole, int top, int head, int& neck) const;
  bool in_limb(const Whole& whole, int b) const;
  Vec3 forward(const Whole& whole) const;
  FoundBones answer(const std::vector<Whole>& wholes) const;
  int left_sign(const Whole& whole, bool& by_shape) const;

  const BoneTree& tree_;
  std::vector<int> first_;  // of pairs on one side: those without a pair above
  std::vector<std::vector<int>> pairs_below_;
  std::vector<int> pair_above_;  // -1 for none
  int looked_at_ = 0;
};

void Search::find_pairs() {
  const auto count = static_cast<int>(tree_.bones.size());
  pairs_below_.resize(tree_.bones.size());
  pair_above_.assign(tree_.bones.size(), -1);
  for (int b = 0; b < count; ++b) {
    const int m = bone(b).mirror;
    if (m < 0) continue;
    int above = bone(b).parent;
    while (above >= 0 && (bone(above).mirror < 0 || !tree_.is_above(bone(above).mirror, m)))
      above = bone(above).parent;
    pair_above_[b] = above;
    if (above >= 0)
      pairs_below_[above].push_back(b);
    else if (tree_.has_plane ? bone(b).across > bone(m).across : bone(b).name.side < 0)
      first_.push_back(b);
  }
}

/// Pairs in the branch of one, each with how many are between.
std::vector<Search::Step> Search::below(int b, int levels) const {
  std::vector<Step> out;
  for (const int child : pairs_below_[b]) out.push_back({child, 0});
  for (size_t i = 0; i < out.size(); ++i)
    if (out[i].skipped + 1 < levels)
      for (const int child : pairs_below_[out[i].bone]) out.push_back({child, out[i].skipped + 1});
  return out;
}

/// The same, and what its name alone says: feet and hands that are led from elsewhere hang on no limb.
std::vector<Search::Step> Search::below_or_named(int b, int levels, Role role) const {
  std::vector<Step> out = below(b, levels);
  for (const int f : first_)
    if (named_pair(f, role) >= 2 && !tree_.is_above(b, f)) out.push_back({f, -1});
  return out;
}

/// Numbers after the first speak against a bone, unless all of a limb are called alike.
float Search::named(int b, Role role) const {
  constexpr float kRank = 0.35f, kMostRanks = 3;
  const TreeBone& one = bone(b);
  const float evidence = one.name.evidence(role);
  const bool alike = one.name.what == "leg" || one.name.what == "arm" || one.name.what == "spine";
  return evidence - (alike || evidence <= 0 ? 0 : kRank * std::min(kMostRanks, one.rank));
}

float Search::named_pair(int b, Role role) const {
  return 0.5f * (named(b, role) + named(bone(b).mirror, role));
}

/// Legs and arms are more than strips of a skirt or hair.
float Search::moves_much(int b) const {
  const float share = 0.5f * (bone(b).total + bone(bone(b).mirror).total);
  return tree_.has_surface ? penalty(0.04f - share, 40, 1.5f) : 0;
}

/// A limb's bone whose branch moves nothing is a handle for the animator, or its twin has the skin.
float Search::moves_something(int b) const {
  constexpr float kNothing = -3;
  return tree_.has_surface && bone(b).total <= 0 && bone(bone(b).mirror).total <= 0 ? kNothing : 0;
}

/// A pair far above a hip has more of the leg.
float Search::passed_over(int hip) const {
  const int above = pair_above_[hip];
  return above < 0 ? 0 : penalty(length(above, hip) / tree_.size - 0.06f, 60, 3);
}

void keep_best(std::vector<Limb>& limbs, size_t most) {
  const auto better = [](const Limb& a, const Limb& b) { return a.score.sum() > b.score.sum(); };
  std::stable_sort(limbs.begin(), limbs.end(), better);
  if (limbs.size() > most) limbs.resize(most);
}

std::vector<Limb> Search::legs() {
  constexpr size_t kOfEachHip = 5;
  std::vector<Limb> all;
  std::vector<int> open = first_;
  for (size_t i = 0; i < open.size(); ++i) {
    const int hip = open[i];
    open.insert(open.end(), pairs_below_[hip].begin(), pairs_below_[hip].end());
    std::vector<Limb> limbs;
    for (const Step& step : below(hip, 6)) {
      Score score;
      score.names = named_pair(hip, Role::Hip) + named_pair(step.bone, Role::Knee);
      score.shape = -0.1f * static_cast<float>(step.skipped) + moves_something(hip) +
                    moves_something(step.bone) + moves_much(hip) + passed_over(hip);
      if (++looked_at_ < kBudget) add_feet(hip, step.bone, score, limbs);
    }
    keep_best(limbs, kOfEachHip);
    all.insert(all.end(), limbs.begin(), limbs.end());
  }
  keep_best(all, kLimbs);
  return all;
}

void Search::add_feet(int hip, int knee, const Score& so_far, std::vector<Limb>& out) {
  constexpr float kUsualLeg = 0.45f, kDetached = 1.5f, kNoToe = 0.8f;
  const float thigh = length(hip, knee);
  for (const Step& step : below_or_named(knee, 6, Role::Ankle)) {
    const int ankle = step.bone;
    const float shin = length(knee, ankle), leg = thigh + shin;
    Limb limb;
    limb.score = so_far;
    limb.score.names += named_pair(ankle, Role::Ankle);
    limb.score.shape += moves_something(ankle) + ratio_penalty(thigh / std::max(shin, 1e-9f), 1, 0.4f, 2, 3) +
                        ratio_penalty(leg / tree_.size, kUsualLeg, 0.5f, 2, 3) -
                        (step.skipped < 0 ? kDetached : 0.1f * static_cast<float>(step.skipped));
    const float bend = (at(knee) - at(hip)).dot(at(ankle) - at(knee)) / std::max(thigh * shin, 1e-9f);
    limb.score.shape += penalty(0.85f - bend, 4, 3);
    limb.bone = {hip, knee, ankle, -1};
    Limb best = limb;
    best.score.shape -= kNoToe;
    for (const Step& toe : below(ankle, 3)) {
      Limb with = limb;
      with.bone[3] = toe.bone;
      with.score.names += named_pair(toe.bone, Role::Toe);
      with.score.shape += foot_shape(knee, ankle, toe.bone, leg) - 0.4f * static_cast<float>(toe.skipped);
      if (with.score.sum() > best.score.sum()) best = with;
      ++looked_at_;
    }
    out.push_back(best);
    if (++looked_at_ > kBudget) return;
  }
}

/// Toes are before the ankle, not below the shin.
float Search::foot_shape(int knee, int ankle, int toe, float leg) const {
  const Vec3 shin = at(ankle) - at(knee), foot = at(toe) - at(ankle);
  const float straight = shin.dot(foot) / std::max(shin.norm() * foot.norm(), 1e-9f);
  return ratio_penalty(foot.norm() / std::max(leg, 1e-9f), 0.17f, 0.7f, 2, 2) +
         penalty(straight - 0.9f, 15, 1.5f) + (tree_.has_surface && bone(toe).total <= 0 ? -0.5f : 0);
}

std::vector<Limb> Search::arms() {
  constexpr size_t kOfEachShoulder = 6;
  std::vector<Limb> all;
  std::vector<int> open = first_;
  for (size_t i = 0; i < open.size(); ++i) {
    const int shoulder = open[i];
    open.insert(open.end(), pairs_below_[shoulder].begin(), pairs_below_[shoulder].end());
    std::vector<Limb> limbs;
    for (const Step& step : below(shoulder, 6)) {
      Score score;
      score.names = named_pair(shoulder, Role::Shoulder) + named_pair(step.bone, Role::Elbow);
      score.shape = -0.1f * static_cast<float>(step.skipped) + moves_something(shoulder) +
                    moves_something(step.bone) + moves_much(shoulder);
      if (++looked_at_ < kBudget) add_hands(shoulder, step.bone, score, limbs);
    }
    keep_best(limbs, kOfEachShoulder);
    for (const Limb& limb : limbs) all.push_back(with_collar(limb));
  }
  keep_best(all, kLimbs);
  return all;
}

void Search::add_hands(int shoulder, int elbow, const Score& so_far, std::vector<Limb>& out) {
  constexpr float kUsualArm = 0.3f, kDetached = 1.5f, kNoWrist = 2.5f;
  const float upper = length(shoulder, elbow);
  Limb limb;
  limb.bone = {-1, shoulder, elbow, -1};
  limb.score = so_far;
  Limb without = limb;
  without.score.shape += ratio_penalty(2 * upper / tree_.size, kUsualArm, 0.5f, 2, 3) - kNoWrist;
  out.push_back(without);
  for (const Step& step : below_or_named(elbow, 6, Role::Wrist)) {
    const int wrist = step.bone;
    const float lower = length(elbow, wrist);
    Limb with = limb;
    with.bone[3] = wrist;
    with.score.names += named_pair(wrist, Role::Wrist);
    with.score.shape += ratio_penalty(upper / std::max(lower, 1e-9f), 1.1f, 0.4f, 2, 3) +
                        ratio_penalty((upper + lower) / tree_.size, kUsualArm, 0.5f, 2, 3) +
                        wrist_shape(elbow, wrist) + moves_something(wrist) -
                        (step.skipped < 0 ? kDetached : 0.15f * static_cast<float>(step.skipped));
    const float bend = (at(elbow) - at(shoulder)).dot(at(wrist) - at(elbow)) / std::max(upper * lower, 1e-9f);
    with.score.shape += penalty(0.6f - bend, 3, 3);
    out.push_back(with);
    if (++looked_at_ > kBudget) return;
  }
}

/// Fingers part at the wrist, and a hand is about half as long as the forearm.
float Search::wrist_shape(int elbow, int wrist) const {
  constexpr size_t kFingers = 3;
  const float hand = bone(wrist).reach / std::max(length(elbow, wrist), 1e-9f);
  float score = pairs_below_[wrist].size() >= kFingers ? 1 : 0;
  for (int b = bone(wrist).parent; b > elbow && tree_.is_above(elbow, b); b = bone(b).parent)
    if (pairs_below_[b].size() >= kFingers) score -= 1.5f;  // a finger
  if (tree_.has_surface) score += penalty(0.3f - hand, 6, 1.5f);
  return score + penalty(hand - 1.1f, 3, 2);
}

/// The same arm with the collar that fits best, or none.
Limb Search::with_collar(Limb arm) const {
  constexpr float kNone = 0.8f;
  const int shoulder = arm.bone[1];
  const float upper = length(shoulder, arm.bone[2]);
  const auto off = [&](int b) { return (at(b) - mid(b)).norm(); };
  Limb best = arm;
  best.score.shape -= kNone;
  float skipped = 0;
  for (int b = bone(shoulder).parent; b >= 0 && skipped < 4; b = bone(b).parent) {
    if (bone(b).mirror < 0 || !tree_.is_above(bone(b).mirror, bone(shoulder).mirror)) continue;
    Limb with = arm;
    with.bone[0] = b;
    with.score.names += named_pair(b, Role::Collar);
    with.score.shape += ratio_penalty(length(b, shoulder) / std::max(upper, 1e-9f), 0.5f, 0.8f, 2, 2) +
                        penalty(off(b) / std::max(off(shoulder), 1e-9f) - 0.75f, 6, 2) - 0.15f * skipped;
    if (with.score.sum() > best.score.sum()) best = with;
    skipped += bone(b).name.is_helper ? 0 : 1;
  }
  return best;
}

/// A person stands: the legs under the trunk, the arms at its top, feet lowest, parts of usual lengths.
float Search::stands(const Limb& leg, const Limb& arm) const {
  const auto [hip, knee, ankle, toe] = leg.bone;
  const auto [collar, shoulder, elbow, wrist] = arm.bone;
  const Vec3 H = mid(hip), A = mid(ankle), S = mid(shoulder), up = S - H;
  const float trunk = std::max(up.norm(), 1e-9f), legs = std::max((H - A).norm(), 1e-9f);
  const float arms = length(shoulder, elbow) + (wrist < 0 ? length(shoulder, elbow) : length(elbow, wrist));
  float score = penalty(0.85f - up.dot(H - A) / (trunk * legs), 8, 9) +
                ratio_penalty(trunk / legs, 0.6f, 0.6f, 2, 3) + ratio_penalty(arms / trunk, 1, 0.5f, 2, 3);
  const Vec3 hand = wrist < 0 ? at(elbow) : at(wrist);
  score += penalty((hand - at(shoulder)).dot(up) / (trunk * arms) - 0.35f, 4, 2);  // a wing
  if (tree_.surface.rows() > 0) {
    const Eigen::Index step = 1 + tree_.surface.rows() / 500;
    float lowest = 1e30f;
    for (Eigen::Index i = 0; i < tree_.surface.rows(); i += step)
      lowest = std::min(lowest, (tree_.surface.row(i) * up).value() / trunk);
    const float height = A.dot(up) / trunk - lowest, all = H.dot(up) / trunk - lowest;
    score += penalty(height / std::max(all, 1e-9f) - 0.25f, 6, 3);
  }
  // Collars are about as far apart as hips; what begins further out is within an arm.
  const auto off = [&](int b) { return (at(b) - mid(b)).norm(); };
  if (collar >= 0) score += penalty(off(collar) / std::max(off(hip), 1e-9f) - 1.35f, 6, 4);
  // Seen from above hips and shoulders are turned alike.
  const Vec3 hips = (other(hip) - at(hip)).normalized(),
             shoulders = (other(shoulder) - at(shoulder)).normalized();
  return score + penalty(0.7f - hips.dot(shoulders), 5, 5);
}

std::vector<Whole> Search::limb_pairs() {
  const std::vector<Limb> all_legs = legs(), all_arms = arms();
  std::vector<Whole> out;
  for (const Limb& leg : all_legs)
    for (const Limb& arm : all_arms) {
      const int top = arm.bone[0] >= 0 ? arm.bone[0] : arm.bone[1];
      const bool apart = !tree_.is_above(leg.bone[0], top) && !tree_.is_above(top, leg.bone[0]) &&
                         !tree_.is_above(leg.bone[0], bone(top).mirror);
      if (!apart) continue;
      Whole whole;
      whole.leg = leg;
      whole.arm = arm;
      whole.trunk.fill(-1);
      whole.score.names = leg.score.names + arm.score.names;
      whole.score.shape = leg.score.shape + arm.score.shape + stands(leg, arm);
      out.push_back(whole);
    }
  const auto better = [](const Whole& a, const Whole& b) { return a.score.sum() > b.score.sum(); };
  std::stable_sort(out.begin(), out.end(), better);
  if (out.size() > kWholes) out.resize(kWholes);
  return out;
}

bool Search::in_limb(const Whole& whole, int b) const {
  const int top = whole.arm.bone[0] >= 0 ? whole.arm.bone[0] : whole.arm.bone[1];
  for (const int limb : {whole.leg.bone[0], bone(whole.leg.bone[0]).mirror, top, bone(top).mirror})
    if (tree_.is_above(limb, b)) return true;
  return false;
}

/// Bones on the middle from which the legs hang, or above: a bone further up that is called pelvis is it.
void Search::add_pelvis(const Whole& whole, int above_legs, int junction,
                        std::vector<std::pair<int, Score>>& out) const {
  constexpr int kLevels = 4;
  const Vec3 H = mid(whole.leg.bone[0]);
  const float leg = std::max((H - mid(whole.leg.bone[2])).norm(), 1e-9f);
  float level = 0;
  for (int b = above_legs; b >= 0 && level < kLevels; b = bone(b).parent, ++level) {
    Score score;
    score.names = named(b, Role::Pelvis);
    score.shape = (b == above_legs ? 1.8f : -0.4f * level) + penalty((at(b) - H).norm() / leg - 0.35f, 2, 2) +
                  (tree_.has_surface && bone(b).mass <= 0 ? -0.4f : 0) + (b == junction ? 0.2f : 0);
    out.emplace_back(b, score);
  }
}

/// The bones of the spine from below `base` to `top`, which has the arms, as three joints.
Score Search::with_spine(int base, int top, bool neck_is_top, Whole& whole) const {
  constexpr float kNoSpine = 2;
  std::vector<int> spine = tree_.path(base, top);
  const auto is_helper = [&](int b) { return bone(b).name.is_helper; };
  spine.erase(std::remove_if(spine.begin(), spine.end(), is_helper), spine.end());
  if (neck_is_top && !spine.empty()) spine.pop_back();
  for (const int joint : {Spine1, Spine2, Spine3}) whole.trunk[joint] = -1;
  if (spine.empty()) return {0, neck_is_top ? kImpossible : -kNoSpine};
  const int chest = spine.back();
  Score score;
  score.names = named(chest, Role::Chest);
  const Vec3 S = mid(whole.arm.bone[1]), up = S - mid(whole.leg.bone[0]);
  score.shape = penalty((at(chest) - S).dot(up) / std::max(up.squaredNorm(), 1e-12f) - 0.06f, 10, 3);
  whole.trunk[Spine3] = chest;
  spine.pop_back();
  if (!spine.empty()) whole.trunk[Spine1] = spine.front();
  if (spine.size() > 1) whole.trunk[Spine2] = spine[spine.size() / 2];
  for (const int b : spine)
    score.names += std::min(0.0f, named(b, Role::Spine)) / static_cast<float>(spine.size());
  return score;
}

/// The head is above the shoulders, on the middle; how much it moves counts in with_head().
Score Search::head_score(const Whole& whole, int head) const {
  const Vec3 S = mid(whole.arm.bone[1]), up = S - mid(whole.leg.bone[0]), d = at(head) - S;
  const float trunk = std::max(up.norm(), 1e-9f), height = d.dot(up) / (trunk * trunk);
  const float aside = (d - height * up).norm() / trunk;
  Score score;
  score.names = named(head, Role::Head);
  score.shape = penalty(0.02f - height, 15, 4) + penalty(height - 0.8f, 2, 2) + penalty(aside - 0.35f, 2, 2);
  if (tree_.has_plane) score.shape += penalty(std::abs(bone(head).across) / trunk - 0.03f, 8, 3);
  return score;
}

/// The likeliest neck between the bone with the arms and the head.
Score Search::neck_of(const Whole& whole, int top, int head, int& neck) const {
  constexpr float kNone = 2.1f, kPassedOver = 0.5f, kHeavy = 2;
  const Vec3 S = mid(whole.arm.bone[1]), up = S - mid(whole.leg.bone[0]);
  std::vector<int> path = tree_.path(top, head);
  path.pop_back();
  Score best{0, -kNone - (path.empty() ? 0 : kPassedOver)};
  neck = -1;
  for (size_t i = 0; i < path.size(); ++i) {
    const float height = (at(path[i]) - S).dot(up) / std::max(up.squaredNorm(), 1e-12f);
    Score score;
    score.names = named(path[i], Role::Neck);
    score.shape = 0.3f - 0.3f * static_cast<float>(i) + penalty(-0.2f - height, 4, 2);
    if (bone(head).mass > 0)
      score.shape += penalty(std::log(bone(path[i]).mass / bone(head).mass), kHeavy, 2);
    if (score.sum() <= best.sum()) continue;
    best = score;
    neck = path[i];
  }
  return best;
}

/// Neck and head above the bone that has the arms. neck: that bone itself, or -1.
Score Search::with_head(int top, int neck, Whole& whole) const {
  constexpr float kNone = 2, kFarOn = 0.25f, kBranch = 1.5f, kOwn = 3;
  Score best{0, -kNone};
  whole.trunk[Head] = -1;
  whole.trunk[Neck] = neck;
  float above = 0, heaviest = 0;  // of what is over the arms, as shares of the surface, or of the bones
  const auto share = [&](int b) {
    return tree_.has_surface ? bone(b).total : static_cast<float>(bone(b).end - b);
  };
  const auto own = [&](int b) {  // what it does not pass on to one bone: a head has a whole face
    float most = 0;
    for (const int child : bone(b).below) most = std::max(most, share(child));
    return share(b) - most;
  };
  for (const int child : bone(top).below)
    if (!in_limb(whole, child)) above = std::max(above, share(child));
  for (int b = top + 1; b < bone(top).end; ++b)
    if (!in_limb(whole, b)) heaviest = std::max(heaviest, own(b));
  const int arm = whole.arm.bone[1];
  for (int b = top + 1; b < bone(top).end; ++b) {
    if (in_limb(whole, b) || tree_.is_above(b, arm) || tree_.is_above(b, bone(arm).mirror)) continue;
    Score score = head_score(whole, b);
    if (above > 0 && heaviest > 0) score.shape += share(b) / above * (kBranch + kOwn * own(b) / heaviest);
    int own_neck = neck;
    if (neck < 0) {
      const Score with = neck_of(whole, top, b, own_neck);
      score.names += with.names;
      score.shape += with.shape;
    }
    const int far = bone(b).depth - bone(top).depth - (neck < 0 ? 2 : 1);
    score.shape -= kFarOn * static_cast<float>(std::max(0, far));
    if (score.sum() <= best.sum()) continue;
    best = score;
    whole.trunk[Head] = b;
    whole.trunk[Neck] = own_neck;
  }
  if (neck < 0) return best;
  const Vec3 S = mid(whole.arm.bone[1]), up = S - mid(whole.leg.bone[0]);
  best.names += named(neck, Role::Neck);
  best.shape += penalty(-0.08f - (at(neck) - S).dot(up) / std::max(up.squaredNorm(), 1e-12f), 30, 5);
  return best;
}

/// The best pelvis, spine, neck and head for these limbs.
void Search::add_trunk(Whole& whole) const {
  const int hip = whole.leg.bone[0],
            top_bone = whole.arm.bone[0] >= 0 ? whole.arm.bone[0] : whole.arm.bone[1];
  const int above_legs = tree_.common(bone(hip).parent, bone(bone(hip).mirror).parent);
  const int chest = tree_.common(bone(top_bone).parent, bone(bone(top_bone).mirror).parent);
  const int junction = tree_.common(above_legs, chest);
  std::vector<std::pair<int, Score>> pelves;
  add_pelvis(whole, above_legs, junction, pelves);
  const Score limbs = whole.score;
  whole.score.shape = kImpossible;
  if (junction < 0) return;
  for (const auto& [pelvis, pelvis_score] : pelves)
    for (const bool neck_is_top : {false, true}) {
      Whole one = whole;
      one.trunk[Pelvis] = pelvis;
      const int base = tree_.is_above(pelvis, chest) ? pelvis : junction;
      const Score spine = with_spine(base, chest, neck_is_top, one);
      const Score head = with_head(chest, neck_is_top ? chest : -1, one);
      one.score.names = limbs.names + pelvis_score.names + spine.names + head.names;
      one.score.shape = limbs.shape + pelvis_score.shape + spine.shape + head.shape;
      if (chest == pelvis && neck_is_top) continue;
      if (one.score.sum() > whole.score.sum()) whole = one;
    }
}

/// Where the body looks, by its feet; its length against the leg's says how sure that is.
Vec3 Search::forward(const Whole& whole) const {
  const auto [hip, knee, ankle, toe] = whole.leg.bone;
  const Vec3 up = (mid(whole.arm.bone[1]) - mid(hip)).normalized();
  const Vec3 side = (at(hip) - other(hip)).normalized();
  const int m = bone(ankle).mirror;
  Vec3 foot = bone(ankle).middle + bone(m).middle - at(ankle) - other(ankle);
  if (toe >= 0) foot = at(toe) + other(toe) - at(ankle) - other(ankle);
  foot -= up * up.dot(foot);
  foot -= side * side.dot(foot);
  return 0.5f * foot / std::max((mid(hip) - mid(ankle)).norm(), 1e-9f);
}

/// 1 where the limbs of a Whole are the left ones, else -1.
int Search::left_sign(const Whole& whole, bool& by_shape) const {
  constexpr float kClear = 0.035f, kStands = -6;
  float words = 0;
  for (const Limb* limb : {&whole.leg, &whole.arm})
    for (const int b : limb->bone)
      if (b >= 0) words += static_cast<float>(bone(bone(b).mirror).name.side - bone(b).name.side);
  const Vec3 ahead = forward(whole), up = mid(whole.arm.bone[1]) - mid(whole.leg.bone[0]);
  const Vec3 side = at(whole.leg.bone[0]) - other(whole.leg.bone[0]);
  const float seen = up.cross(ahead).dot(side);  // up x forward points to the left
  const bool clear = ahead.norm() > kClear && whole.score.shape > kStands;
  by_shape = clear && words * seen < 0;
  if (clear || words == 0) return seen < 0 ? -1 : 1;
  return words < 0 ? -1 : 1;
}

FoundBones Search::answer(const std::vector<Whole>& wholes) const {
  constexpr std::array<std::array<int, 4>, 2> kLimbJoints = {
      {{LeftHip, LeftKnee, LeftAnkle, LeftFoot}, {LeftCollar, LeftShoulder, LeftElbow, LeftWrist}}};
  FoundBones out;
  out.bone.fill(-1);
  out.evidence.fill(0);
  out.margin.fill(-kImpossible);
  const auto best = std::max_element(wholes.begin(), wholes.end(), [](const Whole& a, const Whole& b) {
    return a.score.sum() < b.score.sum();
  });
  if (best == wholes.end() || best->score.sum() <= kImpossible / 2) return out;
  out.found = true;
  out.shape = best->score.shape;
  const int sign = left_sign(*best, out.sides_by_shape);
  for (const int joint : {Pelvis, Spine1, Spine2, Spine3, Neck, Head}) {
    out.bone[joint] = best->trunk[joint];
    if (out.bone[joint] >= 0) out.evidence[joint] = named(out.bone[joint], role_of(joint));
    for (const Whole& whole : wholes)
      if (whole.trunk[joint] != best->trunk[joint])
        out.margin[joint] = std::min(out.margin[joint], best->score.sum() - whole.score.sum());
  }
  for (const int arms : {0, 1})
    for (size_t i = 0; i < 4; ++i) {
      const auto limb_of = [&](const Whole& whole) { return (arms > 0 ? whole.arm : whole.leg).bone[i]; };
      const int here = limb_of(*best), joint = kLimbJoints[arms][i];
      float margin = -kImpossible;
      for (const Whole& whole : wholes)
        if (limb_of(whole) != here) margin = std::min(margin, best->score.sum() - whole.score.sum());
      for (const int right : {0, 1}) {
        const int b = here < 0 ? -1 : (sign > 0) == (right == 0) ? here : bone(here).mirror;
        out.bone[joint + right] = b;
        out.margin[joint + right] = margin;
        if (b >= 0) out.evidence[joint + right] = named(b, role_of(joint));
      }
    }
  return out;
}

FoundBones Search::best() {
  std::vector<Whole> wholes = limb_pairs();
  for (Whole& whole : wholes) add_trunk(whole);
  return answer(wholes);
}

}  // namespace

BoneRole role_of(int joint) {
  constexpr std::array<Role, kJointCount> kRoles = {
      Role::Pelvis, Role::Hip,    Role::Hip,    Role::Spine, Role::Knee,     Role::Knee,
      Role::Spine,  Role::Ankle,  Role::Ankle,  Role::Chest, Role::Toe,      Role::Toe,
      Role::Neck,   Role::Collar, Role::Collar, Role::Head,  Role::Shoulder, Role::Shoulder,
      Role::Elbow,  Role::Elbow,  Role::Wrist,  Role::Wrist};
  return kRoles[joint];
}

FoundBones search_bones(const BoneTree& tree) {
  return Search(tree).best();
}

}  // namespace understudy
