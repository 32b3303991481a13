#include "retarget/character/read_character.hpp"

#include <filesystem>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/character/import_process.hpp"
#include "retarget/character/obj_character.hpp"
#include "retarget/character/vertex_colors.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/formats/mesh_reader.hpp"

namespace understudy {
namespace {

/// Formats of which more than a mesh is read.
struct Reader {
  std::string_view format;
  Character (*parse)(std::string_view bytes, const std::string& path);
};
constexpr Reader kReaders[] = {{"glTF", parse_gltf_character}, {"OBJ", parse_obj_character}};

/// Of these an outside library reads all.
bool needs_process(const FileFormat* format) {
  return format && !format->parse && !format->open;
}

Character read_any(const std::string& path, const ReadCharacterOptions& options) {
  const std::string bytes = read_file(path), stem = std::filesystem::path(path).stem().string();
  US_CHECK(!bytes.empty(), path, ": is empty");
  const FileFormat* const suffix = format_of_suffix(path, kTarget);
  US_CHECK(suffix || !can_be(path, kMotion), path, ": is a motion, not a character");
  const FileFormat* const content = format_of_content(bytes, kTarget);
  if (needs_process(suffix) || needs_process(content)) return read_in_process(path, options);
  const FileFormat* const format = content ? content : suffix;
  for (const Reader& reader : kReaders)
    if (format && reader.format == format->name) return reader.parse(bytes, path);
  const Mesh mesh = parse_mesh(bytes, path);
  Character out = character_of_mesh(mesh, stem);
  check_character(out, path);
  return out;
}

}  // namespace

Character character_of_mesh(const Mesh& mesh, const std::string& name) {
  Character out;
  out.name = name;
  CharacterNode node;
  node.name = name;
  out.nodes.push_back(node);
  CharacterPart part;
  part.name = name;
  part.node = 0;
  part.vertices = mesh.vertices;
  part.faces = mesh.faces;
  if (mesh.faces.rows() > 0) part.normals = vertex_normals(mesh.vertices, mesh.faces);
  if (mesh.colors.rows() == mesh.vertices.rows() && mesh.colors.rows() > 0) {
    part.colors = RowMatrix::Ones(mesh.vertices.rows(), 4);
    part.colors.leftCols<3>() = mesh.colors.unaryExpr(&to_linear);
  }
  const std::string color = part.colors.rows() > 0 ? "1.0,1.0,1.0,1.0" : "0.8,0.76,0.72,1.0";
  out.materials.push_back(R"({"name":"body","doubleSided":true,"pbrMetallicRoughness":{"baseColorFactor":[)" +
                          color + R"(],"metallicFactor":0.0,"roughnessFactor":0.8}})");
  part.material = 0;
  out.parts.push_back(std::move(part));
  return out;
}

Character read_character(const std::string& path, const ReadCharacterOptions& options) {
  Character character = read_any(path, options);
  character.file = path;
  return character;
}

}  // namespace understudy
