// Films that are encoded while the next pictures are drawn.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/video_writer.hpp"

namespace understudy::app {

/// One or more films of equally many pictures, written by a thread of its own.
class ClipWriter {
 public:
  struct Film {
    std::string path;
    render::VideoOptions options;
  };
  /// Throws Error naming the path when it cannot be written.
  explicit ClipWriter(const std::vector<Film>& films);
  /// Without finish() nothing is left behind.
  ~ClipWriter();
  ClipWriter(const ClipWriter&) = delete;
  ClipWriter& operator=(const ClipWriter&) = delete;

  /// The next picture of each film; waits while many are still to be encoded. Throws Error when an earlier
  /// one could not be written.
  void push(std::vector<render::Image> pictures);
  /// Waits for the rest and gives the films their names. Throws Error.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace understudy::app
