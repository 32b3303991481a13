#include "retarget/character/pixels.hpp"

#include <webp/decode.h>

#include <cstdlib>
#include <string>

namespace {

// What a PNG's data unpack to has no bound in its header. One piece of memory is as large as the pixels and
// the file want it, and no larger.
thread_local size_t largest_piece = 0;

/// Zeros: the decoder looks into tables of codes that a JPEG names and never gives.
void* piece(size_t size) {
  return size <= largest_piece ? std::calloc(1, size) : nullptr;
}

void* piece_again(void* old, size_t size) {
  return size <= largest_piece ? std::realloc(old, size) : nullptr;
}

}  // namespace

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 65536
#define STBI_MALLOC(size) piece(size)
#define STBI_REALLOC(old, size) piece_again(old, size)
#define STBI_FREE(old) std::free(old)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wshadow"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

#include "retarget/base/error.hpp"
#include "retarget/character/picture.hpp"

namespace understudy {
namespace {

constexpr int64_t kMostPixels = 64ll << 20;
constexpr size_t kTables = 64 << 10;  // of the decoders

const uint8_t* data(std::string_view bytes) {
  return reinterpret_cast<const uint8_t*>(bytes.data());
}

/// Width and height from the header alone; 0 where it is none that is decoded here.
Pixels size_in_header(std::string_view bytes) {
  Pixels out;
  const std::string type = picture_type(bytes);
  if (bytes.size() >= (1ull << 31)) return out;
  int channels = 0;
  largest_piece = kTables;
  const bool read =
      type == "image/webp" ? WebPGetInfo(data(bytes), bytes.size(), &out.width, &out.height) != 0
      : type == "image/png" || type == "image/jpeg"
          ? stbi_info_from_memory(data(bytes), bytes.size(), &out.width, &out.height, &channels) != 0
          : false;
  if (!read || out.width <= 0 || out.height <= 0) out.width = out.height = 0;
  return out;
}

}  // namespace

bool is_decoded(std::string_view bytes) {
  const std::string type = picture_type(bytes);
  return type == "image/png" || type == "image/jpeg" || type == "image/webp";
}

int64_t decoded_size(std::string_view bytes) {
  const Pixels size = size_in_header(bytes);
  return int64_t{3} * size.width * size.height;
}

Pixels decode_picture(std::string_view bytes) {
  US_CHECK(is_decoded(bytes), "it is neither PNG, JPEG nor WebP");
  Pixels out = size_in_header(bytes);
  US_CHECK(out.width > 0, "it cannot be decoded");
  const int64_t pixels = static_cast<int64_t>(out.width) * out.height;
  US_CHECK(pixels <= kMostPixels, "it has ", out.width, " x ", out.height, " pixels, over 64 megapixels");
  // Sixteen bits in four channels and their rows' filters, and the packed data, which are put together.
  largest_piece =
      8 * static_cast<size_t>(pixels) + static_cast<size_t>(out.height) + 2 * bytes.size() + kTables;
  int channels = 0;
  if (picture_type(bytes) == "image/webp")
    out.rgb = {WebPDecodeRGB(data(bytes), bytes.size(), &out.width, &out.height), WebPFree};
  else
    out.rgb = {stbi_load_from_memory(data(bytes), bytes.size(), &out.width, &out.height, &channels, 3),
               stbi_image_free};
  US_CHECK(out.rgb, "it cannot be decoded");
  return out;
}

}  // namespace understudy
