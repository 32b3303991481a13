#include "retarget/formats/mesh_reader.hpp"

#include <filesystem>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/formats/file_formats.hpp"

namespace understudy {

Mesh parse_mesh(std::string_view bytes, const std::string& path) {
  US_CHECK(!bytes.empty(), path, ": is empty");
  const FileFormat* const content = format_of_content(bytes, kScanFrame);
  const FileFormat* const suffix = format_of_suffix(path, kScanFrame);
  US_CHECK(content || suffix, path, ": is not a known mesh or point cloud (", format_names(kScanFrame), ")");
  if (content && suffix && content != suffix)
    log::warn_once((std::filesystem::path(path).parent_path() / ("*" + file_suffix(path))).string() +
                   ": these files are " + content->name + " despite their suffix, and are read as such");
  US_CHECK(content || !suffix->always_recognised, path, ": is not ", suffix->name, " despite its suffix");
  const FileFormat& format = content ? *content : *suffix;
  Mesh mesh = format.parse(bytes, path);
  US_CHECK(content || mesh.vertices.rows() > 0, path, ": is not ", format.name, " despite its suffix");
  return mesh;
}

Mesh read_mesh(const std::string& path) {
  return parse_mesh(read_file(path), path);
}

}  // namespace understudy
