#include "render/renderer.hpp"

#include <algorithm>
#include <cstring>

#include "render/gl/debug.hpp"
#include "render/gl/scopes.hpp"
#include "render/passes/background_pass.hpp"
#include "render/passes/ground_pass.hpp"
#include "render/passes/mesh_pass.hpp"
#include "render/passes/occlusion_pass.hpp"
#include "render/passes/points_pass.hpp"
#include "render/passes/skeleton_pass.hpp"
#include "retarget/base/error.hpp"

namespace understudy::render {
namespace {

/// The multisampled picture, its depth resolved for the passes that read it, and a plain picture to read
/// back.
class Canvas {
 public:
  explicit Canvas(int samples) {
    GLint most = 0;
    gl::api().GetIntegerv(GL_MAX_SAMPLES, &most);
    samples_ = std::clamp(samples, 1, std::max(1, most));
  }

  void resize(PixelSize size) {
    US_CHECK(size.width > 0 && size.height > 0 && size.width <= 16384 && size.height <= 16384,
             "a picture cannot be ", size.width, " x ", size.height, " pixels");
    if (size.width == size_.width && size.height == size_.height) return;
    size_ = size;
    attach_storage(many_, many_color_, samples_ > 1 ? samples_ : 0);
    attach_storage(one_, one_color_, 0);
    attach_depth();
    complete(many_);
    complete(one_);
  }

  /// Copies the depth of one sample a pixel into depth_texture().
  void resolve_depth() const { blit(many_.name(), one_.name(), GL_DEPTH_BUFFER_BIT); }
  /// Averages the samples into `framebuffer`.
  void resolve_color(unsigned framebuffer) const { blit(many_.name(), framebuffer, GL_COLOR_BUFFER_BIT); }
  unsigned framebuffer() const { return many_.name(); }
  unsigned plain_framebuffer() const { return one_.name(); }
  unsigned depth_texture() const { return depth_texture_.name(); }

 private:
  void attach_storage(const gl::Framebuffer& framebuffer, const gl::Renderbuffer& color, int samples) const {
    gl::api().BindRenderbuffer(GL_RENDERBUFFER, color.name());
    gl::api().RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA8, size_.width, size_.height);
    const gl::TargetScope target(framebuffer.name(), size_.width, size_.height);
    gl::api().FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color.name());
  }

  void attach_depth() const {
    gl::api().BindRenderbuffer(GL_RENDERBUFFER, many_depth_.name());
    gl::api().RenderbufferStorageMultisample(GL_RENDERBUFFER, samples_ > 1 ? samples_ : 0,
                                             GL_DEPTH_COMPONENT24, size_.width, size_.height);
    {
      const gl::TargetScope target(many_.name(), size_.width, size_.height);
      gl::api().FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                                        many_depth_.name());
    }
    gl::api().BindTexture(GL_TEXTURE_2D, depth_texture_.name());
    gl::api().TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, size_.width, size_.height, 0,
                         GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, nullptr);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
      gl::api().TexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
      gl::api().TexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
    const gl::TargetScope target(one_.name(), size_.width, size_.height);
    gl::api().FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_texture_.name(),
                                   0);
  }

  void complete(const gl::Framebuffer& framebuffer) const {
    const gl::TargetScope target(framebuffer.name(), size_.width, size_.height);
    US_CHECK(gl::api().CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE,
             "OpenGL makes no framebuffer of ", size_.width, " x ", size_.height, " pixels with ", samples_,
             " samples");
  }

  void blit(unsigned from, unsigned to, GLbitfield what) const {
    const gl::TargetScope restore(from, size_.width, size_.height);
    gl::api().BindFramebuffer(GL_DRAW_FRAMEBUFFER, to);
    gl::api().BlitFramebuffer(0, 0, size_.width, size_.height, 0, 0, size_.width, size_.height, what,
                              GL_NEAREST);
  }

  int samples_ = 1;
  PixelSize size_;
  gl::Framebuffer many_, one_;
  gl::Renderbuffer many_color_, many_depth_, one_color_;
  gl::Texture depth_texture_;
};

}  // namespace

struct Renderer::Parts {
  explicit Parts(const RendererOptions& options) : canvas(options.samples) {}

  void draw_solid(const Scene& scene);
  void draw_over(const Scene& scene);

  Canvas canvas;
  FrameBlock frame;
  BackgroundPass background;
  MeshPass meshes;
  PointsPass points;
  SkeletonPass skeletons;
  OcclusionPass occlusion;
  GroundPass ground;
};

void Renderer::Parts::draw_solid(const Scene& scene) {
  for (const auto& mesh : scene.meshes)
    if (mesh.opacity >= 1) meshes.draw(mesh);
  for (const auto& skeleton : scene.skeletons)
    if (!skeleton.x_ray) skeletons.draw(meshes, skeleton);
}

/// What lies over the opaque part: see-through meshes, then the skeletons that show through everything.
void Renderer::Parts::draw_over(const Scene& scene) {
  for (const auto& mesh : scene.meshes)
    if (mesh.opacity < 1) meshes.draw(mesh);
  gl::api().Clear(GL_DEPTH_BUFFER_BIT);
  for (const auto& skeleton : scene.skeletons)
    if (skeleton.x_ray) skeletons.draw(meshes, skeleton);
}

Renderer::Renderer(const RendererOptions& options) : parts_(std::make_unique<Parts>(options)) {
  gl::check_debug();
}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::draw(const Scene& scene, const Camera& camera, const Target& target) {
  Parts& p = *parts_;
  for (const auto& mesh : scene.meshes) check(mesh);
  p.canvas.resize(target.size);
  {
    const gl::TargetScope canvas(p.canvas.framebuffer(), target.size.width, target.size.height);
    const gl::CapabilityScope depth(GL_DEPTH_TEST, true), samples(GL_MULTISAMPLE, true);
    p.frame.set(camera, scene.light, target.size);
    gl::api().Clear(GL_DEPTH_BUFFER_BIT);
    p.background.draw(scene.background);
    p.draw_solid(scene);
    if (scene.occlusion > 0 && !scene.meshes.empty()) {
      p.canvas.resolve_depth();
      p.occlusion.draw(p.canvas.depth_texture(), target.size, scene.occlusion);
    }
    for (const auto& cloud : scene.clouds) p.points.draw(cloud);  // too rough for occlusion from depth
    p.ground.draw(scene);
    p.draw_over(scene);
  }
  p.canvas.resolve_color(target.framebuffer);
  gl::check_debug();
}

Image Renderer::render_image(const Scene& scene, const Camera& camera, PixelSize size) {
  Canvas& canvas = parts_->canvas;
  canvas.resize(size);
  draw(scene, camera, {canvas.plain_framebuffer(), size});
  Image bottom_up(size.width, size.height), image(size.width, size.height);
  {
    const gl::TargetScope source(canvas.plain_framebuffer(), size.width, size.height);
    gl::api().PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl::api().ReadPixels(0, 0, size.width, size.height, GL_RGB, GL_UNSIGNED_BYTE, bottom_up.pixels.data());
  }
  for (int y = 0; y < size.height; ++y)
    std::memcpy(image.at(0, y), bottom_up.at(0, size.height - 1 - y), static_cast<size_t>(size.width) * 3);
  gl::check_debug();
  return image;
}

}  // namespace understudy::render
