// The values behind the colours of a surface: one for each vertex, with their legend.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/session/frame_cache.hpp"
#include "app/session/session.hpp"

namespace understudy::ui {

/// The frames that one pane shows; null where not made yet.
struct PanePictures {
  int frame = -1;
  std::shared_ptr<const app::ScanPicture> scan;
  std::vector<std::shared_ptr<const app::PosedPicture>> takes;  ///< as PaneContent::takes
  std::shared_ptr<const app::PosedPicture> reference;           ///< the first take, for differences
  struct Ghost {
    std::shared_ptr<const app::ScanPicture> scan;
    std::shared_ptr<const app::PosedPicture> take;
    int frame = -1;
  };
  std::vector<Ghost> ghosts;
};

/// A scale, or categories, or nothing (plain).
struct Legend {
  enum class Scale { Viridis, Error, Uncertainty };
  std::string title;  ///< "Offsets"; empty: no legend
  std::string unit;   ///< "mm"
  float high = 1;     ///< the scale begins at 0
  Scale scale = Scale::Viridis;
  struct Category {
    std::string label;
    Vec3 color;
  };
  std::vector<Category> categories;  ///< then there is no scale
  std::string missing;               ///< why there is nothing to show; empty when there is
};

/// A surface's figures, in the legend's unit.
struct SurfaceValues {
  Legend legend;
  std::shared_ptr<const Eigen::VectorXf> values;  ///< [V]; null: plain, categories, or missing
};

/// A legend's colour at `share` of its scale, 0..1.
Vec3 scale_color(Legend::Scale scale, float share);

/// The colouring that a take is shown with: the one chosen, or the painted joint's weights while painting.
app::Colouring take_colouring(const app::Session& session);
/// The joint whose weights are shown, -1 for all.
int weights_joint(const app::Session& session);

/// The legend of the joints' colours while takes show the weights of all joints; without a title while they
/// do not.
Legend joints_legend(const app::Session& session);

/// Of take `k` in a picture of it in frame `frame`. reference: of the first take.
SurfaceValues take_values(const app::Session& session, int k, const PanePictures& pictures,
                          const std::shared_ptr<const app::PosedPicture>& posed);
/// Of the source's scan in a frame, [V, 3].
SurfaceValues scan_values(const app::Session& session, const Points& scan, int frame);

}  // namespace understudy::ui
