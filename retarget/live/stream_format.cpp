#include "retarget/live/stream_format.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

#include "retarget/formats/bytes.hpp"
#include "retarget/formats/file_formats.hpp"

namespace understudy {
namespace {

constexpr size_t kLength = 4, kMark = 4;  // bytes
constexpr int64_t kLiveScanPoint = 9, kFloatPoint = 12;
constexpr int64_t kLeastPly = 16;  // more than the mark
constexpr float kMetre_mm = 1000;

// This machine is little endian, as all that Debian's LibTorch runs on.
template <class T>
T number_at(std::string_view bytes, size_t at) {
  return load<T>(bytes.data() + at, false);
}

int64_t livescan_size(int64_t points) {
  US_CHECK(points >= 0, "a frame of ", points, " points");
  US_CHECK(points <= kMostStreamPoints, "a frame of ", grouped(points), " points, more than ",
           grouped(kMostStreamPoints));
  return points * kLiveScanPoint;
}

int64_t float_size(int64_t bytes) {
  US_CHECK(bytes % kFloatPoint == 0, "a frame of ", grouped(bytes),
           " bytes, which is no number of points of 12 bytes");
  US_CHECK(bytes / kFloatPoint <= kMostStreamPoints, "a frame of ", grouped(bytes / kFloatPoint),
           " points, more than ", grouped(kMostStreamPoints));
  return bytes;
}

int64_t ply_size(int64_t bytes) {
  US_CHECK(bytes >= kLeastPly, "a frame of ", bytes, " bytes, too few for a PLY file");
  US_CHECK(bytes <= kMostStreamBytes, "a frame of ", grouped(bytes), " bytes, more than ",
           grouped(kMostStreamBytes));
  return bytes;
}

/// Noise read as numbers is far off: one such frame must not decide how large everybody is.
bool is_seen(const Vec3& point) {
  return point.allFinite() && !point.isZero(0) && point.cwiseAbs().maxCoeff() <= kFarthestPoint;
}

/// Without what was not seen.
Mesh seen_points(Mesh cloud) {
  std::vector<char> kept(static_cast<size_t>(cloud.vertices.rows()));
  for (size_t i = 0; i < kept.size(); ++i)
    kept[i] = is_seen(cloud.vertices.row(static_cast<Eigen::Index>(i)).transpose()) ? 1 : 0;
  return std::find(kept.begin(), kept.end(), 0) == kept.end() ? cloud : kept_part(cloud, kept);
}

Mesh decode_livescan(std::string_view bytes) {
  const auto count = static_cast<Eigen::Index>(bytes.size() / kLiveScanPoint);
  const size_t colors = static_cast<size_t>(count) * 3 * sizeof(int16_t);
  Mesh cloud;
  cloud.vertices.resize(count, 3);
  cloud.colors.resize(count, 3);
  for (Eigen::Index i = 0; i < 3 * count; ++i) {
    const auto at = static_cast<size_t>(i);
    cloud.vertices.data()[i] =
        static_cast<float>(number_at<int16_t>(bytes, at * sizeof(int16_t))) / kMetre_mm;
    cloud.colors.data()[i] = static_cast<float>(number_at<uint8_t>(bytes, colors + at)) / 255;
  }
  return cloud;
}

Mesh decode_floats(std::string_view bytes) {
  Mesh cloud;
  cloud.vertices.resize(static_cast<Eigen::Index>(bytes.size() / kFloatPoint), 3);
  std::memcpy(cloud.vertices.data(), bytes.data(), bytes.size());
  return cloud;
}

Mesh decode_ply(const std::string& bytes, const std::string& source) {
  const FileFormat* const ply = format_of_suffix("frame.ply", kScanFrame);
  US_CHECK(format_of_content(bytes, kScanFrame) == ply, source, ": a frame is no PLY file");
  Mesh mesh = ply->parse(bytes, source);
  US_CHECK(mesh.vertices.rows() <= kMostStreamPoints, source, ": a frame of ", grouped(mesh.vertices.rows()),
           " points, more than ", grouped(kMostStreamPoints));
  return mesh.is_cloud() ? seen_points(std::move(mesh)) : mesh;
}

}  // namespace

StreamFormat stream_format(const std::string& word) {
  const auto found = std::find(kStreamFormatNames.begin(), kStreamFormatNames.end(), word);
  US_CHECK(found != kStreamFormatNames.end(), word, ": is no form of a stream; it is ", kStreamFormatNames[0],
           ", ", kStreamFormatNames[1], ", ", kStreamFormatNames[2], " or ", kStreamFormatNames[3]);
  return static_cast<StreamFormat>(found - kStreamFormatNames.begin());
}

/// Decides on the frame's size as soon as the head is long enough.
void StreamCutter::read_head() {
  const uint32_t length = number_at<uint32_t>(head_, 0);
  if (length == 0) {
    size_ = 0;
    return;
  }
  if (format_ == StreamFormat::Auto) {
    if (head_.size() < kLength + kMark) return;
    const bool is_ply = head_[4] == 'p' && head_[5] == 'l' && head_[6] == 'y' && head_[7] <= ' ';
    format_ = is_ply ? StreamFormat::Ply : StreamFormat::LiveScan;
  }
  if (format_ == StreamFormat::LiveScan)
    size_ = livescan_size(static_cast<int32_t>(length));
  else
    size_ = format_ == StreamFormat::Ply ? ply_size(length) : float_size(length);
}

size_t StreamCutter::push(std::string_view bytes) {
  size_t taken = 0;
  const size_t head = format_ == StreamFormat::Auto ? kLength + kMark : kLength;
  while (!size_ && taken < bytes.size() && head_.size() < head) {
    head_ += bytes[taken++];
    if (head_.size() >= kLength) read_head();
  }
  if (!size_) return taken;
  if (head_.size() > kLength) frame_.bytes = head_.substr(kLength);
  head_.resize(kLength);
  const size_t missing = static_cast<size_t>(*size_) - frame_.bytes.size();
  const size_t more = std::min(missing, bytes.size() - taken);
  frame_.bytes.append(bytes.substr(taken, more));
  whole_ = more == missing;
  return taken + more;
}

std::optional<StreamFrame> StreamCutter::take() {
  if (!whole_) return {};
  StreamFrame done = std::move(frame_);
  done.format = done.bytes.empty() ? StreamFormat::Auto : format_;
  frame_ = {};
  head_.clear();
  size_.reset();
  whole_ = false;
  return done;
}

Mesh decode(const StreamFrame& frame, const std::string& source) {
  switch (frame.format) {
    case StreamFormat::LiveScan:
      return seen_points(decode_livescan(frame.bytes));
    case StreamFormat::Float32:
      return seen_points(decode_floats(frame.bytes));
    case StreamFormat::Ply:
      return decode_ply(frame.bytes, source);
    case StreamFormat::Auto:
      break;
  }
  return {Points(0, 3)};
}

}  // namespace understudy
