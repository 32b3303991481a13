// A picture in memory, and PNG files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "retarget/math/types.hpp"

namespace understudy::render {

/// 8-bit sRGB, row by row from the top left, three bytes a pixel.
struct Image {
  int width = 0, height = 0;
  std::vector<uint8_t> pixels;
  std::vector<uint8_t> alpha;  ///< one byte a pixel, 255 opaque, colours not multiplied; empty: all opaque

  Image() = default;
  /// All of one colour (0..1). Throws Error when a side is not in 1..32768.
  Image(int width, int height, const Vec3& color = Vec3::Ones());
  uint8_t* at(int x, int y) { return pixels.data() + 3 * (static_cast<size_t>(y) * width + x); }
  const uint8_t* at(int x, int y) const { return pixels.data() + 3 * (static_cast<size_t>(y) * width + x); }
};

/// Copies `source` into `image` with its top left corner at x, y; what falls outside is left out.
/// Transparent pixels of `source` let `image` show through.
void paste(Image& image, const Image& source, int x, int y);

/// Writes a PNG beside and renames it, so that no half file is ever seen. Throws Error naming the file.
void write_png(const std::string& path, const Image& image);
/// The bytes of a PNG that says `comment` right at its beginning, among its first 200 bytes where that is
/// short; empty: it says nothing.
std::string png_file(const Image& image, const std::string& comment = "");
/// Reads a PNG as RGB, with alpha where the file has it. Throws Error naming the file.
Image read_png(const std::string& path);

}  // namespace understudy::render
