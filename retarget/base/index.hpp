// Signed indices: sizes to compare them with, and elements that may not be there.
#pragma once

#include <cstddef>

namespace understudy {

/// The number of elements, signed: C++20's std::ssize.
template <class Container>
constexpr std::ptrdiff_t ssize(const Container& container) {
  return static_cast<std::ptrdiff_t>(container.size());
}

/// Pointer to the element at an index of any sign; null outside of the container.
template <class Container>
constexpr auto at_or_null(Container& container, std::ptrdiff_t index) -> decltype(&container[0]) {
  return index >= 0 && index < ssize(container) ? &container[index] : nullptr;
}

}  // namespace understudy
