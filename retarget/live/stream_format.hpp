// How clouds follow each other in a stream of bytes: cutting it into frames, and a frame into points. Nothing
// here waits or allocates what a stranger's number says before that number was bounded.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// All numbers are little endian, and frames follow each other with nothing between.
///   LiveScan  int32 n, n x 3 int16 millimetres, n x 3 uint8 red, green, blue: LiveScan3D's
///   Ply       uint32 bytes, so many bytes of a PLY file, ascii or binary
///   Float32   uint32 bytes = 12 n, n x 3 float32: x, y, z
///   Auto      Ply where "ply" stands behind the first length, else LiveScan
enum class StreamFormat { Auto, LiveScan, Ply, Float32 };
constexpr std::array<const char*, 4> kStreamFormatNames = {"auto", "livescan", "ply", "float32"};
/// Throws Error for another word.
StreamFormat stream_format(const std::string& word);

constexpr int64_t kMostStreamPoints = 2'000'000;        ///< of a frame
constexpr int64_t kMostStreamBytes = int64_t{1} << 27;  ///< of a PLY

/// A frame as it came, behind its length.
struct StreamFrame {
  StreamFormat format = StreamFormat::Auto;  ///< Auto: it is empty
  std::string bytes;
};

/// Cuts a stream into frames. The first frame decides what Auto is.
class StreamCutter {
 public:
  explicit StreamCutter(StreamFormat format) : format_(format) {}
  /// The next bytes: takes some of them, at least one of several, none behind the end of a frame. How many.
  /// Throws Error, one clause for the end of a sentence, where a length cannot be: the stream has lost its
  /// beat or lies, and what follows is not to be read.
  size_t push(std::string_view bytes);
  /// The frame that the last push() made whole.
  std::optional<StreamFrame> take();
  /// Whether a frame has begun and is not whole.
  bool in_frame() const { return !head_.empty() || !frame_.bytes.empty(); }

 private:
  void read_head();

  StreamFormat format_;
  std::string head_;             // its length, and while nothing is decided what comes behind
  std::optional<int64_t> size_;  // of the frame that is being read, bytes
  StreamFrame frame_;
  bool whole_ = false;
};

/// A coordinate in the stream's unit, whichever that is: further off nobody stands.
constexpr float kFarthestPoint = 1e6f;

/// Its points, those of LiveScan in metres; colours where it has some. Of clouds the points that are not
/// finite, beyond kFarthestPoint, or at exactly 0, 0, 0, which depth cameras give for what they did not see,
/// are left out. Throws Error naming `source`.
Mesh decode(const StreamFrame& frame, const std::string& source);

}  // namespace understudy
