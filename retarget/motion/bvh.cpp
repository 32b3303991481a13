#include "retarget/motion/bvh.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr size_t kMostJoints = 10000;
constexpr int kDeepest = 1000;
constexpr double kLongestFrame = 10;  // seconds

/// Words of a text, and the line they are on. Colons only part words: names are read apart.
class Words {
 public:
  Words(std::string_view text, const std::string& path) : text_(text), path_(path) {
    if (text_.substr(0, 3) == "\xEF\xBB\xBF") at_ = 3;
  }
  /// Empty at the end.
  std::string_view next() {
    skip_space();
    const size_t begin = at_;
    if (at_ < text_.size() && is_brace(text_[at_])) return text_.substr(at_++, 1);
    while (at_ < text_.size() && !is_space(text_[at_]) && !is_brace(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }
  std::string_view peek() {
    const Words before = *this;
    const std::string_view word = next();
    at_ = before.at_;
    line_ = before.line_;
    return word;
  }
  /// The rest of the line, which may hold spaces.
  std::string name() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    const size_t begin = at_;
    while (at_ < text_.size() && text_[at_] != '\n' && text_[at_] != '\r' && !is_brace(text_[at_])) ++at_;
    std::string name(text_.substr(begin, at_ - begin));
    while (!name.empty() && is_space(name.back())) name.pop_back();
    return name;
  }
  bool take(std::string_view wanted) {
    if (lower_case(peek()) != wanted) return false;
    next();
    return true;
  }
  void expect(std::string_view wanted) {
    const std::string_view found = peek();
    US_CHECK(take(wanted), where(), found.empty() ? "it ends" : "there is '" + excerpt(found) + "'",
             " where '", wanted, "' is expected");
  }
  double number(const char* what) {
    std::string_view word = next();
    if (!word.empty() && word[0] == '+') word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    US_CHECK(!word.empty(), where(), "it ends before ", what);
    US_CHECK(error == std::errc() && end == word.data() + word.size() && std::isfinite(value), where(), "'",
             excerpt(word), "' is not a number for ", what);
    return value;
  }
  std::string where() const { return path_ + ": line " + std::to_string(line_) + ": "; }
  size_t left() const { return text_.size() - at_; }

 private:
  static bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == ':';
  }
  static bool is_brace(char c) { return c == '{' || c == '}'; }
  void skip_space() {
    while (at_ < text_.size() && is_space(text_[at_])) line_ += text_[at_++] == '\n' ? 1 : 0;
  }

  std::string_view text_;
  const std::string& path_;
  size_t at_ = 0;
  int64_t line_ = 1;
};

/// One number of a frame: 0..2 a position along x, y, z, 3..5 a turn about them.
struct Channel {
  size_t node = 0;
  int what = 0;
};

class BvhReader {
 public:
  BvhReader(std::string_view text, const std::string& path) : words_(text, path), path_(path) {}
  Character read() {
    out_.name = std::filesystem::path(path_).stem().string();
    words_.expect("hierarchy");
    read_hierarchy();
    read_motion();
    check_character(out_, path_);
    return std::move(out_);
  }

 private:
  int add_node(const std::string& name, int parent) {
    US_CHECK(out_.nodes.size() < kMostJoints, words_.where(), "there are more than ", kMostJoints, " joints");
    CharacterNode node;
    node.name = name;
    node.parent = parent;
    out_.nodes.push_back(node);
    return out_.nodes.size() - 1;
  }

  void read_offset(int node) {
    for (int axis = 0; axis < 3; ++axis)
      out_.nodes[node].local.translation[axis] = static_cast<float>(words_.number("an offset"));
  }

  void read_channels(int node) {
    const double count = words_.number("the number of channels");
    US_CHECK(count >= 0 && count <= 6 && count == std::trunc(count), words_.where(),
             "a joint has 0 to 6 channels, not ", count);
    static const std::vector<std::string> names = {"xposition", "yposition", "zposition",
                                                   "xrotation", "yrotation", "zrotation"};
    for (int i = 0; i < static_cast<int>(count); ++i) {
      const std::string word(words_.next());
      const auto found = std::find(names.begin(), names.end(), lower_case(word));
      US_CHECK(found != names.end(), words_.where(), "'", excerpt(word), "' is not a channel");
      channels_.push_back({static_cast<size_t>(node), static_cast<int>(found - names.begin())});
    }
  }

