#include "app/cli/outputs.hpp"

#include "retarget/base/error.hpp"
#include "retarget/formats/npz.hpp"

namespace understudy::app {
namespace {

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

void append(std::vector<float>& values, const float* from, Eigen::Index count) {
  values.insert(values.end(), from, from + count);
}

/// vertices T x V x 3, joints T x 22 x 3, rotations T x 22 x 3 x 3 (local, row by row), source_joints T x 22 x 3: all
/// figures, for others to judge. Holds the sequence in memory until the end.
class FiguresOutput final : public Output {
 public:
  FiguresOutput(std::string path, int64_t vertex_count) : path_(std::move(path)), vertex_count_(vertex_count) {}

  void push(const PerformedFrame& frame) override {
    const RetargetedFrame& result = frame.result;
    append(vertices_, result.vertices.data(), result.vertices.size());
    append(joints_, result.joints.data(), result.joints.size());
    append(source_joints_, frame.source_joints.data(), frame.source_joints.size());
    for (const Mat3& R : result.pose.local) {
      const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> rows = R;
      append(rotations_, rows.data(), rows.size());
    }
    ++frames_;
  }

  void finish() override {
    write_npz(path_, {{"vertices", {{frames_, vertex_count_, 3}, std::move(vertices_), {}}},
                      {"joints", {{frames_, kJointCount, 3}, std::move(joints_), {}}},
                      {"rotations", {{frames_, kJointCount, 3, 3}, std::move(rotations_), {}}},
                      {"source_joints", {{frames_, kJointCount, 3}, std::move(source_joints_), {}}}});
  }

 private:
  std::string path_;
  int64_t vertex_count_, frames_ = 0;
  std::vector<float> vertices_, joints_, rotations_, source_joints_;
};

}  // namespace

std::unique_ptr<Output> open_output(const std::string& path, const Mesh& target, const Retargeter&, double) {
  US_CHECK(ends_with(path, ".npz"), path, ": this output format is not known, use .glb or .npz");
  return std::make_unique<FiguresOutput>(path, target.vertices.rows());
}

}  // namespace understudy::app
