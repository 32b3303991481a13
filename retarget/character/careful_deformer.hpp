// A deformer that checks the prediction for a body unlike those the networks know, and binds by shape where
// they are unsure.
#pragma once

#include <memory>
#include <string>

#include "retarget/geometry/mesh.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy {

/// Skin weights made safe for any proportions.
struct SafeBinding {
  RowMatrix weights;            ///< [V, 22], rows sum to 1
  Eigen::VectorXf uncertainty;  ///< [V] 0..1: how far a vertex is bound by the shape alone
  /// [V] 0..1: 1 where pose-corrective offsets must not act (rigid parts, cloth, uncertainty)
  Eigen::VectorXf hard;
  std::string note;  ///< where, one sentence; empty where the weights stay as they were
};
/// Where `weights` [V, 22] reach over to bones that lie far away through the solid, they are blended with
/// geometric ones; skirts follow pelvis and thighs, rigid parts stay rigid. mesh and joints in T-pose.
SafeBinding safe_binding(const Mesh& mesh, const Joints& joints, const RowMatrix& weights);

/// `inner` with safe weights; faces [F, 3] of the target's vertices, none for a cloud.
class CarefulDeformer final : public Deformer {
 public:
  CarefulDeformer(Faces faces, std::shared_ptr<Deformer> inner);
  void bind(const Points& rest, const Joints& rest_joints) override;
  const RowMatrix& weights() const override { return inner_->weights(); }
  std::shared_ptr<Deformer> with_weights(RowMatrix weights) const override;
  Points deform(const Pose& pose) const override;
  Points offsets(const Pose& pose) const override;
  std::string name() const override { return inner_->name(); }
  /// Its weights are moved: see weights().
  const SafeBinding& binding() const { return binding_; }

 private:
  Faces faces_;
  std::shared_ptr<Deformer> inner_;
  SafeBinding binding_;
  Points rest_;
  Joints joints_ = Joints::Zero();
};

}  // namespace understudy
