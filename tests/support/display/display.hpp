// An X display for tests of windows: Xvfb, Debian package xvfb.
#pragma once

#include <sys/types.h>

#include <string>

#include "render/image.hpp"
#include "tests/app/program.hpp"

namespace understudy::tests {

/// An X display without a screen, on a number that it picks; ends with this object.
class Display {
 public:
  /// Of that many pixels.
  explicit Display(int width = 1300, int height = 820);
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;
  bool works() const { return !number_.empty(); }
  std::string name() const { return ":" + number_; }
  /// What it shows now. Throws Error when it cannot be read.
  render::Image picture() const;

 private:
  ScratchFolder memory_;  ///< where Xvfb maps its pixels
  pid_t pid_ = -1;
  std::string number_;
};

}  // namespace understudy::tests
