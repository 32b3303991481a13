#include "retarget/formats/result_writer.hpp"

#include <zip.h>

#include <cstdio>

#include "retarget/base/error.hpp"

namespace understudy {

namespace {

constexpr size_t kHeaderBytes = 128;  // room for any shape; written again when the number of frames is known

std::string npy_header(int64_t frames, const std::string& shape) {
  std::string header("\x93NUMPY\x01\x00", 8);
  header += static_cast<char>(kHeaderBytes - 10);
  header += '\0';
  header += detail::join("{'descr': '<f4', 'fortran_order': False, 'shape': (", frames, ", ", shape, "), }");
  header.resize(kHeaderBytes - 1, ' ');
  return header + '\n';
}

}  // namespace

ResultWriter::ResultWriter(const std::string& path, int64_t vertex_count)
    : path_(path), vertex_count_(vertex_count) {
  arrays_[0] = {"vertices", detail::join(vertex_count, ", 3"), {}};
  arrays_[1] = {"joints", "22, 3", {}};
  arrays_[2] = {"rotations", "22, 3, 3", {}};
  arrays_[3] = {"source_joints", "22, 3", {}};
  for (Array& array : arrays_) {
    array.file.open(part_path(array), std::ios::binary);
    US_CHECK(array.file, path_, ": cannot be written");
    array.file << npy_header(0, array.shape);
  }
}

ResultWriter::~ResultWriter() {
  for (Array& array : arrays_) {
    array.file.close();
    std::remove(part_path(array).c_str());
  }
}

std::string ResultWriter::part_path(const Array& array) const {
  return path_ + "." + array.name + ".part";
}

void ResultWriter::write(Array& array, const float* values, int64_t count) {
  array.file.write(reinterpret_cast<const char*>(values), count * static_cast<int64_t>(sizeof(float)));
  US_CHECK(array.file, path_, ": writing failed, the disk may be full");
}

void ResultWriter::push(const Points& vertices, const Joints& joints, const Rotations& local,
                        const Joints& source_joints) {
  US_CHECK(vertices.rows() == vertex_count_, path_, ": a frame has ", vertices.rows(),
           " vertices, the first had ", vertex_count_);
  std::array<float, kJointCount * 9> rotations;
  for (int j = 0; j < kJointCount; ++j)
    for (int i = 0; i < 9; ++i) rotations[9 * j + i] = local[j](i / 3, i % 3);
  write(arrays_[0], vertices.data(), vertices.size());
  write(arrays_[1], joints.data(), joints.size());
  write(arrays_[2], rotations.data(), static_cast<int64_t>(rotations.size()));
  write(arrays_[3], source_joints.data(), source_joints.size());
  ++frames_;
}

void ResultWriter::finish() {
  for (Array& array : arrays_) {
    array.file.seekp(0);
    array.file << npy_header(frames_, array.shape);
    array.file.close();
    US_CHECK(array.file, path_, ": writing failed, the disk may be full");
  }
  const std::string part = path_ + ".part";
  int code = 0;
  zip_t* archive = zip_open(part.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
  US_CHECK(archive, path_, ": cannot be written");
  for (const Array& array : arrays_) {
    zip_source_t* source = zip_source_file(archive, part_path(array).c_str(), 0, -1);
    const zip_int64_t index = source ? zip_file_add(archive, (array.name + ".npy").c_str(), source, 0) : -1;
    if (index < 0) {
      if (source) zip_source_free(source);
      zip_discard(archive);
      US_CHECK(false, path_, ": cannot be packed");
    }
    zip_set_file_compression(archive, static_cast<zip_uint64_t>(index), ZIP_CM_STORE, 0);
    zip_file_set_mtime(archive, static_cast<zip_uint64_t>(index), 315532800,
                       0);  // the same result, the same bytes
  }
  if (zip_close(archive) != 0) {
    const std::string why = zip_strerror(archive);
    zip_discard(archive);
    std::remove(part.c_str());
    US_CHECK(false, path_, ": writing failed (", why, ")");
  }
  US_CHECK(std::rename(part.c_str(), path_.c_str()) == 0, path_, ": cannot be written");
}

}  // namespace understudy
