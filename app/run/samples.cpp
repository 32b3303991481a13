#include "app/run/samples.hpp"

#include "retarget/base/error.hpp"
#include "retarget/base/program_files.hpp"

namespace understudy::app {

std::string samples_folder() {
  const std::string folder = program_files("samples").string();
  US_CHECK(!folder.empty(),
           "the bundled samples are missing: no folder assets/samples beside the program or above it, "
           "nor ../share/understudy/samples");
  return folder;
}

}  // namespace understudy::app
