#include "retarget/metrics/bent_volume.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

using Edge = std::array<int, 2>;

float reach_of(const Joints& joints, int joint) {
  float shortest = (joints.row(joint) - joints.row(kParents[joint])).norm();
  for (int child = 0; child < kJointCount; ++child)
    if (kParents[child] == joint)
      shortest = std::min(shortest, (joints.row(child) - joints.row(joint)).norm());
  return 0.5f * shortest;
}

/// The bones between pelvis and hip, or chest and shoulder, do not show how thick it is there.
float reach_about(const Joints& joints, int joint) {
  const bool at_trunk =
      joint == LeftHip || joint == RightHip || joint == LeftShoulder || joint == RightShoulder;
  if (!at_trunk) return reach_of(joints, joint);
  const auto child = std::find(kParents.begin(), kParents.end(), joint) - kParents.begin();
  return 0.5f * (joints.row(child) - joints.row(joint)).norm();
}

Faces faces_about(const Points& rest, const Faces& faces, const Joints& joints, int joint) {
  const float reach = reach_about(joints, joint), side = joints(joint, 0) > joints(Pelvis, 0) ? 1.0f : -1.0f;
  std::vector<Eigen::Index> near;
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    bool whole = true;
    for (int k = 0; k < 3; ++k) {
      const auto x = rest.row(faces(f, k));
      whole = whole && (x - joints.row(joint)).norm() < reach && side * (x[0] - joints(Pelvis, 0)) > 0;
    }
    if (whole) near.push_back(f);
  }
  return faces(near, Eigen::all);
}

/// Edges that only one face has, turned round and put into rings.
std::vector<std::vector<Edge>> cuts_of(const Faces& faces) {
  std::set<Edge> edges;
  for (Eigen::Index f = 0; f < faces.rows(); ++f)
    for (int k = 0; k < 3; ++k) edges.insert({faces(f, k), faces(f, (k + 1) % 3)});
  std::multimap<int, int> next;
  for (const auto& [from, to] : edges)
    if (!edges.count({to, from})) next.emplace(to, from);
  std::vector<std::vector<Edge>> rings;
  while (!next.empty()) {
    rings.emplace_back();
    for (auto at = next.begin(); at != next.end();) {
      const int to = at->second;
      rings.back().push_back({at->first, to});
      next.erase(at);
      at = next.find(to);
    }
  }
  return rings;
}

double six_volumes(const Vec3& a, const Vec3& b, const Vec3& c) {
  return static_cast<double>(a.cross(b).dot(c));
}

}  // namespace

double BentVolume::volume(const Piece& piece, const Points& vertices) {
  if (piece.faces.rows() == 0) return 0;
  const Vec3 origin = vertices.row(piece.faces(0, 0));
  const auto at = [&](int v) -> Vec3 { return vertices.row(v).transpose() - origin; };
  double sum = 0;
  for (Eigen::Index f = 0; f < piece.faces.rows(); ++f)
    sum += six_volumes(at(piece.faces(f, 0)), at(piece.faces(f, 1)), at(piece.faces(f, 2)));
  for (const auto& cut : piece.cuts) {
    Vec3 middle = Vec3::Zero();
    for (const Edge& edge : cut) middle += at(edge[0]) / static_cast<float>(cut.size());
    for (const Edge& edge : cut) sum += six_volumes(at(edge[0]), at(edge[1]), middle);
  }
  return sum / 6;
}

BentVolume::BentVolume(const Points& rest, const Faces& faces, const Joints& joints) {
  US_CHECK(faces.rows() > 0, "volume needs a surface, not a point cloud");
  for (size_t b = 0; b < kBends.size(); ++b) {
    pieces_[b].faces = faces_about(rest, faces, joints, kBends[b]);
    pieces_[b].cuts = cuts_of(pieces_[b].faces);
    pieces_[b].rest = volume(pieces_[b], rest);
  }
}

double BentVolume::kept(size_t bend, const Points& vertices) const {
  const Piece& piece = pieces_[bend];
  return piece.rest > 1e-9 ? volume(piece, vertices) / piece.rest : std::nan("");
}

}  // namespace understudy
