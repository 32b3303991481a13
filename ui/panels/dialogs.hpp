// Dialogs and notices: errors, questions, about the program, another method to compare.
// Marks: error.copy, error.close; unsaved.yes, .no, .cancel; recover.K, discard.K, recover.later; missing.K,
// missing.leave; about.copy, about.close; compare.engine, compare.extractor, compare.offsets, compare.root,
// compare.apply, compare.cancel; notice.0 the newest notice.
#pragma once

#include <optional>
#include <string>

#include "ui/panels/panel.hpp"
#include "ui/widgets/dialogs.hpp"

namespace understudy::ui {

/// Draws the first error; false when there is none.
bool draw_error(const app::Session& session, PanelContext& context);

/// The part of an answer that only the window can carry out.
struct QuestionAnswer {
  bool save_as = false;  ///< the document has no file yet: ask for one, then save
  std::string look_for;  ///< MissingFiles: ask for the new place of this path
};
/// Draws the session's question, which must be there.
QuestionAnswer draw_question(const app::Session& session, PanelContext& context);

struct NoticesState {
  Notices shown;
  double newest = 0;  ///< Notice::until of the newest that was taken over
};
/// Call outside any window, last.
void draw_notices(const app::Session& session, PanelContext& context, NoticesState& state, const Rect& over);

/// Program, versions, machine. False once closed.
bool draw_about(PanelContext& context, const std::string& about);

/// The method of the second take; empty at first: like the selected one.
struct CompareState {
  std::optional<app::Method> method;
};
bool draw_compare(const app::Session& session, PanelContext& context, CompareState& state);

}  // namespace understudy::ui
