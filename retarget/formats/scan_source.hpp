// A scan sequence, frame by frame: a folder, a list, one array file, or a single mesh.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// Of a frame that came live.
struct LiveMoment {
  std::chrono::steady_clock::time_point captured;  ///< its first byte was here
  int64_t dropped = 0;                             ///< frames so far that newer ones overtook
};

/// Clouds of files have at most so many points: thinned while they are read, since nothing that follows gains
/// by more.
constexpr Eigen::Index kMostScanPoints = 200000;

/// One frame as it came, in the file's own units and axes.
struct ScanFrame {
  Mesh mesh;
  int64_t number = 0;     ///< from the file's name; the position in the sequence where names have none
  std::string path;       ///< empty: its number is missing in the sequence
  bool usable = true;     ///< false: it could not be read or has no finite point, `mesh` may be empty
  std::string problem;    ///< why it is not usable, one sentence
  bool is_empty = false;  ///< it was read, but has no finite point
  std::optional<LiveMoment> live{};  ///< none: it comes from a file, or nothing came
};

struct ScanSourceOptions {
  bool follow = false;              ///< the folder is still being written: wait for frames
  double timeout_s = 10;            ///< follow: give up when no new frame came for so long
  double poll_s = 0.03;             ///< follow: time between two looks
  std::function<bool()> cancelled;  ///< follow: asked at every look; true ends the sequence
  std::string times;                ///< CSV of when each scan was taken (see scan_times.hpp); empty: none
  double fps = 0;                   ///< times: frames per second of the clock; 0: as the times tell
};

/// What one scan of a sequence is called.
struct ScanName {
  std::string path;    ///< its file; empty: one file holds them all
  int64_t number = 0;  ///< as ScanFrame's
};

/// The regular clock on whose frames scans lie that have times of their own.
struct ScanClock {
  double fps = 0;
  std::string sentence;  ///< "times.csv: 37 scans in 1.48 s, 25 frames/s"
};

/// Numbers that are missing between two frames, both ends included.
struct FrameGap {
  int64_t first = 0, last = 0;
};

/// Hands out the frames of a sequence in order, one in memory at a time; frame i never depends on a later
/// one. A number that is missing is a frame that cannot be used, so that a gap takes as long as it took; only
/// gaps of more than a thousand frames are left out. With a table of times these alone tell: each scan is on
/// the nearest frame of a regular clock, and the others are gaps; frames then have the clock's numbers.
///
/// A folder: the files of its most frequent mesh format, by the numbers in their names (frame_2 before
/// frame_10); other files are left out, other mesh formats with a warning. A list: a .txt or .lst with a path
/// a line, relative to it, or the paths themselves, in the order given. An array: .npy or .npz of shape T x N
/// x 3 (or N x 3), in a .npz `points`, then `vertices`, then the first of that shape, `faces` beside it when
/// there. Any other file: one frame. Move-only; one thread at a time.
class ScanSource {
 public:
  /// What the frames come from; see scan_frames.hpp.
  class Frames {
   public:
    virtual ~Frames() = default;
    virtual std::optional<ScanFrame> next() = 0;
    virtual std::optional<int64_t> count() const = 0;
    virtual void seek(int64_t frame) = 0;
    /// None: the frame is missing. `frame` is below count().
    virtual std::optional<ScanName> scan(int64_t frame) const { return ScanName{"", frame}; }
    std::vector<FrameGap> gaps;
    std::optional<ScanClock> clock;
  };

  /// Throws Error, one sentence, when there is no such path, no permission, no frame in it, two formats are
  /// equally frequent, or the times cannot be those of the scans.
  explicit ScanSource(const std::string& path, const ScanSourceOptions& options = {});
  explicit ScanSource(const std::vector<std::string>& files);
  /// Of another kind; never null.
  explicit ScanSource(std::unique_ptr<Frames> frames) : frames_(std::move(frames)) {}

  /// The next frame; none at the end. A frame that cannot be read comes back with usable = false; only a
  /// sequence that is broken as a whole (an array that ends early, a followed folder that never gets a frame)
  /// throws Error. The file of a sequence of one frame throws when it cannot be read.
  std::optional<ScanFrame> next() { return frames_->next(); }

  /// next() goes on with this frame, 0 the first. At once for files and .npy; a packed .npz is read up to
  /// there. Throws Error when there is no such frame or the folder is followed.
  void seek(int64_t frame) { frames_->seek(frame); }

  /// How many frames there are; none while a folder is followed.
  std::optional<int64_t> count() const { return frames_->count(); }
  /// Missing numbers found so far, those left out, too: all from the start, but for a followed folder.
  const std::vector<FrameGap>& gaps() const { return frames_->gaps; }
  /// None without times.
  const std::optional<ScanClock>& clock() const { return frames_->clock; }

 private:
  std::unique_ptr<Frames> frames_;
};

/// Whether a comes before b when runs of digits count as numbers.
bool natural_less(const std::string& a, const std::string& b);

}  // namespace understudy
