#include "ui/viewport/surface_values.hpp"

#include <algorithm>

#include "render/colors.hpp"
#include "retarget/base/index.hpp"
#include "ui/panels/panel.hpp"

namespace understudy::ui {
namespace {

using app::Colouring;
using app::Session;
using Picture = std::shared_ptr<const app::PosedPicture>;

SurfaceValues missing(const std::string& title, const std::string& why) {
  SurfaceValues none;
  none.legend.title = title;
  none.legend.missing = why;
  return none;
}

Legend scale(const std::string& title, const std::string& unit, float high) {
  Legend legend;
  legend.title = title, legend.unit = unit, legend.high = high;
  return legend;
}

SurfaceValues millimetres(const Session& session, const std::string& title, Eigen::VectorXf values) {
  SurfaceValues out;
  out.legend = scale(title, "mm", session.view.error_scale_mm);
  out.values = std::make_shared<const Eigen::VectorXf>(std::move(values));
  return out;
}

SurfaceValues errors(const Session& session, const std::string& title, Eigen::VectorXf values) {
  SurfaceValues out = millimetres(session, title, std::move(values));
  out.legend.scale = Legend::Scale::Error;
  return out;
}

SurfaceValues weights(const Session& session, const app::TakeState& take) {
  if (take.weights == nullptr) return missing("Skin weights", "not ready yet");
  const int joint = weights_joint(session);
  SurfaceValues out;
  if (joint >= 0 && joint < take.weights->cols()) {
    out.legend = scale("Weight, " + joint_label(joint), "", 1);
    out.values = std::make_shared<const Eigen::VectorXf>(take.weights->col(joint));
    return out;
  }
  out.legend.title = "Skin weights";
  for (int j = 0; j < kJointCount; ++j)
    out.legend.categories.push_back({joint_label(j), render::kCategories[j]});
  return out;
}

SurfaceValues doubt(const app::TakeState& take, Eigen::Index vertices) {
  const char* const title = "Binding uncertainty";
  if (take.binding == nullptr || take.binding->doubt.size() != vertices)
    return missing(title, "it uses its own skin weights");
  SurfaceValues out;
  out.legend = scale(title, "%", 100);
  out.legend.scale = Legend::Scale::Doubt;
  out.values = std::make_shared<const Eigen::VectorXf>(100 * take.binding->doubt);
  return out;
}

SurfaceValues error(const Session& session, const Points& vertices, int frame) {
  const char* const title = "Error";
  if (session.truth == nullptr) return missing(title, "no ground truth is open");
  const app::Truth& truth = *session.truth;
  if (truth.vertices.empty()) return missing(title, "the truth has no vertices");
  if (truth.vertex_count != vertices.rows()) return missing(title, "the truth is of another mesh");
  if (frame < 0 || frame >= truth.frames) return missing(title, "the truth is shorter");
  return errors(session, title, distances_mm(vertices, truth.frame_vertices(frame)));
}

SurfaceValues confidence(const Session& session, const Points& points, const Joints* joints, int frame) {
  const char* const title = "Confidence";
  if (joints == nullptr || frame < 0 || frame >= ssize(session.source.frames))
    return missing(title, "not ready yet");
  SurfaceValues out;
  out.legend = scale(title, "", 1);
  const app::KeptSource& seen = session.source.frames[frame];
  out.values = std::make_shared<const Eigen::VectorXf>(of_nearest_joint(points, *joints, seen.confidence_of));
  return out;
}

}  // namespace

Vec3 scale_color(Legend::Scale scale, float share) {
  if (scale == Legend::Scale::Doubt)
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
      return millimetres(session, "Offsets", 1000 * posed->offsets.rowwise().norm());
    case Colouring::Doubt:
      return doubt(take, posed->vertices.rows());
    case Colouring::Error:
      return error(session, posed->vertices, pictures.frame);
    case Colouring::Difference:
      if (k == 0) return errors(session, "Difference", Eigen::VectorXf::Zero(posed->vertices.rows()));
      if (pictures.reference == nullptr) return missing("Difference", "the first take is not ready");
      if (pictures.reference->vertices.rows() != posed->vertices.rows())
        return missing("Difference", "the first take is of another mesh");
      return errors(session, "Difference", distances_mm(posed->vertices, pictures.reference->vertices));
    case Colouring::Confidence:
      return confidence(session, posed->vertices, at_or_null(take.joints, pictures.frame), pictures.frame);
  }
  return {};
}

SurfaceValues scan_values(const Session& session, const PanePictures& pictures) {
  if (session.view.source.colouring != Colouring::Confidence || pictures.scan == nullptr) return {};
  const app::KeptSource* seen = at_or_null(session.source.frames, pictures.frame);
  return confidence(session, pictures.scan->mesh.vertices, seen != nullptr ? &seen->joints : nullptr,
                    pictures.frame);
}

Eigen::VectorXf distances_mm(const Points& a, const Points& b) {
  return 1000 * (a - b).rowwise().norm();
}

Eigen::VectorXf of_nearest_joint(const Points& points, const Joints& joints,
                                 const Eigen::Array<float, kJointCount, 1>& value) {
  Eigen::VectorXf out(points.rows());
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    Eigen::Index nearest = 0;
    (joints.rowwise() - points.row(i)).rowwise().squaredNorm().minCoeff(&nearest);
    out[i] = value[nearest];
  }
  return out;
}

}  // namespace understudy::ui
