#include <torch/torch.h>

#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/marionette/dynamics_rows.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/nn/load.hpp"
#include "retarget/nn/modules/rotation_vrnn.hpp"
#include "retarget/nn/weights_file.hpp"

namespace understudy::nn {
namespace {

constexpr double kAimRate = 0.15, kAimTurns = 0.1, kAimEffort = 2e-4;
constexpr float kAimSpread = 0.3f;  // standard deviations of the prior that it begins from

torch::Tensor one_row(const Eigen::RowVectorXf& row) {
  return torch::from_blob(const_cast<float*>(row.data()), {1, row.size()}).clone();
}

Eigen::RowVectorXf eigen_row(const torch::Tensor& row) {
  const auto own = row.contiguous();
  return Eigen::Map<const Eigen::RowVectorXf>(own.data_ptr<float>(), own.numel());
}

torch::Tensor normals(int64_t count, Rng& rng) {
  auto made = torch::empty({1, count});
  for (int64_t i = 0; i < count; ++i) made.data_ptr<float>()[i] = rng.normal();
  return made;
}

torch::Tensor seconds(double dt) {
  return torch::full({1, 1}, dt);
}

class NetworkDynamics final : public MotionDynamics {
 public:
  explicit NetworkDynamics(const std::string& path) : NetworkDynamics(path, read_weights_header(path)) {}

  std::string kind() const override { return kind_; }
  void begin(const Rig& rig) override;
  void observe(const RigPose& pose, double dt) override;
  RigPose sample(double dt, Rng& rng) override;
  std::vector<RigPose> aimed(const std::vector<PoseKey>& keys, double dt, int steps, Rng& rng) override;
  std::unique_ptr<MotionDynamics> clone() const override { return std::make_unique<NetworkDynamics>(*this); }

 private:
  NetworkDynamics(const std::string& path, const WeightsHeader& header);
  Eigen::RowVectorXf seen_row(const RigPose& pose, double dt) const;
  void put(const torch::Tensor& row, double dt);
  torch::Tensor rolled(const torch::Tensor& effort, double dt);
  torch::Tensor missed(const torch::Tensor& rows, const std::vector<PoseKey>& keys, double dt) const;

