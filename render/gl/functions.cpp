#include "render/gl/functions.hpp"

#include "retarget/base/error.hpp"

namespace understudy::render::gl {
namespace {
thread_local const Functions* current = nullptr;

template <class F>
void load(F& function, const GetProcAddress& address, const char* name) {
  function = reinterpret_cast<F>(address(name));
}
}  // namespace

Functions load_functions(const GetProcAddress& address) {
  Functions functions;
#define UNDERSTUDY_GL_LOAD(name)             \
  load(functions.name, address, "gl" #name); \
  US_CHECK(functions.name != nullptr, "this OpenGL has no function gl" #name);
  UNDERSTUDY_GL_FUNCTIONS(UNDERSTUDY_GL_LOAD)
#undef UNDERSTUDY_GL_LOAD
  load(functions.DebugMessageCallback, address, "glDebugMessageCallback");
  return functions;
}

const Functions& api() {
  US_CHECK(current != nullptr, "no OpenGL context is current on this thread");
  return *current;
}

void set_api(const Functions* functions) noexcept {
  current = functions;
}
const Functions* api_or_null() noexcept {
  return current;
}

}  // namespace understudy::render::gl
