#include "retarget/formats/scan_source.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <numeric>
#include <system_error>

#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/formats/mesh_reader.hpp"
#include "retarget/formats/scan_frames.hpp"

namespace understudy {
namespace fs = std::filesystem;
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// The run of digits at `at`, and how long it is without leading zeros.
std::pair<std::string_view, size_t> digits_at(std::string_view text, size_t at) {
  const size_t end = std::min(text.find_first_not_of("0123456789", at), text.size());
  const size_t begin = std::min(text.find_first_not_of('0', at), end - 1);
  return {text.substr(begin, end - begin), end - at};
}

// Numbers of the frames: from their names when these rise all along, else their positions.
std::vector<int64_t> frame_numbers(const std::vector<std::string>& files) {
  std::vector<int64_t> numbers;
  for (const auto& file : files) {
    const auto number = frame_number(file);
    if (!number || (!numbers.empty() && *number <= numbers.back())) {
      numbers.resize(files.size());
      std::iota(numbers.begin(), numbers.end(), int64_t{0});
      return numbers;
    }
    numbers.push_back(*number);
  }
  return numbers;
}

// The most frequent step between numbers.
int64_t usual_step(const std::vector<int64_t>& numbers) {
  std::map<int64_t, size_t> steps;
  for (size_t i = 1; i < numbers.size(); ++i) ++steps[numbers[i] - numbers[i - 1]];
  const auto rarer = [](const auto& a, const auto& b) { return a.second < b.second; };
  const auto most = std::max_element(steps.begin(), steps.end(), rarer);
  return most == steps.end() ? 1 : most->first;
}

void report_gaps(const std::string& source, const std::vector<FrameGap>& gaps) {
  if (gaps.empty()) return;
  std::string text;
  for (size_t i = 0; i < std::min<size_t>(gaps.size(), 5); ++i) {
    text += (i ? ", " : "") + std::to_string(gaps[i].first);
    if (gaps[i].last > gaps[i].first) text += "-" + std::to_string(gaps[i].last);
  }
  log::warn_once(source + ": frames are missing: " + text + (gaps.size() > 5 ? " and more" : ""));
}

constexpr int kHopeless = 100;  // unreadable frames from the first on, after which a sequence is given up

class FileFrames : public ScanSource::Frames {
 public:
  FileFrames(const std::vector<std::string>& files, const std::string& source) : source_(source) {
    const std::vector<int64_t> numbers = frame_numbers(files);
    const int64_t usual = usual_step(numbers);
    for (size_t i = 0; i < files.size(); ++i) {
      if (i > 0) add_missing(numbers[i - 1], numbers[i], usual);
      frames_.push_back({files[i], numbers[i]});
    }
  }

  std::optional<ScanFrame> next() override {
    if (at_ == frames_.size()) return {};
    const auto& [file, number] = frames_[at_];
    if (file.empty()) return ++at_, missing_frame(source_, number);
    ScanFrame frame = load_frame(file, number);
    US_CHECK(frame.usable || frames_.size() > 1, frame.problem);
    read_any_ |= frame.usable || frame.is_empty;
    US_CHECK(read_any_ || ++unreadable_ < kHopeless, source_, ": none of its first ", kHopeless,
             " frames can be read; ", frame.problem);
    ++at_;
    return frame;
  }
  std::optional<int64_t> count() const override { return static_cast<int64_t>(frames_.size()); }
  void seek(int64_t frame) override {
    US_CHECK(frame >= 0 && frame < *count(), "there is no frame ", frame, " among ", frames_.size());
    at_ = static_cast<size_t>(frame);
  }
  std::optional<ScanName> scan(int64_t frame) const override {
    const ScanName& name = frames_[static_cast<size_t>(frame)];
    return name.path.empty() ? std::nullopt : std::make_optional(name);
  }

 private:
  void add_missing(int64_t before, int64_t after, int64_t usual) {
    const int64_t count = missing_between(after - before, usual);
    if (count == 0) return;
    gaps.push_back({before + usual, before + count * usual});
    for (int64_t i = 1; i <= count && count <= kLongestGap; ++i) frames_.push_back({"", before + i * usual});
  }

  std::vector<ScanName> frames_;  // without a path: missing
  std::string source_;
  size_t at_ = 0;
  bool read_any_ = false;
  int unreadable_ = 0;  // while none was read
};

std::vector<std::string> under(const std::string& folder, const std::vector<std::string>& names) {
  std::vector<std::string> paths;
  paths.reserve(names.size());
  for (const auto& name : names) paths.push_back((fs::path(folder) / name).string());
  return paths;
}

// The paths in a list file; none when it is no list (a .txt may be a cloud).
std::vector<std::string> listed_files(const std::string& path) {
  const std::string bytes = read_file(path);
  const bool surely = !can_be(path, kScanFrame);
  std::vector<std::string> files;
  TextCursor text(bytes, path);
  std::vector<std::string_view> words;
  double number = 0;
  while (!text.at_end()) {
    const std::string_view line = trim_end(text.line());
    if (line.empty() || line[0] == '#') continue;
    split_words(line, ",;", words);
    if (!surely && files.empty() && (words.empty() || parse_number(words[0], number))) return {};
    const auto file = fs::path(path).parent_path() / fs::path(std::string(line));
    if (!surely && files.empty() && !can_be(file.string(), kScanFrame)) return {};
    files.push_back(file.string());
  }
  US_CHECK(!surely || !files.empty(), path, ": the list names no file");
  return files;
}

std::unique_ptr<ScanSource::Frames> open_file(const std::string& path) {
  const FileFormat* const format = format_of_suffix(path, kScanSequence);
  auto frames = format ? format->open(path) : nullptr;
  return frames ? std::move(frames) : std::make_unique<FileFrames>(std::vector<std::string>{path}, path);
}

}  // namespace

