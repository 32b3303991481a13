#include "app/session/commands.hpp"

#include "retarget/base/error.hpp"

namespace understudy::app {

void Commands::add(Command command) {
  US_CHECK(find(command.name) == nullptr, "there are two commands ", command.name);
  commands_.push_back(std::move(command));
}

void Commands::add(CommandText text, std::function<void(Call&)> run) {
  add(Command{std::move(text), Command::Undo::None, std::move(run)});
}

void Commands::add_edit(CommandText text, std::function<void(Call&)> run) {
  add(Command{std::move(text), Command::Undo::Step, std::move(run)});
}

void Commands::add_slider(CommandText text, std::function<void(Call&)> run) {
  add(Command{std::move(text), Command::Undo::Merged, std::move(run)});
}

const Command* Commands::find(const std::string& name) const {
  if (name.empty()) return nullptr;
  for (const Command& command : commands_)
    if (command.name == name || command.old_name == name) return &command;
  return nullptr;
}

Arguments split_line(const std::string& line) {
  Arguments words;
  std::string word;
  bool inside = false, quoted = false;
  for (size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted) {
      if (c == '\\' && i + 1 < line.size() && (line[i + 1] == '"' || line[i + 1] == '\\')) {
        word += line[++i];
      } else if (c == '"') {
        quoted = false;
      } else {
        word += c;
      }
    } else if (c == '"') {
      quoted = inside = true;
    } else if (c == '#' && !inside) {
      break;
    } else if (c == ' ' || c == '\t' || c == '\r') {
      if (inside) words.push_back(std::move(word));
      word.clear();
      inside = false;
    } else {
      word += c;
      inside = true;
    }
  }
  US_CHECK(!quoted, "a quote is not closed in: ", line);
  if (inside) words.push_back(std::move(word));
  return words;
}

std::string join_line(const std::string& name, const Arguments& arguments) {
  std::string line = name;
  for (const std::string& argument : arguments) {
    line += ' ';
    if (!argument.empty() && argument.find_first_of(" \t\r\"#\\") == std::string::npos) {
      line += argument;
      continue;
    }
    line += '"';
    for (const char c : argument) {
      if (c == '"' || c == '\\') line += '\\';
      line += c;
    }
    line += '"';
  }
  return line;
}

}  // namespace understudy::app
