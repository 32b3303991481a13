#include "retarget/training/hybrid_windows.hpp"

#include <torch/torch.h>

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/training/checkpoint_archive.hpp"

namespace understudy::training {
namespace {

constexpr float kClipRate = 30;  // frames/s
constexpr int64_t kVersion = 2;
// A joint of a frame in the file: place seen, confidence, rotation seen (6D), true place, true rotation (6D).
constexpr int64_t kNumbers = 3 + 1 + 6 + 3 + 6;

Pose pose_between(const Pose& a, const Pose& b, float w) {
  Pose pose;
  for (int j = 0; j < kJointCount; ++j)
    pose.local[j] =
        Eigen::Quaternionf(a.local[j]).slerp(w, Eigen::Quaternionf(b.local[j])).toRotationMatrix();
  pose.root = (1 - w) * a.root + w * b.root;
  return pose;
}

torch::Tensor to_tensor(const std::vector<HybridWindow>& windows, int frames) {
  auto all = torch::empty({static_cast<int64_t>(windows.size()), frames, kJointCount, kNumbers});
  float* at = all.data_ptr<float>();
  for (const HybridWindow& window : windows)
    for (size_t t = 0; t < window.seen.size(); ++t)
      for (int j = 0; j < kJointCount; ++j) {
        const auto put = [&at](const auto& values) {
          for (Eigen::Index i = 0; i < values.size(); ++i) *at++ = values[i];
        };
        put(Vec3(window.seen[t].joints.row(j).transpose()));
        *at++ = window.seen[t].confidence[j];
        put(rotation_to_6d((*window.seen[t].global)[j]));
        put(Vec3(window.truth[t].joints.row(j).transpose()));
        put(rotation_to_6d(window.truth[t].global[j]));
      }
  return all;
}

torch::Tensor intervals(const std::vector<HybridWindow>& windows) {
  auto all = torch::empty({static_cast<int64_t>(windows.size())});
  for (size_t i = 0; i < windows.size(); ++i) all.data_ptr<float>()[i] = windows[i].dt;
  return all;
}

std::vector<HybridWindow> to_windows(const torch::Tensor& all, const torch::Tensor& dt,
                                     const std::string& path) {
  US_CHECK(all.dim() == 4 && all.size(2) == kJointCount && all.size(3) == kNumbers && all.size(1) > 1 &&
               dt.dim() == 1 && dt.size(0) == all.size(0) && all.scalar_type() == torch::kFloat32 &&
               dt.scalar_type() == torch::kFloat32 && torch::isfinite(all).all().item<bool>(),
           path, ": the windows in it are damaged");
  std::vector<HybridWindow> windows(static_cast<size_t>(all.size(0)));
  const auto flat = all.contiguous();
  const float* at = flat.data_ptr<float>();
  for (size_t i = 0; i < windows.size(); ++i) {
    windows[i].dt = dt[static_cast<int64_t>(i)].item<float>();
    for (int64_t t = 0; t < all.size(1); ++t) {
      Extraction& seen = windows[i].seen.emplace_back();
      PosedSkeleton& truth = windows[i].truth.emplace_back();
      seen.global.emplace();
      for (int j = 0; j < kJointCount; ++j, at += kNumbers) {
        seen.joints.row(j) = Eigen::Map<const Eigen::RowVector3f>(at);
        seen.confidence[j] = at[3];
        (*seen.global)[j] = rotation_from_6d(Eigen::Map<const Vec6>(at + 4));
        truth.joints.row(j) = Eigen::Map<const Eigen::RowVector3f>(at + 10);
        truth.global[j] = rotation_from_6d(Eigen::Map<const Vec6>(at + 13));
      }
    }
  }
  return windows;
}

}  // namespace

/// As many points as scanners give: hands and feet are seen from near.
static ScanMakerOptions dense_scans() {
  ScanMakerOptions options;
  options.points = 6000;
  return options;
}

HybridWindowMaker::HybridWindowMaker(const TrainingData& data, int frames, uint64_t seed)
    : data_(data), frames_(frames), rng_(seed), maker_(data, dense_scans(), seed + 1) {
  for (size_t c = 0; c < data.clips.size(); ++c) {
    const std::vector<int>& good = data.clips[c].good;
    std::vector<int> mine;
    for (size_t i = 0; i < good.size();) {
      size_t end = i + 1;
      while (end < good.size() && good[end] == good[end - 1] + 1) ++end;
      if (static_cast<int>(end - i) >= frames) {
        mine.push_back(static_cast<int>(runs_.size()));
        runs_.push_back({static_cast<int>(c), good[i], static_cast<int>(end - i)});
      }
      i = end;
    }
    if (!mine.empty()) of_clip_.push_back(std::move(mine));
  }
  US_CHECK(!runs_.empty(), "no clip has ", frames, " good frames in a row");
}

std::vector<Pose> HybridWindowMaker::poses(float& dt) {
  const auto& mine = of_clip_[rng_.below(static_cast<int>(of_clip_.size()))];
  const Run& run = runs_[mine[rng_.below(static_cast<int>(mine.size()))]];
  const float longest = static_cast<float>(run.count - 1) / static_cast<float>(frames_ - 1);
  const float step = std::min(longest, rng_.chance(0.6f) ? 1.0f : rng_.uniform(0.5f, 1.5f));
  const float start =
      rng_.uniform() * (static_cast<float>(run.count - 1) - step * static_cast<float>(frames_ - 1));
  const bool mirror = rng_.chance(0.5f);
  const Mat3 yaw = rotation_about_y(rng_.uniform(-kPi, kPi));
  const auto& clip = data_.clips[run.clip].motion.poses;
  std::vector<Pose> made;
  for (int t = 0; t < frames_; ++t) {
    const float frame = start + step * static_cast<float>(t);
    const int before = std::min(static_cast<int>(frame), run.count - 2);
    Pose pose = pose_between(clip[run.first + before], clip[run.first + before + 1],
                             frame - static_cast<float>(before));
    if (mirror) pose = understudy::mirrored(pose);
    pose.local[Pelvis] = yaw * pose.local[Pelvis];
    pose.root = yaw * pose.root;
    made.push_back(pose);
  }
  dt = step / kClipRate;
  return made;
}

HybridWindow HybridWindowMaker::next(SkeletonExtractor& extractor) {
  HybridWindow window;
  RecentJoints recent;
  for (const MadeScan& scan : maker_.follow(poses(window.dt))) {
    Mesh cloud;
    cloud.vertices = scan.points;
    window.seen.push_back(extractor.extract_next(cloud, recent));
    US_CHECK(window.seen.back().global, "hybrid wants an extractor that sees rotations");
    window.truth.push_back(scan.truth);
  }
  return window;
}

void write_hybrid_cache(const std::string& path, const HybridCache& cache) {
  torch::serialize::OutputArchive archive;
  archive.write("version", torch::full({1}, kVersion, torch::kInt64));
  archive.write("train", to_tensor(cache.train, cache.frames));
  archive.write("train_dt", intervals(cache.train));
  archive.write("dev", to_tensor(cache.dev, cache.frames));
  archive.write("dev_dt", intervals(cache.dev));
  save_archive(archive, path);
}

HybridCache read_hybrid_cache(const std::string& path) {
  torch::Tensor version, train, train_dt, dev, dev_dt;
  try {
    torch::serialize::InputArchive archive;
    archive.load_from(path);
    archive.read("version", version);
    TORCH_CHECK(version.numel() == 1 && version.scalar_type() == torch::kInt64);
    archive.read("train", train);
    archive.read("train_dt", train_dt);
    archive.read("dev", dev);
    archive.read("dev_dt", dev_dt);
  } catch (const c10::Error&) {
    throw Error(path + ": not a file of extracted windows");
  }
  US_CHECK(version.item<int64_t>() == kVersion, path, ": extracted windows of another version");
  US_CHECK(train.dim() == 4 && dev.dim() == 4 && train.size(1) == dev.size(1), path,
           ": the windows in it are damaged");
  return {static_cast<int>(train.size(1)), to_windows(train, train_dt, path), to_windows(dev, dev_dt, path)};
}

HybridWindow mirrored(const HybridWindow& window) {
  const Eigen::DiagonalMatrix<float, 3> flip(-1.0f, 1.0f, 1.0f);
  const auto other_side = [&flip](const Joints& joints, const Rotations& global, Joints& to,
                                  Rotations& turned) {
    for (int j = 0; j < kJointCount; ++j) {
      to.row(j) = joints.row(kMirror[j]) * flip;
      turned[j] = flip * global[kMirror[j]] * flip;
    }
  };
  HybridWindow other = window;
  for (size_t t = 0; t < window.seen.size(); ++t) {
    const Extraction& seen = window.seen[t];
    other_side(seen.joints, *seen.global, other.seen[t].joints, *other.seen[t].global);
    for (int j = 0; j < kJointCount; ++j) other.seen[t].confidence[j] = seen.confidence[kMirror[j]];
    other_side(window.truth[t].joints, window.truth[t].global, other.truth[t].joints, other.truth[t].global);
  }
  return other;
}

HybridWindow with_scaled_errors(const HybridWindow& window, float factor) {
  HybridWindow other = window;
  for (size_t t = 0; t < window.seen.size(); ++t) {
    Extraction& seen = other.seen[t];
    const PosedSkeleton& truth = window.truth[t];
    seen.joints = truth.joints + factor * (seen.joints - truth.joints);
    for (int j = 0; j < kJointCount; ++j) {
      Mat3& R = (*seen.global)[j];
      const Vec3 error = rotation_to_axis_angle(truth.global[j].transpose() * R);
      const float most = error.norm() > 1e-6f ? std::min(factor, kPi / error.norm()) : factor;
      R = truth.global[j] * rotation_from_axis_angle(most * error);
    }
  }
  return other;
}

}  // namespace understudy::training
