// What drawing costs: median milliseconds of the studio's two views and of their parts. Not a test.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "render/context/context.hpp"
#include "render/renderer.hpp"
#include "retarget/base/rng.hpp"
#include "tests/render/content.hpp"

namespace understudy::render {
namespace {

std::pair<double, double> median_ms(int count, const std::function<void(int)>& work) {
  std::vector<double> times;
  for (int i = -3; i < count; ++i) {  // three to warm up
    const auto begin = std::chrono::steady_clock::now();
    work(i);
    gl::api().Finish();
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    if (i >= 0) times.push_back(took.count());
  }
  std::sort(times.begin(), times.end());
  return {times[times.size() / 2], times.front()};
}

/// Moved a little for each frame, as an animation does.
Points swayed(const Points& points, int frame) {
  Points moved = points;
  moved.col(0).array() += 0.02f * std::sin(0.3f * static_cast<float>(frame)) * points.col(1).array();
  return moved;
}

class Bench {
 public:
  Bench(PixelSize size, const RendererOptions& options) : size_(size), renderer_(options) {}

  void run(const char* name, const Scene& scene) {
    const Camera camera = view_of(scene, size_.aspect());
    Scene moving = scene;
    const auto ms = median_ms(31, [&](int frame) {
      for (size_t i = 0; i < scene.meshes.size(); ++i)
        moving.meshes[i].vertices = swayed(scene.meshes[i].vertices, frame);
      for (size_t i = 0; i < scene.clouds.size(); ++i)
        moving.clouds[i].positions = swayed(scene.clouds[i].positions, frame);
      renderer_.draw(moving, camera, {target_.framebuffer(size_), size_});
    });
    std::printf("  %-34s %7.2f ms  (best %.2f)\n", name, ms.first, ms.second);
    if (std::getenv("US_BENCH_PICTURES") != nullptr)
      write_png("bench_" + std::string(name) + ".png", renderer_.render_image(moving, camera, size_));
  }

 private:
  /// A plain picture to draw into, as a window's view is.
  class Picture {
   public:
    unsigned framebuffer(PixelSize size) {
      if (size.width == size_.width && size.height == size_.height) return framebuffer_.name();
      size_ = size;
      gl::api().BindTexture(GL_TEXTURE_2D, texture_.name());
      gl::api().TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size.width, size.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                           nullptr);
      gl::api().BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
      gl::api().FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_.name(), 0);
      gl::api().BindFramebuffer(GL_FRAMEBUFFER, 0);
      return framebuffer_.name();
    }

   private:
    PixelSize size_;
    gl::Texture texture_;
    gl::Framebuffer framebuffer_;
  };

  PixelSize size_;
  Renderer renderer_;
  Picture target_;
};

Scene without_ground(Scene scene) {
  scene.ground.visible = false;
  return scene;
}

Scene person(int vertices) {
  Scene scene;
  const Mesh mesh = make_person(vertices);
  add(scene, mesh);
  scene.meshes[0].normals = vertex_normals(mesh.vertices, mesh.faces);
  scene.meshes[0].two_sided = false;
  return scene;
}

Scene with_skeleton(Scene scene, bool x_ray) {
  scene.skeletons.push_back(skeleton_view(make_joints()));
  scene.skeletons[0].x_ray = x_ray;
  return scene;
}

void bench(PixelSize size, const RendererOptions& options) {
  std::printf("%d x %d, %d samples%s\n", size.width, size.height, options.samples,
              options.samples == 1 && options.smooth ? ", smoothed" : "");
  Bench bench(size, options);
  Rng rng(3);
  Scene cloud;
  Mesh points;
  points.vertices = sample_points(make_person(), 8000, rng);
  add(cloud, points);
  Scene ground = person(13000);
  ground.meshes[0].vertices =
      Points(0.5f * Points::Ones(ground.meshes[0].vertices->rows(), 3));  // casts and shows nothing
  bench.run("background", without_ground(with_skeleton({}, false)));
  bench.run("ground", ground);
  bench.run("skeleton", without_ground(with_skeleton({}, true)));
  bench.run("8k points", without_ground(cloud));
  bench.run("8k points, skeleton, ground", with_skeleton(cloud, true));
  bench.run("13k mesh", without_ground(person(13000)));
  bench.run("13k mesh, skeleton, ground", with_skeleton(person(13000), true));
  bench.run("200k mesh, skeleton, ground", with_skeleton(person(200000), true));
}

}  // namespace
}  // namespace understudy::render

int main() {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // each line as it comes, into files too
  using namespace understudy::render;
  const auto context = make_offscreen_context();
  std::printf("%s\n", context->description().c_str());
  bench({500, 600}, {1, Quality::Interactive, false});
  bench({500, 600}, {1, Quality::Interactive, true});
  bench({500, 600}, {4, Quality::Interactive});
  bench({640, 720}, {1, Quality::Interactive, true});
  return 0;
}
