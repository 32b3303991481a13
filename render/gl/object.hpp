// Owners of GL names.
#pragma once

#include <utility>

#include "render/gl/functions.hpp"

namespace understudy::render::gl {

/// Owns one GL name. Move-only; 0 means empty. Destroy on the thread whose context made it.
template <class Traits>
class Object {
 public:
  Object() : name_(Traits::create()) {}
  /// For names that need an argument to make (a shader's stage): owns `name` from here on.
  explicit Object(unsigned name) noexcept : name_(name) {}
  ~Object() {
    if (name_ != 0) Traits::destroy(name_);
  }
  Object(Object&& other) noexcept : name_(std::exchange(other.name_, 0u)) {}
  Object& operator=(Object&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;
  unsigned name() const { return name_; }

 private:
  unsigned name_ = 0;
};

// A name whose context has gone went with it: destroy() then has nothing to call.
#define UNDERSTUDY_GL_TRAITS(type, plural)                                   \
  struct type##Traits {                                                      \
    static unsigned create() {                                               \
      unsigned name = 0;                                                     \
      api().Gen##plural(1, &name);                                           \
      return name;                                                           \
    }                                                                        \
    static void destroy(unsigned name) noexcept {                            \
      if (const Functions* gl = api_or_null()) gl->Delete##plural(1, &name); \
    }                                                                        \
  };                                                                         \
  using type = Object<type##Traits>;
UNDERSTUDY_GL_TRAITS(Buffer, Buffers)
UNDERSTUDY_GL_TRAITS(VertexArray, VertexArrays)
UNDERSTUDY_GL_TRAITS(Texture, Textures)
UNDERSTUDY_GL_TRAITS(Framebuffer, Framebuffers)
UNDERSTUDY_GL_TRAITS(Renderbuffer, Renderbuffers)
#undef UNDERSTUDY_GL_TRAITS

struct ShaderTraits {
  static void destroy(unsigned name) noexcept {
    if (const Functions* gl = api_or_null()) gl->DeleteShader(name);
  }
};
struct ProgramTraits {
  static unsigned create() { return api().CreateProgram(); }
  static void destroy(unsigned name) noexcept {
    if (const Functions* gl = api_or_null()) gl->DeleteProgram(name);
  }
};

}  // namespace understudy::render::gl
