#include "app/run/case_writer.hpp"

#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/surface_writer.hpp"

namespace understudy::app {

void make_scan_folder(const std::filesystem::path& folder) {
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
}

void write_scan(const std::filesystem::path& folder, size_t frame, const Points& points) {
  write_file((folder / printed("frame_%05zu.ply", frame)).string(), ply_bytes({}, points, ""),
             /*synced=*/false);
}

uint64_t case_seed(const std::string& name, uint64_t seed) {
  for (const char c : name) seed = 131 * seed + static_cast<unsigned char>(c);
  return seed;
}

}  // namespace understudy::app
