// The frames of one .npy or .npz file, streamed from the file or out of the zip.
#include <zip.h>

#include <algorithm>
#include <cerrno>
#include <fstream>

#include "retarget/base/text.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/formats/scan_frames.hpp"

namespace understudy {
namespace {

// Bytes that come one after the other.
class ByteStream {
 public:
  virtual ~ByteStream() = default;
  // Reads up to `size` bytes; fewer only at the end.
  virtual size_t read(char* to, size_t size) = 0;
  // Goes on from the byte `offset` of the whole.
  virtual void seek(uint64_t offset) = 0;
  uint64_t size = 0;  // of all, from the file
};

class FileStream : public ByteStream {
 public:
  explicit FileStream(const std::string& path) {
    size = check_file(path);
    file_.open(path, std::ios::binary);
    US_CHECK(file_, path, ": cannot be opened (", std::strerror(errno), ")");
  }
  size_t read(char* to, size_t count) override {
    file_.read(to, static_cast<std::streamsize>(count));
    return static_cast<size_t>(file_.gcount());
  }
  void seek(uint64_t offset) override {
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(offset));
  }

 private:
  std::ifstream file_;
};

struct CloseZip {
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};

struct Archive {
  std::shared_ptr<zip_t> zip;
  uint64_t size = 0;  // of the file: packed sizes in its directory may be false
};

class ZipStream : public ByteStream {
 public:
  ZipStream(const Archive& archive, zip_uint64_t index)
      : zip_(archive.zip), index_(index), file_(zip_fopen_index(zip_.get(), index, 0)) {
    zip_stat_t about;
    zip_stat_init(&about);
    if (zip_stat_index(zip_.get(), index, 0, &about) != 0 || !(about.valid & ZIP_STAT_SIZE)) return;
    size = about.size;  // deflate makes at most 1032 bytes of one: what promises more is a lie
    uint64_t packed = archive.size;
    if (about.valid & ZIP_STAT_COMP_SIZE) packed = std::min<uint64_t>(packed, about.comp_size);
    size = std::min<uint64_t>(size, (packed + 1) * 1032);
  }
  size_t read(char* to, size_t count) override {
    size_t have = 0;
    while (file_ && have < count) {
      const zip_int64_t got = zip_fread(file_.get(), to + have, count - have);
      if (got <= 0) break;
      have += static_cast<size_t>(got);
    }
    at_ += have;
    return have;
  }
  // What is packed is read from its start.
  void seek(uint64_t offset) override {
    if (offset < at_) {
      file_.reset(zip_fopen_index(zip_.get(), index_, 0));
      at_ = 0;
    }
    std::string skipped(1 << 16, '\0');
    while (at_ < offset && read(skipped.data(), std::min<uint64_t>(skipped.size(), offset - at_)) > 0) {
    }
  }

