// Characters of many kinds that perform a motion, as exported files, for other programs to read back.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "retarget/character/character_export.hpp"
#include "tests/interop/outside_programs.hpp"

namespace understudy::tests {

struct Exported {
  std::string name, path;
  Character file;  ///< as our own reader has it
  int clip = 0;
  double fps = 25;
  std::vector<float> times;    ///< five frames, then two moments between frames
  std::vector<Points> screen;  ///< [five] of [V, 3]: every vertex of the parts as the screen shows it
  std::vector<Pose> poses;     ///< [five]
  double cost_mm = 0;          ///< what the export says it costs at most
  CharacterExportOptions options;
  std::shared_ptr<const PreparedCharacter> prepared;  ///< as it was before it was written
  /// [V, 3] by our own reader; influences: an engine that knows no more of them a vertex.
  Points ours_at(float seconds, int influences = 8) const;
  PlayJob job(const std::string& program) const;
};
constexpr size_t kFramesShown = 5;

/// All of them, made once, in a folder that goes away with the process.
const std::vector<Exported>& all_exported();
/// And one file of several performers, whose `poses` and `prepared` are those of the first.
const std::vector<Exported>& all_played();
/// Whether the engine that reads four influences sees all of this file.
bool needs_eight(const Exported& exported);

/// Largest distance between rows, mm.
double largest_mm(const Points& a, const Points& b);

/// Where a program that read the file back puts its vertices, against our reader and against the screen.
struct Agreement {
  double ours_mm = 0, screen_mm = 0;
};
Agreement agreement(const Exported& exported, const std::vector<Points>& theirs, int influences);

}  // namespace understudy::tests
