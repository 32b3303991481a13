// The moments of a job that its contact sheet shows, kept while the job runs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/contact_sheet.hpp"

namespace understudy::app {

/// Picks six moments, evenly spread, from a sequence whose length may be unknown; never holds more than
/// twelve.
class PreviewMoments {
 public:
  static constexpr int kShown = 6;
  /// count: frames to come, where known.
  explicit PreviewMoments(std::optional<int64_t> count) : count_(count) {}
  /// Whether frame number `index` (from 0, in order) should be offered to add().
  bool wanted(int64_t index) const;
  void add(int64_t index, render::SheetMoment moment);
  /// At most six.
  std::vector<render::SheetMoment> take();

 private:
  std::optional<int64_t> count_;
  int64_t stride_ = 1;
  std::vector<std::pair<int64_t, render::SheetMoment>> kept_;
};

/// Draws the sheet and writes it as a PNG. The sheet looks from where the first skeleton faces.
void write_preview(const std::string& path, std::vector<render::SheetMoment> moments,
                   const std::string& title);

}  // namespace understudy::app
