#include "render/gl/program.hpp"

#include <vector>

#include "render/gl/scopes.hpp"
#include "retarget/base/error.hpp"

namespace understudy::render::gl {
namespace {

constexpr const char* kVersion = "#version 330 core\n";

Object<ShaderTraits> compiled(const std::string& name, GLenum stage, const std::string& source) {
  Object<ShaderTraits> shader(api().CreateShader(stage));
  const char* parts[] = {kVersion, source.c_str()};
  api().ShaderSource(shader.name(), 2, parts, nullptr);
  api().CompileShader(shader.name());
  GLint ok = 0;
  api().GetShaderiv(shader.name(), GL_COMPILE_STATUS, &ok);
  if (ok == GL_TRUE) return shader;
  std::vector<char> words(4096, '\0');
  api().GetShaderInfoLog(shader.name(), static_cast<GLsizei>(words.size()) - 1, nullptr, words.data());
  throw Error(detail::join("the ", name, " shader does not compile: ", words.data()));
}

}  // namespace

Program::Program(std::string name, const std::string& vertex_source, const std::string& fragment_source)
    : name_(std::move(name)) {
  const auto vertex = compiled(name_, GL_VERTEX_SHADER, vertex_source);
  const auto fragment = compiled(name_, GL_FRAGMENT_SHADER, fragment_source);
  api().AttachShader(id(), vertex.name());
  api().AttachShader(id(), fragment.name());
  api().LinkProgram(id());
  GLint ok = 0;
  api().GetProgramiv(id(), GL_LINK_STATUS, &ok);
  if (ok != GL_TRUE) {
    std::vector<char> words(4096, '\0');
    api().GetProgramInfoLog(id(), static_cast<GLsizei>(words.size()) - 1, nullptr, words.data());
    throw Error(detail::join("the ", name_, " shader does not link: ", words.data()));
  }
  const unsigned block = api().GetUniformBlockIndex(id(), "Frame");
  if (block != GL_INVALID_INDEX) api().UniformBlockBinding(id(), block, 0);
}

int Program::location(const char* uniform) const {
  const int location = api().GetUniformLocation(id(), uniform);
  US_CHECK(location >= 0, "the ", name_, " shader has no uniform ", uniform);
  return location;
}

void set_image(const Texture& texture, const TextureImage& image) {
  api().BindTexture(GL_TEXTURE_2D, texture.name());
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    api().TexParameteri(GL_TEXTURE_2D, filter, static_cast<GLint>(image.filter));
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    api().TexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
  api().TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(image.internal), image.width, image.height, 0,
                   image.format, image.type, image.pixels);
}

void attach(const Framebuffer& framebuffer, const Texture& texture, const TextureImage& image) {
  set_image(texture, image);
  const TargetScope target(framebuffer.name(), image.width, image.height);
  const GLenum part = image.format == GL_DEPTH_COMPONENT ? GL_DEPTH_ATTACHMENT : GL_COLOR_ATTACHMENT0;
  api().FramebufferTexture2D(GL_FRAMEBUFFER, part, GL_TEXTURE_2D, texture.name(), 0);
}

void upload(const Buffer& buffer, GLenum target, const void* data, size_t bytes) {
  api().BindBuffer(target, buffer.name());
  api().BufferData(target, static_cast<GLsizeiptr>(bytes), data, GL_STREAM_DRAW);
}

void use_attribute(unsigned index, const Buffer& buffer, int width) {
  api().BindBuffer(GL_ARRAY_BUFFER, buffer.name());
  api().EnableVertexAttribArray(index);
  api().VertexAttribPointer(index, width, GL_FLOAT, GL_FALSE, 0, nullptr);
}

void use_constant_attribute(unsigned index, const Eigen::Vector3f& value) {
  api().DisableVertexAttribArray(index);
  api().VertexAttrib3f(index, value.x(), value.y(), value.z());
}

}  // namespace understudy::render::gl
