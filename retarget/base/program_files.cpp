#include "retarget/base/program_files.hpp"

namespace understudy {

namespace fs = std::filesystem;

fs::path program_folder() {
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  return failed ? fs::current_path() : program.parent_path();
}

fs::path program_files(const char* name) {
  const fs::path here = program_folder(), installed = here.parent_path() / "share/understudy" / name;
  for (fs::path at = here; at.has_relative_path(); at = at.parent_path())
    if (fs::is_directory(at / "assets" / name)) return at / "assets" / name;
  return fs::is_directory(installed) ? installed : fs::path();
}

}  // namespace understudy
