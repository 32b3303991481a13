#include "retarget/character/picture.hpp"

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"

namespace understudy {
namespace {

// One white pixel.
constexpr unsigned char kWhite[] = {0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d,
                                    0x49, 0x48, 0x44, 0x52, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01,
                                    0x08, 0x02, 0x00, 0x00, 0x00, 0x90, 0x77, 0x53, 0xde, 0x00, 0x00, 0x00,
                                    0x0c, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0xf8, 0xff, 0xff, 0x3f,
                                    0x00, 0x05, 0xfe, 0x02, 0xfe, 0x33, 0x12, 0x95, 0x14, 0x00, 0x00, 0x00,
                                    0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

}  // namespace

std::string picture_type(std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.substr(0, 8) == "\x89PNG\r\n\x1a\n"sv && bytes.size() > 33) return "image/png";
  if (bytes.substr(0, 3) == "\xff\xd8\xff"sv && bytes.size() > 32) return "image/jpeg";
  if (bytes.substr(0, 4) == "RIFF"sv && bytes.size() > 20 && bytes.substr(8, 4) == "WEBP"sv)
    return "image/webp";
  if (bytes.substr(0, 12) == "\xabKTX 20\xbb\r\n\x1a\n"sv) return "image/ktx2";
  return {};
}

std::string picture_or_white(const std::function<std::string()>& read, const std::string& what) {
  try {
    return read();
  } catch (const Error& error) {
    if (std::string(error.what()).find("there is no such file") == std::string::npos) throw;
    log::warn(what + " is missing; a white one stands in for it");
    return {reinterpret_cast<const char*>(kWhite), sizeof kWhite};
  }
}

}  // namespace understudy
