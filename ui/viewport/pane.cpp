#include "ui/viewport/pane.hpp"

#include "render/gl/program.hpp"
#include "render/picking.hpp"
#include "ui/panels/panel.hpp"

namespace understudy::ui {
namespace {

using render::gl::api;

constexpr float kNearScan = 0.02f;  // metres around the pointer's ray in which a point of a scan is met

/// What of a pane can be met: a take's surface before the scan.
struct Met {
  int vertex = 0;
  Vec3 position = Vec3::Zero();
};

std::optional<Met> met_scan(const app::Session& session, const Pane& pane, const render::Ray& ray) {
  const auto& scan = pane.keeper.pictures().scan;
  if (scan == nullptr || !session.view.source.surface) return std::nullopt;
  const auto vertex = render::point_near(scan->mesh.vertices, ray, kNearScan);
  if (!vertex) return std::nullopt;
  return Met{*vertex, scan->mesh.vertices.row(*vertex)};
}

std::optional<Met> met_take(const app::Session& session, const Pane& pane, const render::Ray& ray) {
  const auto& takes = pane.keeper.pictures().takes;
  if (takes.empty() || takes[0] == nullptr || pane.content.takes.empty()) return std::nullopt;
  const size_t k = pane.content.takes[0];
  if (k >= session.takes.size() || session.takes[k].target == nullptr) return std::nullopt;
  const Mesh& mesh = session.takes[k].target->mesh;
  if (mesh.is_cloud() || mesh.vertices.rows() != takes[0]->vertices.rows()) return std::nullopt;
  const auto hit = render::surface_under(ray, takes[0]->vertices, mesh.faces);
  if (!hit) return std::nullopt;
  return Met{hit->vertex, hit->position};
}

std::string weight_words(const app::Session& session, const Pane& pane, int vertex) {
  const auto& weights = session.takes[pane.content.takes[0]].weights;
  if (weights == nullptr || vertex >= weights->rows()) return "";
  Eigen::Index joint = 0;
  const float most = weights->row(vertex).maxCoeff(&joint);
  return joint_label(joint) + "  " + figure(static_cast<double>(most), "");
}

}  // namespace

bool PaneCanvas::shows(const render::Scene& scene, const render::Camera& camera,
                       render::PixelSize size) const {
  return drawn_ && same(size, size_) && same(camera, camera_) && same(scene, scene_);
}

void PaneCanvas::draw(render::Renderer& renderer, const render::Scene& scene, const render::Camera& camera,
                      render::PixelSize size, bool fine) {
  if (!same(size, size_)) resize(size);
  renderer.draw(scene, camera, {framebuffer_.name(), size});
  scene_ = scene, camera_ = camera;
  drawn_ = true, fine_ = fine;
}

void PaneCanvas::resize(render::PixelSize size) {
  size_ = size;
  render::gl::attach(framebuffer_, texture_,
                     {size.width, size.height, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, GL_NEAREST});
}

std::string value_under(const app::Session& session, const Pane& pane, const ImVec2& at) {
  const Legend& legend = pane.made.legend;
  const auto& values = pane.made.values;
  if (legend.title.empty() || (values == nullptr && legend.categories.empty())) return "";
  const render::Ray ray = pane.view.ray(at);
  const auto met = pane.made.values_take < 0 ? met_scan(session, pane, ray) : met_take(session, pane, ray);
  if (!met) return "";
  if (values == nullptr) return weight_words(session, pane, met->vertex);
  return met->vertex < values->size() ? figure(static_cast<double>((*values)[met->vertex]), legend.unit) : "";
}

std::optional<Vec3> surface_place(const app::Session& session, const Pane& pane, const ImVec2& at) {
  const render::Ray ray = pane.view.ray(at);
  if (const auto met = met_take(session, pane, ray)) return met->position;
  if (const auto met = met_scan(session, pane, ray)) return met->position;
  return std::nullopt;
}

}  // namespace understudy::ui
