// The files an animation goes into while it is made.
#pragma once

#include <memory>
#include <string>

#include "app/cli/job.hpp"

namespace understudy::app {

/// Takes frame after frame; the file appears whole at finish(), and nothing is left behind without it.
class Output {
 public:
  virtual ~Output() = default;
  virtual void push(const PerformedFrame& frame) = 0;
  virtual void finish() = 0;
};

/// The format is the suffix's: .glb, or .npz. Throws Error naming the path.
std::unique_ptr<Output> open_output(const std::string& path, const PreparedCharacter& character,
                                    const Retargeter& retargeter, double fps);
/// Throws Error when the suffix is none of those; an empty path is fine.
void check_output_format(const std::string& path);

}  // namespace understudy::app
