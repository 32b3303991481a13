// The table of file formats: all that command line, studio, browser and readers know of names and suffixes.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "retarget/formats/scan_source.hpp"
#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// What a file may be. Of some formats only the content decides.
enum FileUse : unsigned {
  kScanFrame = 1,     ///< a mesh or cloud: one frame of a scan
  kScanSequence = 2,  ///< all frames of a scan, or a list of them
  kTarget = 4,        ///< a body or character that performs
  kMotion = 8,        ///< a skeleton that moves
  kBody = 16,         ///< an SMPL-format body
  kDocument = 32,
  kCase = 64,
  kStudy = 128,  ///< a perceptual study
};

/// One row. Readers of characters and motions are in read_character.cpp and read_motion.cpp, by name.
struct FileFormat {
  const char* name;                   ///< for people: "PLY"
  std::vector<const char*> suffixes;  ///< lower case, with the dot
  unsigned uses;                      ///< FileUse, one or more
  /// kScanFrame: the mesh in the bytes; `source` names the file. Throws Error.
  Mesh (*parse)(std::string_view bytes, const std::string& source) = nullptr;
  /// Whether the bytes give the format away; null: they never do.
  bool (*recognise)(std::string_view bytes) = nullptr;
  bool always_recognised = false;  ///< a file that is not recognised is not of this format
  /// kScanSequence: its frames; null when the content is something else.
  std::unique_ptr<ScanSource::Frames> (*open)(const std::string& path) = nullptr;
  bool is_plain_text = false;  ///< the suffix may be anything's: it counts only where nothing else does
};

const std::vector<FileFormat>& file_formats();
/// The first format with the path's suffix, in any case, and any of the uses; null when there is none.
const FileFormat* format_of_suffix(std::string_view path, unsigned uses);
/// As the readers decide: the format of the suffix, else, where the suffix is nobody's, that of the content
/// (of its first MiB). Null when there is none with these uses.
/// Throws Error when the file must be read and cannot.
const FileFormat* format_of_file(const std::string& path, unsigned uses);
/// The first format with any of the uses that the bytes give away; null when nothing does.
const FileFormat* format_of_content(std::string_view bytes, unsigned uses);
inline bool can_be(std::string_view path, unsigned uses) {
  return format_of_suffix(path, uses) != nullptr;
}

/// For help and messages, plain text left out: "PLY, OBJ, OFF".
std::string format_names(unsigned uses);
/// For filters, plain text left out: ".ply", ".obj", ".off".
std::vector<std::string> format_suffixes(unsigned uses);

}  // namespace understudy
