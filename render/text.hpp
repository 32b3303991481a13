// Text on pictures.
#pragma once

#include <memory>
#include <string>

#include "render/image.hpp"

namespace understudy::render {

/// A font file, or none: then all text is invisible and has no width.
class Font {
 public:
  /// Inter, else DejaVu Sans, where Debian puts them; warns once in the log when neither is there.
  static Font system();
  /// Throws Error when the file is missing or no font.
  explicit Font(const std::string& path);
  Font() = default;

  bool found() const { return face_ != nullptr; }
  /// Width in pixels of UTF-8 text with capitals of about 0.7 `size` pixels.
  float width(const std::string& text, float size) const;
  /// Blends text onto the image with its baseline's left end at x, y.
  void draw(Image& image, const std::string& text, const Eigen::Vector2f& at, float size,
            const Vec3& color) const;

 private:
  struct Face;
  std::shared_ptr<const Face> face_;
};

}  // namespace understudy::render
