// A manner on disk: assets/styles/NAME.json, every figure with its unit, where it comes from and its licence.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "retarget/style/manner.hpp"

namespace understudy {

/// Where a figure comes from.
struct FigureOrigin {
  std::string source;   ///< a publication, what it was measured on, or "set by hand"
  std::string licence;  ///< empty: the file's
};

/// What a style's file tells of it, whatever engine it is for.
struct StyleNote {
  std::string name;         ///< as in --style: the file's name without its end
  std::string label;        ///< "Child", on the screen
  std::string sentence;     ///< what it does, without its full stop
  std::string licence;      ///< "MIT", "CC BY-NC 4.0"
  std::string attribution;  ///< whom to name; may be empty
  std::string made_from;    ///< which recordings or publications
  /// Whether the licence forbids uses for money: its result says so, too.
  bool non_commercial() const;
  /// What a file that was made in it has to say of rights; empty where there is nothing to be said.
  std::string rights() const;
};

struct MannerFile {
  StyleNote note;
  Manner manner;
  float stroke = 1;  ///< how long its strokes last, against the source's: for a TempoEdit
  float spread = 0;  ///< of how long its movements last, a share
  std::map<std::string, FigureOrigin> origins;  ///< by the figure's name
};

/// Throws Error naming the file and what is wrong: not JSON, of another version or set of joints, without a
/// licence, a figure that is unknown, has another unit, no source or an impossible value.
MannerFile parse_manner(const std::string& text, const std::string& path);
MannerFile read_manner(const std::string& path);
/// As parse_manner takes it. Throws Error where it would not.
std::string to_json(const MannerFile& file);

}  // namespace understudy
