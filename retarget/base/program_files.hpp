// Where the program's own files are, wherever it is started: in its build tree or installed.
#pragma once

#include <filesystem>

namespace understudy {

/// The folder of the running program, links followed; the working folder where the system does not report it.
std::filesystem::path program_folder();

/// The program's folder `name` ("weights", "samples"): assets/NAME beside the program or above it (a build
/// tree), else ../share/understudy/NAME (installed). Empty when there is none.
std::filesystem::path program_files(const char* name);

}  // namespace understudy
