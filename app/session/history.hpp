// Undo and redo by snapshots: documents and studies are small, and what is large in them is shared.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/session/document.hpp"
#include "app/study/study.hpp"

namespace understudy::app {

/// Of a Document or a Study.
template <class State>
class HistoryOf {
 public:
  using Time = std::chrono::steady_clock::time_point;
  explicit HistoryOf(int depth = 200) { set_depth(depth); }
  void clear();
  /// At least 1; drops older steps.
  void set_depth(int depth);
  /// Keeps `before`, the state that `label` ("Drag left wrist") changed. A step with the same `merge`
  /// within a second of the last one becomes one with it (the dragging of a slider); empty: never.
  void add(const State& before, const std::string& label, const std::string& merge = "",
           Time now = std::chrono::steady_clock::now());
  /// Makes a change in all that is kept, as if it had always been so; steps that then change nothing are
  /// dropped. `now` is the present state, changed alike.
  void change_all(const std::function<void(State&)>& change, const State& now);
  /// What was undone cannot be redone any more: something else has been done since.
  void forget_redo() { future_.clear(); }
  size_t steps() const { return past_.size(); }
  bool can_undo() const { return !past_.empty(); }
  bool can_redo() const { return !future_.empty(); }
  /// The step that undo() would undo and redo() redo; "" for none.
  std::string undo_label() const, redo_label() const;
  /// When that step was made; nothing without one.
  std::optional<Time> undo_time() const, redo_time() const;
  /// Goes back: gives the state before the last step; `now` is kept for redo(). Throws Error when there is
  /// nothing.
  State undo(const State& now);
  State redo(const State& now);

 private:
  struct Step {
    State state;
    std::string label;
    Time made;
  };
  int depth_ = 1;
  std::vector<Step> past_, future_;
  std::string merge_;
  Time merged_at_;
};
using History = HistoryOf<Document>;
using StudyHistory = HistoryOf<Study>;

}  // namespace understudy::app
