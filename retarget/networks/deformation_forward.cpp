#include "retarget/networks/deformation_forward.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <future>

#include "retarget/base/threads.hpp"
#include "retarget/networks/linear_layer.hpp"
#include "retarget/pipeline/human_rest.hpp"

namespace understudy::nn {
namespace {

constexpr int kWidth = 256, kContextWidth = 128, kSummary = 96, kCode = 128,
              kCodeHidden = 256;                      // the module's
constexpr int kBones = kJointCount - 1, kBlocks = 5;  // three of the trunk, one for weights, one for offsets
constexpr int kPositionWaves = 5, kBoneWaves = 2, kCanonicalWaves = 6;
constexpr int kCanonical = 3 + 6 * kCanonicalWaves;
constexpr float kAdultBones = 4.42f, kBasisUnit = 0.02f, kSmallest = 0.5f, kLargest = 1.4f;
constexpr int kChunk = 64;  // points at a time: their rows stay in the cache

float scale_of(const Joints& joints) {
  return std::max(1e-4f, bone_lengths(joints).tail<kBones>().sum() / kAdultBones);
}

Joints mirrored_joints(const Joints& joints, float middle) {
  Joints mirrored;
  for (int j = 0; j < kJointCount; ++j) mirrored.row(j) = joints.row(kMirror[j]);
  mirrored.col(0) = 2 * middle - mirrored.col(0).array();
  return mirrored;
}

Points mirrored_points(Points points, float middle) {
  points.col(0) = 2 * middle - points.col(0).array();
  return points;
}

/// sin and cos of pi 2^k x for k = 0 .. waves-1, each of all `count` numbers: every one from the one before.
void write_waves(const float* x, int count, int waves, float* out) {
  for (int i = 0; i < count; ++i) {
    const float angle = x[i] * static_cast<float>(M_PI);
    float s = std::sin(angle), c = std::cos(angle);
    for (int k = 0; k < waves; ++k) {
      out[2 * k * count + i] = s;
      out[(2 * k + 1) * count + i] = c;
      const float twice = 2 * s * c;
      c = 1 - 2 * s * s;
      s = twice;
    }
  }
}

/// The numbers of a point, which the module's point_features() defines; `joints` over their scale.
void write_features(const Eigen::RowVector3f& place, const Joints& joints, float* out) {
  float *const away = out, *const distance = out + 66, *const along = out + 88, *const beside = out + 109;
  float* const waves = out + 130;
  for (int j = 0; j < kJointCount; ++j) {
    const Eigen::RowVector3f d = place - joints.row(j);
    Eigen::Map<Eigen::RowVector3f>(away + 3 * j) = 2 * d;
    distance[j] = 2 * d.norm();
  }
  for (int j = 1; j < kJointCount; ++j) {
    const Eigen::RowVector3f from = place - joints.row(kParents[j]),
                             bone = joints.row(j) - joints.row(kParents[j]);
    const float at = std::clamp(from.dot(bone) / std::max(1e-6f, bone.squaredNorm()), -1.0f, 2.0f);
    along[j - 1] = at;
    beside[j - 1] = 2 * (from - std::clamp(at, 0.0f, 1.0f) * bone).norm();
  }
  const Eigen::RowVector3f from_root = place - joints.row(0);
  write_waves(from_root.data(), 3, kPositionWaves, waves);
  write_waves(along, kBones, kBoneWaves, waves + 6 * kPositionWaves);
}

RowMatrix features_of(const Points& points, const Joints& joints) {
  const float scale = scale_of(joints);
  const Joints scaled = joints / scale;
  RowMatrix features(points.rows(), kPointFeatureCount);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    write_features(points.row(i) / scale, scaled, features.row(i).data());
  return features;
}

/// fc1's columns are scaled and shifted by what `film` makes of a body's code.
struct FilmLayers {
  NormLayer norm;
  RowMatrix weight, bias;  // fc1
  LinearLayer fc2, film;
};

/// A body as the networks see it from one side.
struct Side {
  Joints joints;
  std::array<LinearLayer, kBlocks> fc1;  // of this body
  float beyond;                          // its size over the nearest that people have
};

/// Of one thread.
struct Buffers {
  RowMatrix h, branch, normed, hidden, canonical, waves, weights, gate, basis;
};

/// How the sides are exchanged in an offset basis: where each number comes from, and its sign.
struct MirroredBasis {
  std::array<int, 3 * kPoseFeatureCount> from;
  std::array<float, 3 * kPoseFeatureCount> sign;
  MirroredBasis() {
    const auto side = [](int axis) { return axis == 0 ? -1.f : 1.f; };
    for (int c = 0; c < 3; ++c)
      for (int j = 1; j < kJointCount; ++j)
        for (int e = 0; e < 9; ++e) {
          const int at = c * kPoseFeatureCount + 9 * (j - 1) + e;
          from[at] = c * kPoseFeatureCount + 9 * (kMirror[j] - 1) + e;
          sign[at] = side(c) * side(e / 3) * side(e % 3);
        }
  }
};

}  // namespace

struct DeformationForward::Impl {
  Impl(const std::string& path, const Kernels& with);

