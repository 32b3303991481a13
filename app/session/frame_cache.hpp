// Frames ready to be drawn, made in the background when they are asked for: scans read again, targets posed
// again. Bounded: what was looked at longest ago goes first.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "app/session/session.hpp"

namespace understudy::app {

/// A scan as it is drawn: edited, with normals.
struct ScanPicture {
  Mesh mesh;            ///< metres, y up, after the scan edits
  Points normals;       ///< [V, 3], of the faces, or estimated
  Points cropped_away;  ///< [N, 3], what the crop box took
  float spacing = 0;    ///< metres between neighbouring points
  bool usable = true;
  std::string problem;
};

/// A target in one frame. Without vertices where it cannot be posed; the log says why.
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
  explicit FrameCache(int64_t limit_mb = 512, Open open = open_source);
  ~FrameCache();  ///< waits for the one frame that is being made

  /// From now on scans are read from this source with these edits; a change forgets those made before.
  void set_source(const SourceOptions& source, const ScanEdits& edits);
  /// The newest four frames are kept whatever their size: one drawn picture needs several.
  void set_limit(int64_t limit_mb);

  /// The scan of a frame, or null: it is being made now.
  std::shared_ptr<const ScanPicture> scan(int frame);
  /// A take in a frame, or null: it is being made now. Take and frame are found again by the take's
  /// generation.
  struct Wanted {
    int take = 0, frame = 0;
    bool offsets = false;
  };
  std::shared_ptr<const PosedPicture> posed(const TakeState& take, const Wanted& wanted);
  /// Frames that will be wanted soon, made when there is nothing else to do.
  void prefetch_scan(int frame);
  void prefetch_posed(const TakeState& take, const Wanted& wanted);
  /// Waits until all that was asked for (not only prefetched) is there; for pictures, video and tests.
  void wait() const;

  int64_t bytes() const;  ///< held now
  bool busy() const;      ///< prefetching too

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace understudy::app
