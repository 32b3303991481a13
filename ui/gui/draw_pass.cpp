#include "ui/gui/draw_pass.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

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

void DrawPass::present(const ImDrawData& data, const ImFontAtlas& atlas, const render::RenderTarget& target,
                       const ImVec4& backdrop) {
  if (target.size.width <= 0 || target.size.height <= 0) return;
  const bool new_letters = atlas.TexPixelsRGBA32 != atlas_pixels_;
  const bool new_backdrop = std::memcmp(&backdrop, &backdrop_, sizeof backdrop) != 0;
  const bool new_size = canvas_size_.width != target.size.width || canvas_size_.height != target.size.height;
  if (new_letters || new_backdrop || new_size) damage_.forget();
  backdrop_ = backdrop;
  upload_atlas(atlas);
  canvas_size_ = target.size;
  if (new_size)
    render::gl::attach(
        framebuffer_, canvas_,
        {target.size.width, target.size.height, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, GL_NEAREST});
  const std::vector<Rect> rects = damage_.update(data);
  const int width = target.size.width, height = target.size.height;
  const render::gl::TargetScope canvas(framebuffer_.name(), width, height);
  if (!rects.empty()) draw_rects(data, rects);
  api().BindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer);
  api().BlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  render::gl::check_debug();
}

void DrawPass::upload_atlas(const ImFontAtlas& atlas) {
  api().ActiveTexture(GL_TEXTURE0);
  if (atlas.TexPixelsRGBA32 == atlas_pixels_ && atlas_pixels_ != nullptr) return;
  atlas_pixels_ = atlas.TexPixelsRGBA32;
  render::gl::set_image(atlas_, {atlas.TexWidth, atlas.TexHeight, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE,
                                 GL_LINEAR, atlas.TexPixelsRGBA32});
}

/// All lists one after the other in one buffer.
void DrawPass::upload_vertices(const ImDrawData& data) {
  api().BindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  api().BufferData(GL_ARRAY_BUFFER, data.TotalVtxCount * static_cast<GLsizeiptr>(sizeof(ImDrawVert)), nullptr,
                   GL_STREAM_DRAW);
  GLintptr at = 0;
  for (int i = 0; i < data.CmdListsCount; ++i) {
    const ImVector<ImDrawVert>& vertices = data.CmdLists[i]->VtxBuffer;
    api().BufferSubData(GL_ARRAY_BUFFER, at, vertices.size_in_bytes(), vertices.Data);
    at += vertices.size_in_bytes();
  }
}

/// Draws everything inside each rectangle, over the backdrop.
void DrawPass::draw_rects(const ImDrawData& data, const std::vector<Rect>& rects) {
  const render::gl::ProgramScope program(program_.id());
  const render::gl::VertexArrayScope array(vertex_array_.name());
  const render::gl::BlendScope blend(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  const render::gl::CapabilityScope depth(GL_DEPTH_TEST, false), faces(GL_CULL_FACE, false),
      scissor(GL_SCISSOR_TEST, true), samples(GL_MULTISAMPLE, false);
  api().BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  to_clip_.set({2 / static_cast<float>(canvas_size_.width), 2 / static_cast<float>(canvas_size_.height)});
  calls_.clear(), all_indices_.clear();
  std::vector<size_t> ends;  // where each rectangle's calls end
  for (const Rect& rect : rects) collect(data, rect), ends.push_back(calls_.size());
  upload_vertices(data);
  render::gl::upload(indices_, GL_ELEMENT_ARRAY_BUFFER, all_indices_.data(),
                     all_indices_.size() * sizeof(ImDrawIdx));
  for (size_t i = 0; i < rects.size(); ++i) {
    const Rect& r = rects[i];
    api().Scissor(static_cast<int>(r.min.x), canvas_size_.height - static_cast<int>(r.max.y),
                  static_cast<int>(r.width()), static_cast<int>(r.height()));
    api().ClearColor(backdrop_.x, backdrop_.y, backdrop_.z, backdrop_.w);
    api().Clear(GL_COLOR_BUFFER_BIT);
    issue(i == 0 ? 0 : ends[i - 1], ends[i]);
  }
}

void DrawPass::collect(const ImDrawData& data, const Rect& rect) {
  int first_vertex = 0;
  for (int i = 0; i < data.CmdListsCount; ++i) {
    const ImDrawList& list = *data.CmdLists[i];
    for (const ImDrawCmd& command : list.CmdBuffer) {
      const ImVec4& c = command.ClipRect;
      const Rect clip =
          intersection(rect, {{std::floor(c.x), std::floor(c.y)}, {std::ceil(c.z), std::ceil(c.w)}});
      if (!clip.empty()) collect(list, command, clip, first_vertex + static_cast<int>(command.VtxOffset));
    }
    first_vertex += list.VtxBuffer.Size;
  }
}

/// A call with those of the command's triangles that reach into `clip`.
void DrawPass::collect(const ImDrawList& list, const ImDrawCmd& command, const Rect& clip, int first_vertex) {
  const auto named = static_cast<unsigned>(reinterpret_cast<uintptr_t>(command.GetTexID()));
  Call call{named == 0 ? atlas_.name() : named, clip, named == 0, all_indices_.size(), 0, first_vertex};
  const ImDrawVert* vertices = list.VtxBuffer.Data + command.VtxOffset;
  const ImDrawIdx* index = list.IdxBuffer.Data + command.IdxOffset;
  for (const ImDrawIdx* end = index + command.ElemCount; index < end; index += 3) {
    const ImVec2 &a = vertices[index[0]].pos, &b = vertices[index[1]].pos, &c = vertices[index[2]].pos;
    if (std::max({a.x, b.x, c.x}) < clip.min.x || std::min({a.x, b.x, c.x}) > clip.max.x ||
        std::max({a.y, b.y, c.y}) < clip.min.y || std::min({a.y, b.y, c.y}) > clip.max.y)
      continue;
    all_indices_.insert(all_indices_.end(), index, index + 3);
    for (int k = 0; k < 3; ++k) call.blend |= vertices[index[k]].col >> IM_COL32_A_SHIFT != 255;
  }
  call.count = static_cast<int>(all_indices_.size() - call.first_index);
  if (call.count > 0) calls_.push_back(call);
}

void DrawPass::issue(size_t from, size_t to) {
  unsigned bound = 0;
  bool blending = true;
  for (size_t i = from; i < to; ++i) {
    const Call& call = calls_[i];
    if (call.texture != bound) api().BindTexture(GL_TEXTURE_2D, bound = call.texture);
    if (call.blend != blending) (blending = call.blend) ? api().Enable(GL_BLEND) : api().Disable(GL_BLEND);
    const int left = std::max(0, static_cast<int>(call.clip.min.x)),
              top = std::max(0, static_cast<int>(call.clip.min.y)),
              right = std::min(canvas_size_.width, static_cast<int>(call.clip.max.x)),
              bottom = std::min(canvas_size_.height, static_cast<int>(call.clip.max.y));
    if (right <= left || bottom <= top) continue;
    api().Scissor(left, canvas_size_.height - bottom, right - left, bottom - top);
    api().DrawElementsBaseVertex(GL_TRIANGLES, call.count, GL_UNSIGNED_SHORT,
                                 offset(call.first_index * sizeof(ImDrawIdx)), call.first_vertex);
  }
  if (!blending) api().Enable(GL_BLEND);
}

}  // namespace understudy::ui
