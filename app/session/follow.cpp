#include "app/session/follow.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "retarget/base/index.hpp"

namespace understudy::app {
namespace {

constexpr double kSmoothing = 0.25;  // standard deviation, seconds

/// What the camera of a pane follows in a frame: the pelvis, or the middle of a scan that shows no person.
std::optional<Vec3> followed(const Session& session, int pane, int frame) {
  const KeptSource* const seen = at_or_null(session.source.frames, frame);
  if (pane == 0 && session.source.no_person && seen != nullptr && seen->extent)
    return Vec3(0.5f * (seen->extent->low + seen->extent->high));
  const Joints* joints = pane_joints(session, pane, frame);
  if (joints == nullptr || !joints->row(Pelvis).allFinite()) return std::nullopt;
  return Vec3(joints->row(Pelvis));
}

}  // namespace

const Joints* pane_joints(const Session& session, int pane, int frame) {
  const size_t f = frame, k = pane - 1;
  if (frame < 0) return nullptr;
  if (pane == 0) return f < session.source.frames.size() ? &session.source.frames[f].joints : nullptr;
  return k < session.takes.size() && f < session.takes[k].joints.size() ? &session.takes[k].joints[f]
                                                                        : nullptr;
}

Vec3 spread_offset(const Session& session, int pane) {
  if (session.view.layout != Layout::Overlay) return Vec3::Zero();
  const float from_middle = static_cast<float>(pane) - 0.5f * static_cast<float>(session.takes.size());
  return {session.view.overlay.spread_m * from_middle, 0, 0};
}

float width_of(const Box& box) {
  const Vec3 sides = box.high - box.low;
  return std::max(sides.x(), 0.5f * sides.z());
}

Vec3 painted_place(const Session& session) {
  if (session.view.bone_surface != BoneSurface::Beside || !session.bones.rig) return Vec3::Zero();
  const auto box = extent_of(session.bones.rig->found.rig.surface.vertices);
  return {box ? kApart * width_of(*box) : 0, 0, 0};
}

Vec3 second_place(const Session& session) {
  return session.second.place + painted_place(session);
}

Vec3 follow_offset(const Session& session, int pane, int frame) {
  if (!session.view.follow) return Vec3::Zero();
  const double sigma = std::max(1.0, kSmoothing * session.source.fps);
  const int reach = static_cast<int>(std::ceil(2 * sigma));
  Vec3 sum = Vec3::Zero();
  float total = 0;
  for (int f = std::max(0, frame - reach); f <= frame + reach; ++f) {
    const auto place = followed(session, pane, f);
    if (!place) continue;
    const float w = static_cast<float>(std::exp(-0.5 * std::pow((f - frame) / sigma, 2.0)));
    sum += w * *place;
    total += w;
  }
  return total > 0 ? Vec3(sum.x() / total, 0, sum.z() / total) : Vec3::Zero();
}

Vec3 rest_offset(const Session& session, int pane, int frame) {
  const Target& target = *session.takes[static_cast<size_t>(pane) - 1].target;
  const Points& vertices = target.mesh.vertices;
  Vec3 offset(target.joints(Pelvis, 0), vertices.rows() > 0 ? vertices.col(1).minCoeff() : 0,
              target.joints(Pelvis, 2));
  const Joints* const now = pane_joints(session, pane, frame);
  if (!session.view.follow && now != nullptr) offset -= Vec3((*now)(Pelvis, 0), 0, (*now)(Pelvis, 2));
  return offset;
}

}  // namespace understudy::app
