#include "render/image.hpp"

#include <png.h>

#include <algorithm>
#include <cstring>

#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/part_file.hpp"

namespace understudy::render {
namespace {

uint8_t to_byte(float value) {
  return static_cast<uint8_t>(std::clamp(value, 0.f, 1.f) * 255 + 0.5f);
}

std::vector<uint8_t> interleaved(const Image& image) {
  std::vector<uint8_t> rgba(image.alpha.size() * 4);
  for (size_t i = 0; i < image.alpha.size(); ++i) {
    std::copy_n(image.pixels.data() + 3 * i, 3, rgba.data() + 4 * i);
    rgba[4 * i + 3] = image.alpha[i];
  }
  return rgba;
}

/// A chunk of a PNG (PNG specification, 5.3): length, type, content, checksum.
std::string png_chunk(const std::string& type_and_content) {
  const auto big_endian = [](uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>((value >> shift) & 255u);
    return bytes;
  };
  uint32_t crc = ~0u;  // annex D
  for (const char byte : type_and_content) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
  }
  return big_endian(static_cast<uint32_t>(type_and_content.size() - 4)) + type_and_content + big_endian(~crc);
}

std::vector<uint8_t> png_bytes(const std::string& path, const Image& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  const std::vector<uint8_t> rgba = image.alpha.empty() ? image.pixels : interleaved(image);
  png.format = image.alpha.empty() ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::vector<uint8_t> bytes(size);
  const int ok = png_image_write_to_memory(&png, bytes.data(), &size, 0, rgba.data(), 0, nullptr);
  US_CHECK(ok != 0, path, ": ", png.message);
  bytes.resize(size);
  return bytes;
}

/// Fills `image` from RGBA.
Image separated(const std::vector<uint8_t>& rgba, Image image) {
  image.alpha.resize(rgba.size() / 4);
  for (size_t i = 0; i < image.alpha.size(); ++i) {
    std::copy_n(rgba.data() + 4 * i, 3, image.pixels.data() + 3 * i);
    image.alpha[i] = rgba[4 * i + 3];
  }
  return image;
}

}  // namespace

Image::Image(int w, int h, const Vec3& color) : width(w), height(h) {
  US_CHECK(w > 0 && h > 0 && w <= 32768 && h <= 32768, "a picture cannot be ", w, " x ", h, " pixels");
  pixels.resize(static_cast<size_t>(w) * h * 3);
  const uint8_t rgb[3] = {to_byte(color.x()), to_byte(color.y()), to_byte(color.z())};
  if (rgb[0] == rgb[1] && rgb[1] == rgb[2])
    std::memset(pixels.data(), rgb[0], pixels.size());  // a video makes many white ones
  else
    for (size_t i = 0; i < pixels.size(); i += 3) std::copy_n(rgb, 3, pixels.data() + i);
}

void paste(Image& image, const Image& source, int x, int y) {
  const int left = std::max(0, x), right = std::min(image.width, x + source.width);
  if (left >= right) return;
  for (int row = std::max(0, y); row < std::min(image.height, y + source.height); ++row) {
    uint8_t* to = image.at(left, row);
    const uint8_t* from = source.at(left - x, row - y);
    if (source.alpha.empty()) {
      std::memcpy(to, from, static_cast<size_t>(right - left) * 3);
      continue;
    }
    const uint8_t* alpha = source.alpha.data() + static_cast<size_t>(row - y) * source.width + (left - x);
    for (int i = 0; i < 3 * (right - left); ++i) {
      const int a = alpha[i / 3];
      to[i] = static_cast<uint8_t>((from[i] * a + to[i] * (255 - a) + 127) / 255);
    }
  }
}

void write_png(const std::string& path, const Image& image) {
  US_CHECK(image.width > 0 && image.height > 0, path, ": the picture is empty");
  US_CHECK(image.alpha.empty() || 3 * image.alpha.size() == image.pixels.size(), path, ": ",
           image.alpha.size(), " alpha values for ", image.pixels.size() / 3, " pixels");
  const auto bytes = png_bytes(path, image);
  write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::string png_file(const Image& image, const std::string& comment) {
  constexpr size_t kHeader = 8 + 25;  // signature and IHDR
  const std::vector<uint8_t> bytes = png_bytes("a picture", image);
  std::string file(bytes.begin(), bytes.end());
  if (!comment.empty()) file.insert(kHeader, png_chunk(std::string("tEXtComment\0", 12) + comment));
  return file;
}

Image read_png(const std::string& path) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  check_file(path);
  US_CHECK(png_image_begin_read_from_file(&png, path.c_str()) != 0, path, ": ", png.message);
  const bool has_alpha = (png.format & PNG_FORMAT_FLAG_ALPHA) != 0;
  png.format = has_alpha ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
  if (png.width > 32768 || png.height > 32768) {
    png_image_free(&png);
    throw Error(path + ": larger than 32768 pixels");
  }
  Image image(static_cast<int>(png.width), static_cast<int>(png.height));
  std::vector<uint8_t> bytes(PNG_IMAGE_SIZE(png));
  US_CHECK(png_image_finish_read(&png, nullptr, bytes.data(), 0, nullptr) != 0, path, ": ", png.message);
  return has_alpha ? separated(bytes, std::move(image)) : (image.pixels = std::move(bytes), image);
}

}  // namespace understudy::render
