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

/// What a reader may take whatever it reads: buffers of streams, tables of the decoders of packed data
/// (libpng, zlib, JPEG), and what is looked at of a file at once.
constexpr size_t kWhatever = 256 << 10, kLargest = size_t{3} << 30;

/// Four times what the input declares: lists grow by doubling, and what is made of them is as large again.
size_t limit_for(const std::string& bytes) {
  return std::min(4 * std::min(reader->declared(bytes), kLargest) + kWhatever, kLargest);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  for (int i = 1; i < *count; ++i)
    for (const Reader& one : readers())
      if ("--reader=" + one.name == (*arguments)[i]) reader = &one;
  if (reader == nullptr) {
    std::fprintf(stderr, "fuzz_readers --reader=NAME [OPTIONS] CORPUS, NAME is one of:");
    for (const Reader& one : readers()) std::fprintf(stderr, " %s", one.name.c_str());
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
