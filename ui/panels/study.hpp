// The parts of the study panel, and the rows that they share.
#pragma once

#include <string>
#include <vector>

#include "ui/panels/panel.hpp"
#include "ui/widgets/controls.hpp"

namespace understudy::ui {

// A row of a setting, by its name in the file: label and explanation are those of app::study_fields(), its
// mark is "study." and the name, and a change asks for study.set.

void study_text(PanelContext& context, const std::string& setting, const std::string& value,
                const std::string& hint = {});
/// A whole number, typed.
void study_count(PanelContext& context, const std::string& setting, int value);
void study_number(PanelContext& context, const std::string& setting, float value,
                  const NumberOptions& options);
/// auto, or typed; auto asks for none.
void study_optional(PanelContext& context, const std::string& setting, const std::optional<float>& value);
void study_toggle(PanelContext& context, const std::string& setting, bool on);
void study_choice(PanelContext& context, const std::string& setting, const std::vector<std::string>& labels,
                  const std::vector<std::string>& words, const std::string& chosen,
                  const std::vector<std::string>& tips = {});

// The sections. A study is open.

void draw_study_conditions(const app::Session& session, PanelContext& context);
void draw_study_motions(const app::Session& session, PanelContext& context);
void draw_study_targets(const app::Session& session, PanelContext& context);
void draw_study_questions(const app::Session& session, PanelContext& context);
void draw_study_trials(const app::Session& session, PanelContext& context);

}  // namespace understudy::ui
