#include "retarget/formats/npz.hpp"

#include <zip.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <memory>

#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/bytes.hpp"

namespace understudy {
namespace {

constexpr char kNoNumber = '?';           // objects, dates, records: their kind
constexpr int kLongestElement = 1 << 24;  // bytes, or characters of a text
constexpr uint64_t kMostTexts = 65536;    // names: more are no list of names

struct Header {
  char kind = 'f';  // f, i, u, b, U
  int bytes = 4;    // per element
  bool big_endian = false;
  bool fortran = false;
  std::vector<int64_t> shape;
  size_t data_offset = 0;
};

std::string quoted_value(const std::string& dict, const std::string& key) {
  const size_t at = dict.find("'" + key + "'");
  const size_t open = at == std::string::npos ? at : dict.find('\'', at + key.size() + 2);
  const size_t close = open == std::string::npos ? open : dict.find('\'', open + 1);
  return close == std::string::npos ? "" : dict.substr(open + 1, close - open - 1);
}

std::vector<int64_t> shape_of(const std::string& dict, const std::string& source) {
  const size_t at = dict.find("'shape'");
  const size_t open = at == std::string::npos ? at : dict.find('(', at);
  const size_t close = open == std::string::npos ? open : dict.find(')', open);
  US_CHECK(close != std::string::npos, source, ": the array header has no shape");
  std::vector<int64_t> shape;
  for (const std::string& part : split(dict.substr(open + 1, close - open - 1), ',')) {
    if (part.find_first_of("0123456789") == std::string::npos) continue;
    long long extent = -1;
    US_CHECK(std::sscanf(part.c_str(), " %lld", &extent) == 1 && extent >= 0, source,
             ": bad extent in the array's shape");
    shape.push_back(extent);
  }
  US_CHECK(shape.size() <= 64, source, ": the array has ", shape.size(), " dimensions");
  return shape;
}

Header parse_header(const std::string& bytes, const std::string& source) {
  US_CHECK(bytes.size() >= 10 && starts_with(bytes, "\x93NUMPY"), source, ": not a NumPy array");
  const bool is_wide = static_cast<unsigned char>(bytes[6]) >= 2;
  const size_t start = is_wide ? 12 : 10;
  US_CHECK(bytes.size() >= start, source, ": the array header is cut off");
  const uint64_t length =
      is_wide ? load<uint32_t>(bytes.data() + 8, false) : load<uint16_t>(bytes.data() + 8, false);
  US_CHECK(start + length <= bytes.size(), source, ": the array header is cut off");
  const std::string dict = bytes.substr(start, length);
  const std::string descr = quoted_value(dict, "descr");
  Header header;
  header.kind = kNoNumber;
  header.bytes = 0;
  if (descr.size() >= 3) {
    const char* const end = descr.data() + descr.size();
    const auto [stop, problem] = std::from_chars(descr.data() + 2, end, header.bytes);
    if (problem == std::errc() && stop == end && header.bytes >= 0 && header.bytes <= kLongestElement)
      header.kind = descr[1];
    header.big_endian = descr[0] == '>';
  }
  if (header.kind == 'U') header.bytes *= 4;
  header.fortran = dict.find("'fortran_order': True") != std::string::npos;
  header.shape = shape_of(dict, source);
  header.data_offset = start + length;
  return header;
}

/// None for what is no number, or of a size that NumPy's numbers do not have.
std::optional<NumberType> type_of(const Header& header) {
  return number_type(std::string(1, header.kind == 'b' ? 'u' : header.kind) + std::to_string(header.bytes));
}

std::string text_from_ucs4(const char* data, int bytes) {
  std::string text;
  for (int i = 0; i + 4 <= bytes; i += 4) {
    uint32_t code;
    std::memcpy(&code, data + i, 4);
    if (code == 0) break;
    text += code < 128 ? static_cast<char>(code) : '?';
  }
  return text;
}

/// As many strings as the shape says and the bytes hold, at most kMostTexts.
std::vector<std::string> texts_from_ucs4(const char* data, uint64_t available, const Header& header) {
  std::vector<std::string> texts;
  uint64_t wanted = 1;
  for (const int64_t extent : header.shape)
    wanted = std::min(kMostTexts, wanted * std::min<uint64_t>(extent, kMostTexts));
  const auto step = static_cast<uint64_t>(header.bytes);
  for (uint64_t at = 0; texts.size() < wanted && at < available && step > 0; at += step)
    texts.push_back(text_from_ucs4(data + at, static_cast<int>(std::min(available - at, step))));
  return texts;
}

/// Fortran order to C order.
template <class T>
std::vector<T> reordered(const std::vector<T>& values, const std::vector<int64_t>& shape) {
  std::vector<T> result(values.size());
  std::vector<int64_t> index(shape.size(), 0);
  for (size_t from = 0; from < values.size(); ++from) {
    int64_t to = 0;
    for (size_t d = 0; d < shape.size(); ++d) to = to * shape[d] + index[d];
    result[to] = values[from];
    for (size_t d = 0; d < shape.size() && ++index[d] == shape[d]; ++d) index[d] = 0;
  }
  return result;
}

struct ZipCloser {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};
using Zip = std::unique_ptr<zip_t, ZipCloser>;

constexpr uint64_t kLargestArray = uint64_t{8} << 30;  // bytes of one array: above it the header lies

Zip open_archive(const std::string& path) {
  US_CHECK(check_file(path) > 0, path, ": is empty");
  int code = 0;
  Zip archive(zip_open(path.c_str(), ZIP_RDONLY, &code));
  US_CHECK(archive, path, ": not an .npz archive");
  return archive;
}

/// The name of the array in an entry; none for entries of other kinds.
std::optional<std::string> array_name(zip_t* archive, zip_int64_t index) {
  const char* const name = zip_get_name(archive, index, 0);
  const std::string_view text = name ? name : "";
  if (!ends_with(text, ".npy")) return {};
  return std::string(text.substr(0, text.size() - 4));
}

std::string read_entry(zip_t* archive, zip_int64_t index, uint64_t archive_size, const std::string& source) {
  zip_stat_t stat;
  US_CHECK(zip_stat_index(archive, index, 0, &stat) == 0, source, ": the archive is damaged");
  // Deflate cannot expand more than 1032 times: a claim beyond that is a lie, found before memory is taken.
  const uint64_t packed = std::min<uint64_t>(stat.comp_size, archive_size);
  US_CHECK(stat.size <= kLargestArray && stat.size <= packed * 1040 + 1024, source,
           ": the archive's sizes are impossible");
  std::string bytes(stat.size, '\0');
  zip_file_t* file = zip_fopen_index(archive, index, 0);
  US_CHECK(file, source, ": the archive is damaged");
  const zip_int64_t got = zip_fread(file, bytes.data(), bytes.size());
  zip_fclose(file);
  US_CHECK(got >= 0 && static_cast<uint64_t>(got) == stat.size, source,
           ": the archive is damaged or cut off");
  return bytes;
}

std::string npy_bytes(const NpyArray& array) {
  std::string dict = "{'descr': '<f4', 'fortran_order': False, 'shape': (";
  for (int64_t extent : array.shape) dict += std::to_string(extent) + ",";
  dict += "), }";
  dict.append(63 - (10 + dict.size()) % 64, ' ').append("\n");
  std::string bytes("\x93NUMPY\x01\x00", 8);
  bytes += static_cast<char>(dict.size() & 255);
  bytes += static_cast<char>(dict.size() >> 8);
  bytes += dict;
  return bytes.append(reinterpret_cast<const char*>(array.values.data()),
                      array.values.size() * sizeof(float));
}

}  // namespace

RowMatrix NpyArray::matrix(int64_t cols, const std::string& what) const {
  US_CHECK(cols > 0 && size() % cols == 0, what, ": ", size(), " numbers do not make rows of ", cols);
  return Eigen::Map<const RowMatrix>(values.data(), size() / cols, cols);
}

IntegerMatrix NpyArray::integers(int64_t cols, const std::string& what) const {
  if (whole.empty())
    return matrix(cols, what).unaryExpr([](float value) { return understudy::whole(value); });
  US_CHECK(cols > 0 && size() % cols == 0, what, ": ", size(), " numbers do not make rows of ", cols);
  return Eigen::Map<const IntegerMatrix>(whole.data(), size() / cols, cols);
}

NpyArray parse_npy(const std::string& bytes, const std::string& source) {
  const Header header = parse_header(bytes, source);
  NpyArray array;
  array.shape = header.shape;
  const uint64_t available = bytes.size() - header.data_offset;
  if (header.kind == 'U') {
    array.texts = texts_from_ucs4(bytes.data() + header.data_offset, available, header);
    if (!array.texts.empty()) array.text = array.texts.front();
    return array;
  }
  const auto type = type_of(header);
  US_CHECK(type, source, ": arrays of this number type cannot be read");
  uint64_t count = 1;
  for (int64_t extent : header.shape) {
    const uint64_t e = static_cast<uint64_t>(extent);
    US_CHECK(e == 0 || count <= kLargestArray / e, source, ": the array's shape is impossibly large");
    count *= e;
  }
  US_CHECK(count <= available / header.bytes, source, ": ends before its ", count, " numbers");
  array.values.resize(count);
  if (!is_float(*type)) array.whole.resize(count);
  const char* data = bytes.data() + header.data_offset;
  for (uint64_t i = 0; i < count; ++i, data += header.bytes) {
    const double value = load_number(*type, data, header.big_endian);
    array.values[i] = narrow(value);
    if (!array.whole.empty()) array.whole[i] = whole(value);
  }
  if (header.fortran && header.shape.size() > 1) {
    array.values = reordered(array.values, header.shape);
    array.whole = reordered(array.whole, header.shape);
  }
  return array;
}

std::vector<std::string> npz_names(const std::string& path) {
  const Zip archive = open_archive(path);
  std::vector<std::string> names;
  for (zip_int64_t i = 0; i < zip_get_num_entries(archive.get(), 0); ++i)
    if (const auto name = array_name(archive.get(), i)) names.push_back(*name);
  return names;
}

Npz read_npz(const std::string& path) {
  const Zip archive = open_archive(path);
  const uint64_t archive_size = check_file(path);
  Npz npz;
  for (zip_int64_t i = 0; i < zip_get_num_entries(archive.get(), 0); ++i) {
    const auto name = array_name(archive.get(), i);
    if (!name) continue;
    const std::string source = path + ": " + *name;
    const std::string bytes = read_entry(archive.get(), i, archive_size, source);
    const Header header = parse_header(bytes, source);
    if (header.kind == 'U' || type_of(header)) npz[*name] = parse_npy(bytes, source);
  }
  return npz;
}

const NpyArray& require(const Npz& npz, const std::string& name, const std::string& source) {
  const auto it = npz.find(name);
  US_CHECK(it != npz.end(), source, ": has no array '", name, "'");
  return it->second;
}

void write_npz(const std::string& path, const Npz& npz) {
  PartFile file(path);
  int code = 0;
  Zip archive(zip_open(file.part().c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code));
  US_CHECK(archive, path, ": cannot be written");
  std::vector<std::string> kept;  // libzip reads the buffers when it closes
  kept.reserve(npz.size());
  for (const auto& [name, array] : npz) {
    kept.push_back(npy_bytes(array));
    zip_source_t* source = zip_source_buffer(archive.get(), kept.back().data(), kept.back().size(), 0);
    const zip_int64_t index = zip_file_add(archive.get(), (name + ".npy").c_str(), source, ZIP_FL_OVERWRITE);
    US_CHECK(index >= 0, path, ": cannot be written");
    zip_file_set_mtime(archive.get(), index, 315532800, 0);  // a fixed date: the same arrays, the same bytes
  }
  US_CHECK(zip_close(archive.get()) == 0, path, ": cannot be written (", zip_strerror(archive.get()), ")");
  static_cast<void>(archive.release());  // closed above
  file.finish();
}

}  // namespace understudy