 private:
  std::shared_ptr<zip_t> zip_;  // outlives what is open in it
  zip_uint64_t index_;
  uint64_t at_ = 0;
  std::unique_ptr<zip_file_t, CloseZip> file_;
};

struct NpyHeader {
  uint64_t bytes = 0;  // of the header itself: the numbers follow
  std::vector<int64_t> shape;
  NumberType type = NumberType::F32;
  bool swap = false;
  bool readable = false;  // a number type and order that is streamed here
};

// The text between a key of the header's dictionary and what ends its value.
std::string_view dictionary_value(std::string_view text, std::string_view key, char end) {
  const size_t at = text.find(key);
  if (at == text.npos) return {};
  const size_t begin = text.find(':', at);
  if (begin == text.npos) return {};
  const size_t stop = text.find(end, begin);
  return text.substr(begin + 1, stop == text.npos ? text.npos : stop - begin - 1);
}

NpyHeader read_npy_header(ByteStream& stream, const std::string& source) {
  std::string start(10, '\0');
  US_CHECK(stream.read(start.data(), 10) == 10 && starts_with(start, "\x93NUMPY"), source,
           ": is not a NumPy array");
  uint64_t length = load<uint16_t>(start.data() + 8, false);
  if (start[6] > 1) {  // version 2: four bytes
    char more[2];
    US_CHECK(stream.read(more, 2) == 2, source, ": ends inside its header");
    length |= static_cast<uint64_t>(load<uint16_t>(more, false)) << 16;
  }
  US_CHECK(length <= 65536, source, ": has a header of ", length, " bytes");
  std::string text(length, '\0');
  US_CHECK(stream.read(text.data(), length) == length, source, ": ends inside its header");

  NpyHeader header;
  header.bytes = (start[6] > 1 ? 12 : 10) + length;
  std::vector<std::string_view> words;
  split_words(dictionary_value(text, "'shape'", ')'), "(),", words);
  for (const auto& word : words) {
    int64_t size = 0;
    US_CHECK(parse_integer(word, size) && size >= 0, source, ": its shape is broken");
    header.shape.push_back(size);
  }
  split_words(dictionary_value(text, "'descr'", ','), "'\"", words);
  const std::string_view descr = words.empty() ? std::string_view() : words[0];
  const auto type = descr.size() == 3 ? number_type(descr.substr(1)) : std::nullopt;
  split_words(dictionary_value(text, "'fortran_order'", ','), "", words);
  header.readable = type && !words.empty() && words[0] == "False";
  header.swap = !descr.empty() && descr[0] == '>';
  if (type) header.type = *type;
  return header;
}

bool is_sequence(const std::vector<int64_t>& shape) {
  return shape.size() == 3 && shape[2] == 3;
}
bool is_frame(const std::vector<int64_t>& shape) {
  return shape.size() == 2 && shape[1] == 3;
}

class ArrayFrames : public ScanSource::Frames {
 public:
  ArrayFrames(const std::string& path, std::unique_ptr<ByteStream> stream, const NpyHeader& header)
      : path_(path), stream_(std::move(stream)), header_(header) {
    US_CHECK(header.readable, path,
             ": its numbers are not in C order or of a type that is read; save it as float32");
    const bool sequence = is_sequence(header.shape);
    frames_ = sequence ? header.shape[0] : 1;
    points_ = header.shape[sequence ? 1 : 0];
    const uint64_t width = 3 * size_of(header.type), left = stream_->size;
    US_CHECK(points_ >= 0 && static_cast<uint64_t>(points_) <= left / width &&
                 (points_ == 0 ||
                  static_cast<uint64_t>(frames_) <= left / (width * static_cast<uint64_t>(points_))),
             path, ": its header says ", frames_, " frames of ", points_,
             " points, more than the file can hold");
    US_CHECK(frames_ > 0 && points_ > 0, path, ": holds no points");
    bytes_.resize(width * static_cast<uint64_t>(points_));
  }

  std::optional<ScanFrame> next() override {
    if (at_ == frames_) return {};
    US_CHECK(stream_->read(bytes_.data(), bytes_.size()) == bytes_.size(), path_, ": ends before frame ", at_,
             " of ", frames_);
    ScanFrame frame;
    frame.number = at_++;
    frame.path = path_;
    frame.mesh.vertices.resize(points_, 3);
    frame.mesh.faces = faces;
    const char* from = bytes_.data();
    float* const to = frame.mesh.vertices.data();
    for (Eigen::Index i = 0; i < 3 * points_; ++i, from += size_of(header_.type))
      to[i] = narrow(load_number(header_.type, from, header_.swap));
    frame.usable = finite_count(frame.mesh.vertices) > 0;
    if (!frame.usable)
      frame.problem = path_ + ": frame " + std::to_string(frame.number) + " has no finite points";
    return frame;
  }
  std::optional<int64_t> count() const override { return frames_; }
  void seek(int64_t frame) override {
    US_CHECK(frame >= 0 && frame < frames_, path_, ": there is no frame ", frame, " among ", frames_);
    at_ = frame;
    stream_->seek(header_.bytes + bytes_.size() * static_cast<uint64_t>(frame));
  }
  int64_t points() const { return points_; }

