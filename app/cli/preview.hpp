// The moments of a job that its contact sheet shows, kept while the job runs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/contact_sheet.hpp"

namespace understudy::app {

/// Picks moments, evenly spread, from a sequence whose length may be unknown; never holds more than twice as
/// many as it shows.
class PreviewMoments {
 public:
  static constexpr int kShown = 6;
  /// count: frames to come, where known. shown: how many moments are wanted.
  explicit PreviewMoments(std::optional<int64_t> count, int shown = kShown) : count_(count), shown_(shown) {}
  /// Whether frame number `index` (from 0, in order) should be offered to add().
  bool wanted(int64_t index) const;
  void add(int64_t index, render::SheetMoment moment);
  /// At most `shown`.
  std::vector<render::SheetMoment> take();

 private:
  std::optional<int64_t> count_;
  int shown_;
  int64_t stride_ = 1;
  std::vector<std::pair<int64_t, render::SheetMoment>> kept_;
};

/// Draws the sheet, `columns` moments in a row, and writes it as a PNG. It looks from where the first
/// skeleton faces.
void write_preview(const std::string& path, const std::vector<render::SheetMoment>& moments,
                   const std::string& title, int columns = PreviewMoments::kShown);

}  // namespace understudy::app
