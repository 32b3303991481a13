// Named commands: what menus, keys, scripts and tests all use to make something happen.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace understudy::app {

class Call;

using Arguments = std::vector<std::string>;

/// What people read of a command.
struct CommandText {
  std::string name;        ///< "playback.seek"
  std::string label;       ///< for menus and undo: "Seek"
  std::string usage{};     ///< "SECONDS: jumps to a time"
  std::string shortcut{};  ///< "Ctrl+S", "Space"; empty: none
  std::string old_name{};  ///< of older scripts; empty: none
};

struct Command : CommandText {
  enum class Undo {
    None,   ///< the document stays as it is
    Step,   ///< the state before is kept
    Merged  ///< many in a row (a slider) are one step
  };
  Undo undo;
  std::function<void(Call&)> run;  ///< throws Error
};

/// The registry. Names are unique.
class Commands {
 public:
  /// A command that leaves the document as it is; one that edits it; one that edits it many times in a row.
  void add(CommandText text, std::function<void(Call&)> run);
  void add_edit(CommandText text, std::function<void(Call&)> run);
  void add_slider(CommandText text, std::function<void(Call&)> run);
  /// By its name, or the one that it had in older versions. Null when there is none.
  const Command* find(const std::string& name) const;
  const std::vector<Command>& all() const { return commands_; }

 private:
  void add(Command command);
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
