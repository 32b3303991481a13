// libFuzzer on one of the readers: fuzz_readers --reader=ply [libFuzzer's options] CORPUS. No reader may
// crash, throw anything but Error, or take more than four times what its input says it holds.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "tests/fuzz/readers.hpp"

extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*on_malloc)(const volatile void*, size_t),
                                                         void (*on_free)(const volatile void*));
extern "C" void __sanitizer_print_stack_trace();

namespace {

using understudy::fuzz::Reader;
using understudy::fuzz::readers;

const Reader* reader = nullptr;
size_t most = SIZE_MAX;  // bytes that one allocation may have; no limit between inputs

void on_malloc(const volatile void*, size_t size) {
  if (size <= most) return;
  const size_t limit = most;
  most = SIZE_MAX;
  std::fprintf(stderr, "one allocation of %zu bytes, the limit for this input is %zu\n", size, limit);
  __sanitizer_print_stack_trace();
  std::abort();
}

/// Text becomes numbers, numbers doubles, and lists grow by doubling: all within this times the file's size.
/// libzip makes room for the 65,535 entries that an archive may name.
constexpr size_t kOfFile = 64, kSmall = 4 << 20, kLargest = size_t{3} << 30;

size_t limit_for(const std::string& bytes) {
  const size_t declared = std::min(reader->declared(bytes), kLargest);
  return std::min(4 * declared + kOfFile * bytes.size() + kSmall, kLargest);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  for (int i = 1; i < *count; ++i)
    for (const Reader& one : readers())
      if (std::string("--reader=") + one.name == (*arguments)[i]) reader = &one;
  if (reader == nullptr) {
    std::fprintf(stderr, "fuzz_readers --reader=NAME [OPTIONS] CORPUS, NAME is one of:");
    for (const Reader& one : readers()) std::fprintf(stderr, " %s", one.name);
    std::fprintf(stderr, "\n");
    std::exit(2);
  }
  understudy::log::set_sink([](understudy::log::Level, const std::string&) {});
  __sanitizer_install_malloc_and_free_hooks(on_malloc, [](const volatile void*) {});
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  most = limit_for(bytes);
  try {
    reader->read(bytes);
  } catch (const understudy::Error& error) {
    if (std::strlen(error.what()) == 0 || std::strlen(error.what()) > 2000) std::abort();  // no sentence
  }
  most = SIZE_MAX;
  return 0;
}
