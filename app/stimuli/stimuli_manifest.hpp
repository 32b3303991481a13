// What is known of finished clips: manifest.json and manifest.csv for people and programs, and what is
// remembered to go on after an interruption.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "app/stimuli/framing.hpp"
#include "app/study/trials.hpp"

namespace understudy::app {

/// One pane of a clip and its camera.
struct PaneRecord {
  std::string pane;      ///< source, target, result; of a pair result A and result B
  std::string file;      ///< of the pane alone, relative to the folder; empty: it was not asked for
  std::string checksum;  ///< of that file
  int x = 0, y = 0, width = 0, height = 0;  ///< in the clip, pixels
  float yaw_deg = 0, pitch_deg = 0, fov_deg = 0;
  float distance_m = 0;          ///< from the camera to what it looks at
  Vec3 looks_at = Vec3::Zero();  ///< metres
};
template <class V, class S>
FieldsOf<S, PaneRecord> fields(V& visit, S& pane) {
  visit("pane", pane.pane);
  visit("file", pane.file);
  visit("checksum", pane.checksum);
  visit("x", pane.x, kFrameNumbers);
  visit("y", pane.y, kFrameNumbers);
  visit("width", pane.width, kFrameNumbers);
  visit("height", pane.height, kFrameNumbers);
  visit("yaw_deg", pane.yaw_deg);
  visit("pitch_deg", pane.pitch_deg);
  visit("fov_deg", pane.fov_deg);
  visit("distance_m", pane.distance_m);
  visit("looks_at", pane.looks_at);
}

struct ClipRecord {
  std::string clip;  ///< its name
  std::string condition, other, motion, action, target;
  std::string file;      ///< relative to the folder
  std::string checksum;  ///< FNV-1a of its bytes, 16 hexadecimal digits
  int64_t bytes = 0;
  int width = 0, height = 0, frames = 0, fps = 0;
  float seconds = 0;
  int runs = 0;        ///< how often the motion begins
  float motion_s = 0;  ///< of the motion, at speed 1
  std::vector<PaneRecord> panes;
};
template <class V, class S>
FieldsOf<S, ClipRecord> fields(V& visit, S& clip) {
  visit("clip", clip.clip);
  visit("condition", clip.condition);
  visit("other", clip.other);
  visit("motion", clip.motion);
  visit("action", clip.action);
  visit("target", clip.target);
  visit("file", clip.file);
  visit("checksum", clip.checksum);
  visit("bytes", clip.bytes, Within<int64_t>{0, int64_t{1} << 50});
  visit("width", clip.width, kFrameNumbers);
  visit("height", clip.height, kFrameNumbers);
  visit("frames", clip.frames, kFrameNumbers);
  visit("fps", clip.fps, kFrameNumbers);
  visit("seconds", clip.seconds);
  visit("runs", clip.runs, kFrameNumbers);
  visit("motion_s", clip.motion_s);
  visit("panes", clip.panes);
}

/// Writes manifest.json and manifest.csv (a line a clip) into the folder. `study`: the checksums of its
/// parts, digest_of(). Throws Error naming the file.
void write_manifest(const std::string& folder, const std::string& name, const std::string& study,
                    const std::vector<ClipRecord>& clips);

/// The clips in a folder and what each was made from: made.json, written anew after each clip.
class MadeClips {
 public:
  /// What is there; a file that cannot be read counts as none.
  explicit MadeClips(std::string folder);
  /// The clip where it was made from this, and its files are as they were written; null: it is to be made.
  const ClipRecord* find(const std::string& clip, const std::string& made_from) const;
  /// Throws Error naming the file.
  void add(const ClipRecord& clip, const std::string& made_from);

 private:
  struct Made {
    std::string from;
    ClipRecord clip;
  };
  bool is_whole(const std::string& file, const std::string& checksum) const;
  std::string folder_;
  std::map<std::string, Made> made_;
};

}  // namespace understudy::app
