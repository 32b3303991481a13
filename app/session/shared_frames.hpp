// A list of frames that its copies share: a worker gets thousands of them without copying one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace understudy::app {

/// Frames in chunks of kChunk that are never changed: a write replaces the chunks that it touches, and copies
/// of the list keep the old ones. Copies may be read on other threads; each object belongs to one thread.
template <class Frame>
class SharedFrames {
 public:
  static constexpr size_t kChunk = 64;

  class Iterator {
   public:
    Iterator(const SharedFrames& all, size_t at) : all_(&all), at_(at) {}
    const Frame& operator*() const { return (*all_)[at_]; }
    Iterator& operator++() { return ++at_, *this; }
    bool operator!=(const Iterator& other) const { return at_ != other.at_; }

   private:
    const SharedFrames* all_;
    size_t at_;
  };

  size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  /// Valid until the frame's chunk is written to.
  const Frame& operator[](size_t i) const { return (*chunks_[i / kChunk])[i % kChunk]; }
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size_}; }

  void clear() { *this = {}; }
  void push_back(Frame frame) {
    write(size_, size_ + 1, [&](size_t, Frame& last) { last = std::move(frame); });
  }
  /// Calls change(i, frame) for the frames from `first` to before `last`.
  /// The list grows to `last`, with default frames.
  template <class Change>
  void write(size_t first, size_t last, Change change) {
    chunks_.resize(std::max(chunks_.size(), (last + kChunk - 1) / kChunk));
    for (size_t at = std::min(first, size_); at < last;) {
      const size_t c = at / kChunk, end = std::min(last, (c + 1) * kChunk);
      std::vector<Frame> chunk;
      chunk.reserve(kChunk);
      if (chunks_[c]) chunk = *chunks_[c];
      chunk.resize(std::max(chunk.size(), end - c * kChunk));
      for (; at < end; ++at)
        if (at >= first) change(at, chunk[at % kChunk]);
      chunks_[c] = std::make_shared<const std::vector<Frame>>(std::move(chunk));
    }
    size_ = std::max(size_, last);
  }

 private:
  std::vector<std::shared_ptr<const std::vector<Frame>>> chunks_;
  size_t size_ = 0;
};

}  // namespace understudy::app