  Faces faces{0, 3};

 private:
  std::string path_;
  std::unique_ptr<ByteStream> stream_;
  NpyHeader header_;
  int64_t frames_ = 0, points_ = 0, at_ = 0;
  std::string bytes_;
};

std::string entry_name(zip_t* zip, zip_int64_t index) {
  const char* const name = zip_get_name(zip, static_cast<zip_uint64_t>(index), 0);
  return name ? name : "";
}

// `points`, then `vertices`, then the first array of the shape of a sequence; -1: none.
zip_int64_t find_array(const Archive& archive, const std::string& path) {
  for (const char* const name : {"points.npy", "vertices.npy"}) {
    const zip_int64_t index = zip_name_locate(archive.zip.get(), name, 0);
    if (index < 0) continue;
    ZipStream stream(archive, static_cast<zip_uint64_t>(index));
    const auto shape = read_npy_header(stream, path + " (" + name + ")").shape;
    if (is_sequence(shape) || is_frame(shape)) return index;
  }
  const zip_int64_t count = zip_get_num_entries(archive.zip.get(), 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const std::string name = entry_name(archive.zip.get(), i);
    if (!ends_with(name, ".npy")) continue;
    ZipStream stream(archive, static_cast<zip_uint64_t>(i));
    if (is_sequence(read_npy_header(stream, detail::join(path, " (", name, ")")).shape)) return i;
  }
  return -1;
}

// Faces beside the points, where they fit.
Faces read_faces(const Archive& archive, int64_t points, const std::string& path) {
  const zip_int64_t index = zip_name_locate(archive.zip.get(), "faces.npy", 0);
  if (index < 0) return Faces(0, 3);
  ZipStream stream(archive, static_cast<zip_uint64_t>(index));
  const NpyHeader header = read_npy_header(stream, path + " (faces)");
  const uint64_t width = 3 * size_of(header.type);
  if (!header.readable || !is_frame(header.shape) ||
      static_cast<uint64_t>(header.shape[0]) > stream.size / width)
    return Faces(0, 3);
  FaceList faces;
  char row[24];
  for (int64_t i = 0; i < header.shape[0]; ++i) {
    US_CHECK(stream.read(row, width) == width, path, ": its faces are cut off");
    int64_t corners[3];
    for (size_t c = 0; c < 3; ++c)
      corners[c] = whole(load_number(header.type, row + c * width / 3, header.swap));
    faces.add(corners, 3);
  }
  return faces.finish(points, path);
}

}  // namespace

std::unique_ptr<ScanSource::Frames> npy_frames(const std::string& path) {
  auto stream = std::make_unique<FileStream>(path);
  const NpyHeader header = read_npy_header(*stream, path);
  US_CHECK(is_sequence(header.shape) || is_frame(header.shape), path,
           ": its array is not frames x points x 3");
  return std::make_unique<ArrayFrames>(path, std::move(stream), header);
}

std::unique_ptr<ScanSource::Frames> npz_frames(const std::string& path) {
  const FileStream readable(path);  // throws when it cannot be read
  int code = 0;
  const std::shared_ptr<zip_t> zip(zip_open(path.c_str(), ZIP_RDONLY, &code), [](zip_t* z) {
    if (z) zip_discard(z);
  });
  const Archive archive{zip, readable.size};
  US_CHECK(zip, path, ": is not a .npz file, or is cut off");
  const zip_int64_t index = find_array(archive, path);
  US_CHECK(index >= 0, path, ": holds no array of frames x points x 3");
  auto stream = std::make_unique<ZipStream>(archive, static_cast<zip_uint64_t>(index));
  const NpyHeader header = read_npy_header(*stream, path);
  auto frames = std::make_unique<ArrayFrames>(path, std::move(stream), header);
  frames->faces = read_faces(archive, frames->points(), path);
  return frames;
}

}  // namespace understudy
