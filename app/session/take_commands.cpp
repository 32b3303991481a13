#include <filesystem>

#include "app/session/command_sets.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/pipeline/method_table.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;
constexpr size_t kMostTakes = 8;

std::string target_file(const Call& c, size_t i) {
  std::string path = c.path(i);
  std::error_code failed;
  US_CHECK(fs::exists(path, failed), path, ": there is no such file");
  US_CHECK(!fs::is_directory(path, failed), path, ": is a folder; a target is one file");
  US_CHECK(format_of_file(path, kTarget) != nullptr, path, ": is not a known character or mesh format");
  return path;
}

void check_room(const Document& document) {
  US_CHECK(document.takes.size() < kMostTakes, "there are ", kMostTakes, " takes already");
}

/// A person in a picture performs 2D poses alone.
void check_fits(const Document& document) {
  US_CHECK(document.flat || document.source.path.empty(), name_of(document.source),
           ": is no file of 2D poses, and a person in a picture performs nothing else");
}

bool is_edited(const Take& take) {
  return (take.flat && !take.flat->lengths.empty()) || !take.pose_edits.empty() ||
         !take.target_edits.joints.empty() || take.target_edits.weights ||
         !take.target_edits.rest_pose.empty() || !take.target_edits.face.empty();
}

/// Says which take went, and offers it back.
void remove_take(Call& c) {
  const Take& take = c.take();
  c.label = "Remove " + take.name;
  c.studio.notify("Removed " + take.name + (is_edited(take) ? " with its edits" : ""), false,
                  {"Undo", join_line("edit.undo", {c.label})});
  c.document.takes.erase(c.document.takes.begin() + static_cast<std::ptrdiff_t>(c.take_number()));
}

void add_targets(Commands& commands) {
  commands.add_edit({"target.add", "Add target", "PATH"}, [](Call& c) {
    check_room(c.document);
    Take take;
    if (const auto flat = flat_target_file(c.path(0))) {
      take.target.path = *flat;
      take.flat.emplace();
      check_fits(c.document);
    } else {
      take.target.path =
          opened({&c.session.settings.recent_targets}, c.path(0), [&] { return target_file(c, 0); });
    }
    take.target.not_a_person = NotAPerson::Refuse;
    take.name = fs::path(take.target.path).stem().string();
    remember_folder(c.studio, take.target.path);
    c.document.takes.push_back(std::move(take));
    choose_take(c.session, static_cast<int>(c.document.takes.size()) - 1);
  });
  commands.add_edit({"target.replace", "Replace target", "TAKE PATH"}, [](Call& c) {
    Take& take = c.take();
    const std::optional<std::string> flat = flat_target_file(c.path(1));
    if (flat) check_fits(c.document);
    take.target = TargetOptions{};
    take.target.path = flat ? *flat : target_file(c, 1);
    take.flat.reset();
    if (flat) take.flat.emplace();
    take.target.not_a_person = NotAPerson::Refuse;
    take.target_edits = {};
    remember_folder(c.studio, take.target.path);
    take.name = fs::path(take.target.path).stem().string();
  });
  commands.add_edit({"target.remove", "Remove take", "TAKE"}, remove_take);
  commands.add({"target.select", "Select take", "TAKE"},
               [](Call& c) { choose_take(c.session, static_cast<int>(c.take_number())); });
  commands.add_edit({"take.person", "Choose whom a take performs", "TAKE NUMBER|source"}, [](Call& c) {
    std::string& person = c.take().person;
    person = c.word(1, "person");
    if (person == "source") return person.clear();
    US_CHECK(person_number(person) > 0, "a take performs a person by their number, or the source's (source)");
    c.label = c.take().name + ": perform person " + person;
  });
  commands.add_edit({"take.rename", "Rename take", "TAKE NAME"},
                    [](Call& c) { c.take().name = c.word(1, "name"); });
}

void use_anyway(Call& c) {
  c.take().target.not_a_person = NotAPerson::Use;
  auto& question = c.session.question;
  const bool asked = question && question->kind == Question::Kind::NotAPerson;
  if (asked && question->take == static_cast<int>(c.take_number())) question.reset();
}

void add_target_import(Commands& commands) {
  commands.add_edit({"target.units", "Units of the target", "TAKE auto|m|dm|cm|mm|in"},
                    [](Call& c) { c.take().target.import.units = c.one_of(1, "unit", kUnitNames); });
  commands.add_edit({"target.up", "Up axis of the target", "TAKE auto|x|y|z|-x|-y|-z"},
                    [](Call& c) { c.take().target.import.up = c.one_of(1, "axis", kAxisNames); });
  commands.add_edit({"target.height", "Height of the target", "TAKE METRES|auto: by its units, else 1.7 m"},
                    [](Call& c) { c.take().target.import.height = c.body_height(1); });
  commands.add_edit({"target.use_anyway", "Use a target that does not look like a person", "TAKE"},
                    use_anyway);
  commands.add_slider(
      {"target.turn", "Turn the target", "TAKE DEGREES|auto: so that it faces +z", "", "target.yaw"},
      [](Call& c) {
        TargetOptions& target = c.take().target;
        target.forward = c.word(1, "angle") == "auto";
        target.import.turn_deg = target.forward ? 0 : c.number(1, "angle");
      });
  commands.add_slider({"target.betas", "Shape of the target", "TAKE \"1.2,-0.5\""}, [](Call& c) {
    std::vector<float>& betas = c.take().target.betas;
    betas.clear();
    for (const std::string& item : split(c.word(1, "list of shape parameters"), ','))
      betas.push_back(ArgumentReader({item}).number(0, "shape parameter"));
  });
}

