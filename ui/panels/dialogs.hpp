// Dialogs and notices: errors, questions, about the program, settings, another method to compare.
// Marks: settings.theme(.0, .1), settings.scale, settings.samples, settings.cache, settings.autosave,
// settings.undo_depth, settings.mouse, settings.close; error.copy, error.close; unsaved.yes, .no, .cancel;
// recover.K, discard.K, recover.later; missing.K, missing.leave; about.copy, about.close; compare.engine,
// compare.extractor, compare.offsets, compare.path, compare.apply, compare.cancel; person.yes, person.cancel;
// notice.0 the newest notice, notice.0.offer and
// notice.0.also its buttons.
#pragma once

#include <optional>
#include <string>

#include "ui/panels/files.hpp"
#include "ui/widgets/dialogs.hpp"

namespace understudy::ui {

/// Ends a dialog of one's own, closed where it does not stay or Escape is pressed. Whether it stays.
bool finish_dialog(bool stays);

/// Draws the first error; false when there is none.
bool draw_error(const app::Session& session, PanelContext& context);

/// Draws the session's question, which must be there. Where the answer needs a path it opens the browser.
void draw_question(const app::Session& session, PanelContext& context, FilesState& files);

struct NoticesState {
  std::optional<app::Notice> held;  ///< the pointer is on it: it stays although its time is over
};
/// The newest notices, three at most. Call outside any window, last.
void draw_notices(const app::Session& session, PanelContext& context, NoticesState& state, const Rect& over);

// Dialogs to be drawn every frame while they are open. False once closed.

bool draw_settings(const app::Session& session, PanelContext& context);
/// Program, versions, machine.
bool draw_about(PanelContext& context, const std::string& about);

/// The method of the second take; empty at first: like the selected one.
struct CompareState {
  std::optional<app::Method> method;
  std::optional<app::FlatTake> flat;  ///< of a person in a picture
};
bool draw_compare(const app::Session& session, PanelContext& context, CompareState& state);

}  // namespace understudy::ui
