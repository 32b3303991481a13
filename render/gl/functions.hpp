// The OpenGL 3.3 core functions the renderer calls, as pointers loaded from whichever library made the
// context. A table of our own rather than a loader library: EGL, OSMesa, a window and the null context fill
// the same one.
#pragma once

#include <functional>

#define GL_GLEXT_PROTOTYPES  // declares the prototypes whose types the table takes; nothing links to them
#include <GL/glcorearb.h>

// clang-format off
#define UNDERSTUDY_GL_FUNCTIONS(X) \
  X(ActiveTexture) X(AttachShader) X(BindAttribLocation) X(BindBuffer) X(BindBufferBase) X(BindFramebuffer) \
  X(BindRenderbuffer) X(BindTexture) X(BindVertexArray) X(BlendEquation) X(BlendFunc) X(BlendFuncSeparate) \
  X(BlitFramebuffer) X(BufferData) X(BufferSubData) X(CheckFramebufferStatus) X(Clear) X(ClearColor) \
  X(ColorMask) X(CompileShader) X(CreateProgram) X(CreateShader) X(CullFace) X(DeleteBuffers) \
  X(DeleteFramebuffers) X(DeleteProgram) X(DeleteRenderbuffers) X(DeleteShader) X(DeleteTextures) \
  X(DeleteVertexArrays) X(DepthFunc) X(DepthMask) X(DepthRange) X(Disable) X(DisableVertexAttribArray) \
  X(DrawArrays) X(DrawElements) X(DrawElementsBaseVertex) X(Enable) X(EnableVertexAttribArray) X(Finish) \
  X(FramebufferRenderbuffer) X(FramebufferTexture2D) X(GenBuffers) X(GenFramebuffers) X(GenRenderbuffers) \
  X(GenTextures) X(GenVertexArrays) X(GetBooleanv) X(GetError) X(GetIntegerv) X(GetProgramInfoLog) \
  X(GetProgramiv) X(GetShaderInfoLog) X(GetShaderiv) X(GetString) X(GetStringi) X(GetUniformBlockIndex) \
  X(GetUniformLocation) X(IsEnabled) X(LinkProgram) X(PixelStorei) X(PolygonMode) X(PolygonOffset) X(ReadBuffer) \
  X(ReadPixels) X(RenderbufferStorageMultisample) X(Scissor) X(ShaderSource) X(TexImage2D) X(TexParameteri) \
  X(Uniform1f) X(Uniform1i) X(Uniform2f) X(Uniform3f) X(Uniform4f) X(UniformBlockBinding) \
  X(UniformMatrix4fv) X(UseProgram) X(VertexAttrib3f) X(VertexAttribPointer) X(Viewport)
// clang-format on

namespace understudy::render::gl {

struct Functions {
#define UNDERSTUDY_GL_MEMBER(name) decltype(&::gl##name) name = nullptr;
  UNDERSTUDY_GL_FUNCTIONS(UNDERSTUDY_GL_MEMBER)
#undef UNDERSTUDY_GL_MEMBER
  decltype(&::glDebugMessageCallback) DebugMessageCallback = nullptr;  ///< null without KHR_debug
};

/// Address of a GL function by its full name, null when there is none.
using GetProcAddress = std::function<void*(const char*)>;

/// Loads every function; throws Error naming the first that is missing (KHR_debug's may be).
Functions load_functions(const GetProcAddress& address);

/// The functions of the context that is current on this thread. Throws Error when there is none.
const Functions& api();
/// Sets them (null: none); contexts call this from make_current().
void set_api(const Functions* functions) noexcept;
/// The same without a throw, for destructors: null when no context is current.
const Functions* api_or_null() noexcept;

}  // namespace understudy::render::gl
