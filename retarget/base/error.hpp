// The one error type and the one check of the whole program.
#pragma once

#include <new>
#include <sstream>
#include <stdexcept>
#include <string>

namespace understudy {

/// Any failure a user or caller can cause. what() is one sentence fit for a dialog box.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

namespace detail {
template <class... Parts>
std::string join(const Parts&... parts) {
  std::ostringstream out;
  (out << ... << parts);
  return out.str();
}
}  // namespace detail

/// Runs a part of a job that may fail without the whole failing; gives the sentence of what went wrong, of
/// any exception, and an empty one when nothing did.
template <class Part>
std::string failure_of(Part part) {
  try {
    part();
  } catch (const std::bad_alloc&) {
    return "there is not enough memory";
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "it failed for an unknown reason";
  }
  return {};
}
}  // namespace understudy

/// Throws Error with the joined parts when the condition is false.
#define US_CHECK(condition, ...)                                                          \
  do {                                                                                    \
    if (!(condition)) throw ::understudy::Error(::understudy::detail::join(__VA_ARGS__)); \
  } while (false)
