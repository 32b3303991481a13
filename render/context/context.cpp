#include "render/context/context.hpp"

#include <dlfcn.h>

#include "render/context/backends.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy::render {

Library::Library(const char* file) : file_(file), handle_(dlopen(file, RTLD_NOW | RTLD_LOCAL)) {
  US_CHECK(handle_ != nullptr, file, " cannot be loaded");
}

void* Library::symbol(const char* name) const {
  void* found = dlsym(handle_, name);
  US_CHECK(found != nullptr, file_, " has no function ", name);
  return found;
}

namespace {

std::unique_ptr<Context> made(ContextKind kind, bool debug) {
  switch (kind) {
    case ContextKind::Egl:
      return make_egl_context(debug);
    case ContextKind::Osmesa:
      return make_osmesa_context(debug);
    default:
      return make_null_context();
  }
}

std::unique_ptr<Context> first_that_works(bool debug) {
  std::string why;
  for (const ContextKind kind : {ContextKind::Egl, ContextKind::Osmesa}) {
    try {
      auto context = made(kind, debug);
      context->make_current();
      return context;
    } catch (const Error& error) {
      append_item(why, error.what(), "; ");
    }
  }
  throw Error("no OpenGL 3.3 to draw with: " + why);
}

}  // namespace

std::unique_ptr<Context> make_offscreen_context(const ContextOptions& options) {
  const bool debug = options.debug != gl::DebugMode::Off;
  auto context = options.kind == ContextKind::Any ? first_that_works(debug) : made(options.kind, debug);
  context->make_current();
  gl::install_debug(options.debug);
  return context;
}

}  // namespace understudy::render
