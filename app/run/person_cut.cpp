#include "app/run/person_cut.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/run/interrupt.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

constexpr double kStill = 0.6;    // how much less somebody counts who never moves
constexpr float kMoves_m = 0.1f;  // less is noise

int64_t sure_people(const SceneFrame& frame) {
  return std::count_if(frame.people.begin(), frame.people.end(),
                       [](const ScenePerson& person) { return person.is_sure && person.unseen_s == 0; });
}

/// How well somebody is seen.
double score_of(const PersonSeen& seen, bool largest, bool anyone_moves) {
  if (largest) return seen.points;
  const double still = anyone_moves && seen.moved_m < kMoves_m ? kStill : 1.0;
  return (seen.is_sure ? 1.0 : 0.01) * still * seen.quality * std::sqrt(seen.points);
}

/// Who is surely a person by looks and does not move, as the end of a sentence; empty: all move.
std::string still_people(const std::map<int, PersonSeen>& all) {
  std::string who;
  int count = 0;
  for (const auto& [id, seen] : all) {
    if (!seen.is_sure || seen.moved_m >= kMoves_m) continue;
    append_item(who, std::to_string(id));
    ++count;
  }
  if (count == 0) return {};
  const bool one = count == 1;
  return std::string("; ") + (one ? "person " : "people ") + who + (one ? " does" : " do") +
         " not move in the first second: " +
         (one ? "somebody who stands still, or a mannequin" : "they stand still, or are mannequins");
}

}  // namespace

PersonCut::PersonCut(std::shared_ptr<SkeletonExtractor> extractor, const SourceOptions& options)
    : extractor_(std::move(extractor)),
      wanted_(options.person),
      name_(options.path),
      edits_(options.edits),
      renames_(options.people),
      waits_(!options.follow),
      quiet_(options.quiet),
      scene_(extractor_),
      person_(person_number(options.person)),
      is_sure_(person_ > 0) {}

void PersonCut::restart() {
  scene_.restart();
  scene_now_ = {};
  seen_.clear();
}

/// Of the source's frame `number`.
void PersonCut::take_apart(const SourceFrame& frame, const Source& source, int64_t number) {
  const int at = static_cast<int>(std::min<int64_t>(number, kFrameNumbers.high));
  scene_now_ = scene_.push(frame.mesh, static_cast<float>(1 / source.fps()));
  ids_.clear();
  for (const ScenePerson& person : scene_now_.people)
    if (person.unseen_s == 0) ids_.emplace_back(renamed(renames_, person.id, at), person.id);
  understudy::apply(renames_, at, scene_now_);
  for (const ScenePerson& person : scene_now_.people) {
    if (person.unseen_s > 0) continue;
    PersonSeen& seen = seen_[person.id];
    seen.id = person.id;
    seen.is_sure = seen.is_sure || person.is_sure;
    ++seen.frames;
    seen.points += static_cast<double>(person.points);
    seen.quality += static_cast<double>(person.quality);
    seen.moved_m = person.moved_m;
  }
}

std::vector<PersonSeen> PersonCut::people() const {
  std::vector<PersonSeen> all;
  for (const auto& [id, seen] : seen_) all.push_back(seen);
  return all;
}

std::string PersonCut::missing() const {
  const int number = person_number(wanted_);
  if (number == 0 || !extractor_ || seen_.count(number) > 0) return {};
  return "there is no person " + std::to_string(number) + " in it; it shows " + in_words(people());
}

/// Who is seen best so far, of those in this frame.
void PersonCut::choose(const SceneFrame& now) {
  const bool anyone_moves =
      std::any_of(seen_.begin(), seen_.end(), [](const auto& one) { return one.second.moved_m >= kMoves_m; });
  double most = -1;
  for (const ScenePerson& person : now.people) {
    if (person.unseen_s > 0) continue;
    const double score = score_of(seen_[person.id], wanted_ == "largest", anyone_moves);
    if (score > most) most = score, person_ = person.id, is_sure_ = person.is_sure;
  }
}

