// Small pictures of files' contents, for the file browser and the start screen.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/studio/preview_content.hpp"
#include "render/gl/object.hpp"
#include "render/renderer.hpp"
#include "retarget/base/worker.hpp"
#include "ui/gui/draw_pass.hpp"

namespace understudy::app {

/// One picture: drawn once, then kept.
struct FilePreview {
  ImTextureID texture = nullptr;  ///< null: no picture (yet)
  int width = 0, height = 0;      ///< pixels
  std::string text;               ///< "87 frames, 4,202 points"; or why there is no picture
};

/// Reads files in a thread of its own and draws the pictures in update(). Make, use and destroy it with
/// one context current.
class Previews {
 public:
  Previews();
  ~Previews();  ///< waits for the one file that is being read
  Previews(const Previews&) = delete;
  Previews& operator=(const Previews&) = delete;

  /// One picture of the scans, motions, targets and documents at these paths, side by side. Empty while it is
  /// being made. Never waits. up: see preview_content().
  const FilePreview& of(const std::vector<std::string>& paths, render::PixelSize size, bool dark,
                        const std::string& up = "");
  /// Draws at most one picture from what has been read. True when there is a new one.
  bool update();
  /// Whether something is still to be read or drawn.
  bool busy() const;

 private:
  struct Reading {
    std::string key;
    render::PixelSize size;
    bool dark = true;
    std::vector<std::string> paths;
    std::string up;
    std::vector<PreviewContent> contents;
  };
  struct Picture {
    FilePreview preview;
    std::unique_ptr<render::gl::Texture> texture;
    int64_t used = 0;
  };
  Worker::Task next();
  void draw(const Reading& reading);
  std::unique_ptr<render::gl::Texture> picture_of(const render::Scene& scene, render::PixelSize size);
  void forget_oldest();

  std::unique_ptr<render::Renderer> renderer_;
  std::map<std::string, Picture> pictures_;
  int64_t uses_ = 0;
  std::deque<Reading> to_read_, to_draw_;
  Worker worker_{"previews", [this] { return next(); }};
};

}  // namespace understudy::app
