// The commands, one file per family.
#pragma once

#include "app/session/studio.hpp"

namespace understudy::app {

void add_document_commands(Commands& commands);
void add_source_commands(Commands& commands);
void add_take_commands(Commands& commands);
void add_playback_commands(Commands& commands);
void add_view_commands(Commands& commands);
void add_edit_commands(Commands& commands);
void add_export_commands(Commands& commands);
void add_program_commands(Commands& commands);
void add_all_commands(Commands& commands);

// Parsed arguments. Each function throws Error naming the argument that is wrong.

double number(const Arguments& arguments, size_t i, const char* what);
int whole_number(const Arguments& arguments, size_t i, const char* what);
bool on_off(const Arguments& arguments, size_t i);
/// "on", "off" or "toggle" of what is `now`.
bool switched(const Arguments& arguments, size_t i, bool now);
const std::string& word(const Arguments& arguments, size_t i, const char* what);
/// The index of the argument among `words`.
size_t choice(const Arguments& arguments, size_t i, const char* what, const std::vector<std::string>& words);
template <size_t N>
size_t choice(const Arguments& arguments, size_t i, const char* what, const Names<N>& names) {
  return choice(arguments, i, what, std::vector<std::string>(names.begin(), names.end()));
}
/// A joint by name ("left_wrist") or number.
int joint_argument(const Arguments& arguments, size_t i);
Vec3 vector_argument(const Arguments& arguments, size_t i, const char* what);
/// The take with that number.
Take& take_argument(Session& session, const Arguments& arguments, size_t i);
bool has_word(const Arguments& arguments, size_t from, const std::string& word);

}  // namespace understudy::app
