// The ways to get a context, each in its own file.
#pragma once

#include <memory>

#include "render/context/context.hpp"

namespace understudy::render {

/// Each throws Error with the reason when it cannot make one. The context is not yet current.
std::unique_ptr<Context> make_egl_context(bool debug);
std::unique_ptr<Context> make_osmesa_context(bool debug);
std::unique_ptr<Context> make_null_context();

/// A shared library, open until the process ends: drivers start threads that do not survive dlclose.
class Library {
 public:
  explicit Library(const char* file);
  void* symbol(const char* name) const;  ///< throws Error when it is missing
 private:
  const char* file_;
  void* handle_;
};

/// A function of a library, with the type of its prototype.
template <class F>
F function(const Library& library, const char* name) {
  return reinterpret_cast<F>(library.symbol(name));
}

}  // namespace understudy::render
