#include "app/run/samples.hpp"

#include <filesystem>

#include "retarget/base/error.hpp"

namespace understudy::app {
namespace fs = std::filesystem;

std::string samples_folder() {
  std::error_code failed;
  fs::path at = fs::read_symlink("/proc/self/exe", failed).parent_path();
  for (; at.has_relative_path(); at = at.parent_path())
    if (fs::is_directory(at / "assets/samples")) return (at / "assets/samples").string();
  throw Error("the bundled samples are missing: no folder assets/samples beside the program or above it");
}

}  // namespace understudy::app
