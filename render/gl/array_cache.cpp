#include "render/gl/array_cache.hpp"

#include <algorithm>

namespace understudy::render::gl {
namespace {
constexpr int kPictures = 4;  // two or three views take turns
}

const Buffer& ArrayCache::find(const std::shared_ptr<const void>& array, const void* data, size_t bytes) {
  Entry* free = nullptr;
  for (const auto& entry : entries_) {
    if (entry->array == array && array != nullptr) {
      entry->unused = 0;
      return entry->buffer;
    }
    if (entry->array == nullptr) free = entry.get();
  }
  if (free == nullptr) free = entries_.emplace_back(std::make_unique<Entry>()).get();
  free->array = array;
  free->unused = 0;
  upload(free->buffer, GL_ARRAY_BUFFER, data, bytes);
  return free->buffer;
}

void ArrayCache::next_picture() {
  for (const auto& entry : entries_)
    if (++entry->unused > kPictures) entry->array.reset();
  // Freed ones wait for new arrays a while, then go.
  entries_.erase(std::remove_if(entries_.begin(), entries_.end(),
                                [](const auto& entry) { return entry->unused > 2 * kPictures; }),
                 entries_.end());
}

}  // namespace understudy::render::gl
