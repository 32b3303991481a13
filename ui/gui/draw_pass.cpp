#include "ui/gui/draw_pass.hpp"

#include <cmath>
#include <cstddef>

#include "render/gl/debug.hpp"
#include "render/gl/scopes.hpp"

namespace understudy::ui {
namespace {

using render::gl::api;

const char* const kVertex = R"(
layout(location = 0) in vec2 a_position;  // pixels from the top left
layout(location = 1) in vec2 a_place;
layout(location = 2) in vec4 a_color;
uniform vec2 u_to_clip;
out vec2 v_place;
out vec4 v_color;
void main() {
  v_place = a_place;
  v_color = a_color;
  gl_Position = vec4(a_position.x * u_to_clip.x - 1.0, 1.0 - a_position.y * u_to_clip.y, 0.0, 1.0);
}
)";

const char* const kFragment = R"(
uniform sampler2D u_texture;
in vec2 v_place;
in vec4 v_color;
out vec4 o_color;
void main() { o_color = v_color * texture(u_texture, v_place); }
)";

static_assert(sizeof(ImDrawIdx) == 2, "indices are drawn as GL_UNSIGNED_SHORT");

const void* offset(size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

void describe_vertices() {
  const auto attribute = [](unsigned index, int count, GLenum type, size_t at) {
    api().EnableVertexAttribArray(index);
    api().VertexAttribPointer(index, count, type, type == GL_UNSIGNED_BYTE ? GL_TRUE : GL_FALSE,
                              sizeof(ImDrawVert), offset(at));
  };
  attribute(0, 2, GL_FLOAT, offsetof(ImDrawVert, pos));
  attribute(1, 2, GL_FLOAT, offsetof(ImDrawVert, uv));
  attribute(2, 4, GL_UNSIGNED_BYTE, offsetof(ImDrawVert, col));
}

}  // namespace

DrawPass::DrawPass() : program_("interface", kVertex, kFragment), to_clip_(program_, "u_to_clip") {
  const render::gl::VertexArrayScope array(vertex_array_.name());
  api().BindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  api().BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
  describe_vertices();
}

void DrawPass::draw(const ImDrawData& data, const ImFontAtlas& atlas, const render::Target& target) {
  if (data.TotalIdxCount == 0 || target.size.width <= 0 || target.size.height <= 0) return;
  upload_atlas(atlas);
  const render::gl::TargetScope canvas(target.framebuffer, target.size.width, target.size.height);
  const render::gl::ProgramScope program(program_.id());
  const render::gl::VertexArrayScope array(vertex_array_.name());
  const render::gl::BlendScope blend(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  const render::gl::CapabilityScope depth(GL_DEPTH_TEST, false), faces(GL_CULL_FACE, false),
      scissor(GL_SCISSOR_TEST, true), samples(GL_MULTISAMPLE, false);
  api().BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  upload_lists(data);
  to_clip_.set({2 / static_cast<float>(target.size.width), 2 / static_cast<float>(target.size.height)});
  draw_commands(data, target.size);
  render::gl::check_debug();
}

void DrawPass::upload_atlas(const ImFontAtlas& atlas) {
  api().ActiveTexture(GL_TEXTURE0);
  if (atlas.TexPixelsRGBA32 == atlas_pixels_ && atlas_pixels_ != nullptr) return;
  atlas_pixels_ = atlas.TexPixelsRGBA32;
  api().BindTexture(GL_TEXTURE_2D, atlas_.name());
  api().TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  api().TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  api().TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  api().TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  api().TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, atlas.TexWidth, atlas.TexHeight, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                   atlas.TexPixelsRGBA32);
}

/// All lists one after the other in one buffer for vertices and one for indices.
void DrawPass::upload_lists(const ImDrawData& data) {
  api().BindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  api().BufferData(GL_ARRAY_BUFFER, data.TotalVtxCount * static_cast<GLsizeiptr>(sizeof(ImDrawVert)), nullptr,
                   GL_STREAM_DRAW);
  api().BufferData(GL_ELEMENT_ARRAY_BUFFER, data.TotalIdxCount * static_cast<GLsizeiptr>(sizeof(ImDrawIdx)),
                   nullptr, GL_STREAM_DRAW);
  GLintptr vertex_at = 0, index_at = 0;
  for (int i = 0; i < data.CmdListsCount; ++i) {
    const ImDrawList& list = *data.CmdLists[i];
    api().BufferSubData(GL_ARRAY_BUFFER, vertex_at, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data);
    api().BufferSubData(GL_ELEMENT_ARRAY_BUFFER, index_at, list.IdxBuffer.size_in_bytes(),
                        list.IdxBuffer.Data);
    vertex_at += list.VtxBuffer.size_in_bytes();
    index_at += list.IdxBuffer.size_in_bytes();
  }
}

void DrawPass::draw_commands(const ImDrawData& data, render::PixelSize size) {
  unsigned bound = 0;  // what is bound already; the scene's passes leave anything
  int first_vertex = 0;
  size_t first_index = 0;
  for (int i = 0; i < data.CmdListsCount; ++i) {
    const ImDrawList& list = *data.CmdLists[i];
    for (const ImDrawCmd& command : list.CmdBuffer) {
      const int left = std::max(0, static_cast<int>(command.ClipRect.x)),
                top = std::max(0, static_cast<int>(command.ClipRect.y)),
                right = std::min(size.width, static_cast<int>(std::ceil(command.ClipRect.z))),
                bottom = std::min(size.height, static_cast<int>(std::ceil(command.ClipRect.w)));
      if (command.ElemCount == 0 || right <= left || bottom <= top) continue;
      const auto named = static_cast<unsigned>(reinterpret_cast<uintptr_t>(command.GetTexID()));
      const unsigned texture = named == 0 ? atlas_.name() : named;
      if (texture != bound) api().BindTexture(GL_TEXTURE_2D, bound = texture);
      api().Scissor(left, size.height - bottom, right - left, bottom - top);
      api().DrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount), GL_UNSIGNED_SHORT,
                                   offset((first_index + command.IdxOffset) * sizeof(ImDrawIdx)),
                                   first_vertex + static_cast<int>(command.VtxOffset));
    }
    first_vertex += list.VtxBuffer.Size;
    first_index += static_cast<size_t>(list.IdxBuffer.Size);
  }
}

}  // namespace understudy::ui
