// Cuts one person out of the scans of a source.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/run/source.hpp"
#include "retarget/pipeline/observation.hpp"
#include "retarget/scene/scene.hpp"

namespace understudy::app {

/// Somebody in a source, over the frames so far.
struct PersonSeen {
  int id = 0;
  bool is_sure = false;
  int64_t frames = 0;  ///< in which they were seen
  double points = 0;   ///< of them in all these frames
  double quality = 0;  ///< summed over these frames
  float moved_m = 0;
};

/// Leaves of each frame what is one person's. A person alone passes through untouched.
class PersonCut {
 public:
  /// Of the options `person`, `people`, `path`, `edits`, `follow` and `quiet` count. Without an extractor
  /// nothing is cut.
  PersonCut(std::shared_ptr<SkeletonExtractor> extractor, const SourceOptions& options);
  /// Starts anew; who was chosen stays.
  void restart();

  /// A frame of `source`, which goes on with the frame `next`. Where several people are in the first one,
  /// looks at the first second to choose who is seen best, and goes back; of a source that is followed the
  /// first frame tells.
  void apply(SourceFrame& frame, Source& source, int64_t next);
  /// What an observer saw in the frame that was cut.
  void tell(const Observation& seen);

  /// The last frame taken apart, with `people` put right: whose each point of the uncut scan was.
  const SceneFrame& scene() const { return scene_now_; }
  /// Who is cut out; 0: nobody yet.
  int person() const { return person_; }
  /// All so far, by id.
  std::vector<PersonSeen> people() const;
  /// Why nothing was cut out, for who looks at it at the end: a number that nobody has; empty where somebody
  /// has it.
  std::string missing() const;

 private:
  void take_apart(const SourceFrame& frame, const Source& source, int64_t number);
  void choose(const SceneFrame& now);
  void look_ahead(const SourceFrame& frame, Source& source, int64_t next);
  void tell_choice() const;

  std::shared_ptr<SkeletonExtractor> extractor_;
  std::string wanted_, name_;
  ScanEdits edits_;
  std::vector<PersonEdit> renames_;
  bool waits_, quiet_;
  Scene scene_;
  SceneFrame scene_now_;
  std::vector<std::pair<int, int>> ids_;  // of those in the last frame: here, and in the scene
  std::map<int, PersonSeen> seen_;
  int person_ = 0;
  std::string still_;  // who did not move in the first second, for a message
  bool is_sure_ = false, looked_ahead_ = false, told_crowd_ = false;
};

/// Goes through a source once and says who is in it, by id.
std::vector<PersonSeen> people_in(const SourceOptions& options, std::shared_ptr<SkeletonExtractor> extractor);

/// The ids of all who are surely people, for SourceOptions::person "all". Logs who is there. Throws Error
/// naming the source where nobody is.
std::vector<int> all_people(const SourceOptions& options,
                            const std::shared_ptr<SkeletonExtractor>& extractor);

/// "person 1 (seen in 80 frames), person 2 (...)".
std::string in_words(const std::vector<PersonSeen>& people);

}  // namespace understudy::app
