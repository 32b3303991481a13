// The program's name and version, as reports carry it.
#pragma once

namespace understudy::app {

constexpr const char* kProgram = "understudy 0.1.0";

}  // namespace understudy::app
