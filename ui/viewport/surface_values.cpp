#include "ui/viewport/surface_values.hpp"

#include "app/session/follow.hpp"
#include "render/colors.hpp"
#include "retarget/base/index.hpp"
#include "ui/panels/panel.hpp"

namespace understudy::ui {
namespace {

using app::Colouring;
using app::Session;
using Scale = Legend::Scale;
using SeenFrames = app::SharedFrames<app::KeptSource>;
using Picture = std::shared_ptr<const app::PosedPicture>;

SurfaceValues missing(const std::string& title, const std::string& why) {
  SurfaceValues none;
  none.legend.title = title, none.legend.missing = why;
  return none;
}

/// Values on a scale from 0 to `high`.
SurfaceValues scaled(const std::string& title, const std::string& unit, float high, Scale scale,
                     Eigen::VectorXf values) {
  SurfaceValues out;
  out.legend.title = title, out.legend.unit = unit, out.legend.high = high, out.legend.scale = scale;
  out.values = std::make_shared<const Eigen::VectorXf>(std::move(values));
  return out;
}

/// Millimetres between rows of the same number; both [V, 3].
SurfaceValues distances(const Session& session, const std::string& title, const Points& a, const Points& b) {
  return scaled(title, "mm", session.view.error_scale_mm, Scale::Error, 1000 * (a - b).rowwise().norm());
}

SurfaceValues weights(const Session& session, const app::TakeState& take) {
  if (take.weights == nullptr) return missing("Skin weights", "not ready yet");
  const int joint = weights_joint(session);
  if (joint >= 0 && joint < take.weights->cols())
    return scaled("Weight, " + joint_label(joint), "", 1, Scale::Viridis, take.weights->col(joint));
  SurfaceValues out;
  out.legend = joints_legend(session);
  return out;
}

SurfaceValues binding_uncertainty(const app::TakeState& take, Eigen::Index vertices) {
  const char* const title = "Binding uncertainty";
  if (take.binding == nullptr || take.binding->uncertainty.size() != vertices)
    return missing(title, "it uses its own skin weights");
  return scaled(title, "%", 100, Scale::Uncertainty, 100 * take.binding->uncertainty);
}

SurfaceValues error(const Session& session, const Points& vertices, int frame) {
  const char* const title = "Error";
  if (session.truth == nullptr) return missing(title, "needs ground truth");
  const app::Truth& truth = *session.truth;
  if (truth.vertices.empty()) return missing(title, "the ground truth has no vertices");
  if (truth.vertex_count != vertices.rows()) return missing(title, "the ground truth is of another mesh");
  if (frame < 0 || frame >= truth.frames) return missing(title, "the ground truth has fewer frames");
  return distances(session, title, vertices, truth.frame_vertices(frame));
}

/// Each point has the confidence of the joint nearest to it.
SurfaceValues confidence(const SeenFrames& frames, const Points& points, const Joints* joints, int frame) {
  const app::KeptSource* seen = at_or_null(frames, frame);
  if (joints == nullptr || seen == nullptr) return missing("Confidence", "not ready yet");
  Eigen::VectorXf values(points.rows());
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    Eigen::Index nearest = 0;
    (joints->rowwise() - points.row(i)).rowwise().squaredNorm().minCoeff(&nearest);
    values[i] = seen->confidence_of[nearest];
  }
  return scaled("Confidence", "", 1, Scale::Viridis, std::move(values));
}

}  // namespace

Vec3 scale_color(Legend::Scale scale, float share) {
  if (scale == Legend::Scale::Uncertainty)
    return render::diverging_color(0.5f + 0.5f * share);  // from neutral to warm
  return scale == Legend::Scale::Error ? render::error_color(share) : render::viridis(share);
}

Colouring take_colouring(const Session& session) {
  return session.tool == app::Tool::Paint ? Colouring::Weights : session.view.take.colouring;
}

int weights_joint(const Session& session) {
  if (session.tool == app::Tool::Paint && session.selected_joint >= 0) return session.selected_joint;
  return session.view.weights_joint;
}

Legend joints_legend(const Session& session) {
  Legend legend;
  if (take_colouring(session) != Colouring::Weights || weights_joint(session) >= 0) return legend;
  legend.title = "Skin weights";
  for (int j = 0; j < kJointCount; ++j) legend.categories.push_back({joint_label(j), render::kCategories[j]});
  return legend;
}

SurfaceValues take_values(const Session& session, int k, const PanePictures& pictures, const Picture& posed) {
  if (posed == nullptr || k < 0 || k >= ssize(session.takes)) return {};
  const app::TakeState& take = session.takes[k];
  const Colouring colouring = take_colouring(session);
  if (take.target == nullptr && colouring != Colouring::Plain)
    return missing("Colours", "the target is not bound yet");
  switch (colouring) {
    case Colouring::Plain:
      return {};
    case Colouring::Weights:
      return weights(session, take);
    case Colouring::Offsets:
      if (posed->offsets.rows() != posed->vertices.rows()) return missing("Offsets", "not ready yet");
      return scaled("Offsets", "mm", session.view.error_scale_mm, Scale::Viridis,
                    1000 * posed->offsets.rowwise().norm());
    case Colouring::Uncertainty:
      return binding_uncertainty(take, posed->vertices.rows());
    case Colouring::Error:
      return error(session, posed->vertices, pictures.frame);
    case Colouring::Difference:
      if (k == 0) return distances(session, "Difference", posed->vertices, posed->vertices);
      if (pictures.reference == nullptr) return missing("Difference", "the first take is not ready");
      if (pictures.reference->vertices.rows() != posed->vertices.rows())
        return missing("Difference", "the first take is of another mesh");
      return distances(session, "Difference", posed->vertices, pictures.reference->vertices);
    case Colouring::Confidence:
      return confidence(app::performed_by(session, k), posed->vertices,
                        at_or_null(take.joints, pictures.frame), pictures.frame);
  }
  return {};
}

SurfaceValues scan_values(const Session& session, const Points& scan, int frame) {
  if (session.view.source.colouring != Colouring::Confidence) return {};
  return confidence(session.source.frames, scan, app::pane_joints(session, 0, frame), frame);
}

}  // namespace understudy::ui
