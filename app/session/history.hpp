// Undo and redo by snapshots: documents are small, and what is large in them is shared.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "app/session/document.hpp"

namespace understudy::app {

class History {
 public:
  using Time = std::chrono::steady_clock::time_point;
  explicit History(int depth = 200) { set_depth(depth); }
  void clear();
  /// At least 1; drops older steps.
  void set_depth(int depth);
  /// Keeps `before`, the state that `label` ("Drag left wrist") changed. A step with the same `merge`
  /// within a second of the last one becomes one with it (the dragging of a slider); empty: never.
  void add(const Document& before, const std::string& label, const std::string& merge = "",
           Time now = std::chrono::steady_clock::now());
  /// Makes a change in all that is kept, as if it had always been so; steps that then change nothing are
  /// dropped. `now` is the present document, changed alike.
  void change_all(const std::function<void(Document&)>& change, const Document& now);
  size_t steps() const { return past_.size(); }
  bool can_undo() const { return !past_.empty(); }
  bool can_redo() const { return !future_.empty(); }
  /// The step that undo() would undo and redo() redo; "" for none.
  std::string undo_label() const, redo_label() const;
  /// Goes back: gives the document before the last step; `now` is kept for redo(). Throws Error when there is
  /// nothing.
  Document undo(const Document& now);
  Document redo(const Document& now);

 private:
  struct Step {
    Document document;
    std::string label;
  };
  int depth_ = 1;
  std::vector<Step> past_, future_;
  std::string merge_;
  Time merged_at_;
};

}  // namespace understudy::app
