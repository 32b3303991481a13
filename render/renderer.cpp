#include "render/renderer.hpp"

#include <algorithm>
#include <string>

#include "render/gizmo.hpp"
#include "render/gl/debug.hpp"
#include "render/gl/scopes.hpp"
#include "render/passes/cover_passes.hpp"
#include "render/passes/ground_pass.hpp"
#include "render/passes/lines_pass.hpp"
#include "render/passes/mesh_pass.hpp"
#include "render/passes/occlusion_pass.hpp"
#include "render/passes/points_pass.hpp"
#include "render/solids.hpp"
#include "retarget/base/error.hpp"

namespace understudy::render {
namespace {

/// The pictures drawn into: the one in work, with as many samples as wanted; one of the same kind that keeps
/// what stands still; a plain one to read back.
class Canvas {
 public:
  explicit Canvas(int samples) {
    GLint most = 0;
    gl::api().GetIntegerv(GL_MAX_SAMPLES, &most);
    samples_ = std::clamp(samples, 1, std::max(1, most));
  }

  int samples() const { return samples_; }
  /// Whether the size is another one and all pictures are lost.
  bool resize(PixelSize size) {
    US_CHECK(size.width > 0 && size.height > 0 && size.width <= 16384 && size.height <= 16384,
             "a picture cannot be ", size.width, " x ", size.height, " pixels");
    if (same(size, size_)) return false;
    size_ = size;
    attach_samples(still_, still_color_, GL_RGBA8, samples_);
    attach_samples(plain_, plain_color_, GL_RGBA8, 1);
    if (samples_ > 1) {
      attach_samples(work_, work_color_, GL_RGBA8, samples_);
      attach_samples(work_, work_depth_, GL_DEPTH_COMPONENT24, samples_);
      attach_depth_texture(plain_);
    } else {
      gl::attach(work_, color_texture_, {size_.width, size_.height});
      attach_depth_texture(work_);
    }
    for (const gl::Framebuffer* each : {&work_, &still_, &plain_}) complete(*each);
    return true;
  }

  unsigned work() const { return work_.name(); }
  unsigned still() const { return still_.name(); }
  unsigned plain() const { return plain_.name(); }
  /// The picture in work, where it has one sample a pixel.
  unsigned color_texture() const { return color_texture_.name(); }
  unsigned depth_texture() const { return depth_texture_.name(); }
  void copy_still() const { blit(still(), work(), GL_COLOR_BUFFER_BIT); }
  /// One sample's depth of each pixel into depth_texture().
  void resolve_depth() const {
    if (samples_ > 1) blit(work(), plain(), GL_DEPTH_BUFFER_BIT);
  }
  /// The samples' means into `framebuffer`.
  void resolve_color(unsigned framebuffer) const { blit(work(), framebuffer, GL_COLOR_BUFFER_BIT); }

 private:
  void attach_samples(const gl::Framebuffer& framebuffer, const gl::Renderbuffer& to, GLenum format,
                      int samples) const {
    gl::api().BindRenderbuffer(GL_RENDERBUFFER, to.name());
    gl::api().RenderbufferStorageMultisample(GL_RENDERBUFFER, samples > 1 ? samples : 0, format, size_.width,
                                             size_.height);
    const gl::TargetScope target(framebuffer.name(), size_.width, size_.height);
    gl::api().FramebufferRenderbuffer(GL_FRAMEBUFFER,
                                      format == GL_RGBA8 ? GL_COLOR_ATTACHMENT0 : GL_DEPTH_ATTACHMENT,
                                      GL_RENDERBUFFER, to.name());
  }

