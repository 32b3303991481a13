// Reads videos picture by picture, such as VideoWriter makes.
#pragma once

#include <memory>
#include <string>

#include "render/image.hpp"

namespace understudy::render {

/// The first video in a file, from its beginning. Sound is left alone. Use from one thread at a time.
class VideoReader {
 public:
  /// Throws Error naming the path: nothing there, no video, or one that libavcodec cannot read.
  explicit VideoReader(const std::string& path);
  ~VideoReader();
  VideoReader(VideoReader&&) noexcept;
  VideoReader& operator=(VideoReader&&) noexcept;

  int width() const;
  int height() const;
  double fps() const;

  /// Goes on by one picture; false after the last one. Throws Error naming the path where it is damaged.
  bool next();
  /// The picture that next() came to last; after the end that is the last one.
  Image picture();
  /// To before the first picture again.
  void restart();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace understudy::render