  RotationVrnn net_{nullptr};
  std::string kind_, bones_;
  std::vector<int> parents_;
  std::shared_ptr<const DynamicsRows> form_;
  torch::Tensor rest_;
  VrnnState state_;
  std::optional<RigPose> last_;
};

NetworkDynamics::NetworkDynamics(const std::string& path, const WeightsHeader& header) {
  VrnnOptions options;
  options.joints = header_size(path, header, "joints", options.joints, 1000);
  const auto positions = header.numbers.find("positions");
  options.positions = positions != header.numbers.end() && positions->second > 0;
  net_ = RotationVrnn(options);
  const WeightsHeader read = load_weights(path, kDynamicsWeights, kDynamicsVersion, *net_);
  const auto text = [&](const char* key) {
    const auto found = read.texts.find(key);
    US_CHECK(found != read.texts.end(), path, ": does not say its ", key);
    return found->second;
  };
  kind_ = text("kind"), bones_ = text("bones");
  net_->eval();
  for (auto& parameter : net_->parameters()) parameter.set_requires_grad(false);
}

void NetworkDynamics::begin(const Rig& rig) {
  US_CHECK(bones_of(rig) == bones_ && rig.count() == net_->options().joints, rig.name,
           ": its bones are not those of the kind \"", kind_, "\"");
  parents_.clear();
  for (const RigJoint& joint : rig.joints) parents_.push_back(joint.parent);
  form_ = std::make_shared<DynamicsRows>(rig);
  const Points rest = form_->rest();
  rest_ = torch::from_blob(const_cast<float*>(rest.data()), {1, rest.rows(), 3}).clone();
  state_ = net_->begin(1, torch::kCPU);
  last_.reset();
}

Eigen::RowVectorXf NetworkDynamics::seen_row(const RigPose& pose, double dt) const {
  const Eigen::RowVectorXf row = last_ ? form_->row(*last_, pose, dt) : form_->first_row(pose);
  return net_->options().positions ? form_->places_row(pose, row) : row;
}

void NetworkDynamics::observe(const RigPose& pose, double dt) {
  US_CHECK(form_, "nothing was begun");
  const torch::NoGradGuard no_grad;
  const auto x = one_row(seen_row(pose, dt)), step = seconds(dt);
  const auto z = net_->posterior(state_, x, step).mean;
  net_->advance(net_->decoded(z, state_, step), z, step, state_);
  state_.last = x;  // it is known
  last_ = pose;
}

/// The next frame is this row.
void NetworkDynamics::put(const torch::Tensor& row, double dt) {
  US_CHECK(torch::isfinite(row).all().item<bool>(), "the network of dynamics gave no finite pose");
  const Eigen::RowVectorXf numbers = eigen_row(row);
  last_ = net_->options().positions ? form_->pose_at(*last_, numbers, dt) : form_->pose(*last_, numbers, dt);
}

RigPose NetworkDynamics::sample(double dt, Rng& rng) {
  US_CHECK(last_, "no pose was observed to go on from");
  const torch::NoGradGuard no_grad;
  const auto step = seconds(dt);
  const Gaussian p = net_->prior(state_, step);
  const auto z = p.mean + p.deviation * normals(p.mean.size(1), rng);
  const auto row = net_->decoded(z, state_, step);
  net_->advance(row, z, step, state_);
  put(row, dt);
  return *last_;
}

/// Rows [1, N, width] that follow the state under these steps of z [1, N, latent], in the prior's deviations.
torch::Tensor NetworkDynamics::rolled(const torch::Tensor& effort, double dt) {
  VrnnState state = state_;
  const auto step = seconds(dt);
  std::vector<torch::Tensor> rows;
  for (int64_t t = 0; t < effort.size(1); ++t) {
    const Gaussian p = net_->prior(state, step);
    const auto z = p.mean + p.deviation * effort.select(1, t);
    rows.push_back(net_->decoded(z, state, step));
    net_->advance(rows.back(), z, step, state);
  }
  state_.hidden = state.hidden.detach();
  state_.last = state.last.detach();
  return torch::stack(rows, 1);
}

/// How far joints and rotations are from the keys after the first, squared. rows: of the first key, too.
torch::Tensor NetworkDynamics::missed(const torch::Tensor& rows, const std::vector<PoseKey>& keys,
                                      double dt) const {
  const auto places = row_places(*net_, rows, rest_, parents_);
  const RootWay way = root_way(rows, torch::full({1, rows.size(1)}, dt));
  const RigPose& start = keys.front().pose;
  const float heading = heading_of(start.turns[0]);
  auto off = torch::zeros({});
  for (size_t k = 1; k < keys.size(); ++k) {
    const RigPose& pose = keys[k].pose;
    const int64_t t = keys[k].frame;
    const auto wanted = one_row(form_->places_row(pose, form_->first_row(pose)))
                            .slice(-1, RotationVrnnImpl::kRoot)
                            .view({-1, 3});
    off = off + squared_error(places[0][t], wanted);
    const Vec3 gone = rotation_about_y(-heading) * (pose.root - start.root) / form_->size();
    const auto root = torch::tensor({gone.x(), pose.root.y() / form_->size(), gone.z()});
    const float turned = std::remainder(heading_of(pose.turns[0]) - heading, 2 * kPi);
    off =
        off + static_cast<double>(parents_.size()) * ((way.places[0][t] - root).square().sum() +
                                                      kAimTurns * (1 - (way.headings[0][t] - turned).cos()));
    if (net_->options().positions) continue;
    const auto turns = row_turns(one_row(form_->first_row(pose)));
    off = off + kAimTurns * (row_turns(rows[0][t].unsqueeze(0)) - turns).square().sum();
  }
  return off;
}

std::vector<RigPose> NetworkDynamics::aimed(const std::vector<PoseKey>& keys, double dt, int steps,
                                            Rng& rng) {
  US_CHECK(form_, "nothing was begun");
  US_CHECK(keys.size() >= 2 && keys.front().frame == 0, "it is aimed from a pose at frame 0 to a later one");
  state_ = net_->begin(1, torch::kCPU);
  last_.reset();
  observe(keys.front().pose, dt);
  const VrnnState start = state_;
  const int64_t frames = keys.back().frame;
  auto effort = (kAimSpread * normals(frames * net_->options().latent, rng))
                    .view({1, frames, net_->options().latent})
                    .requires_grad_(true);
  torch::optim::Adam optimizer({effort}, torch::optim::AdamOptions(kAimRate));
  for (int i = 0; i < steps; ++i) {
    state_ = start;
    const auto rows = torch::cat({start.last.unsqueeze(1), rolled(effort, dt)}, 1);
    optimizer.zero_grad();
    (missed(rows, keys, dt) + kAimEffort * effort.square().sum()).backward();
    optimizer.step();
  }
  const torch::NoGradGuard no_grad;
  state_ = start;
  const auto rows = rolled(effort, dt);
  std::vector<RigPose> poses = {keys.front().pose};
  for (int64_t t = 0; t < frames; ++t) {
    put(rows.select(1, t), dt);
    poses.push_back(*last_);
  }
  return poses;
}

}  // namespace

std::unique_ptr<MotionDynamics> load_dynamics(const std::string& path) {
  return std::make_unique<NetworkDynamics>(path);
}

}  // namespace understudy::nn
