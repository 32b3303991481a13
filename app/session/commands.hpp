// Named commands: what menus, keys, scripts and tests all use to make something happen.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace understudy::app {

class Studio;

using Arguments = std::vector<std::string>;

struct Command {
  std::string name;                                    ///< "playback.seek"
  std::string label;                                   ///< for menus and undo: "Seek"
  std::string usage;                                   ///< "SECONDS: jumps to a time"
  std::string shortcut;                                ///< "Ctrl+S", "Space"; empty: none
  bool undoable = false;                               ///< the document may change: the state before is kept
  bool merges = false;                                 ///< many in a row (a slider) are one step of undo
  std::function<void(Studio&, const Arguments&)> run;  ///< throws Error
};

/// The registry. Names are unique.
class Commands {
 public:
  void add(Command command);
  /// Null when there is none.
  const Command* find(const std::string& name) const;
  const std::vector<Command>& all() const { return commands_; }

 private:
  std::vector<Command> commands_;
};

/// What panels push; run in order after the frame.
using CommandQueue = std::vector<std::pair<std::string, Arguments>>;

/// Splits a line of a script at blanks; "quoted words" stay whole, # starts a comment. Throws Error for a
/// quote that is not closed.
Arguments split_line(const std::string& line);
/// The reverse, for recordings.
std::string join_line(const std::string& name, const Arguments& arguments);

}  // namespace understudy::app
