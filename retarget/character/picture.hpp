// Pictures that a character's materials use: what their bytes hold, decoded, and materials of them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "retarget/character/character.hpp"

namespace understudy {

/// "image/png", "image/jpeg", "image/webp", "image/ktx2"; empty: none of those.
std::string picture_type(std::string_view bytes);

/// The bytes that `read` gives; a white pixel as PNG, and a warning that begins with `what`, where the file
/// is missing. Other failures go on.
std::string picture_or_white(const std::function<std::string()>& read, const std::string& what);

/// Adds a picture, named after its file, as an image and a texture of its own; false, and nothing is added,
/// where the bytes are no picture.
bool add_picture(const std::string& file, std::string bytes, Character& out);
/// A rough material of glTF that is seen from both sides, of this texture or, with -1, this colour, 0..1.
nlohmann::json plain_material(const std::string& name, const Vec3& color, float alpha, int texture);

/// Three bytes a pixel as screens show them, the first row on top; transparency is left out.
struct Pixels {
  int width = 0, height = 0;
  std::unique_ptr<uint8_t, void (*)(void*)> rgb{nullptr, nullptr};
};

/// PNG, JPEG and WebP are; KTX2 is not.
bool is_decoded(std::string_view bytes);

/// Bytes that the decoded picture takes, as in its header; 0 where there is no such header.
int64_t decoded_size(std::string_view bytes);

/// Throws Error, a sentence about "it": a picture of another kind, damaged, or of more than 64 megapixels,
/// which is found before they are unpacked.
Pixels decode_picture(std::string_view bytes);

}  // namespace understudy