  const Kernels& kernels;
  LinearLayer context1, context2, context3, code1, code2, entry, to_canonical, from_canonical, to_weights,
      to_basis, to_gate;
  std::array<FilmLayers, kBlocks> blocks;  // trunk, weights, offsets
  NormLayer weight_norm, offset_norm;

  void apply_silu(const LinearLayer& layer, const RowMatrix& x, RowMatrix& out) const;
  RowMatrix body_code(const Joints& joints, const Points& surface) const;
  Side side_of(const Joints& joints, const Points& surface) const;
  void add_block(int block, const Side& side, const RowMatrix& x, RowMatrix& sum, Buffers& b) const;
  void evaluate(const Points& points, const Side& side, Buffers& b) const;
};

DeformationForward::Impl::Impl(const std::string& path, const Kernels& with) : kernels(with) {
  const NetworkWeights file(path, "deformation", kDeformationVersion);
  const auto linear = [&](const std::string& name, int inputs, int outputs) {
    return file.linear(with, name, inputs, outputs);
  };
  context1 = linear("context1", kPointFeatureCount, kContextWidth);
  context2 = linear("context2", kContextWidth, kContextWidth);
  context3 = linear("context3", 2 * kContextWidth, kSummary);
  code1 = linear("code1", 3 * kJointCount + 1 + kSummary, kCodeHidden);
  code2 = linear("code2", kCodeHidden, kCode);
  entry = linear("entry", kPointFeatureCount, kWidth);
  to_canonical = linear("to_canonical", kWidth, 3);
  from_canonical = linear("from_canonical", kCanonical, kWidth);
  to_weights = linear("to_weights", kWidth, kJointCount);
  to_basis = linear("to_basis", kWidth, 3 * kPoseFeatureCount);
  to_gate = linear("to_gate", kWidth, kBones);
  weight_norm = file.norm("weight_norm", kWidth);
  offset_norm = file.norm("offset_norm", kWidth);
  const char* const names[kBlocks] = {"trunk.0", "trunk.1", "trunk.2", "weight_block", "offset_block"};
  for (int i = 0; i < kBlocks; ++i) {
    const std::string name = names[i];
    blocks[i] = {file.norm(name + ".norm", kWidth), file.tensor(name + ".fc1.weight", kWidth, kWidth),
                 file.tensor(name + ".fc1.bias", kWidth, 1), linear(name + ".fc2", kWidth, kWidth),
                 linear(name + ".film", kCode, 2 * kWidth)};
  }
}

void DeformationForward::Impl::apply_silu(const LinearLayer& layer, const RowMatrix& x,
                                          RowMatrix& out) const {
  layer.apply(x, out);
  kernels.silu(out.data(), out.size());
}

RowMatrix DeformationForward::Impl::body_code(const Joints& joints, const Points& surface) const {
  RowMatrix seen, hidden, summary, code;
  apply_silu(context1, features_of(surface, joints), hidden);
  apply_silu(context2, hidden, seen);
  RowMatrix pooled(1, 2 * kContextWidth);
  pooled << seen.colwise().maxCoeff(), seen.colwise().mean();
  context3.apply(pooled, summary);
  const float scale = scale_of(joints);
  const Joints body = (joints.rowwise() - joints.row(0)) * (2 / scale);
  RowMatrix seen_body(1, code1.inputs());
  // Size enters only within people's range: a giant is a scaled person (evaluate() scales his offsets).
  seen_body << Eigen::Map<const Eigen::RowVectorXf>(body.data(), body.size()),
      3 * std::log(std::clamp(scale, kSmallest, kLargest)), summary.leftCols(kSummary);
  apply_silu(code1, seen_body, hidden);
  apply_silu(code2, hidden, code);
  return code;
}

Side DeformationForward::Impl::side_of(const Joints& joints, const Points& surface) const {
  const float scale = scale_of(joints);
  Side side{joints, {}, scale / std::clamp(scale, kSmallest, kLargest)};
  const RowMatrix code = body_code(joints, surface);
  RowMatrix film;
  for (int i = 0; i < kBlocks; ++i) {
    const FilmLayers& block = blocks[i];
    block.film.apply(code, film);
    const Eigen::VectorXf factor = 1 + film.leftCols(kWidth).transpose().array();
    const Eigen::VectorXf shift = film.middleCols(kWidth, kWidth).transpose();
    side.fc1[i] = LinearLayer(kernels, factor.asDiagonal() * block.weight,
                              RowMatrix(block.bias.cwiseProduct(factor) + shift));
  }
  return side;
}

/// sum += the block of x.
void DeformationForward::Impl::add_block(int block, const Side& side, const RowMatrix& x, RowMatrix& sum,
                                         Buffers& b) const {
  blocks[block].norm.apply(kernels, x, nullptr, b.normed);
  apply_silu(side.fc1[block], b.normed, b.hidden);
  blocks[block].fc2.apply(b.hidden, sum, Finish::Add);
}

/// b.weights and b.basis of points of this side.
void DeformationForward::Impl::evaluate(const Points& points, const Side& side, Buffers& b) const {
  entry.apply(features_of(points, side.joints), b.h);
  add_block(0, side, b.h, b.h, b);
  to_canonical.apply(b.h, b.canonical);
  b.waves.resize(points.rows(), kCanonical);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    b.waves.row(i).head<3>() = b.canonical.row(i).head<3>();
    write_waves(b.canonical.row(i).data(), 3, kCanonicalWaves, b.waves.row(i).data() + 3);
  }
  from_canonical.apply(b.waves, b.h, Finish::Add);
  add_block(1, side, b.h, b.h, b);
  add_block(2, side, b.h, b.h, b);

