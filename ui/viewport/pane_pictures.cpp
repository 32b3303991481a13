#include "ui/viewport/pane_pictures.hpp"

#include <algorithm>

#include "retarget/base/index.hpp"

namespace understudy::ui {
namespace {

using app::Session;

constexpr size_t kAsked = 3;  // frames asked for that may still be shown when they come late
constexpr int kAhead = 4;     // frames made before playback comes to them

bool wants_scan(const Session& session, const PaneContent& pane) {
  return pane.source && (session.view.source.surface || session.tool == app::Tool::Crop);
}

bool wants_take(const Session& session, int k, int frame) {
  const app::TakeState* take = take_of(session, k);
  return take != nullptr && take->ready && session.view.take.surface &&
         at_or_null(take->joints, frame) != nullptr;
}

app::FrameCache::Wanted wanted(const Session& session, int k, int frame) {
  app::FrameCache::Wanted what;
  what.take = k, what.frame = frame;
  what.offsets = take_colouring(session) == app::Colouring::Offsets;
  return what;
}

std::vector<PanePictures::Ghost> ghosts_of(const Session& session, app::FrameCache& cache,
                                           const PaneContent& pane, int frame) {
  const app::View& view = session.view;
  std::vector<PanePictures::Ghost> ghosts;
  for (int side = -1; side <= 1; side += 2)
    for (int i = 1; i <= view.ghost_count; ++i) {
      const int f = frame + side * i * view.ghost_step;
      if (f < 0 || f >= frame_count(session, pane)) continue;
      PanePictures::Ghost ghost;
      ghost.frame = f;
      if (view.source.ghosts && wants_scan(session, pane)) ghost.scan = cache.scan(f);
      if (view.take.ghosts && !pane.takes.empty() && wants_take(session, pane.takes[0], f))
        ghost.take = cache.posed(*take_of(session, pane.takes[0]), {pane.takes[0], f, false});
      ghosts.push_back(std::move(ghost));
    }
  return ghosts;
}

}  // namespace

std::optional<PanePictures> pictures_of(const Session& session, app::FrameCache& cache,
                                        const PaneContent& pane, int frame) {
  PanePictures out;
  out.frame = frame;
  if (frame < 0) return out;
  bool whole = true;
  if (wants_scan(session, pane)) whole = (out.scan = cache.scan(frame)) != nullptr && whole;
  for (const int k : pane.takes) {
    out.takes.push_back(nullptr);
    if (!wants_take(session, k, frame)) continue;
    out.takes.back() = cache.posed(*take_of(session, k), wanted(session, k, frame));
    whole = out.takes.back() != nullptr && whole;
  }
  if (take_colouring(session) == app::Colouring::Difference && !pane.takes.empty() &&
      wants_take(session, 0, frame))
    whole = (out.reference = cache.posed(session.takes[0], wanted(session, 0, frame))) != nullptr && whole;
  if (!whole) return std::nullopt;
  const bool ghosts =
      (pane.source && session.view.source.ghosts) || (!pane.takes.empty() && session.view.take.ghosts);
  if (ghosts) out.ghosts = ghosts_of(session, cache, pane, frame);
  return out;
}

std::optional<std::shared_ptr<const TargetLook>> look_of_standing(const Session& session, TargetLooks& looks,
                                                                  const PaneContent& pane) {
  if (shows_rest(session, pane)) return looks.of(take_of(session, pane.takes[0])->target);
  if (shows_as_loaded(session, pane)) return looks.plain_of(take_of(session, pane.takes[0])->as_loaded);
  return std::nullopt;
}

const PanePictures& PictureKeeper::update(const Session& session, app::FrameCache& cache, TargetLooks& looks,
                                          const PaneContent& pane) {
  forget_others(session, pane);
  if (show_standing(session, looks, pane)) return pictures_;
  const int frame = pane_frame(session, pane);
  waiting_ = false;
  if (frame < 0) return pictures_ = {};
  if (asked_.empty() || asked_.front() != frame) asked_.push_front(frame);
  if (asked_.size() > kAsked) asked_.pop_back();
  for (size_t i = 0; i < asked_.size(); ++i) {
    auto pictures = pictures_of(session, cache, pane, asked_[i]);
    if (!pictures) continue;
    pictures_ = std::move(*pictures);
    asked_.resize(i + 1);  // what is older will never be shown again
    break;
  }
  waiting_ = pictures_.frame != frame;
  for (const PanePictures::Ghost& ghost : pictures_.ghosts)
    waiting_ = waiting_ || (session.view.take.ghosts && !pane.takes.empty() && ghost.take == nullptr) ||
               (session.view.source.ghosts && pane.source && ghost.scan == nullptr);
  return pictures_;
}

/// The look in T-pose or as loaded; the one shown before stays until it is ready.
bool PictureKeeper::show_standing(const Session& session, TargetLooks& looks, const PaneContent& pane) {
  const auto look = look_of_standing(session, looks, pane);
  if (!look) return false;
  asked_.clear();
  waiting_ = *look == nullptr || (!(*look)->shaded && shows_rest(session, pane));
  if (*look == nullptr && pictures_.frame < 0) return true;
  pictures_ = {};
  if (*look != nullptr && session.view.take.surface)
    pictures_.takes = {std::shared_ptr<const app::PosedPicture>(*look, &(*look)->rest)};
  return true;
}

/// Pictures of another source or target are not shown any longer.
void PictureKeeper::forget_others(const Session& session, const PaneContent& pane) {
  std::vector<std::shared_ptr<const Target>> targets;
  for (const int k : pane.takes)
    targets.push_back(take_of(session, k) != nullptr ? shown_target(*take_of(session, k)) : nullptr);
  const bool same =
      source_ == session.document.source.path &&
      std::equal(targets.begin(), targets.end(), targets_.begin(), targets_.end(),
                 [](const auto& a, const auto& b) { return a == b || same_surface(a.get(), b.get()); });
  targets_ = std::move(targets), source_ = session.document.source.path;
  if (same) return;
  pictures_ = {}, asked_.clear();
}

void prefetch(const Session& session, app::FrameCache& cache, const PaneContent& pane) {
  const int frame = pane_frame(session, pane), count = frame_count(session, pane);
  if (frame < 0) return;
  const app::FrameRange range = play_range(session.playback, count);
  for (int i = 1; i <= kAhead; ++i) {
    int f = session.playback.playing || i % 2 == 1 ? frame + (session.playback.playing ? i : (i + 1) / 2)
                                                   : frame - i / 2;
    if (session.playback.playing && session.playback.loop && !range.empty() && f > range.last)
      f = range.first + (f - range.last - 1);
    if (f < 0 || f >= count) continue;
    if (wants_scan(session, pane)) cache.prefetch_scan(f);
    for (const int k : pane.takes)
      if (wants_take(session, k, f)) cache.prefetch_posed(*take_of(session, k), wanted(session, k, f));
  }
}

}  // namespace understudy::ui
