// OpenGL 3.3 core contexts that need no window. A window's context (GLFW) implements the same class.
#pragma once

#include <memory>
#include <string>

#include "render/gl/debug.hpp"
#include "render/gl/functions.hpp"

namespace understudy::render {

/// A GL context; its names live as long as it does. One thread at a time.
class Context {
 public:
  virtual ~Context() = default;
  /// Makes it current on this thread and gl::api() its functions.
  virtual void make_current() = 0;
  /// Which library and driver, for people: "EGL, llvmpipe (LLVM 15.0.6, 256 bits)".
  virtual std::string description() const = 0;
};

enum class ContextKind {
  Any,     ///< EGL, or OSMesa where there is no EGL
  Egl,     ///< surfaceless EGL: graphics hardware or software, whatever Mesa finds
  Osmesa,  ///< software in this process, needs no display system at all
  Null     ///< draws nothing and counts; for tests
};

struct ContextOptions {
  ContextKind kind = ContextKind::Any;
  gl::DebugMode debug = gl::DebugMode::Off;
};

/// A context that draws offscreen, current on this thread. The libraries are loaded at run time. Throws Error
/// with what each of them said when none works.
std::unique_ptr<Context> make_offscreen_context(const ContextOptions& options = {});

/// What a null context saw.
struct NullCounts {
  int live_names = 0;  ///< GL names made and not deleted
  int draws = 0;       ///< glDrawArrays and glDrawElements
};
/// Counts of the null contexts of this thread.
NullCounts null_counts();

}  // namespace understudy::render
