// A studio that nobody looks at: commands that do what the studio does, as it does it.
#pragma once

#include <memory>
#include <string>

#include "app/session/studio.hpp"

namespace understudy::app {

/// With the program's networks, without settings and copies for recovery.
std::unique_ptr<Studio> headless_studio(const std::string& weights);

/// How takes are made.
struct MakeOptions {
  std::string from;          ///< what performs, for the progress
  bool with_errors = false;  ///< goes on where a take cannot be made
};

/// Performs all takes, and says how far this one is. Throws Error where it fails, asks, or is interrupted.
void make_takes(Studio& studio, size_t take, const MakeOptions& options);

/// What a file is called without its folder and suffix.
std::string clip_name(const std::string& path);

}  // namespace understudy::app