  /// Without recursion: files may be as deep as they like.
  void read_hierarchy() {
    std::vector<int> open;  // joints whose brace is not closed yet
    while (true) {
      const std::string word = lower_case(words_.peek());
      if (word == "motion" && open.empty()) return;
      words_.next();
      if (word == "}") {
        US_CHECK(!open.empty(), words_.where(), "a brace closes that was never opened");
        open.pop_back();
      } else if ((word == "root" && open.empty()) || (word == "joint" && !open.empty())) {
        open.push_back(add_node(words_.name(), open.empty() ? -1 : open.back()));
        words_.expect("{");
      } else if (word == "end" && !open.empty()) {
        words_.name();  // "Site"
        const std::string name = out_.nodes[open.back()].name + "_end";
        open.push_back(add_node(name, open.back()));
        words_.expect("{");
      } else if (word == "offset" && !open.empty()) {
        read_offset(open.back());
      } else if (word == "channels" && !open.empty()) {
        read_channels(open.back());
      } else {
        throw Error(words_.where() + (word.empty()
                                          ? "it ends within the hierarchy"
                                          : "'" + excerpt(word) + "' is not expected in the hierarchy"));
      }
      US_CHECK(open.size() <= kDeepest, words_.where(), "its joints are more than ", kDeepest,
               " levels deep");
    }
  }

  void read_motion() {
    words_.expect("motion");
    words_.expect("frames");
    const double frames = words_.number("the number of frames");
    US_CHECK(frames >= 1 && frames <= 1e9 && frames == std::trunc(frames), words_.where(), "a motion of ",
             frames, " frames is not possible");
    words_.expect("frame");
    words_.expect("time");
    const double seconds = words_.number("the frame time");
    US_CHECK(seconds >= 1e-5 && seconds <= kLongestFrame, words_.where(), "a frame time of ", seconds,
             " s is not possible");
    read_frames(static_cast<int64_t>(frames), seconds);
  }

  void read_frames(int64_t frames, double seconds) {
    const auto count = static_cast<int64_t>(channels_.size());
    US_CHECK(count > 0, words_.where(), "no joint has a channel");
    // Each number takes a digit and a space at least.
    US_CHECK(frames * count <= static_cast<int64_t>(words_.left() / 2 + 1), words_.where(), frames,
             " frames of ", count, " numbers are announced, but the file ends long before");
    values_.resize(frames, count);
    for (int64_t f = 0; f < frames; ++f)
      for (int64_t c = 0; c < count; ++c) values_(f, c) = static_cast<float>(words_.number("all its frames"));
    if (!words_.peek().empty()) log::warn(words_.where() + "there is more than its frames; it is left out");
    add_tracks(frames, seconds);
  }

  void add_tracks(int64_t frames, double seconds) {
    std::vector<float> times(frames);
    for (size_t f = 0; f < times.size(); ++f) times[f] = static_cast<float>(static_cast<double>(f) * seconds);
    CharacterAnimation animation;
    animation.name = out_.name;
    for (size_t first = 0; first < channels_.size();) {
      size_t end = first;
      const size_t node = channels_[first].node;
      while (end < channels_.size() && channels_[end].node == node) ++end;
      const Vec3 offset = out_.nodes[node].local.translation;
      CharacterTrack place, turn;
      place.node = turn.node = node;
      place.path = TrackPath::Translation;
      bool moves = false, turns = false;
      for (int64_t f = 0; f < frames; ++f) {
        Vec3 position = offset;
        Eigen::Quaternionf q = Eigen::Quaternionf::Identity();
        for (size_t c = first; c < end; ++c) {
          const int what = channels_[c].what;
          const float value = values_(f, c);
          (what < 3 ? moves : turns) = true;
          if (what < 3)
            position[what] = value;
          else  // in the order of the channels, the first outermost
            q = q * Eigen::AngleAxisf(std::remainder(value, 360.0f) * kPi / 180, Vec3::Unit(what - 3));
        }
        place.values.insert(place.values.end(), position.data(), position.data() + 3);
        turn.values.insert(turn.values.end(), {q.x(), q.y(), q.z(), q.w()});
      }
      // Positions stand for the offset; below the root a few programs write how far they are from it instead.
      const Vec3 begin(place.values[0], place.values[1], place.values[2]);
      if (moves && out_.nodes[node].parent >= 0 && begin.norm() < 0.5f * offset.norm())
        for (size_t i = 0; i < place.values.size(); ++i) place.values[i] += offset[i % 3];
      if (moves) place.times = times, animation.tracks.push_back(std::move(place));
      if (turns) turn.times = times, animation.tracks.push_back(std::move(turn));
      first = end;
    }
    out_.animations.push_back(std::move(animation));
  }

  Words words_;
  const std::string& path_;
  Character out_;
  std::vector<Channel> channels_;
  RowMatrix values_;  // [frames, channels]
};

}  // namespace

Character parse_bvh(std::string_view text, const std::string& path) {
  return BvhReader(text, path).read();
}

Character read_bvh(const std::string& path) {
  return parse_bvh(read_file(path), path);
}

}  // namespace understudy
