// What completes a sparse capture: few points a scan, few scans, perhaps markers, become a motion and a body.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "retarget/formats/markers.hpp"
#include "retarget/geometry/mesh.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// What was captured at one time: points on somebody's surface, markers, or both. Metres, y up.
struct SparseFrame {
  double seconds = 0;
  Points points{0, 3};          ///< in no order; which are not finite are left out
  std::vector<Marker> markers;  ///< named as in kMarkerPlaces
};

struct SparseCapture {
  std::vector<SparseFrame> frames;  ///< in the order of time
  double fps = 30;                  ///< of the motion that is wanted; its first frame is at the first capture
};

/// The motion, and who moves.
struct CompletedCapture {
  Motion motion;              ///< from the first captured frame to the last, at the wanted rate
  std::vector<bool> is_made;  ///< of each frame: nothing was captured within half a frame of it
  /// Of each frame the error that its joints are expected to have on average, metres; never 0.
  std::vector<float> doubt_m;
  Joints rest = Joints::Zero();       ///< T-pose joints of the body, metres
  Points vertices{0, 3};              ///< of its surface in T-pose, [V, 3]
  Faces faces{0, 3};                  ///<
  RowMatrix weights{0, kJointCount};  ///< skin, [V, 22]
};

/// Fits a body and its motion to all frames of a sparse capture at once (paper 2, section 6): the body is
/// one, which is what lets few points a scan tell it. Looks both ways. One thread at a time. The same capture
/// has the same completion; a turned or moved one the turned or moved.
class SparseFitter {
 public:
  virtual ~SparseFitter() = default;
  /// Told the share that is done, 0..1; may throw, which ends the work.
  using Progress = std::function<void(float)>;
  /// Throws Error: fewer than two frames, times that are equal, fall, are not finite or an hour apart, a rate
  /// that is none, a frame with fewer than 10 points and no markers, fewer than 3 markers in a frame without
  /// points, a marker whose name is unknown.
  virtual CompletedCapture complete(const SparseCapture& capture, const Progress& progress) = 0;
  virtual std::string name() const = 0;
};

}  // namespace understudy
