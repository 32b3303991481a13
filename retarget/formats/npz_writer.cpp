#include "retarget/formats/npz_writer.hpp"

#include <zip.h>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

constexpr size_t kNpyHeaderBytes =
    128;  // room for any shape; written again when the number of frames is known
constexpr zip_int64_t kFixedDate = 315532800;  // the same result, the same bytes

/// (3, 2), (3,) or ().
std::string shape_text(const std::vector<int64_t>& shape) {
  std::string text = "(";
  for (size_t i = 0; i < shape.size(); ++i) text += (i > 0 ? ", " : "") + std::to_string(shape[i]);
  return text + (shape.size() == 1 ? ",)" : ")");
}

std::string npy_header(const std::string& type, const std::vector<int64_t>& shape) {
  std::string header("\x93NUMPY\x01\x00", 8);
  header += static_cast<char>(kNpyHeaderBytes - 10);
  header += '\0';
  header += "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape_text(shape) + ", }";
  header.resize(kNpyHeaderBytes - 1, ' ');
  return header + '\n';
}

std::string frames_header(int64_t frames, std::vector<int64_t> shape) {
  shape.insert(shape.begin(), frames);
  return npy_header("<f4", shape);
}

/// An archive that is given up unless it is closed.
struct ZipWriter {
  explicit ZipWriter(const std::string& path) : file(path) {
    int code = 0;
    zip = zip_open(file.part().c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
    US_CHECK(zip, path, ": cannot be written");
  }
  ~ZipWriter() {
    if (zip) zip_discard(zip);
  }
  PartFile file;
  zip_t* zip = nullptr;
};

void add_entry(ZipWriter& archive, const std::string& name, zip_source_t* source, const std::string& path) {
  const zip_int64_t index = source ? zip_file_add(archive.zip, (name + ".npy").c_str(), source, 0) : -1;
  if (index < 0 && source) zip_source_free(source);
  US_CHECK(index >= 0, path, ": cannot be packed");
  zip_set_file_compression(archive.zip, static_cast<zip_uint64_t>(index), ZIP_CM_STORE, 0);
  zip_file_set_mtime(archive.zip, static_cast<zip_uint64_t>(index), kFixedDate, 0);
}

}  // namespace

size_t NpzWriter::add_frames(const std::string& name, const std::vector<int64_t>& frame_shape) {
  Array array;
  array.name = name;
  array.frame_shape = frame_shape;
  for (const int64_t n : frame_shape) array.frame_size *= n;
  array.file = std::make_unique<PartFile>(path_ + "." + name);
  array.file->write(frames_header(0, frame_shape));
  arrays_.push_back(std::move(array));
  return arrays_.size() - 1;
}

void NpzWriter::push(size_t index, const float* values) {
  Array& array = arrays_[index];
  array.file->write(values, static_cast<size_t>(array.frame_size) * sizeof(float));
  ++array.frames;
}

void NpzWriter::add(const std::string& name, const std::vector<int64_t>& shape,
                    const std::vector<double>& values) {
  Array array;
  array.name = name;
  array.bytes = npy_header("<f8", shape);
  array.bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
  arrays_.push_back(std::move(array));
}

void NpzWriter::add(const std::string& name, const std::string& text) {
  Array array;
  array.name = name;
  array.bytes = npy_header("<U" + std::to_string(text.size()), {});
  for (const char c : text) array.bytes += {c, '\0', '\0', '\0'};  // UTF-32, of plain letters
  arrays_.push_back(std::move(array));
}

void NpzWriter::finish() {
  ZipWriter archive(path_);
  for (Array& array : arrays_) {
    if (!array.file) {
      add_entry(archive, array.name,
                zip_source_buffer(archive.zip, array.bytes.data(), array.bytes.size(), 0), path_);
      continue;
    }
    array.file->rewrite(0, frames_header(array.frames, array.frame_shape));
    add_entry(archive, array.name, zip_source_file(archive.zip, array.file->part().c_str(), 0, -1), path_);
  }
  US_CHECK(zip_close(archive.zip) == 0, path_, ": cannot be written (", zip_strerror(archive.zip), ")");
  archive.zip = nullptr;
  arrays_.clear();
  archive.file.finish();
}

}  // namespace understudy
