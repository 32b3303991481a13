// State scopes: each changes one piece of GL state and puts back what was there when it ends.
#pragma once

#include <array>

#include "render/gl/functions.hpp"

namespace understudy::render::gl {

/// Base of all scopes: neither copied nor moved.
struct Scope {
  Scope() = default;
  Scope(const Scope&) = delete;
  Scope& operator=(const Scope&) = delete;
};

/// glEnable or glDisable of one capability.
class CapabilityScope : Scope {
 public:
  CapabilityScope(GLenum capability, bool on)
      : capability_(capability), before_(api().IsEnabled(capability) == GL_TRUE) {
    set(on);
  }
  ~CapabilityScope() { set(before_); }

 private:
  void set(bool on) { on ? api().Enable(capability_) : api().Disable(capability_); }
  GLenum capability_;
  bool before_;
};

/// Binds or sets one thing; `kState` asks which was there, `kSet` is the function of the table that sets it.
template <GLenum kState, auto kSet>
class ValueScope : Scope {
 public:
  explicit ValueScope(unsigned value) {
    api().GetIntegerv(kState, &before_);
    (api().*kSet)(value);
  }
  ~ValueScope() { (api().*kSet)(static_cast<unsigned>(before_)); }

 private:
  GLint before_ = 0;
};
using ProgramScope = ValueScope<GL_CURRENT_PROGRAM, &Functions::UseProgram>;
using VertexArrayScope = ValueScope<GL_VERTEX_ARRAY_BINDING, &Functions::BindVertexArray>;
using DepthFuncScope = ValueScope<GL_DEPTH_FUNC, &Functions::DepthFunc>;

/// Draws into a framebuffer of a size in pixels; restores both bindings and the viewport.
class TargetScope : Scope {
 public:
  TargetScope(unsigned framebuffer, int width, int height) {
    api().GetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &draw_);
    api().GetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &read_);
    api().GetIntegerv(GL_VIEWPORT, viewport_.data());
    api().BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    api().Viewport(0, 0, width, height);
  }
  ~TargetScope() {
    api().BindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<unsigned>(draw_));
    api().BindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<unsigned>(read_));
    api().Viewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
  }

 private:
  GLint draw_ = 0, read_ = 0;
  std::array<GLint, 4> viewport_{};
};

/// Draws inside one rectangle only, pixels from the bottom left.
class ScissorScope : Scope {
 public:
  ScissorScope(int x, int y, int width, int height) : enabled_(GL_SCISSOR_TEST, true) {
    api().GetIntegerv(GL_SCISSOR_BOX, before_.data());
    api().Scissor(x, y, width, height);
  }
  ~ScissorScope() { api().Scissor(before_[0], before_[1], before_[2], before_[3]); }

 private:
  CapabilityScope enabled_;
  std::array<GLint, 4> before_{};
};

/// Blending of the whole colour, alpha included.
class BlendScope : Scope {
 public:
  BlendScope(GLenum source, GLenum destination, GLenum equation = GL_FUNC_ADD) : enabled_(GL_BLEND, true) {
    api().GetIntegerv(GL_BLEND_SRC_RGB, &source_);
    api().GetIntegerv(GL_BLEND_DST_RGB, &destination_);
    api().GetIntegerv(GL_BLEND_EQUATION_RGB, &equation_);
    api().BlendFunc(source, destination);
    api().BlendEquation(equation);
  }
  ~BlendScope() {
    api().BlendFunc(static_cast<GLenum>(source_), static_cast<GLenum>(destination_));
    api().BlendEquation(static_cast<GLenum>(equation_));
  }

 private:
  CapabilityScope enabled_;
  GLint source_ = 0, destination_ = 0, equation_ = 0;
};

/// Whether depth is written.
class DepthMaskScope : Scope {
 public:
  explicit DepthMaskScope(bool on) {
    api().GetBooleanv(GL_DEPTH_WRITEMASK, &before_);
    api().DepthMask(on ? GL_TRUE : GL_FALSE);
  }
  ~DepthMaskScope() { api().DepthMask(before_); }

 private:
  GLboolean before_ = GL_TRUE;
};

/// Whether colour is written.
class ColorMaskScope : Scope {
 public:
  explicit ColorMaskScope(bool on) {
    api().GetBooleanv(GL_COLOR_WRITEMASK, before_.data());
    const GLboolean value = on ? GL_TRUE : GL_FALSE;
    api().ColorMask(value, value, value, value);
  }
  ~ColorMaskScope() { api().ColorMask(before_[0], before_[1], before_[2], before_[3]); }

 private:
  std::array<GLboolean, 4> before_{};
};

/// Faces drawn as their edges, moved towards the eye by an offset (glPolygonOffset),
/// which counts in here alone.
class EdgesScope : Scope {
 public:
  EdgesScope(float factor, float units) : moved_(GL_POLYGON_OFFSET_LINE, true) {
    api().GetIntegerv(GL_POLYGON_MODE, before_.data());
    api().PolygonOffset(factor, units);
    api().PolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  }
  ~EdgesScope() { api().PolygonMode(GL_FRONT_AND_BACK, static_cast<GLenum>(before_[0])); }

 private:
  CapabilityScope moved_;
  std::array<GLint, 2> before_{};  // some drivers write two, of the front and of the back
};

}  // namespace understudy::render::gl
