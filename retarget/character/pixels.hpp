// Pictures of files, decoded.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

namespace understudy {

/// Three bytes a pixel as screens show them, the first row on top; transparency is left out.
struct Pixels {
  int width = 0, height = 0;
  std::unique_ptr<uint8_t, void (*)(void*)> rgb{nullptr, nullptr};
};

/// PNG, JPEG and WebP are; KTX2 is not.
bool is_decoded(std::string_view bytes);

/// Bytes that the decoded picture takes, as its header says; 0 where there is no such header.
int64_t decoded_size(std::string_view bytes);

/// Throws Error, a sentence about "it": a picture of another kind, damaged, or of more than 64 megapixels,
/// which is found before they are unpacked.
Pixels decode_picture(std::string_view bytes);

}  // namespace understudy
