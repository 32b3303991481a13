#include "retarget/formats/result_writer.hpp"

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

enum ResultArray : size_t { Vertices, JointsArray, RotationsArray, SourceJoints };

}  // namespace

ResultWriter::ResultWriter(const std::string& path, int64_t vertex_count)
    : path_(path), vertex_count_(vertex_count), npz_(path) {
  npz_.add_frames("vertices", {vertex_count, 3});
  npz_.add_frames("joints", {kJointCount, 3});
  npz_.add_frames("rotations", {kJointCount, 3, 3});
  npz_.add_frames("source_joints", {kJointCount, 3});
}

void ResultWriter::push(const Points& vertices, const Joints& joints, const Rotations& local,
                        const Joints& source_joints) {
  US_CHECK(vertices.rows() == vertex_count_, path_, ": a frame has ", vertices.rows(),
           " vertices, the first had ", vertex_count_);
  std::array<float, kJointCount * 9> rotations;
  for (size_t j = 0; j < kJointCount; ++j)
    for (int i = 0; i < 9; ++i) rotations[9 * j + static_cast<size_t>(i)] = local[j](i / 3, i % 3);
  npz_.push(Vertices, vertices.data());
  npz_.push(JointsArray, joints.data());
  npz_.push(RotationsArray, rotations.data());
  npz_.push(SourceJoints, source_joints.data());
}

void ResultWriter::finish(const Eigen::Matrix4d& source_to_scan) {
  const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> rows = source_to_scan;
  npz_.add("source_to_scan", {4, 4}, {rows.data(), rows.data() + rows.size()});
  npz_.finish();
}

}  // namespace understudy
