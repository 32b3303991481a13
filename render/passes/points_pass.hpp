// Points as lit round discs, tilted along their normals, or small balls where there are none.
#pragma once

#include "render/gl/array_cache.hpp"
#include "render/gl/program.hpp"
#include "render/scene.hpp"

namespace understudy::render {

class PointsPass {
 public:
  /// `arrays` outlives the pass.
  explicit PointsPass(gl::ArrayCache& arrays);
  /// Throws Error when normals or colours are of another number than the points. multisampled: of the target
  /// that is bound.
  void draw(const PointsView& view, bool multisampled);

 private:
  struct Kind {
    Kind(const char* name, const std::string& vertex, const std::string& fragment);
    gl::Program program;
    gl::Uniform<float> radius{program, "u_radius"}, smooth{program, "u_smooth"};
  };

  gl::ArrayCache& arrays_;
  Kind discs_, balls_;
  gl::VertexArray disc_array_, ball_array_;
};

}  // namespace understudy::render
