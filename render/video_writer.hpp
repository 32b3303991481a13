// Videos: MP4 (H.264) and folders of pictures.
#pragma once

#include <memory>
#include <string>

#include "render/image.hpp"

namespace understudy::render {

struct VideoOptions {
  int width = 1280,
      height = 720;  ///< pixels; MP4 needs even sides: an odd one gains a pixel that repeats its edge
  double fps = 30;
  int quality = 18;         ///< of MP4, x264's constant rate factor: 0 lossless .. 51 worst
  bool repeatable = false;  ///< the same pictures give the same bytes of MP4, in one thread
};

/// One film, picture by picture. A path that ends in .mp4 is a file; any other is a folder of PNGs,
/// frame_00000.png and so on. Use from one thread at a time.
class VideoWriter {
 public:
  /// Throws Error naming the path when it cannot be written or no H.264 encoder is there.
  VideoWriter(const std::string& path, const VideoOptions& options);
  /// Without finish() the half film is removed: an MP4 appears under its name only when it is whole.
  ~VideoWriter();

  /// The next picture; must be of the size given. Alpha is kept in PNGs; in MP4 it lies over white.
  void push(const Image& image);
  /// Writes what is still on its way and gives the film its name. No push after it. Throws Error when nothing
  /// was pushed.
  void finish();

  class Sink;  ///< how the pictures are written

 private:
  std::string path_;
  VideoOptions options_;
  std::unique_ptr<Sink> sink_;
  int frames_ = 0;
};

}  // namespace understudy::render
