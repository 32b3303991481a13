#include "app/session/history.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"

namespace understudy::app {
namespace {

constexpr std::chrono::seconds kMergeWithin{1};

}  // namespace

template <class State>
void HistoryOf<State>::clear() {
  past_.clear();
  future_.clear();
  merge_.clear();
}

template <class State>
void HistoryOf<State>::set_depth(int depth) {
  depth_ = std::max(depth, 1);
  const size_t most = depth_;
  if (past_.size() > most) past_.erase(past_.begin(), past_.end() - depth_);
}

template <class State>
void HistoryOf<State>::add(const State& before, const std::string& label, const std::string& merge,
                           Time now) {
  future_.clear();
  const bool merges = !merge.empty() && merge == merge_ && !past_.empty() && now - merged_at_ <= kMergeWithin;
  merge_ = merge;
  merged_at_ = now;
  if (merges) {
    past_.back().label = label;
    return;
  }
  past_.push_back({before, label, now});
  set_depth(depth_);
}

template <class State>
void HistoryOf<State>::change_all(const std::function<void(State&)>& change, const State& now) {
  for (Step& step : past_) change(step.state);
  for (size_t i = past_.size(); i-- > 0;) {
    const State& after = i + 1 < past_.size() ? past_[i + 1].state : now;
    if (same(past_[i].state, after)) past_.erase(past_.begin() + static_cast<std::ptrdiff_t>(i));
  }
  future_.clear();
  merge_.clear();
}

template <class State>
std::string HistoryOf<State>::undo_label() const {
  return past_.empty() ? "" : past_.back().label;
}

template <class State>
std::string HistoryOf<State>::redo_label() const {
  return future_.empty() ? "" : future_.back().label;
}

template <class State>
auto HistoryOf<State>::undo_time() const -> std::optional<Time> {
  return past_.empty() ? std::nullopt : std::optional(past_.back().made);
}

template <class State>
auto HistoryOf<State>::redo_time() const -> std::optional<Time> {
  return future_.empty() ? std::nullopt : std::optional(future_.back().made);
}

template <class State>
State HistoryOf<State>::undo(const State& now) {
  US_CHECK(can_undo(), "there is nothing to undo");
  Step step = std::move(past_.back());
  past_.pop_back();
  future_.push_back({now, step.label, step.made});
  merge_.clear();
  return std::move(step.state);
}

template <class State>
State HistoryOf<State>::redo(const State& now) {
  US_CHECK(can_redo(), "there is nothing to redo");
  Step step = std::move(future_.back());
  future_.pop_back();
  past_.push_back({now, step.label, step.made});
  merge_.clear();
  return std::move(step.state);
}

template class HistoryOf<Document>;
template class HistoryOf<Study>;

}  // namespace understudy::app
