// Draws scenes into framebuffers and pictures.
#pragma once

#include <memory>

#include "render/camera.hpp"
#include "render/image.hpp"
#include "render/passes/frame.hpp"
#include "render/scene.hpp"

namespace understudy::render {

enum class Quality {
  Interactive,  ///< for views at many pictures a second: occlusion is what the meshes' ambient values say
  Best          ///< for pictures: occlusion also of what touches in this very pose, from the depths seen
};

struct RendererOptions {
  int samples = 4;  ///< a pixel, against jagged edges; fewer where the driver has fewer
  Quality quality = Quality::Best;
  /// with one sample a pixel: soften edges afterwards, which costs software OpenGL far less
  bool smooth = true;
};

/// Where to draw: a framebuffer (0: the window's) and its size.
struct RenderTarget {
  unsigned framebuffer = 0;
  PixelSize size;
};

/// Owns the passes and the multisampled picture they draw into. Make, use and destroy it with one context
/// current.
class Renderer {
 public:
  /// Throws Error when no context is current or its OpenGL lacks something.
  explicit Renderer(const RendererOptions& options = {});
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Draws the scene over all of the target. Throws Error when the scene's arrays do not fit together, and,
  /// where the context's messages are fatal, with the first of them.
  void draw(const Scene& scene, const Camera& camera, const RenderTarget& target);
  /// Draws into a picture of its own and reads it back.
  Image render_image(const Scene& scene, const Camera& camera, PixelSize size);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace understudy::render
