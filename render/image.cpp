#include "render/image.hpp"

#include <png.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "retarget/base/error.hpp"

namespace understudy::render {
namespace {

uint8_t to_byte(float value) {
  return static_cast<uint8_t>(std::clamp(value, 0.f, 1.f) * 255 + 0.5f);
}

std::vector<uint8_t> png_bytes(const std::string& path, const Image& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::vector<uint8_t> bytes(size);
  const int ok = png_image_write_to_memory(&png, bytes.data(), &size, 0, image.pixels.data(), 0, nullptr);
  US_CHECK(ok != 0, path, ": ", png.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace

Image::Image(int w, int h, const Vec3& color) : width(w), height(h) {
  US_CHECK(w > 0 && h > 0 && w <= 32768 && h <= 32768, "a picture cannot be ", w, " x ", h, " pixels");
  pixels.resize(static_cast<size_t>(w) * h * 3);
  const uint8_t rgb[3] = {to_byte(color.x()), to_byte(color.y()), to_byte(color.z())};
  for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = rgb[i % 3];
}

void paste(Image& image, const Image& source, int x, int y) {
  const int left = std::max(0, x), right = std::min(image.width, x + source.width);
  if (left >= right) return;
  for (int row = std::max(0, y); row < std::min(image.height, y + source.height); ++row)
    std::memcpy(image.at(left, row), source.at(left - x, row - y), static_cast<size_t>(right - left) * 3);
}

void write_png(const std::string& path, const Image& image) {
  US_CHECK(image.width > 0 && image.height > 0, path, ": the picture is empty");
  const auto bytes = png_bytes(path, image);
  const std::string part = path + ".part";
  std::ofstream out(part, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) std::remove(part.c_str());
  US_CHECK(out, path, ": cannot be written");
  std::error_code why;
  std::filesystem::rename(part, path, why);
  if (why) std::remove(part.c_str());
  US_CHECK(!why, path, ": cannot be written, ", why.message());
}

Image read_png(const std::string& path) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  US_CHECK(png_image_begin_read_from_file(&png, path.c_str()) != 0, path, ": ", png.message);
  png.format = PNG_FORMAT_RGB;
  if (png.width > 32768 || png.height > 32768) {
    png_image_free(&png);
    throw Error(path + ": larger than 32768 pixels");
  }
  Image image(static_cast<int>(png.width), static_cast<int>(png.height));
  const png_color white{255, 255, 255};  // what shows through transparent pixels
  US_CHECK(png_image_finish_read(&png, &white, image.pixels.data(), 0, nullptr) != 0, path, ": ",
           png.message);
  return image;
}

}  // namespace understudy::render
