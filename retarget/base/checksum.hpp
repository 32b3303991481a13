// A checksum that is the same on every machine: to tell files and texts apart, not to keep anybody
// from making equal ones.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace understudy {

constexpr uint64_t kFnvStart = 0xcbf29ce484222325ull;

/// FNV-1a with 64 bits; `hash` goes on with an earlier one.
constexpr uint64_t fnv1a(std::string_view bytes, uint64_t hash = kFnvStart) {
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return hash;
}

/// 16 hexadecimal digits.
std::string checksum_text(uint64_t checksum);
/// FNV-1a of a file's bytes as text; empty where it cannot be read.
std::string checksum_of_file(const std::string& path);

}  // namespace understudy