/// Takes the first second apart, chooses, and comes back.
void PersonCut::look_ahead(const SourceFrame& frame, Source& source, int64_t next) {
  const int frames = static_cast<int>(std::lround(source.fps()));
  bool moved = false;
  for (int k = 1; k < frames; ++k) {
    auto later = source.next();
    if (!later) break;
    moved = true;
    if (later->usable && !edits_.empty()) later->mesh = understudy::apply(edits_, later->mesh);
    if (later->usable) take_apart(*later, source, next - 1 + k);
  }
  choose(scene_now_);
  if (moved) still_ = still_people(seen_);
  if (moved) source.seek(next);
  restart();
  take_apart(frame, source, next - 1);
}

void PersonCut::apply(SourceFrame& frame, Source& source, int64_t next) {
  if (!extractor_ || !frame.usable || frame.skeleton) return;
  take_apart(frame, source, next - 1);
  const bool first = person_ == 0;
  if (!is_sure_) {
    choose(scene_now_);
    if (sure_people(scene_now_) > 1 && waits_ && !std::exchange(looked_ahead_, true))
      look_ahead(frame, source, next);
  }
  if (first && person_ > 0 && !quiet_) tell_choice();
  if (scene_now_.left_out > 0 && !std::exchange(told_crowd_, true) && !quiet_)
    log::warn(name_ + ": a crowd: " + std::to_string(People::kMost) + " people are followed, " +
              std::to_string(scene_now_.left_out) + " more are left out");
  if (scene_now_.owner.empty() && scene_now_.alone == person_) return;
  frame.mesh = person_ > 0 ? part_of(frame.mesh, scene_now_, person_) : Mesh{};  // 0 is the scenery
  if (frame.mesh.vertices.rows() > 0) return;
  frame.usable = false;
  frame.problem =
      person_ == 0 ? "nobody is seen in it" : "person " + std::to_string(person_) + " is not seen in it";
}

void PersonCut::tell(const Observation& seen) {
  for (const auto& [id, in_scene] : ids_)
    if (id == person_) scene_.tell(in_scene, seen, refusal(seen).empty());
}

void PersonCut::tell_choice() const {
  const auto several = sure_people(scene_now_);
  const char* const why = person_number(wanted_) > 0 ? " is taken"
                          : wanted_ == "largest"     ? " is taken, who has most points"
                                                     : " is taken, who is seen best (--person chooses)";
  if (several > 1)
    log::info(name_ + ": " + std::to_string(several) + " people are seen; person " + std::to_string(person_) +
              why + still_);
  else if (scene_now_.owner.size() > 0)
    log::info(name_ + ": one person" + std::string(scene_now_.ground ? ", and a ground" : "") +
              ", which are told apart in each frame");
}

std::vector<PersonSeen> people_in(const SourceOptions& options,
                                  std::shared_ptr<SkeletonExtractor> extractor) {
  SourceOptions quiet = options;
  quiet.quiet = true;
  quiet.person = "1";  // nothing is chosen
  const auto source = open_source(quiet);
  PersonCut cut(std::move(extractor), quiet);
  for (int64_t at = 0; auto frame = source->next(); ++at) {
    check_interrupt("after " + std::to_string(at) + " frames");
    if (frame->usable) frame->mesh = understudy::apply(options.edits, frame->mesh);
    cut.apply(*frame, *source, at + 1);
  }
  return cut.people();
}

std::vector<int> all_people(const SourceOptions& options,
                            const std::shared_ptr<SkeletonExtractor>& extractor) {
  const std::vector<PersonSeen> people = people_in(options, extractor);
  std::vector<int> ids;
  for (const PersonSeen& one : people)
    if (one.is_sure) ids.push_back(one.id);
  log::info(options.path + ": " + in_words(people));
  US_CHECK(!ids.empty(), options.path, ": nobody is seen in it");
  return ids;
}

std::string in_words(const std::vector<PersonSeen>& people) {
  std::string words;
  for (const PersonSeen& one : people)
    append_item(words, "person " + std::to_string(one.id) + (one.is_sure ? "" : " (unsure)") + " in " +
                           std::to_string(one.frames) + (one.frames == 1 ? " frame" : " frames"));
  return words.empty() ? "nobody" : words;
}

}  // namespace understudy::app
