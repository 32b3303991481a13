// A performed motion into a file of any format: what command line and studio share.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/run/pose_choice.hpp"
#include "retarget/character/character_export.hpp"
#include "retarget/pose2d/face_marks.hpp"

namespace understudy::app {

struct ExportBody;
class MotionOutput;

/// One row of the table of formats that a performed motion can be written in.
struct ExportFormat {
  const char* name;    ///< "bvh", as in --format and commands
  const char* suffix;  ///< ".bvh"; empty: a folder
  const char* label;   ///< for menus
  const char* words;   ///< what it is good for, one sentence
  bool by_suffix;      ///< a path with the suffix means it; false: it is chosen by its name alone
  bool is_character;   ///< a rigged character: influences, morphs, key reduction and several clips
  bool own_bones;  ///< can be on the character's own bones, a character's file is so unless asked otherwise
  /// Its writer; see open_export.
  std::unique_ptr<MotionOutput> (*open)(const std::string& path, const ExportBody& body,
                                        const std::string& name, double fps);
  bool is_pictures = false;  ///< through a camera; a path in neither .mp4 nor .json is a folder
};

/// All of them, in the order of menus.
const std::vector<ExportFormat>& export_formats();
/// The format of that name; an empty name: what the path's suffix stands for. Throws Error naming the path.
const ExportFormat& export_format(const std::string& name, const std::string& path);
/// For help: ".glb, .gltf, .bvh".
std::string export_suffixes();

/// Throws Error at once when nothing could be written there, before hours of work are done for it.
void check_export(const std::string& path, const ExportFormat& format);

/// Of a file, or of all files in a folder; 0 where there is none.
int64_t bytes_at(const std::string& path);

/// Whether writing there would replace one of these files; empty paths are none.
bool is_one_of(const std::string& path, const std::vector<std::string>& files);
/// Throws Error where it would: they are read, and would be lost.
void check_not_read(const std::string& path, const std::vector<std::string>& files);

/// Throws Error where an option asks for something that such a file cannot hold.
void check_export_options(const std::string& path, const ExportFormat& format,
                          const CharacterExportOptions& file);

/// Throws Error where anything of pose pictures is chosen for a file that has none.
void check_pose_choice(const std::string& path, const ExportFormat& format, const PoseChoice& poses);

/// Throws Error where such a file cannot hold so many performers.
void check_performers(const std::string& path, const ExportFormat& format, size_t count);

/// Throws Error where such a file cannot be on the character's own bones.
void check_own_bones(const std::string& path, const ExportFormat& format);

/// The character that performs, as on screen.
struct ExportBody {
  std::shared_ptr<const PreparedCharacter> character;
  std::shared_ptr<const Deformer> screen;  ///< bound to the target, with painted weights
  CharacterExportOptions
      file;            ///< of other formats than glTF only in_place, joints, progress; their_rig: own_bones
  PoseChoice poses{};  ///< of pose pictures
  std::vector<FaceMove> face{};  ///< marks that its user moved
};

/// One frame of a motion.
struct ExportFrame {
  const Pose& pose;
  Joints source_joints = Joints::Zero();  ///< of the source, for formats that hold them
  const Points* vertices = nullptr;       ///< where they are known already, in the target's order
  float doubt_m = 0;                      ///< of a frame that was not captured but made; else 0
};

/// Takes one motion, frame after frame. What was at the path stays until finish(); without it nothing is left
/// behind.
class MotionOutput {
 public:
  virtual ~MotionOutput() = default;
  virtual void push(const ExportFrame& frame) = 0;
  /// From the frames' source_joints to the coordinates of the source's file, for formats that hold them;
  /// known after the first frame.
  void set_source_to_scan(const Eigen::Matrix4d& matrix) { source_to_scan_ = matrix; }
  /// Whether all the work is done by finish(), which then tells of its progress.
  virtual bool is_written_at_end() const { return false; }
  /// Size and error of the written file. Throws Error, also where there was no frame.
  virtual ExportCost finish() = 0;

 protected:
  Eigen::Matrix4d source_to_scan_ = Eigen::Matrix4d::Identity();
};

/// name: of the motion. Throws Error naming the path: it cannot be written, or the format does not
/// support the options.
std::unique_ptr<MotionOutput> open_export(const std::string& path, const ExportFormat& format,
                                          const ExportBody& body, const std::string& name, double fps);

/// Logs these rights, where there are any: such a file has no place for them.
void tell_left_out(const std::string& path, const std::string& rights);

/// What one performer performs.
struct ExportInput {
  ExportBody body;
  std::vector<CharacterClip> clips;   ///< more than one only in glTF
  std::vector<Joints> source_joints;  ///< beside the poses of the only clip; may be empty
  Eigen::Matrix4d source_to_scan = Eigen::Matrix4d::Identity();  ///< from them to the source's file
  std::string name{};                                            ///< of the performer, in a file of several
};

/// All of it; several performers only in glTF, where their clips play at once (see animated_character). The
/// first one's body.file.progress gets 0..1; what it throws ends the export, and what was there stays.
ExportCost export_motion(const std::string& path, const ExportFormat& format,
                         const std::vector<ExportInput>& performers);

/// "differs from the viewport by 0.41 mm on average, 2.13 mm at most; 1.2 MB", for people.
std::string sentence(const ExportCost& cost);

}  // namespace understudy::app
