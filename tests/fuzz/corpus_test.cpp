// Every file of the fuzzer's corpus, whole, cut off and with damaged bytes, by every reader's own rules: what
// the fuzzer does for long under its sanitizers, for a moment in any build.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/formats/bytes.hpp"
#include "tests/fuzz/readers.hpp"

namespace understudy::fuzz {
namespace {

/// Reads quietly; true when the reader took it. Anything but Error goes on.
bool taken(const Reader& reader, const std::string& bytes) {
  try {
    reader.read(bytes);
    return true;
  } catch (const Error& error) {
    EXPECT_STRNE(error.what(), "");
    return false;
  }
}

std::string damaged(std::string bytes, Rng& rng) {
  for (int n = 1 + rng.below(4); n > 0; --n) {
    const auto at = static_cast<size_t>(rng.below(static_cast<int>(bytes.size())));
    bytes[at] = rng.below(2) == 0 ? static_cast<char>(rng.below(256))
                                  : static_cast<char>(bytes[at] ^ (1 << rng.below(8)));
  }
  return bytes;
}

class Corpus : public testing::TestWithParam<Reader> {};

TEST_P(Corpus, IsReadOrRefusedQuicklyWholeCutAndDamaged) {
  const log::Sink before = log::set_sink([](log::Level, const std::string&) {});
  const Reader& reader = GetParam();
  Rng rng(7);
  int files = 0, whole = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(US_SOURCE_DIR "/tests/fuzz/corpus/") + reader.name)) {
    const std::string bytes = read_file(entry.path().string());
    const auto began = std::chrono::steady_clock::now();
    ++files;
    whole += taken(reader, bytes);
    for (size_t cut = 0; cut < 16; ++cut) taken(reader, bytes.substr(0, bytes.size() * cut / 16));
    for (int i = 0; i < 40; ++i) taken(reader, damaged(bytes, rng));
    EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(60)) << entry.path();
  }
  EXPECT_GE(files, 1);
  EXPECT_GE(whole, 1) << "no file of the corpus is good";
  log::set_sink(before);
}

INSTANTIATE_TEST_SUITE_P(Readers, Corpus, testing::ValuesIn(readers()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace understudy::fuzz