  b.branch = b.h;
  add_block(3, side, b.h, b.branch, b);
  weight_norm.apply(kernels, b.branch, nullptr, b.normed);
  to_weights.apply(b.normed, b.weights);
  kernels.softmax(
      {b.weights.data(), b.weights.cols(), nullptr, 0, static_cast<int>(points.rows()), kJointCount, 0});
  b.branch = b.h;
  add_block(4, side, b.h, b.branch, b);
  offset_norm.apply(kernels, b.branch, nullptr, b.normed);
  to_gate.apply(b.normed, b.gate);
  to_basis.apply(b.normed, b.basis);
  const float unit = kBasisUnit * side.beyond;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    for (int c = 0; c < 3; ++c)
      for (int bone = 0; bone < kBones; ++bone)
        b.basis.row(i).segment<9>(c * kPoseFeatureCount + 9 * bone) *=
            unit / (1 + std::exp(-b.gate(i, bone)));
}

DeformationForward::DeformationForward(const std::string& path, const Kernels& with)
    : impl_(std::make_unique<const Impl>(path, with)) {}
DeformationForward::~DeformationForward() = default;

SurfaceValues DeformationForward::evaluate(const Points& points, const Joints& joints,
                                           const Points& surface) const {
  static const MirroredBasis exchanged;
  const float middle = joints.col(0).mean(), band = static_cast<float>(kMirrorBand) * scale_of(joints);
  const Eigen::ArrayXf t = ((points.col(0).array() - middle + band) / (2 * band)).max(0.f).min(1.f);
  const Eigen::ArrayXf left = t * t * (3 - 2 * t);  // 1 on the left, 0 on the right
  SurfaceValues out{RowMatrix::Zero(points.rows(), kJointCount),
                    RowMatrix::Zero(points.rows(), 3 * kPoseFeatureCount)};
  const auto one_side = [&](bool mirrored) {
    const Side side = mirrored
                          ? impl_->side_of(mirrored_joints(joints, middle), mirrored_points(surface, middle))
                          : impl_->side_of(joints, surface);
    std::vector<int> rows;
    for (Eigen::Index i = 0; i < points.rows(); ++i)
      if (mirrored ? left[i] < 1 : left[i] > 0) rows.push_back(static_cast<int>(i));
    const auto add = [&](int row, Eigen::Index i, const Buffers& b) {
      const float share = mirrored ? 1 - left[row] : left[row];
      for (int j = 0; j < kJointCount; ++j)
        out.weights(row, j) += share * b.weights(i, mirrored ? kMirror[j] : j);
      for (int k = 0; k < 3 * kPoseFeatureCount; ++k)
        out.basis(row, k) +=
            share * (mirrored ? exchanged.sign[k] * b.basis(i, exchanged.from[k]) : b.basis(i, k));
    };
    // Each thread writes rows of its own.
    const auto every_other = [&](size_t first, size_t step) {
      Buffers b;
      for (size_t from = first * kChunk; from < rows.size(); from += step * kChunk) {
        const std::vector<int> chunk(rows.begin() + from,
                                     rows.begin() + std::min(from + kChunk, rows.size()));
        const Points seen = points(chunk, Eigen::all);
        impl_->evaluate(mirrored ? mirrored_points(seen, middle) : seen, side, b);
        for (size_t i = 0; i < chunk.size(); ++i) add(chunk[i], static_cast<Eigen::Index>(i), b);
      }
    };
    if (rows.size() <= 16 * kChunk || usable_threads() < 2) return every_other(0, 1);
    auto other = std::async(std::launch::async, every_other, 1, 2);
    every_other(0, 2);
    other.get();
  };
  one_side(false);
  one_side(true);
  return out;
}

}  // namespace understudy::nn
