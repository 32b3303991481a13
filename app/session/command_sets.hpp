// The commands, one file per family, and the call that each of them gets.
#pragma once

#include "app/session/studio.hpp"
#include "retarget/base/error.hpp"
#include "retarget/character/rig_character.hpp"

namespace understudy::app {

void add_document_commands(Commands& commands);
void add_source_commands(Commands& commands);
void add_take_commands(Commands& commands);
void add_style_commands(Commands& commands);
void add_teach_commands(Commands& commands);
void add_playback_commands(Commands& commands);
void add_view_commands(Commands& commands);
void add_edit_commands(Commands& commands);
void add_export_commands(Commands& commands);
void add_study_commands(Commands& commands);
void add_map_commands(Commands& commands);
void add_bones_commands(Commands& commands);
void add_second_body_commands(Commands& commands);
void add_made_motions_commands(Commands& commands);
void add_flat_commands(Commands& commands);
void add_program_commands(Commands& commands);
void add_all_commands(Commands& commands);

/// Arguments, parsed. Each function throws Error naming the argument that is wrong, as `what`.
class ArgumentReader {
 public:
  explicit ArgumentReader(Arguments given) : arguments(std::move(given)) {}

  const std::string& word(size_t i, const char* what) const;
  /// Finite and below 1e12; an int is a whole number.
  template <class Number = float>
  Number number(size_t i, const char* what) const {
    return static_cast<Number>(std::is_integral_v<Number> ? whole_number(i, what) : real_number(i, what));
  }
  template <class Number>
  Number clamped(size_t i, const char* what, Number low, Number high) const {
    return std::clamp(number<Number>(i, what), low, high);
  }
  /// "on" or "off".
  bool on(size_t i) const;
  /// "on", "off" or "toggle" of what is `now`; nothing toggles, too.
  bool switched(size_t i, bool now) const;
  /// The index of the argument among `words`.
  size_t choice(size_t i, const char* what, const std::vector<std::string>& words) const;
  template <class Enum, size_t N>
  Enum choice(size_t i, const char* what, const Names<N>& names) const {
    return static_cast<Enum>(choice(i, what, std::vector<std::string>(names.begin(), names.end())));
  }
  /// The argument, which is one of `words`.
  const std::string& one_of(size_t i, const char* what, const std::vector<std::string>& words) const;
  /// Metres that a body is made tall; none for "auto".
  std::optional<float> body_height(size_t i) const;
  /// A joint by name ("left_wrist") or number.
  int joint(size_t i) const;
  Vec3 vector(size_t i, const char* what) const;
  /// A path, made absolute.
  std::string path(size_t i, const char* what = "path") const;
  bool has(const std::string& wanted, size_t from) const;

  const Arguments arguments;

 private:
  double real_number(size_t i, const char* what) const;
  double whole_number(size_t i, const char* what) const;
};

/// A command that is being run: its arguments, and what it may change.
class Call : public ArgumentReader {
 public:
  Call(Studio& of, const Arguments& given)
      : ArgumentReader(given), studio(of), session(of.session()), document(of.session().document) {}

  /// The take that an argument names by its number.
  size_t take_number(size_t i = 0) const;
  Take& take(size_t i = 0) const { return document.takes[take_number(i)]; }
  TakeState& take_state(size_t i = 0) const { return session.takes[take_number(i)]; }

  Studio& studio;
  Session& session;
  Document& document;
  std::string label;  ///< of this run, for undo: "Remove adult"; empty: the command's
};

/// One setting of a take's style: "style" NAME|FILE|none, "style_strength" and its shares. False: it is
/// another's.
bool set_style(StyleChoice& style, const std::string& setting, const ArgumentReader& value);
/// The settings that set_style knows.
std::vector<std::string> style_settings();
/// "edit.move tempo" and "edit.remove tempo".
void move_tempo_mark(Call& c);
void remove_tempo_mark(Call& c);

/// Whether the open study is saved, or none is open. If not, asks first and goes on with `then`.
bool no_unsaved_study(Studio& studio, const std::string& then);
/// Saves the open study. It may be one that cannot be run yet. Throws Error naming the path.
void save_study(Studio& studio, const std::string& path);

/// Another source in place of the open one: edits and settings of the old one's frames go with it.
void set_source(Call& c, SourceOptions source);

/// Opens 2D poses as the source.
void set_flat_source(Call& c, const std::string& path);
/// One setting of how a person in a picture performs: "place", "touches", "growth", "engine". Throws Error
/// for another.
void set_flat(FlatTake& take, const std::string& setting, const ArgumentReader& value);
/// Exchanges left and right of 2D poses: FIRST LAST [arms|legs|both].
void exchange_flat_sides(Call& c);
/// Whether a file can be the person in a picture who performs 2D poses: such poses, proportions, or a
/// picture with poses beside. Then the path of these.
std::optional<std::string> flat_target_file(const std::string& path);

/// What was found in the source's scans. Throws Error where there is nothing yet.
const DiscoveredRig& rig_of(const Call& c);
/// A bone of a rig by name or number. Throws Error where it has no such bone.
size_t bone_number(const Call& c, size_t i, const understudy::Rig& rig);
/// A clip of the document by the name or number that is the call's first word. Throws Error where none is.
MadeClip& kept_clip(Call& c);
/// Writes a rig with clips to the call's path, in the background; several in glTF alone. Throws Error where
/// that cannot be.
void export_rig(Call& c, const std::shared_ptr<const RiggedMotion>& rig, std::vector<RigClip> clips);

/// The folder that a file or folder was opened from or saved in, for the next time; not that of the samples.
void remember_folder(Studio& studio, const std::string& path);

/// Opens what an entry of recent lists names, or checks that it can be opened. Where that throws Error the
/// entry is taken off, and the sentence says so.
template <class Open>
auto opened(std::initializer_list<std::vector<std::string>*> recent, const std::string& entry,
            const Open& open) {
  try {
    return open();
  } catch (const Error& error) {
    const std::string more = taken_off(recent, entry);
    if (more.empty()) throw;
    throw Error(error.what() + more);
  }
}

/// The offer of a notice about a file that was written.
inline Offer showing(const std::string& path) {
  return {"Show in folder", join_line("file.show", {path})};
}

/// `value` where it is `wanted`, else none.
template <class Value>
std::optional<Value> only_if(bool wanted, Value value) {
  return wanted ? std::optional<Value>(std::move(value)) : std::nullopt;
}

}  // namespace understudy::app