void set_rig(Call& c) {
  const Rig rig = ArgumentReader({present_rig(c.word(1, "rig"))}).choice<Rig>(0, "rig", kRigNames);
  const auto& character = c.take_state().character;
  US_CHECK(rig != Rig::Own || !character || character->rigged, c.take().name,
           " has no skeleton of its own whose bones are known");
  c.take().target.rig = rig;
}

/// Refuses a wrong choice at once where the character is known.
void set_bone(Call& c) {
  BoneChoices& bones = c.take().target.bones;
  const std::string joint = kJointNames[c.joint(1)];
  const std::string& bone = c.word(2, "bone");
  bones[joint] = bone == "none" ? "" : bone;
  if (bone == "auto") bones.erase(joint);
  if (const auto& character = c.take_state().character)
    map_bones(character->character, character->bind.nodes, bones);
}

void add_rig(Commands& commands) {
  commands.add_edit({"target.rig", "Rig of the target", "TAKE auto|own|22"}, set_rig);
  commands.add_edit({"target.bone", "Bone of a joint", "TAKE JOINT BONE|none|auto"}, set_bone);
  commands.add_edit({"target.bones_clear", "Reset to the bones found", "TAKE"},
                    [](Call& c) { c.take().target.bones.clear(); });
}

std::vector<std::string> switch_names() {
  std::vector<std::string> names;
  for (const MethodSwitch& one : kSwitches) names.push_back(one.name);
  return names;
}

/// What older scripts call otherwise.
std::string present_name(const std::string& setting) {
  for (const MethodSwitch& one : kSwitches)
    if (setting == one.old_word) return one.name;
  return setting == "root" ? "path" : setting;
}

/// One setting of a method, "engine=paper".
void set_method(Method& method, const std::string& key, const std::string& value) {
  std::vector<std::string> settings = switch_names();
  settings.insert(settings.begin(), {"engine", "extractor", "offsets", "path", "predict"});
  for (const Proportion& one : kProportions) settings.push_back(one.name);
  for (const std::string& one : style_settings()) settings.push_back(one);
  ArgumentReader({key}).one_of(0, "setting", settings);
  const ArgumentReader words({value});
  if (set_style(method.style, key, words)) return;
  if (key == "engine")
    method.engine = words.one_of(0, "engine", names_of(engines()));
  else if (key == "extractor")
    method.extractor = words.one_of(0, "extractor", names_of(extractors()));
  else if (key == "path")
    method.path = words.choice<RootMode>(0, "path", kRootNames);
  else if (key == "offsets")
    method.offsets = words.on(0);
  else if (key == "predict")
    method.predict = words.on(0);
  for (const MethodSwitch& one : kSwitches)
    if (key == one.name) method.*one.on = words.on(0);
  for (const Proportion& one : kProportions)
    if (key == one.name) method.*one.value = words.clamped(0, one.name, one.range.low, one.range.high);
}

void compare(Call& c) {
  Take other = c.take();
  check_room(c.document);
  for (size_t i = 1; i < c.arguments.size(); ++i) {
    const std::string& setting = c.arguments[i];
    const size_t equals = setting.find('=');
    US_CHECK(equals != std::string::npos, "a setting is written as engine=paper, not ", setting);
    const std::string key = present_name(setting.substr(0, equals)), value = setting.substr(equals + 1);
    if (other.flat)
      set_flat(*other.flat, key, ArgumentReader({value}));
    else
      set_method(other.method, key, value);
    const std::string shown = key == "engine" ? "transfer" : key;  // as the panels call it
    other.name.append(i == 1 ? " (" : ", ").append(shown).append(" ").append(value);
  }
  other.name += c.arguments.size() > 1 ? ")" : " (2)";
  c.document.takes.push_back(std::move(other));
}

/// "target.stride TAKE NUMBER".
void add_proportions(Commands& commands) {
  for (const Proportion& one : kProportions)
    commands.add_slider({std::string("target.") + one.name, one.label,
                         detail::join("TAKE NUMBER: ", one.range.low, " to ", one.range.high)},
                        [&one](Call& c) { set_method(c.take().method, one.name, c.word(1, "number")); });
}

void add_methods(Commands& commands) {
  const auto setting = [&commands](const std::string& key, const char* label, const std::string& usage,
                                   const char* old_name = "") {
    commands.add_edit({"method." + key, label, usage, "", old_name},
                      [key](Call& c) { set_method(c.take().method, key, c.word(1, "setting")); });
  };
  setting("engine", "Motion transfer", "TAKE " + names_of(engines(), "|"));
  setting("extractor", "Skeleton extraction", "TAKE " + names_of(extractors(), "|"));
  setting("offsets", "Pose-corrective offsets", "TAKE on|off");
  setting("predict", "Predict unusable frames", "TAKE on|off");
  setting("path", "Path", "TAKE scaled|original|in-place", "method.root");
  std::string filters;
  for (const std::string& name : switch_names()) append_item(filters, name, "|");
  commands.add_edit({"method.filter", "Filter", "TAKE " + filters + " on|off"}, [](Call& c) {
    const ArgumentReader setting({present_name(c.word(1, "filter"))});
    set_method(c.take().method, setting.one_of(0, "filter", switch_names()), c.word(2, "switch"));
  });
  commands.add_edit({"compare.add", "Compare with another method", "TAKE [SETTING=VALUE ...]"}, compare);
}

}  // namespace

void add_take_commands(Commands& commands) {
  add_targets(commands);
  add_target_import(commands);
  add_proportions(commands);
  add_rig(commands);
  add_methods(commands);
}

}  // namespace understudy::app
