// Arrays on the graphics card, kept for as long as they are drawn.
#pragma once

#include <memory>
#include <vector>

#include "render/gl/program.hpp"
#include "render/shared.hpp"

namespace understudy::render::gl {

/// Uploads each shared array once. Use with one context, on its thread.
class ArrayCache {
 public:
  /// The buffer with this array's rows; uploads it on first use.
  template <class T>
  const Buffer& of(const Shared<T>& array) {
    return find(array.pointer(), array->data(), static_cast<size_t>(array->size()) * sizeof(*array->data()));
  }
  /// Call once per picture: buffers that the last few pictures did not use are reused for new arrays.
  void next_picture();

 private:
  struct Entry {
    std::shared_ptr<const void> array;  ///< kept, so that its address stays its own
    int unused = 0;                     ///< pictures since it was last asked for
    Buffer buffer;
  };
  const Buffer& find(const std::shared_ptr<const void>& array, const void* data, size_t bytes);

  std::vector<std::unique_ptr<Entry>> entries_;
};

}  // namespace understudy::render::gl
