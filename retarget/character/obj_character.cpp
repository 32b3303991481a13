#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "retarget/character/picture.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/character/vertex_colors.hpp"
#include "retarget/formats/bytes.hpp"

namespace understudy {
namespace {

using nlohmann::json;

/// What a path in the file stands for; none outside of its folder. Backslashes are how some programs write
/// it.
std::optional<std::string> beside(const std::string& path, std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  const std::filesystem::path inside = std::filesystem::path(name).lexically_normal();
  if (!inside.is_relative() || inside.empty() || *inside.begin() == ".." || name.find('\0') != name.npos)
    return {};
  return (std::filesystem::path(path).parent_path() / inside).string();
}

/// A line from its second word on: names may hold blanks.
std::string from_second(std::string_view line, const std::vector<std::string_view>& words) {
  return std::string(trim_end(line.substr(words[1].data() - line.data())));
}

struct ObjMaterial {
  Vec3 color = Vec3(0.8f, 0.8f, 0.8f);
  float alpha = 1;
  std::string picture;
};

class ObjReader {
 public:
  ObjReader(std::string_view bytes, const std::string& path) : text_(bytes, path), path_(path) {}
  Character read();

 private:
  using Corner = std::array<int64_t, 3>;  // position, texture, normal; -1: none
  struct Group {
    std::vector<Corner> corners;  // three a triangle
    std::vector<Corner> loose;    // of no face
  };

  void line(std::string_view text);
  void numbers(std::vector<float>& to, size_t least, size_t keep);
  void face();
  void add_loose();
  int64_t index(std::string_view text, size_t count) const;
  void read_materials(const std::string& name);
  void finish_group(const std::string& material, const Group& group, Character& out);
  int material(const std::string& name, Character& out);
  int texture(const std::string& name, Character& out);

