#include "retarget/character/picture.hpp"

#include <webp/decode.h>
#include <algorithm>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

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
#include "retarget/base/log.hpp"

namespace understudy {
namespace {

constexpr const char* kWebp = "image/webp";
constexpr int64_t kMostPixels = 64ll << 20;
constexpr size_t kTables = 64 << 10;  // of the decoders
// One white pixel.
constexpr unsigned char kWhite[] = {0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d,
                                    0x49, 0x48, 0x44, 0x52, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01,
                                    0x08, 0x02, 0x00, 0x00, 0x00, 0x90, 0x77, 0x53, 0xde, 0x00, 0x00, 0x00,
                                    0x0c, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0xf8, 0xff, 0xff, 0x3f,
                                    0x00, 0x05, 0xfe, 0x02, 0xfe, 0x33, 0x12, 0x95, 0x14, 0x00, 0x00, 0x00,
                                    0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

const uint8_t* data(std::string_view bytes) {
  return reinterpret_cast<const uint8_t*>(bytes.data());
}

/// stb_image takes Huffman tables of more than 256 codes and writes behind them. Looks wherever one may be.
bool has_large_table(std::string_view jpeg) {
  const auto byte = [&](size_t i) { return i < jpeg.size() ? size_t{static_cast<uint8_t>(jpeg[i])} : 0; };
  for (size_t at = jpeg.find("\xFF\xC4"); at != jpeg.npos; at = jpeg.find("\xFF\xC4", at + 1)) {
    const size_t end = at + 2 + 256 * byte(at + 2) + byte(at + 3);  // past the file stb_image reads zeros
    for (size_t table = at + 4, codes = 0; table < std::min(end, jpeg.size()); table += 17 + codes) {
      codes = 0;
      for (size_t length = 1; length <= 16; ++length) codes += byte(table + length);
      if (codes > 256 && byte(table) >> 4 < 2 && byte(table) % 16 < 4) return true;
    }
  }
  return false;
}

/// Width and height from the header alone; 0 where it is none that is decoded here.
Pixels size_in_header(std::string_view bytes) {
  if (picture_type(bytes) == "image/jpeg" && has_large_table(bytes)) return {};
  Pixels out;
  if (!is_decoded(bytes) || bytes.size() >= (1ull << 31)) return out;
  int channels = 0;
  largest_piece = kTables;
  const bool read =
      picture_type(bytes) == kWebp
          ? WebPGetInfo(data(bytes), bytes.size(), &out.width, &out.height) != 0
          : stbi_info_from_memory(data(bytes), bytes.size(), &out.width, &out.height, &channels) != 0;
  if (!read || out.width <= 0 || out.height <= 0) out.width = out.height = 0;
  return out;
}

}  // namespace

std::string picture_type(std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.substr(0, 8) == "\x89PNG\r\n\x1a\n"sv && bytes.size() > 33) return "image/png";
  if (bytes.substr(0, 3) == "\xff\xd8\xff"sv && bytes.size() > 32) return "image/jpeg";
  if (bytes.substr(0, 4) == "RIFF"sv && bytes.size() > 20 && bytes.substr(8, 4) == "WEBP"sv) return kWebp;
  if (bytes.substr(0, 12) == "\xabKTX 20\xbb\r\n\x1a\n"sv) return "image/ktx2";
  return {};
}

std::string picture_or_white(const std::function<std::string()>& read, const std::string& what) {
  try {
    return read();
  } catch (const Error& error) {
    if (std::string(error.what()).find("there is no such file") == std::string::npos) throw;
    log::warn(what + " is missing and replaced by a white one");
    return {reinterpret_cast<const char*>(kWhite), sizeof kWhite};
  }
}

bool add_picture(const std::string& file, std::string bytes, Character& out) {
  std::string type = picture_type(bytes);
  if (type.empty()) return false;
  out.textures.push_back(nlohmann::json({{"source", out.images.size()}}).dump());
  out.images.push_back({std::filesystem::path(file).stem().string(), std::move(type), std::move(bytes)});
  return true;
}

nlohmann::json plain_material(const std::string& name, const Vec3& color, float alpha, int texture) {
  nlohmann::json pbr = {{"metallicFactor", 0.0}, {"roughnessFactor", 0.8}};
  if (texture >= 0)
    pbr["baseColorTexture"] = {{"index", texture}};
  else
    pbr["baseColorFactor"] = {color.x(), color.y(), color.z(), alpha};
  return {{"name", name}, {"doubleSided", true}, {"pbrMetallicRoughness", pbr}};
}

bool is_decoded(std::string_view bytes) {
  const std::string type = picture_type(bytes);
  return type == "image/png" || type == "image/jpeg" || type == kWebp;
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
  if (picture_type(bytes) == kWebp)
    out.rgb = {WebPDecodeRGB(data(bytes), bytes.size(), &out.width, &out.height), WebPFree};
  else
    out.rgb = {stbi_load_from_memory(data(bytes), bytes.size(), &out.width, &out.height, &channels, 3),
               stbi_image_free};
  US_CHECK(out.rgb, "it cannot be decoded");
  return out;
}

}  // namespace understudy
