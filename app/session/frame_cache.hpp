// Frames ready to draw, made in the background on request: scans read again, targets posed again. Bounded:
// drops the least recently used frames first.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "app/session/session.hpp"

namespace understudy::app {

/// An edited scan with normals, ready to draw.
struct ScanPicture {
  Mesh mesh;            ///< metres, y up, after the scan edits
  Points normals;       ///< [V, 3], of the faces, or estimated
  Points cropped_away;  ///< [N, 3], the points that the crop box removed
  float spacing = 0;    ///< metres between neighbouring points
  bool usable = true;
  std::string problem;
};

/// A target in one frame. Has no vertices where posing failed; the log says why.
struct PosedPicture {
  Points vertices;  ///< [V, 3]
  Points normals;   ///< [V, 3]; empty for a cloud
  Points offsets;   ///< [V, 3] of the T-pose, metres; only where wanted
};

/// Thread-safe.
class FrameCache {
 public:
  using Open = std::function<std::unique_ptr<Source>(const SourceOptions&)>;
  /// `open`: where scans come from, called on the cache's thread.
  explicit FrameCache(
      int64_t limit_mb = 512, Open open = [](const SourceOptions& source) { return open_source(source); });
  ~FrameCache();  ///< waits for the one frame that is being made

  /// Reads scans from this source with these edits from now on; a change drops the frames made before.
  void set_source(const SourceOptions& source, const ScanEdits& edits);
  /// Drops what was made of takes: one of them was removed.
  void forget_takes();
  /// Keeps the newest four frames whatever their size: one picture needs several.
  void set_limit(int64_t limit_mb);

  /// The scan of a frame; null while it is being made.
  std::shared_ptr<const ScanPicture> scan(int frame);
  /// A take in a frame; null while it is being made. The take's generation shows whether a frame is still
  /// valid.
  struct Wanted {
    int take = 0, frame = 0;
    bool offsets = false;
  };
  std::shared_ptr<const PosedPicture> posed(const TakeState& take, const Wanted& wanted);
  /// The target of the take k in a rest pose, skinned alone;
  /// null while it is being made, and without its weights.
  std::shared_ptr<const PosedPicture> rest(const TakeState& take, int k, const Pose& pose);
  /// A take in a frame of what it performs for a moment (StepPerformance), or while that is being made in the
  /// last one before that is; null without one.
  std::shared_ptr<const PosedPicture> performing(const TakeState& take, int k,
                                                 const std::vector<StepPerformance::Frame>& frames, int now);
  /// Frames that will be needed soon; made when nothing else waits.
  void prefetch_scan(int frame);
  void prefetch_posed(const TakeState& take, const Wanted& wanted);
  /// Waits until every requested (not prefetched) frame is made; for pictures, video and tests.
  void wait() const;

  int64_t bytes() const;  ///< in use
  int64_t made() const;   ///< pictures since the start
  bool busy() const;      ///< also while prefetching

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace understudy::app
