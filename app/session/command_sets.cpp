#include "app/session/command_sets.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {

const std::string& word(const Arguments& arguments, size_t i, const char* what) {
  US_CHECK(i < arguments.size(), "a ", what, " is missing");
  return arguments[i];
}

double number(const Arguments& arguments, size_t i, const char* what) {
  const std::string& text = word(arguments, i, what);
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  US_CHECK(end != text.c_str() && *end == '\0' && std::abs(value) < 1e12, what, " is a number, not '", text,
           "'");
  return value;
}

int whole_number(const Arguments& arguments, size_t i, const char* what) {
  const double value = number(arguments, i, what);
  US_CHECK(value == std::floor(value) && std::abs(value) < 1e9, what, " is a whole number, not ",
           arguments[i]);
  return static_cast<int>(value);
}

size_t choice(const Arguments& arguments, size_t i, const char* what, const std::vector<std::string>& words) {
  const std::string& text = word(arguments, i, what);
  const auto found = std::find(words.begin(), words.end(), text);
  std::string all;
  for (const std::string& known : words) append_item(all, known);
  US_CHECK(found != words.end(), what, " is one of ", all, ", not '", text, "'");
  return static_cast<size_t>(found - words.begin());
}

bool on_off(const Arguments& arguments, size_t i) {
  return choice(arguments, i, "switch", {"off", "on"}) == 1;
}

bool switched(const Arguments& arguments, size_t i, bool now) {
  const size_t how = i < arguments.size() ? choice(arguments, i, "switch", {"off", "on", "toggle"}) : 2;
  return how == 2 ? !now : how == 1;
}

int joint_argument(const Arguments& arguments, size_t i) {
  const std::string& text = word(arguments, i, "joint");
  for (int j = 0; j < kJointCount; ++j)
    if (text == kJointNames[j]) return j;
  const int j = whole_number(arguments, i, "joint");
  US_CHECK(j >= 0 && j < kJointCount, "there is no joint ", j);
  return j;
}

Vec3 vector_argument(const Arguments& arguments, size_t i, const char* what) {
  Vec3 value;
  for (int axis = 0; axis < 3; ++axis) value[axis] = static_cast<float>(number(arguments, i + axis, what));
  return value;
}

Take& take_argument(Session& session, const Arguments& arguments, size_t i) {
  const int k = whole_number(arguments, i, "take");
  US_CHECK(k >= 0 && k < ssize(session.document.takes), "there is no take ", k);
  return session.document.takes[k];
}

bool has_word(const Arguments& arguments, size_t from, const std::string& wanted) {
  return from < arguments.size() &&
         std::find(arguments.begin() + static_cast<long>(from), arguments.end(), wanted) != arguments.end();
}

void add_all_commands(Commands& commands) {
  add_document_commands(commands);
  add_source_commands(commands);
  add_take_commands(commands);
  add_playback_commands(commands);
  add_view_commands(commands);
  add_edit_commands(commands);
  add_export_commands(commands);
  add_program_commands(commands);
}

}  // namespace understudy::app