  TextCursor text_;
  const std::string& path_;
  int64_t number_ = 0;
  std::vector<std::string_view> words_;
  std::vector<float> positions_, colors_, uvs_, normals_;
  std::map<std::string, Group> groups_;
  std::map<std::string, ObjMaterial> materials_;
  std::map<std::string, int> textures_;  // by file: pictures are kept once
  std::set<std::string> libraries_;
  Group* current_ = nullptr;  // where faces go; null: to the group without a name
};

void ObjReader::numbers(std::vector<float>& to, size_t least, size_t keep) {
  US_CHECK(words_.size() > least, path_, ": line ", number_, ": has fewer than ", least, " numbers");
  for (size_t i = 1; i <= keep; ++i) {
    double value = 0;
    US_CHECK(i >= words_.size() || parse_number(words_[i], value), path_, ": line ", number_, ": '",
             excerpt(words_[i]), "' is not a number");
    to.push_back(narrow(value));
  }
}

int64_t ObjReader::index(std::string_view text, size_t count) const {
  if (text.empty()) return -1;
  int64_t value = 0;
  US_CHECK(parse_integer(text, value), path_, ": line ", number_, ": '", excerpt(text),
           "' is not a corner of a face");
  const auto have = static_cast<int64_t>(count);
  const int64_t at = value > 0 ? value - 1 : have + value;
  US_CHECK(value != 0 && at >= 0 && at < have, path_, ": line ", number_, ": a face names number ", value,
           " of ", have);
  return at;
}

void ObjReader::face() {
  std::vector<Corner> corners;
  for (size_t i = 1; i < words_.size(); ++i) {
    const std::string_view word = words_[i];
    const size_t first = word.find('/'), second = first == word.npos ? first : word.find('/', first + 1);
    Corner corner = {index(word.substr(0, first), positions_.size() / 3), -1, -1};
    US_CHECK(corner[0] >= 0, path_, ": line ", number_, ": a corner of a face names no vertex");
    if (first != word.npos)
      corner[1] = index(word.substr(first + 1, second == word.npos ? word.npos : second - first - 1),
                        uvs_.size() / 2);
    if (second != word.npos) corner[2] = index(word.substr(second + 1), normals_.size() / 3);
    corners.push_back(corner);
  }
  if (current_ == nullptr) current_ = &groups_[""];
  std::vector<Corner>& to = current_->corners;
  for (size_t i = 2; i < corners.size(); ++i) to.insert(to.end(), {corners[0], corners[i - 1], corners[i]});
}

void ObjReader::line(std::string_view text) {
  const size_t hash = text.find('#');
  split_words(text.substr(0, hash), "", words_);
  if (words_.empty()) return;
  const std::string_view what = words_[0];
  if (what == "v") {
    numbers(positions_, 3, 3);
    if (words_.size() >= 7) {
      words_.erase(words_.begin() + 1, words_.end() - 3);
      numbers(colors_, 3, 3);
    }
  } else if (what == "vt") {
    numbers(uvs_, 1, 2);
  } else if (what == "vn") {
    numbers(normals_, 3, 3);
  } else if (what == "f") {
    face();
  } else if (what == "usemtl" && words_.size() > 1) {
    current_ = &groups_[from_second(text, words_)];
  } else if (what == "mtllib" && words_.size() > 1) {
    read_materials(from_second(text, words_));
  }
}

void ObjReader::read_materials(const std::string& name) {
  const auto file = beside(path_, name);
  US_CHECK(file, path_, ": its materials are outside of its folder (", excerpt(name), ")");
  if (!libraries_.insert(*file).second) return;
  std::error_code failed;  // names may be longer than any file's
  if (!std::filesystem::exists(*file, failed)) {
    log::warn(path_ + ": its materials " + excerpt(name) + " are missing");
    return;
  }
  const std::string bytes = read_file(*file);
  TextCursor text(bytes, *file);
  std::vector<std::string_view> words;
  ObjMaterial* current = nullptr;
  while (!text.at_end()) {
    const std::string_view whole_line = text.line();
    split_words(whole_line, "", words);
    if (words.size() < 2) continue;
    const std::string rest = from_second(whole_line, words);
    double value = 0;
    if (words[0] == "newmtl") current = &materials_[rest];
    if (current == nullptr) continue;
    if (words[0] == "Kd")
      for (size_t i = 1; i < std::min<size_t>(4, words.size()); ++i)
        if (parse_number(words[i], value)) current->color[i - 1] = std::clamp(narrow(value), 0.0f, 1.0f);
    if (words[0] == "d" && parse_number(words[1], value))
      current->alpha = std::clamp(narrow(value), 0.0f, 1.0f);
    if (words[0] == "map_Kd") current->picture = words[1][0] == '-' ? std::string(words.back()) : rest;
  }
}

int ObjReader::texture(const std::string& name, Character& out) {
  const auto file = beside(path_, name);
  US_CHECK(file, path_, ": a picture is outside of its folder (", excerpt(name), ")");
  const auto [entry, is_new] = textures_.try_emplace(*file, out.textures.size());
  if (!is_new) return entry->second;
  const bool is_picture = add_picture(
      *file, picture_or_white([&] { return read_file(*file); }, path_ + ": the picture " + excerpt(name)),
      out);
  US_CHECK(is_picture, *file, ": is not a picture (PNG, JPEG, WebP or KTX2)");
  return entry->second;
}

int ObjReader::material(const std::string& name, Character& out) {
  const ObjMaterial& from = materials_[name];
  const int picture = from.picture.empty() ? -1 : texture(from.picture, out);
  json object = plain_material(name.empty() ? "default" : name, from.color, from.alpha, picture);
  if (from.alpha < 1) object["alphaMode"] = "BLEND";
  out.materials.push_back(object.dump(-1, ' ', false, json::error_handler_t::replace));
  return out.materials.size() - 1;
}

void ObjReader::finish_group(const std::string& name, const Group& group, Character& out) {
  CharacterPart part;
  part.name = name.empty() ? out.name : name;
  part.node = 0;
  part.material = material(name, out);
  std::map<Corner, int> known;
  std::vector<Corner> corners;
  std::vector<int> faces;
  bool has_uvs = true, has_normals = true;
  for (const Corner& corner : group.corners) {
    const auto [entry, is_new] = known.try_emplace(corner, corners.size());
    if (is_new) corners.push_back(corner);
    faces.push_back(entry->second);
    has_uvs = has_uvs && corner[1] >= 0;
    has_normals = has_normals && corner[2] >= 0;
  }
  corners.insert(corners.end(), group.loose.begin(), group.loose.end());
  const Eigen::Index count = corners.size();
  part.vertices.resize(count, 3);
  if (has_normals) part.normals.resize(count, 3);
  if (has_uvs) part.uvs.emplace_back(count, 2);
  const bool colored = colors_.size() == positions_.size();
  if (colored) part.colors = RowMatrix::Ones(count, 4);
  for (Eigen::Index v = 0; v < count; ++v) {
    const Corner& c = corners[v];
    for (Eigen::Index i = 0; i < 3; ++i) {
      part.vertices(v, i) = positions_[3 * c[0] + i];
      if (has_normals) part.normals(v, i) = c[2] < 0 ? (i == 1) : normals_[3 * c[2] + i];
      if (colored) part.colors(v, i) = to_linear(colors_[3 * c[0] + i]);
    }
    out.file_vertices.push_back(static_cast<int>(c[0]));
    if (has_uvs && c[1] < 0) part.uvs[0].row(v).setZero();
    if (has_uvs && c[1] >= 0)  // OBJ counts v from below, glTF from above
      part.uvs[0].row(v) << uvs_[2 * c[1]], 1 - uvs_[2 * c[1] + 1];
  }
  part.faces = Eigen::Map<const Faces>(faces.data(), faces.size() / 3, 3);
  out.parts.push_back(std::move(part));
}

/// Vertices of no face go with the first part; all of them together are a cloud.
void ObjReader::add_loose() {
  std::vector<bool> used(positions_.size() / 3, false);
  for (const auto& [name, group] : groups_)
    for (const Corner& corner : group.corners) used[corner[0]] = true;
  if (groups_.empty()) groups_[""];
  const auto has_faces = [](const auto& entry) { return !entry.second.corners.empty(); };
  auto first = std::find_if(groups_.begin(), groups_.end(), has_faces);
  if (first == groups_.end()) first = groups_.begin();
  for (size_t v = 0; v < used.size(); ++v)
    if (!used[v]) first->second.loose.push_back({static_cast<int64_t>(v), -1, -1});
}

Character ObjReader::read() {
  std::string joined;  // lines that end in a backslash go on in the next
  while (!text_.at_end()) {
    ++number_;
    joined += text_.line();
    if (!joined.empty() && joined.back() == '\\') {
      joined.back() = ' ';
      continue;
    }
    line(joined);
    joined.clear();
  }
  Character out;
  out.name = std::filesystem::path(path_).stem().string();
  CharacterNode node;
  node.name = out.name;
  out.nodes.push_back(node);
  add_loose();
  for (const auto& [name, group] : groups_)
    if (!group.corners.empty() || !group.loose.empty()) finish_group(name, group, out);
  US_CHECK(out.parts.size() <= 10000, path_, ": has ", out.parts.size(), " parts; 10000 are read at most");
  check_character(out, path_);
  return out;
}

}  // namespace

Character parse_obj_character(std::string_view bytes, const std::string& path) {
  return ObjReader(bytes, path).read();
}

}  // namespace understudy
