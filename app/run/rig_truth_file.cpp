#include "app/run/rig_truth_file.hpp"

#include <algorithm>

#include "app/run/case_writer.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"

namespace understudy::app {
namespace {

using Row3 = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;
constexpr int kBoneNumbers = 12;

/// [rows, columns] of a matrix that lies row by row.
template <class Matrix>
NpyArray whole_array(const Matrix& matrix) {
  static_assert(Matrix::IsRowMajor);
  NpyArray array;
  array.shape = {matrix.rows(), matrix.cols()};
  for (Eigen::Index i = 0; i < matrix.size(); ++i)
    array.values.push_back(static_cast<float>(matrix.data()[i]));
  return array;
}

/// The array of that many axes whose last ones are `tail`.
const NpyArray& array_of(const Npz& npz, const char* name, const std::vector<int64_t>& tail,
                         const std::string& path) {
  const NpyArray& array = require(npz, name, path);
  US_CHECK(array.shape.size() == tail.size() + 1 && array.shape[0] > 0 &&
               std::equal(tail.begin(), tail.end(), array.shape.begin() + 1),
           path, ": ", name, " has the wrong shape");
  return array;
}

std::vector<Points> frames_of(const NpyArray& array) {
  const int64_t rows = array.shape[1];
  std::vector<Points> frames;
  for (int64_t t = 0; t < array.shape[0]; ++t)
    frames.emplace_back(Eigen::Map<const Points>(array.values.data() + t * rows * 3, rows, 3));
  return frames;
}

}  // namespace

Npz rig_truth_arrays(const RigTruth& truth) {
  check_rig_truth(truth);
  const int64_t V = truth.rest.rows(), J = truth.count();
  Npz arrays{{"vertices", frames_array(truth.vertices, {V, 3})},
             {"joints", frames_array(truth.joints, {J, 3})},
             {"weights", whole_array(truth.weights)},
             {"faces", whole_array(truth.faces)},
             {"rest", whole_array(truth.rest)}};
  arrays["parents"] = {{J}, {truth.parents.begin(), truth.parents.end()}, ""};
  NpyArray& axes = arrays["axes"];
  axes.shape = {J, 3};
  for (const Vec3& axis : truth.axes) axes.values.insert(axes.values.end(), axis.begin(), axis.end());
  NpyArray& bones = arrays["bones"];
  bones.shape = {truth.frames(), J, kBoneNumbers};
  for (const BoneMotions& frame : truth.bones)
    for (const RigidMotion& bone : frame) {
      const Row3 R = bone.R;
      bones.values.insert(bones.values.end(), R.data(), R.data() + 9);
      bones.values.insert(bones.values.end(), bone.t.begin(), bone.t.end());
    }
  return arrays;
}

bool is_rig_truth(const Npz& npz) {
  return npz.count("parents") > 0;
}

RigTruth rig_truth_of(const Npz& npz, const std::string& path) {
  RigTruth truth;
  for (const float parent : array_of(npz, "parents", {}, path).values)
    truth.parents.push_back(static_cast<int>(parent));
  const int64_t J = truth.count();
  const NpyArray& rest = array_of(npz, "rest", {3}, path);
  const int64_t V = rest.shape[0];
  truth.rest = rest.matrix(3, path);
  truth.vertices = frames_of(array_of(npz, "vertices", {V, 3}, path));
  truth.joints = frames_of(array_of(npz, "joints", {J, 3}, path));
  const NpyArray& weights = array_of(npz, "weights", {J}, path);
  truth.weights = weights.matrix(J, path);
  truth.faces = array_of(npz, "faces", {3}, path).matrix(3, path).cast<int>();
  const RowMatrix axes = array_of(npz, "axes", {3}, path).matrix(3, path);
  for (const auto& axis : axes.rowwise()) truth.axes.emplace_back(axis.transpose());
  const NpyArray& bones = array_of(npz, "bones", {J, kBoneNumbers}, path);
  for (int64_t t = 0; t < bones.shape[0]; ++t) {
    BoneMotions& frame = truth.bones.emplace_back();
    for (int64_t j = 0; j < J; ++j) {
      const float* numbers = bones.values.data() + (t * J + j) * kBoneNumbers;
      frame.push_back({Mat3(Eigen::Map<const Row3>(numbers)), Vec3(numbers[9], numbers[10], numbers[11])});
    }
  }
  const std::string wrong = failure_of([&] { check_rig_truth(truth); });
  US_CHECK(wrong.empty(), path, ": ", wrong);
  return truth;
}

}  // namespace understudy::app
