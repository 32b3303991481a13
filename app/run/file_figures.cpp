#include "app/run/file_figures.hpp"

#include <chrono>

#include "app/run/interrupt.hpp"
#include "retarget/base/error.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/metrics/surface_metrics.hpp"

namespace understudy::app {

Metrics file_figures(const ExportBody& body, const CharacterClip& clip, const Truth& truth) {
  US_CHECK(!truth.vertices.empty() && truth.frames == static_cast<int64_t>(clip.poses.size()),
           "the ground truth has another number of frames than the file, or no vertices");
  const auto began = std::chrono::steady_clock::now();
  const std::string bytes =
      gltf_bytes(animated_character({{*body.character, *body.screen, {clip}, body.file}}), "evaluated.glb");
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  const Character written = parse_gltf_character(bytes, "evaluated.glb");
  const MergedSurface& surface = body.character->surface;
  double medl = 0, mpvd = 0, off_screen = 0;
  const auto count = static_cast<double>(truth.frames);
  for (int64_t t = 0; t < truth.frames; ++t) {
    check_interrupt("while the file was evaluated");
    const auto at = static_cast<float>(static_cast<double>(t) / clip.fps);
    const Points seen = surface.merged(vertices_at(written, 0, at));
    const Points in_file = surface.in_file_order(seen), right = truth.frame_vertices(t);
    medl += edge_length_error(in_file, right) / count;
    mpvd += mean_vertex_error(in_file, right) / count;
    off_screen += mean_vertex_error(seen, body.screen->deform(clip.poses[t])) / count;
  }
  return {{"file_medl_mm", 1000 * medl},
          {"file_mpvd_m", mpvd},
          {"file_screen_mm", 1000 * off_screen},
          {"file_mb", static_cast<double>(bytes.size()) / 1e6},
          {"file_s", seconds}};
}

}  // namespace understudy::app