  void attach_depth_texture(const gl::Framebuffer& framebuffer) const {
    gl::attach(
        framebuffer, depth_texture_,
        {size_.width, size_.height, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, GL_NEAREST});
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
  gl::Framebuffer work_, still_, plain_;
  gl::Renderbuffer work_color_, work_depth_, still_color_, plain_color_;
  gl::Texture color_texture_, depth_texture_;
};

/// A person's folds are shallow: they need more strength than occlusion from depth to be as visible.
float ambient_strength(const Scene& scene) {
  return std::min(1.f, 1.6f * scene.occlusion);
}

/// The rectangle of a picture that what is drawn covers, pixels from the bottom left, `margin` more all
/// round; everything when part of it is behind the eye.
struct Rectangle {
  int x = 0, y = 0, width = 0, height = 0;
};
Rectangle covered(const Points& corners, const Camera& camera, PixelSize size, float margin) {
  if (corners.rows() == 0) return {};
  Eigen::Vector2f low(1e6f, 1e6f), high(-1e6f, -1e6f);
  for (Eigen::Index i = 0; i < corners.rows(); ++i) {
    const Vec3 at = on_screen(camera, size, corners.row(i));
    if (!camera.orthographic && at.z() < 0.01f) return {0, 0, size.width, size.height};
    low = low.cwiseMin(at.head<2>());
    high = high.cwiseMax(at.head<2>());
  }
  const auto inside = [](float value, int most) {
    return static_cast<int>(std::clamp(value, 0.f, static_cast<float>(most)));
  };
  const int left = inside(low.x() - margin, size.width), right = inside(high.x() + margin, size.width);
  const int top = inside(low.y() - margin, size.height), bottom = inside(high.y() + margin, size.height);
  return {left, size.height - bottom, right - left, bottom - top};
}

/// Corners of the box around all that has edges: everything but lines, which are soft by themselves.
Points corners_of(const Scene& scene, const Camera& camera) {
  Points all = all_points(scene);
  for (const auto& gizmo : scene.gizmos) {
    const float reach = gizmo_reach(gizmo, camera);
    all.conservativeResize(all.rows() + 2, 3);
    all.bottomRows(2) << (gizmo.position.array() - reach).transpose(),
        (gizmo.position.array() + reach).transpose();
  }
  if (all.rows() == 0) return all;
  const Eigen::RowVector3f low = all.colwise().minCoeff(), high = all.colwise().maxCoeff();
  Points corners(8, 3);
  for (int corner = 0; corner < 8; ++corner)
    for (int k = 0; k < 3; ++k) corners(corner, k) = (corner >> k & 1) != 0 ? high[k] : low[k];
  return corners;
}

/// The picture of bottom-up premultiplied RGBA.
Image upright(const std::vector<uint8_t>& rgba, PixelSize size, bool transparent) {
  Image image(size.width, size.height);
  if (transparent) image.alpha.resize(rgba.size() / 4);
  for (int y = 0; y < size.height; ++y) {
    const uint8_t* from = rgba.data() + 4 * static_cast<size_t>(size.height - 1 - y) * size.width;
    uint8_t* to = image.at(0, y);
    for (int x = 0; x < size.width; ++x, from += 4, to += 3) {
      std::copy_n(from, 3, to);
      if (!transparent) continue;
      const int alpha = from[3];
      image.alpha[static_cast<size_t>(y) * size.width + x] = from[3];
      for (int c = 0; c < 3 && alpha > 0; ++c)
        to[c] = static_cast<uint8_t>(std::min(255, (255 * to[c] + alpha / 2) / alpha));
    }
  }
  return image;
}

bool is_solid(const SkeletonView& skeleton) {
  return !skeleton.x_ray && skeleton.opacity >= 1;
}
bool is_see_through(const SkeletonView& skeleton) {
  return !skeleton.x_ray && skeleton.opacity < 1;
}
bool is_over_all(const SkeletonView& skeleton) {
  return skeleton.x_ray;
}

}  // namespace

struct Renderer::Parts {
  explicit Parts(const RendererOptions& o) : options(o), canvas(o.samples) {}

  void draw_still(const Scene& scene, const Camera& camera, PixelSize size);
  void show(const Scene& scene, const Camera& camera, const RenderTarget& target);
  void draw_meshes(const Scene& scene, bool opaque);
  void draw_clouds(const Scene& scene, bool opaque);
  void draw_skeletons(const Scene& scene, bool (*which)(const SkeletonView&));
  void draw_lines(const Scene& scene, bool x_ray);
  void forget_depth_of_see_through(const Scene& scene);

