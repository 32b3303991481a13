#include "render/gl/debug.hpp"

#include <string>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"

namespace understudy::render::gl {
namespace {

thread_local DebugMode current_mode = DebugMode::Off;
thread_local std::string first_message;

void APIENTRY on_message(GLenum, GLenum type, GLuint, GLenum, GLsizei length, const GLchar* text,
                         const void*) {
  if (type != GL_DEBUG_TYPE_ERROR && type != GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR) return;
  const std::string words(text,
                          length < 0 ? std::char_traits<char>::length(text) : static_cast<size_t>(length));
  if (current_mode == DebugMode::Log) log::warn_once("OpenGL: " + words);
  if (first_message.empty()) first_message = words;
}

}  // namespace

void install_debug(DebugMode mode) {
  current_mode = mode;
  first_message.clear();
  if (mode == DebugMode::Off || api().DebugMessageCallback == nullptr) return;
  api().Enable(GL_DEBUG_OUTPUT);
  api().Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  api().DebugMessageCallback(on_message, nullptr);
}

void check_debug() {
  if (current_mode != DebugMode::Fatal) return;
  if (const GLenum code = api().GetError(); code != GL_NO_ERROR && first_message.empty())
    first_message = detail::join("error 0x", std::hex, code);
  if (!first_message.empty()) throw Error("OpenGL: " + std::exchange(first_message, {}));
}

}  // namespace understudy::render::gl
