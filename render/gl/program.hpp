// Shader programs and their uniforms.
#pragma once

#include <Eigen/Core>
#include <string>
#include <type_traits>

#include "render/gl/object.hpp"

namespace understudy::render::gl {

/// A linked program. Throws Error with the compiler's words when a stage does not compile or link.
class Program {
 public:
  /// `name` is for messages. Both sources begin after the version line; attributes are bound by their layout
  /// qualifiers, the uniform block `Frame`, where a source has one, to binding 0.
  Program(std::string name, const std::string& vertex_source, const std::string& fragment_source);
  unsigned id() const { return program_.name(); }
  const std::string& name() const { return name_; }
  /// Location of a uniform; throws Error when the program has no such active uniform.
  int location(const char* uniform) const;

 private:
  std::string name_;
  Object<ProgramTraits> program_;
};

/// One uniform of one program, declared as a member beside it so that a wrong name fails at start-up. Setting
/// it needs the program in use.
template <class T>
class Uniform {
 public:
  Uniform(const Program& program, const char* name) : location_(program.location(name)) {}
  void set(const T& value) const {
    if constexpr (std::is_same_v<T, float>)
      api().Uniform1f(location_, value);
    else if constexpr (std::is_same_v<T, int>)
      api().Uniform1i(location_, value);
    else if constexpr (std::is_same_v<T, Eigen::Vector2f>)
      api().Uniform2f(location_, value.x(), value.y());
    else if constexpr (std::is_same_v<T, Eigen::Vector3f>)
      api().Uniform3f(location_, value.x(), value.y(), value.z());
    else
      api().Uniform4f(location_, value.x(), value.y(), value.z(), value.w());
  }

 private:
  int location_;
};

/// The picture that a texture gets: its format, size and pixels (null: undefined ones).
struct TextureImage {
  int width = 0, height = 0;
  GLenum internal = GL_RGBA8, format = GL_RGBA, type = GL_UNSIGNED_BYTE;
  GLenum filter = GL_LINEAR;
  const void* pixels = nullptr;
};
/// Binds the texture, gives it the picture, and clamps it at its edges.
void set_image(const Texture& texture, const TextureImage& image);
/// The same, and what is drawn into the framebuffer (its depth where the format is one) goes into the
/// texture.
void attach(const Framebuffer& framebuffer, const Texture& texture, const TextureImage& image);

/// Replaces a buffer's contents with `bytes` bytes.
void upload(const Buffer& buffer, GLenum target, const void* data, size_t bytes);

/// An attribute of the bound vertex array: rows of `width` floats (1..4), one for each vertex.
void use_attribute(unsigned index, const Buffer& buffer, int width);
/// Gives attribute `index` of the bound vertex array one value for every vertex.
void use_constant_attribute(unsigned index, const Eigen::Vector3f& value);

}  // namespace understudy::render::gl
