// Edits of a study: of any setting by its name, and of its lists, from what is open or from files.
#pragma once

#include <string>
#include <vector>

#include "app/session/session.hpp"

namespace understudy::app {

/// A setting of a study, for the panel and for undo.
struct StudyField {
  const char* name;         ///< as study.set takes it, without the numbers of lists: "questions.text"
  const char* label;        ///< of its row: "Question"
  const char* explanation;  ///< without a full stop
};
const std::vector<StudyField>& study_fields();
/// Of a setting's full name ("questions.0.text"); null where it is not listed.
const StudyField* study_field(const std::string& name);

/// The study with another value of a setting: a name as in the file ("plan.order", "questions.0.points",
/// "conditions.1.method.offsets") and its value, several of them where the setting is a list; "none" for one
/// that need not be there. Files of conditions follow where a motion or a target is renamed.
/// Throws Error: there is no such setting, or it cannot have that value.
Study with_value(const Study& study, const std::string& name, const std::vector<std::string>& values);

/// Of lists that commands name as kStudyListNames do, all but the trials. Throw Error where the list has no
/// such item. What is removed takes along the files of conditions that are only for it.
void remove_item(Study& study, const std::string& list, size_t i);
void move_item(Study& study, const std::string& list, size_t from, size_t to);
void copy_item(Study& study, const std::string& list, size_t i);

// From what is open; what the study has already is not added again.

/// A condition for each method of the takes.
void add_conditions_of_takes(Study& study, const Document& document);
/// The takes' targets, as their files are: edits of them are not part of a study.
void add_targets_of_takes(Study& study, const Document& document);
/// The source, between the loop marks where there are any. Throws Error where no source is open.
void add_motion_of_source(Study& study, const Session& session);
/// The blend that is open at `steps` evenly spread weights, from the first of its motions to the last: a
/// motion each. Throws Error where the source is none, and for fewer than 2 or more than 100.
void add_blends(Study& study, const Session& session, int steps);
/// All three, as far as there is something; nothing is asked yet.
Study study_of_takes(const Session& session);

// From files.

/// An animation each; with as many as there are motions one is for each, in their order.
void add_condition_of_files(Study& study, const std::vector<std::string>& paths);
void add_motion_of_file(Study& study, const std::string& path);
void add_target_of_file(Study& study, const std::string& path);
/// "likert", "choice" or "attention", with words to be changed.
void add_question(Study& study, QuestionKind kind);

/// The angles of the active view, and its light.
void see_as_in_view(Study& study, const View& view);

/// "Copy, no offsets": the engine, and what differs from its usual settings.
std::string method_in_words(const Method& method);

}  // namespace understudy::app
