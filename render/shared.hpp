// Arrays that are shared rather than copied.
#pragma once

#include <memory>
#include <utility>

#include "retarget/base/fields.hpp"

namespace understudy::render {

/// An immutable array: copies share it and the renderer uploads it once: the same pointer() means the same
/// contents. Cheap to copy, usable from any thread.
template <class T>
class Shared {
 public:
  Shared() = default;                                                            ///< an empty array
  Shared(T value) : value_(std::make_shared<const T>(std::move(value))) {}       // NOLINT: converts
  Shared(std::shared_ptr<const T> value) noexcept : value_(std::move(value)) {}  // NOLINT: converts
  /// Of an Eigen expression.
  template <class Expression, class = decltype(std::declval<const Expression&>().eval())>
  Shared(const Expression& expression) : Shared(T(expression)) {}  // NOLINT: converts

  const T& operator*() const { return value_ ? *value_ : empty(); }
  const T* operator->() const { return &**this; }
  operator const T&() const { return **this; }  // NOLINT: converts
  /// Null for the empty array.
  const std::shared_ptr<const T>& pointer() const { return value_; }
  /// Whether both are one array; of small ones, which are often made anew, whether they hold the same.
  friend bool operator==(const Shared& a, const Shared& b) {
    return a.value_ == b.value_ || (a->rows() <= 64 && same(*a, *b));
  }

 private:
  static const T& empty() {
    static const T nothing(0, T::ColsAtCompileTime);
    return nothing;
  }
  std::shared_ptr<const T> value_;
};

}  // namespace understudy::render
