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

constexpr float kAimSpread = 0.3f;  // standard deviations of the prior, between keys

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
  void raise(float height) override;
  std::vector<RigPose> aimed(const std::vector<PoseKey>& keys, double dt, Rng& rng) override;
  std::unique_ptr<MotionDynamics> clone() const override { return std::make_unique<NetworkDynamics>(*this); }

 private:
  NetworkDynamics(const std::string& path, const WeightsHeader& header);
  Eigen::RowVectorXf seen_row(const RigPose& pose, double dt) const;
  void put(const torch::Tensor& row, double dt);
  torch::Tensor way_through(const std::vector<PoseKey>& keys) const;

  RotationVrnn net_{nullptr};
  std::string kind_, bones_;
  std::shared_ptr<const DynamicsRows> form_;
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
  form_ = std::make_shared<DynamicsRows>(rig);
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
  net_->advance(x, net_->prior(state_, net_->nothing_ahead(1, torch::kCPU), step).mean, step, state_);
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
  const AheadStep nothing = net_->nothing_ahead(1, torch::kCPU);
  const Gaussian p = net_->prior(state_, nothing, step);
  const auto z = p.mean + p.deviation * normals(p.mean.size(1), rng);
  const auto row = net_->decoded(z, state_, nothing, step);
  net_->advance(row, z, step, state_);
  put(row, dt);
  return *last_;
}

void NetworkDynamics::raise(float height) {
  US_CHECK(last_, "no pose was observed to raise");
  last_->root.y() += height;
  state_.last = state_.last.clone();
  state_.last[0][RotationVrnnImpl::kRoot - 1] += height / form_->size();
}

/// [1, T, width], the first key at the origin and facing along +z; zeros between keys.
torch::Tensor NetworkDynamics::way_through(const std::vector<PoseKey>& keys) const {
  auto way = torch::zeros({1, keys.back().frame + 1, net_->width()});
  const RigPose& start = keys.front().pose;
  const float first = heading_of(start.turns[0]);
  float heading = 0;
  for (const PoseKey& key : keys) {
    Eigen::RowVectorXf row = form_->first_row(key.pose);
    if (net_->options().positions) row = form_->places_row(key.pose, row);
    const Vec3 gone = rotation_about_y(-first) * (key.pose.root - start.root) / form_->size();
    heading += std::remainder(heading_of(key.pose.turns[0]) - first - heading, 2 * kPi);
    row.head<3>() << gone.x(), gone.z(), heading;
    way[0][key.frame] = one_row(row)[0];
  }
  return way;
}

std::vector<RigPose> NetworkDynamics::aimed(const std::vector<PoseKey>& keys, double dt, Rng& rng) {
  US_CHECK(form_, "nothing was begun");
  US_CHECK(keys.size() >= 2 && keys.front().frame == 0, "it is aimed from a pose at frame 0 to a later one");
  const torch::NoGradGuard no_grad;
  const int64_t frames = keys.back().frame + 1;
  auto known = torch::zeros({1, frames}, torch::kBool);
  for (const PoseKey& key : keys) known[0][key.frame] = true;
  const Ahead ahead = net_->ahead(way_through(keys), known, torch::full({1, frames}, dt));
  state_ = net_->begin(1, torch::kCPU);
  last_.reset();
  observe(keys.front().pose, dt);
  std::vector<RigPose> poses = {keys.front().pose};
  const auto step = seconds(dt);
  for (int64_t t = 1; t < frames; ++t) {
    const AheadStep to = step_of(ahead, t);
    const Gaussian p = net_->prior(state_, to, step);
    const auto z = p.mean + kAimSpread * p.deviation * normals(p.mean.size(1), rng);
    const auto row = net_->decoded(z, state_, to, step);
    net_->advance(row, z, step, state_);
    put(row, dt);
    poses.push_back(*last_);
  }
  meet_keys(form_->rig(), 1 / dt, keys, poses);  // to the last bit
  return poses;
}

}  // namespace

std::unique_ptr<MotionDynamics> load_dynamics(const std::string& path) {
  return std::make_unique<NetworkDynamics>(path);
}

}  // namespace understudy::nn
