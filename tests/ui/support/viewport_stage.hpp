// A session made by hand: a person of tubes that walks and waves, scanned as points, performed by a target.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "app/session/frame_cache.hpp"
#include "app/session/session.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/skeleton/skinning.hpp"
#include "tests/render/content.hpp"

namespace understudy::ui {

/// Skin weights and nothing else, but for offsets of 10 mm along x everywhere.
class StageDeformer final : public Deformer {
 public:
  StageDeformer(Points rest, const Joints& joints, RowMatrix weights)
      : rest_(std::move(rest)), joints_(joints), weights_(std::move(weights)) {}
  void bind(const Points&, const Joints&) override {}
  const RowMatrix& weights() const override { return weights_; }
  std::shared_ptr<Deformer> with_weights(RowMatrix weights) const override {
    return std::make_shared<StageDeformer>(rest_, joints_, std::move(weights));
  }
  Points deform(const Pose& pose) const override {
    return linear_blend_skinning(rest_ + offsets(pose), weights_, joints_, forward_kinematics(joints_, pose));
  }
  Points offsets(const Pose&) const override {
    Points out = Points::Zero(rest_.rows(), 3);
    out.col(0).setConstant(0.01f);
    return out;
  }
  std::string name() const override { return "stage"; }

 private:
  Points rest_;
  Joints joints_;
  RowMatrix weights_;
};

/// Each vertex belongs to the joint at the root of the nearest bone.
inline RowMatrix stage_weights(const Points& vertices, const Joints& joints) {
  RowMatrix weights = RowMatrix::Zero(vertices.rows(), kJointCount);
  for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
    int best = 0;
    float least = 1e9f;
    for (int j = 1; j < kJointCount; ++j) {
      const Vec3 a = joints.row(kParents[static_cast<size_t>(j)]), b = joints.row(j);
      const Vec3 p = vertices.row(v);
      const float t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.f, 1.f);
      const float away = (p - a - t * (b - a)).norm();
      if (away < least) least = away, best = kParents[static_cast<size_t>(j)];
    }
    weights(v, best) = 1;
  }
  return weights;
}

inline Pose stage_pose(int frame) {
  Pose pose;
  pose.root = Vec3(0, 0.95f, 0.03f * static_cast<float>(frame));
  pose.local[LeftShoulder] =
      rotation_from_axis_angle({0, 0, -0.9f + 0.6f * std::sin(0.4f * static_cast<float>(frame))});
  pose.local[RightShoulder] = rotation_from_axis_angle({0, 0, 1.0f});
  pose.local[LeftHip] = rotation_from_axis_angle({0.5f * std::sin(0.3f * static_cast<float>(frame)), 0, 0});
  return pose;
}

/// Scans of the person, made on the spot.
class StageSource final : public app::Source {
 public:
  StageSource(std::shared_ptr<const Deformer> person, Mesh mesh, int frames)
      : Source(30), person_(std::move(person)), mesh_(std::move(mesh)), frames_(frames) {
    set_decision("metres", Eigen::Matrix4d::Identity());
  }
  std::optional<app::SourceFrame> next() override {
    if (at_ >= frames_) return std::nullopt;
    Mesh posed = mesh_;
    posed.vertices = person_->deform(stage_pose(static_cast<int>(at_)));
    Rng rng(7 + static_cast<uint64_t>(at_));
    app::SourceFrame frame;
    frame.mesh.vertices = sample_points(posed, 4000, rng);
    frame.number = at_++;
    return frame;
  }
  void seek(int64_t frame) override { at_ = frame; }
  std::optional<int64_t> count() const override { return frames_; }

 private:
  std::shared_ptr<const Deformer> person_;
  Mesh mesh_;
  int64_t frames_, at_ = 0;
};

struct Stage {
  explicit Stage(int frames = 24, int vertices = 3000) {
    mesh = render::make_person(vertices);
    target = std::make_shared<Target>(prepare_target(mesh, render::make_joints()));
    weights = std::make_shared<const RowMatrix>(stage_weights(mesh.vertices, target->joints));
    deformer = std::make_shared<StageDeformer>(mesh.vertices, target->joints, *weights);
    session.source.name = "dance", session.document.source.path = "dance";
    session.view.follow = false;
    for (int f = 0; f < frames; ++f) add_source_frame(f);
    cache = std::make_unique<app::FrameCache>(256, [this, frames](const app::SourceOptions&) {
      return std::make_unique<StageSource>(deformer, mesh, frames);
    });
    cache->set_source(session.document.source, {});
  }

  void add_source_frame(int f) {
    app::KeptSource frame;
    frame.joints = frame.raw = forward_kinematics(target->joints, stage_pose(f)).joints;
    frame.confidence = 0.9f;
    frame.confidence_of.setConstant(0.9f);
    frame.raw_confidence = frame.confidence_of;
    session.source.frames.push_back(frame);
  }

  /// A take that stands `aside` metres further along x than the source.
  void add_take(const std::string& name, float aside = 0) {
    app::Take take;
    take.name = name;
    session.document.takes.push_back(take);
    app::TakeState state;
    state.ready = true;
    state.target = target, state.weights = weights, state.deformer = deformer;
    state.generation = static_cast<int64_t>(session.takes.size()) + 1;
    for (size_t f = 0; f < session.source.frames.size(); ++f) {
      Pose pose = stage_pose(static_cast<int>(f));
      pose.root.x() += aside;
      state.shown.poses.push_back(pose);
      state.joints.push_back(forward_kinematics(target->joints, pose).joints);
    }
    session.takes.push_back(std::move(state));
  }

  /// A skeleton found in the source: hips, and an arm that has what is above 1.4 m. It goes along x.
  void add_found(float step_m = 0.1f) {
    auto rig = std::make_shared<DiscoveredRig>();
    understudy::Rig& found = rig->found.rig;
    found.joints = {{"hips", -1, JointKind::Free, Vec3(0, 0.9f, 0)},
                    {"arm", 0, JointKind::Ball, Vec3(0, 1.4f, 0)}};
    found.surface = mesh;
    std::vector<int> bones;
    for (Eigen::Index v = 0; v < mesh.vertices.rows(); ++v)
      bones.push_back(mesh.vertices(v, 1) > 1.4f ? 1 : 0);
    found.skin = SkinWeights::rigid(bones);
    const size_t frames = session.source.frames.size();
    for (size_t t = 0; t < frames; ++t) {
      RigPose pose = rest_pose(found);
      pose.root.x() += step_m * static_cast<float>(t);
      rig->found.motion.poses.push_back(pose);
    }
    rig->bones.resize(2), rig->off_m.assign(frames, 0.f), rig->doubted.assign(frames, false);
    session.document.bones.wanted = true;
    session.bones.rig = rig;
  }

  void show_frame(int f) {
    session.playback.live = false;
    session.playback.frame = f;
  }

  Mesh mesh;
  std::shared_ptr<const Target> target;
  std::shared_ptr<const RowMatrix> weights;
  std::shared_ptr<const Deformer> deformer;
  app::Session session;
  std::unique_ptr<app::FrameCache> cache;
};

}  // namespace understudy::ui
