#include "app/session/history.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"

namespace understudy::app {
namespace {

constexpr std::chrono::seconds kMergeWithin{1};

}  // namespace

void History::clear() {
  past_.clear();
  future_.clear();
  merge_.clear();
}

void History::set_depth(int depth) {
  depth_ = std::max(depth, 1);
  const size_t most = depth_;
  if (past_.size() > most) past_.erase(past_.begin(), past_.end() - depth_);
}

void History::add(const Document& before, const std::string& label, const std::string& merge, Time now) {
  future_.clear();
  const bool merges = !merge.empty() && merge == merge_ && !past_.empty() && now - merged_at_ <= kMergeWithin;
  merge_ = merge;
  merged_at_ = now;
  if (merges) {
    past_.back().label = label;
    return;
  }
  past_.push_back({before, label});
  set_depth(depth_);
}

void History::change_all(const std::function<void(Document&)>& change, const Document& now) {
  for (Step& step : past_) change(step.document);
  for (size_t i = past_.size(); i-- > 0;) {
    const Document& after = i + 1 < past_.size() ? past_[i + 1].document : now;
    if (same(past_[i].document, after)) past_.erase(past_.begin() + static_cast<std::ptrdiff_t>(i));
  }
  future_.clear();
  merge_.clear();
}

std::string History::undo_label() const {
  return past_.empty() ? "" : past_.back().label;
}

std::string History::redo_label() const {
  return future_.empty() ? "" : future_.back().label;
}

Document History::undo(const Document& now) {
  US_CHECK(can_undo(), "there is nothing to undo");
  Step step = std::move(past_.back());
  past_.pop_back();
  future_.push_back({now, step.label});
  merge_.clear();
  return std::move(step.document);
}

Document History::redo(const Document& now) {
  US_CHECK(can_redo(), "there is nothing to redo");
  Step step = std::move(future_.back());
  future_.pop_back();
  past_.push_back({now, step.label});
  merge_.clear();
  return std::move(step.document);
}

}  // namespace understudy::app
