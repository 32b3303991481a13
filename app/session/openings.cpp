// What was opened and could not be read is taken back; all else stays as it is. What is read but may be no
// person is asked about; scans in which nobody is found are offered to be cleaned up, frames that could not
// be used to be filled.
#include <algorithm>

#include "app/session/background.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"

namespace understudy::app {
namespace {

bool same_file(const SourceOptions& a, const SourceOptions& b) {
  if (a.blend.has_value() != b.blend.has_value()) return false;
  return a.path == b.path && a.motion == b.motion && (!a.blend || are_same_parts(*a.blend, *b.blend));
}

/// Whatever belongs to the source, as it was before.
void restore_source(Document& document, const Document& before) {
  document.source = before.source;
  document.truth = before.truth;
  document.scan_edits = before.scan_edits;
  document.skeleton_edits = before.skeleton_edits;
  document.flat = before.flat;
  document.bones = before.bones;
  for (Take& take : document.takes)
    for (const Take& old : before.takes)
      if (old.name == take.name && same(old.target, take.target)) take.pose_edits = old.pose_edits;
}

}  // namespace

/// Keeps what was there before targets and sources that a command has opened.
void Studio::note_openings(const Document& before, const std::vector<int64_t>& ids_before,
                           bool changed_before) {
  Background& b = *background_;
  const Background::Opening opening{before, session_.history.steps(), changed_before};
  if (!same_file(before.source, session_.document.source)) b.opened_source = opening;
  for (size_t k = 0; k < b.take_ids.size(); ++k) {
    const auto found = std::find(ids_before.begin(), ids_before.end(), b.take_ids[k]);
    const Take* const old = at_or_null(before.takes, found - ids_before.begin());
    if (!old || old->target.path != session_.document.takes[k].target.path)
      b.opened_targets[b.take_ids[k]] = opening;
  }
}

/// Makes the change in the document and all that undo keeps.
void Studio::roll_back(size_t steps, bool changed_before, const Change& change) {
  const bool is_last = session_.history.steps() == steps;
  change(session_.document);
  session_.history.change_all(change, session_.document);
  session_.changed = !is_last || changed_before;
  follow_document();
}

bool Studio::take_back_target(size_t k) {
  Background& b = *background_;
  const auto opened = b.opened_targets.find(b.take_ids[k]);
  if (opened == b.opened_targets.end()) return false;
  const Background::Opening opening = opened->second;
  b.opened_targets.erase(opened);
  const Take* const old = at_or_null(opening.before.takes, static_cast<std::ptrdiff_t>(k));
  const bool added = opening.before.takes.size() < session_.document.takes.size() || !old;
  const TargetOptions failed = session_.document.takes[k].target;
  const auto is_failed = [&](const Take& take) { return same(take.target, failed); };
  roll_back(opening.steps, opening.changed, [&](Document& document) {
    auto& takes = document.takes;
    if (added)
      return static_cast<void>(
          takes.erase(std::remove_if(takes.begin(), takes.end(), is_failed), takes.end()));
    std::replace_if(takes.begin(), takes.end(), is_failed, *old);
  });
  return true;
}

void Studio::roll_back_source() {
  Background& b = *background_;
  if (!b.opened_source) return;
  const Background::Opening opening = *b.opened_source;
  b.opened_source.reset();
  const SourceOptions failed = session_.document.source;
  roll_back(opening.steps, opening.changed, [&](Document& document) {
    if (same_file(document.source, failed)) restore_source(document, opening.before);
  });
}

/// Where nobody is found in the first frames, once for each way in which the scan is cleaned.
void Studio::offer_clean_up(const std::string& doubt) {
  constexpr std::ptrdiff_t kFewest = 3, kFirst = 60;  // frames
  Background& b = *background_;
  SourceState& source = session_.source;
  const ScanEdits& edits = session_.document.scan_edits;
  if (!source.clips.empty() && !session_.document.source.as_scan) return;
  std::ptrdiff_t seen = 0, nobody = 0;
  for (std::ptrdiff_t t = 0; t < std::min(kFirst, ssize(source.frames)); ++t) {
    const KeptSource& frame = source.frames[t];
    if (!frame.extent) continue;
    ++seen;
    const bool elsewhere = frame.person > 0 && frame.points == 0;  // somebody who comes later, or has left
    nobody += frame.flagged && !elsewhere ? 1 : 0;
  }
  const bool lost = seen >= kFewest && nobody * 5 >= seen * 4;
  source.no_person = source.no_person || lost || !doubt.empty();
  if ((doubt.empty() && !lost) || b.advised == b.source_key) return;
  b.advised = b.source_key;
  const bool cleaned = edits.floor && edits.largest_cluster;
  const std::string sentence = !lost     ? "This may not be a person"
                               : cleaned ? "No person recognised. Crop the scan in Edit > Scan"
                                         : "No person recognised: a floor or things may hide them";
  log::warn(session_.document.source.path + ": " + (doubt.empty() ? sentence : doubt));
  const Offer find{"Find its own skeleton", "bones.find", true}, clean{"Clean up", "edit.clean_up", true};
  const bool has_bones = session_.document.bones.wanted;
  if (lost && !cleaned)
    notify(sentence, true, clean, has_bones ? Offer{} : find);
  else
    notify(sentence, true, has_bones ? Offer{} : find);
}

namespace {

/// Whether nothing is to be done about a frame any more: it is filled, or neither played nor exported.
bool is_settled(const PoseEdits& edits, int frame) {
  const auto in = [frame](const auto& range) { return range.first <= frame && frame <= range.last; };
  return std::any_of(edits.fill.begin(), edits.fill.end(), in) || edits.skip.count(frame) > 0 ||
         (edits.trim && !in(*edits.trim));
}

/// The runs in which something is still to be done.
std::vector<FillEdit> unsettled(const PoseEdits& edits, std::vector<FillEdit> runs) {
  const auto is_done = [&](const FillEdit& run) {
    for (int t = run.first; t <= run.last; ++t)
      if (!is_settled(edits, t)) return false;
    return true;
  };
  runs.erase(std::remove_if(runs.begin(), runs.end(), is_done), runs.end());
  return runs;
}

std::string fill_command(size_t take) {
  return "edit.fill " + std::to_string(take) + " bad";
}

/// "7 frames (41 to 47) could not be used and repeat the last pose".
std::string unusable_in_words(const std::vector<FillEdit>& runs, bool predicted) {
  int count = 0;
  for (const FillEdit& run : runs) count += run.last - run.first + 1;
  const FillEdit& only = runs[0];
  std::string text = count == 1 ? "1 frame" : std::to_string(count) + " frames";
  if (runs.size() > 1)
    text += " in " + std::to_string(runs.size()) + " places";
  else
    text += " (" + std::to_string(only.first) +
            (count > 1 ? " to " + std::to_string(only.last) : std::string()) + ")";
  const std::string poses = predicted    ? " and went on as those before"
                            : count == 1 ? " and repeats the last pose"
                                         : " and repeat the last pose";
  return text + " could not be used" + (only.first > 0 ? poses : "");
}

}  // namespace

void Studio::withdraw_notice(int64_t id) {
  auto& notices = session_.notices;
  notices.erase(
      std::remove_if(notices.begin(), notices.end(), [id](const Notice& one) { return one.id == id; }),
      notices.end());
}

/// Once all frames of a take are made, once for each source: not where they are filled or left out already.
void Studio::offer_fill(size_t k) {
  Background& b = *background_;
  Background::Applied& applied = b.applied[b.take_ids[k]];
  const Take& take = session_.document.takes[k];
  applied.fill_of = b.source_key, applied.fill_notice = 0;
  applied.unusable = unusable_runs(session_, k);
  const auto runs = unsettled(take.pose_edits, applied.unusable);
  const bool none_is_known =
      runs.size() == 1 && runs[0].first == 0 && runs[0].last + 1 == ssize(performed_by(session_, k));
  if (runs.empty() || none_is_known) return;
  const std::string whose = session_.takes.size() > 1 ? take.name + ": " : "";
  notify(whose + unusable_in_words(runs, take.method.predict), true, Offer{"Fill", fill_command(k), true});
  applied.fill_notice = session_.notices_made;
}

void Studio::offer_fills() {
  Background& b = *background_;
  for (size_t k = 0; k < session_.takes.size(); ++k) {
    Background::Applied& applied = b.applied[b.take_ids[k]];
    if (is_performed(session_, k) && applied.fill_of != b.source_key) offer_fill(k);
    const auto notice = std::find_if(session_.notices.begin(), session_.notices.end(),
                                     [&applied](const Notice& one) { return one.id == applied.fill_notice; });
    if (notice == session_.notices.end()) continue;
    notice->offer.command = fill_command(k);  // takes before it may have gone
    if (unsettled(session_.document.takes[k].pose_edits, applied.unusable).empty())
      session_.notices.erase(notice);
  }
}

/// One after the other.
void Studio::ask_about_persons() {
  Background& b = *background_;
  if (session_.question || b.doubted.empty()) return;
  const int64_t id = *b.doubted.begin();
  b.doubted.erase(b.doubted.begin());
  const TakeState* const take = take_of(id);
  if (!take || take->problem.empty()) return;
  const int k = static_cast<int>(take - session_.takes.data());
  session_.question = Question{Question::Kind::NotAPerson, take->problem + ". Use it anyway?", "", {}, {}, k};
}

}  // namespace understudy::app