std::unique_ptr<ScanSource::Frames> listed_frames(const std::string& path) {
  auto files = listed_files(path);
  if (files.empty()) return nullptr;
  return std::make_unique<FileFrames>(std::move(files), path);
}

bool natural_less(const std::string& a, const std::string& b) {
  size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const auto [x, length_a] = digits_at(a, i);
      const auto [y, length_b] = digits_at(b, j);
      if (x.size() != y.size()) return x.size() < y.size();
      if (x != y) return x < y;
      i += length_a;
      j += length_b;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
    }
  }
  if (i < a.size() || j < b.size()) return j < b.size();
  return a < b;  // equal but for leading zeros
}

std::optional<int64_t> frame_number(const std::string& path) {
  const std::string stem = fs::path(path).stem().string();
  size_t end = stem.size();
  while (end > 0 && !is_digit(stem[end - 1])) --end;
  size_t begin = end;
  while (begin > 0 && is_digit(stem[begin - 1])) --begin;
  int64_t number = 0;
  if (begin == end || !parse_integer(std::string_view(stem).substr(begin, end - begin), number)) return {};
  return number;
}

void take_scan(ScanFrame& frame, const std::function<Mesh()>& read) {
  try {
    frame.mesh = read();
    thin_cloud(frame.mesh, kMostScanPoints);
    frame.is_empty = finite_count(frame.mesh.vertices) == 0;
    US_CHECK(!frame.is_empty, frame.path, ": has no ", frame.mesh.vertices.rows() > 0 ? "finite " : "",
             "points");
  } catch (const Error& error) {
    frame.problem = error.what();
  } catch (const std::bad_alloc&) {
    frame.problem = frame.path + ": is too large for this machine's memory";
  }
  frame.usable = frame.problem.empty();
}

ScanFrame load_frame(const std::string& path, int64_t number) {
  ScanFrame frame;
  frame.number = number;
  frame.path = path;
  take_scan(frame, [&] { return read_mesh(path); });
  return frame;
}

ScanFrame missing_frame(const std::string& sequence, int64_t number) {
  ScanFrame frame;
  frame.number = number;
  frame.usable = false;
  frame.problem = sequence + ": frame " + std::to_string(number) + " is missing";
  return frame;
}

std::vector<std::string> folder_files(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> names;
  fs::directory_iterator entry(folder, error);
  US_CHECK(!error, folder, ": cannot be opened (", error.message(), ")");
  while (entry != fs::directory_iterator()) {
    const std::string name = entry->path().filename().string();
    std::error_code ignored;
    if (!entry->is_directory(ignored)) names.push_back(name);
    entry.increment(error);
    US_CHECK(!error, folder, ": cannot be read (", error.message(), ")");
  }
  return names;
}

std::vector<std::string> frame_files(const std::string& folder, const std::vector<std::string>& names) {
  std::map<const FileFormat*, std::vector<std::string>> kinds, text;
  for (const auto& name : names) {
    const FileFormat* const format = format_of_suffix(name, kScanFrame);
    if (format && name[0] != '.') (format->is_plain_text ? text : kinds)[format].push_back(name);
  }
  if (kinds.empty()) kinds = std::move(text);
  if (kinds.empty()) return {};
  const auto fewer = [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); };
  auto best = std::max_element(kinds.begin(), kinds.end(), fewer);
  for (const auto& [format, files] : kinds) {
    if (format == best->first) continue;
    US_CHECK(files.size() < best->second.size(), folder, ": holds ", files.size(), " frames each of ",
             best->first->name, " and ", format->name, "; choose between them with a list of files");
    log::warn_once(folder + ": " + std::to_string(files.size()) + " " + format->name +
                   " files are left out, because most frames are " + best->first->name);
  }
  std::sort(best->second.begin(), best->second.end(), natural_less);
  return best->second;
}

ScanSource::ScanSource(const std::string& path, const ScanSourceOptions& options) {
  std::error_code error;
  const auto status = fs::status(path, error);
  US_CHECK(!path.empty() && status.type() != fs::file_type::not_found, path.empty() ? "''" : path,
           ": there is no such file or folder");
  US_CHECK(!error, path, ": cannot be opened (", error.message(), ")");
  if (fs::is_directory(status)) {
    if (options.follow) {
      US_CHECK(options.times.empty(), path, ": is still being written, its scans have no times yet (",
               options.times, ")");
      frames_ = follow_folder(path, options);
      return;
    }
    const auto names = frame_files(path, folder_files(path));
    US_CHECK(!names.empty(), path, ": holds no frames (", format_names(kScanFrame), " files)");
    frames_ = std::make_unique<FileFrames>(under(path, names), path);
  } else {
    US_CHECK(!options.follow, path, ": is a file, only a folder can be followed");
    frames_ = open_file(path);
  }
  if (options.times.empty())
    report_gaps(path, frames_->gaps);
  else
    frames_ = clock_frames(std::move(frames_), path, options.times, options.fps);
}

ScanSource::ScanSource(const std::vector<std::string>& files) {
  US_CHECK(!files.empty(), "the list of scans is empty");
  frames_ = std::make_unique<FileFrames>(files, "the list of scans");
  report_gaps("the list of scans", frames_->gaps);
}

}  // namespace understudy