  using Pass = void (*)(Parts&, const Scene&, const Camera&);
  static const Pass kPasses[];

  RendererOptions options;
  Canvas canvas;
  std::string still;  ///< key of what the canvas keeps
  gl::ArrayCache arrays;
  std::vector<MeshView> solids;  ///< of the scene's skeletons, one each
  FrameBlock frame;
  BackgroundPass background;
  MeshPass meshes{arrays};
  PointsPass points{arrays};
  OcclusionPass occlusion;
  GroundPass ground;
  LinesPass lines;
  SmoothPass smooth;
};

/// Background and grid, redrawn only when the view or they have changed.
void Renderer::Parts::draw_still(const Scene& scene, const Camera& camera, PixelSize size) {
  std::string key = key_of(camera, size, scene.background, scene.ground);
  if (key != still) {
    const gl::TargetScope target(canvas.still(), size.width, size.height);
    background.draw(scene.background);
    if (scene.ground.visible) ground.draw_grid(scene.ground, camera.target);
    still = std::move(key);
  }
  canvas.copy_still();
}

void Renderer::Parts::draw_meshes(const Scene& scene, bool opaque) {
  for (const auto& mesh : scene.meshes)
    if ((mesh.opacity >= 1) == opaque) meshes.draw(mesh, ambient_strength(scene));
}

void Renderer::Parts::draw_clouds(const Scene& scene, bool opaque) {
  for (const auto& cloud : scene.clouds)
    if ((cloud.opacity >= 1) == opaque) points.draw(cloud, canvas.samples() > 1);
}

void Renderer::Parts::draw_skeletons(const Scene& scene, bool (*which)(const SkeletonView&)) {
  for (size_t i = 0; i < scene.skeletons.size(); ++i)
    if (which(scene.skeletons[i])) meshes.draw(solids[i], 0);
}

void Renderer::Parts::draw_lines(const Scene& scene, bool x_ray) {
  for (const auto& view : scene.lines)
    if (view.x_ray == x_ray) lines.draw(view);
}

/// Clouds and skeletons to be seen through hide nothing that is drawn later:
/// all depth is again that of what is opaque.
void Renderer::Parts::forget_depth_of_see_through(const Scene& scene) {
  gl::api().Clear(GL_DEPTH_BUFFER_BIT);
  const gl::ColorMaskScope colors(false);
  for (MeshView mesh : scene.meshes) {
    mesh.wireframe = false;  // edges have no depth
    if (mesh.opacity >= 1) meshes.draw(mesh, 0);
  }
  draw_skeletons(scene, is_solid);
  draw_clouds(scene, true);
}

/// What is drawn over the still background, in this order. A new pass is a file of passes/ with its shaders
/// and its class, which nothing but this file includes; a member of Parts and a row here;
/// and a golden picture.
const Renderer::Parts::Pass Renderer::Parts::kPasses[] = {
    [](Parts& p, const Scene& s, const Camera&) {
      if (s.ground.visible && s.ground.shadow > 0) p.ground.draw_shadow(s);
    },
    // What is opaque; points are too rough for occlusion from depth.
    [](Parts& p, const Scene& s, const Camera&) { p.draw_meshes(s, true); },
    [](Parts& p, const Scene& s, const Camera&) { p.draw_skeletons(s, is_solid); },
    [](Parts& p, const Scene& s, const Camera&) {
      if (p.options.quality != Quality::Best || s.occlusion <= 0 || s.meshes.empty()) return;
      p.canvas.resolve_depth();
      p.occlusion.draw(p.canvas.depth_texture(), p.frame.size(), s.occlusion);
    },
    [](Parts& p, const Scene& s, const Camera&) { p.draw_clouds(s, true); },
    // What is to be seen through: skeletons first, which are inside the rest.
    [](Parts& p, const Scene& s, const Camera&) {
      if (std::none_of(s.skeletons.begin(), s.skeletons.end(), is_see_through)) return;
      p.draw_skeletons(s, is_see_through);
      p.forget_depth_of_see_through(s);
    },
    [](Parts& p, const Scene& s, const Camera&) {
      const auto opaque = [](const auto& cloud) { return cloud.opacity >= 1; };
      if (std::all_of(s.clouds.begin(), s.clouds.end(), opaque)) return;
      p.draw_clouds(s, false);
      p.forget_depth_of_see_through(s);
    },
    // What lies over it.
    [](Parts& p, const Scene& s, const Camera&) { p.draw_lines(s, false); },
    [](Parts& p, const Scene& s, const Camera&) { p.draw_meshes(s, false); },
    // What shows through everything.
    [](Parts& p, const Scene& s, const Camera&) {
      const auto x_ray = [](const LinesView& view) { return view.x_ray; };
      if (std::any_of(s.skeletons.begin(), s.skeletons.end(), is_over_all) ||
          std::any_of(s.lines.begin(), s.lines.end(), x_ray))
        gl::api().Clear(GL_DEPTH_BUFFER_BIT);
      p.draw_skeletons(s, is_over_all);
      p.draw_lines(s, true);
    },
    [](Parts& p, const Scene& s, const Camera& camera) {
      if (!s.gizmos.empty()) gl::api().Clear(GL_DEPTH_BUFFER_BIT);
      for (const auto& gizmo : s.gizmos) p.meshes.draw(gizmo_solids(gizmo, camera), 0);
    },
};

/// Into the target: the samples' means, or one sample with its edges smoothed afterwards.
void Renderer::Parts::show(const Scene& scene, const Camera& camera, const RenderTarget& target) {
  canvas.resolve_color(target.framebuffer);
  if (canvas.samples() > 1 || !options.smooth) return;
  const float margin = 4 + 0.04f / metres_a_pixel(camera, target.size, camera.target);  // bones, discs
  const Rectangle edges = covered(corners_of(scene, camera), camera, target.size, margin);
  if (edges.width <= 0 || edges.height <= 0) return;
  const gl::TargetScope framebuffer(target.framebuffer, target.size.width, target.size.height);
  const gl::ScissorScope scissor(edges.x, edges.y, edges.width, edges.height);
  smooth.draw(canvas.color_texture());
}

Renderer::Renderer(const RendererOptions& options) : parts_(std::make_unique<Parts>(options)) {
  gl::check_debug();
}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::draw(const Scene& scene, const Camera& camera, const RenderTarget& target) {
  Parts& p = *parts_;
  for (const auto& mesh : scene.meshes) MeshPass::check(mesh);
  p.solids.clear();
  for (const auto& skeleton : scene.skeletons) p.solids.push_back(skeleton_solids(skeleton));
  if (p.canvas.resize(target.size)) p.still.clear();
  {
    const gl::TargetScope canvas(p.canvas.work(), target.size.width, target.size.height);
    const gl::CapabilityScope depth(GL_DEPTH_TEST, true), samples(GL_MULTISAMPLE, true);
    p.frame.set(camera, scene.light, target.size);
    p.draw_still(scene, camera, target.size);
    gl::api().Clear(GL_DEPTH_BUFFER_BIT);
    for (const Parts::Pass pass : Parts::kPasses) pass(p, scene, camera);
  }
  p.show(scene, camera, target);
  p.arrays.next_picture();
  gl::check_debug();
}

Image Renderer::render_image(const Scene& scene, const Camera& camera, PixelSize size) {
  Canvas& canvas = parts_->canvas;
  if (canvas.resize(size)) parts_->still.clear();
  draw(scene, camera, {canvas.plain(), size});
  const size_t count = static_cast<size_t>(size.width) * static_cast<size_t>(size.height);
  std::vector<uint8_t> rgba(4 * count);
  {
    const gl::TargetScope source(canvas.plain(), size.width, size.height);
    gl::api().PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl::api().ReadPixels(0, 0, size.width, size.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  }
  gl::check_debug();
  return upright(rgba, size, scene.background.transparent);
}

}  // namespace understudy::render
