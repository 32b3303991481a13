#include "retarget/metrics/hand_contact.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/math/segment.hpp"

namespace understudy {
namespace {

constexpr int kHandPoints = 200, kEvaluated = 40;

enum Region { Trunk, Skull, Thigh, Shin, UpperArm, Forearm, Hand };
struct Label {
  Region region;
  int side;  // 0 left, 1 right; 0 in the middle
};

/// A straight piece of the skeleton and what lies around it.
struct Piece {
  Vec3 a, b;
  Label label;
};

std::vector<Piece> pieces_of(const Joints& rest) {
  const auto at = [&](int j) { return Vec3(rest.row(j).transpose()); };
  std::vector<Piece> pieces;
  for (const auto& [a, b] : {std::pair(Pelvis, Spine1), {Spine1, Spine2}, {Spine2, Spine3}, {Spine3, Neck}})
    pieces.push_back({at(a), at(b), {Trunk, 0}});
  pieces.push_back({at(Head), at(Head) + 1.5f * (at(Head) - at(Neck)), {Skull, 0}});
  for (const int side : {0, 1}) {
    const Vec3 hip = at(LeftHip + side), knee = at(LeftKnee + side), ankle = at(LeftAnkle + side);
    const Vec3 shoulder = at(LeftShoulder + side), elbow = at(LeftElbow + side), wrist = at(LeftWrist + side);
    pieces.push_back({at(Pelvis), hip, {Trunk, side}});
    pieces.push_back({at(Spine3), shoulder, {Trunk, side}});
    pieces.push_back({hip + 0.2f * (knee - hip), knee, {Thigh, side}});
    pieces.push_back({knee, ankle, {Shin, side}});
    pieces.push_back({ankle, at(LeftFoot + side), {Shin, side}});
    pieces.push_back({shoulder + 0.2f * (elbow - shoulder), elbow, {UpperArm, side}});
    pieces.push_back({elbow, wrist, {Forearm, side}});
    pieces.push_back({wrist, wrist + 0.8f * (wrist - elbow), {Hand, side}});
  }
  return pieces;
}

Label label_of(const Vec3& point, const std::vector<Piece>& pieces) {
  float nearest = INFINITY;
  Label label{};
  for (const Piece& piece : pieces) {
    const float squared = from_segment(point, piece.a, piece.b).squaredNorm();
    if (squared < nearest) nearest = squared, label = piece.label;
  }
  return label;
}

/// The part that `label` is to a hand of `side`; kTouchedParts for its own arm and for shins.
TouchedPart part_for(int side, const Label& label) {
  constexpr TouchedPart kOf[] = {TouchTorso,    TouchHead,     TouchThighs,   kTouchedParts,
                                 TouchOtherArm, TouchOtherArm, TouchOtherHand};  // of each Region
  return label.region >= UpperArm && label.side == side ? kTouchedParts : kOf[label.region];
}

Faces faces_where(const Faces& faces, const std::vector<bool>& in) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index f = 0; f < faces.rows(); ++f)
    if (in[faces(f, 0)] && in[faces(f, 1)] && in[faces(f, 2)]) kept.push_back(f);
  return faces(kept, Eigen::all);
}

float squared_to_box(const Vec3& p, const Eigen::AlignedBox3f& box) {
  return box.isEmpty() ? INFINITY : box.squaredExteriorDistance(p);
}

}  // namespace

HandContact::HandContact(const Points& rest, const Faces& faces, const Joints& rest_joints) {
  US_CHECK(faces.rows() > 0, "hand contacts need a surface, not a point cloud");
  const std::vector<Piece> pieces = pieces_of(rest_joints);
  const size_t count = rest.rows();
  std::vector<Label> labels(count);
  for (size_t v = 0; v < count; ++v) labels[v] = label_of(rest.row(v).transpose(), pieces);
  for (int side = 0; side < 2; ++side) {
    const size_t s = side;
    std::vector<int> hand, arm;
    std::vector<bool> other(count);
    std::array<std::vector<bool>, kTouchedParts> in;
    in.fill(std::vector<bool>(count));
    for (size_t v = 0; v < count; ++v) {
      const Label& label = labels[v];
      const bool mine = label.side == side;
      if (mine && label.region == Hand) hand.push_back(v);
      if (mine && (label.region == Hand || label.region == Forearm)) arm.push_back(v);
      other[v] = !(mine && (label.region == Hand || label.region == Forearm || label.region == UpperArm));
      const TouchedPart part = part_for(side, label);
      if (part == kTouchedParts) continue;
      parts_[s][part].push_back(v);
      in[part][v] = true;
    }
    hands_[s] = far_apart(rest, hand, kHandPoints);
    evaluated_[s] = far_apart(rest, arm, kEvaluated);
    others_.emplace_back(rest, faces_where(faces, other));
    for (size_t p = 0; p < kTouchedParts; ++p) part_faces_[s][p] = faces_where(faces, in[p]);
  }
}

HandGaps HandContact::gaps(const Points& vertices) const {
  HandGaps result;
  for (size_t s = 0; s < 2; ++s) {
    Eigen::Matrix3Xf hand(3, hands_[s].size());
    Eigen::AlignedBox3f box;
    for (size_t i = 0; i < hands_[s].size(); ++i) {
      hand.col(i) = vertices.row(hands_[s][i]).transpose();
      box.extend(hand.col(i));
    }
    for (size_t p = 0; p < kTouchedParts; ++p) {
      float nearest = kFarGap * kFarGap;
      const auto look = [&](const Vec3& point) {
        if (squared_to_box(point, box) < nearest)
          nearest = std::min(nearest, (hand.colwise() - point).colwise().squaredNorm().minCoeff());
      };
      for (const int v : parts_[s][p]) look(vertices.row(v).transpose());
      const Faces& faces = part_faces_[s][p];
      for (Eigen::Index f = 0; f < faces.rows(); ++f)
        look((vertices.row(faces(f, 0)) + vertices.row(faces(f, 1)) + vertices.row(faces(f, 2))).transpose() /
             3);
      result[s][p] = std::sqrt(nearest);
    }
  }
  return result;
}

double HandContact::buried(const Points& vertices) const {
  int inside = 0;
  size_t evaluated = 0;
  for (size_t s = 0; s < 2; ++s) {
    std::array<Eigen::AlignedBox3f, kTouchedParts> boxes;  // outside all of them nothing can be inside
    for (size_t p = 0; p < kTouchedParts; ++p)
      for (const int v : parts_[s][p]) boxes[p].extend(vertices.row(v).transpose());
    std::vector<int> near;
    for (const int v : evaluated_[s])
      if (std::any_of(boxes.begin(), boxes.end(),
                      [&](const auto& b) { return b.contains(vertices.row(v).transpose()); }))
        near.push_back(v);
    const std::vector<bool> around = others_[s].around(vertices, vertices(near, Eigen::all));
    inside += static_cast<int>(std::count(around.begin(), around.end(), true));
    evaluated += evaluated_[s].size();
  }
  return evaluated == 0 ? 0 : static_cast<double>(inside) / static_cast<double>(evaluated);
}

void ContactsKept::add(const HandGaps& source, const HandGaps& target) {
  for (size_t s = 0; s < 2; ++s)
    for (size_t p = 0; p < kTouchedParts; ++p) {
      if (!(source[s][p] < touch_m)) continue;
      ++count_;
      kept_ += target[s][p] < touch_m;
      gap_sum_ += target[s][p];
    }
}

}  // namespace understudy
