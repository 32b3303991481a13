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

std::string target_file(const Arguments& arguments, size_t i) {
  const std::string path = fs::absolute(word(arguments, i, "path")).lexically_normal().string();
  std::error_code failed;
  US_CHECK(fs::exists(path, failed), path, ": there is no such file");
  US_CHECK(!fs::is_directory(path, failed), path, ": is a folder; a target is one file");
  US_CHECK(can_be(path, kTarget), path, ": is not a known character or mesh format");
  return path;
}

std::vector<float> betas(const std::string& text) {
  std::vector<float> values;
  for (const std::string& item : split(text, ','))
    values.push_back(static_cast<float>(number({item}, 0, "shape parameter")));
  return values;
}

void add_targets(Commands& commands) {
  commands.add({"target.add", "Add target", "PATH", "", true, false, [](Studio& s, const Arguments& a) {
                  Session& session = s.session();
                  auto& takes = session.document.takes;
                  US_CHECK(takes.size() < kMostTakes, "there are ", kMostTakes, " takes already");
                  Take take;
                  take.target.path = target_file(a, 0);
                  take.name = fs::path(take.target.path).stem().string();
                  remember(session.settings.recent_targets, take.target.path);
                  takes.push_back(std::move(take));
                  session.selected_take = takes.size() - 1;
                }});
  commands.add(
      {"target.replace", "Replace target", "TAKE PATH", "", true, false, [](Studio& s, const Arguments& a) {
         Take& take = take_argument(s.session(), a, 0);
         take.target = TargetOptions{};
         take.target.path = target_file(a, 1);
         take.target_edits = {};
         take.name = fs::path(take.target.path).stem().string();
       }});
  commands.add({"target.remove", "Remove take", "TAKE", "", true, false, [](Studio& s, const Arguments& a) {
                  take_argument(s.session(), a, 0);
                  auto& takes = s.session().document.takes;
                  takes.erase(takes.begin() + whole_number(a, 0, "take"));
                }});
  commands.add({"target.select", "Select take", "TAKE", "", false, false, [](Studio& s, const Arguments& a) {
                  take_argument(s.session(), a, 0);
                  s.session().selected_take = whole_number(a, 0, "take");
                  s.session().view.active_pane = s.session().selected_take + 1;
                }});
  commands.add(
      {"take.rename", "Rename take", "TAKE NAME", "", true, false,
       [](Studio& s, const Arguments& a) { take_argument(s.session(), a, 0).name = word(a, 1, "name"); }});
}

void add_target_import(Commands& commands) {
  commands.add({"target.units", "Units of the target", "TAKE auto|m|dm|cm|mm|in", "", true, false,
                [](Studio& s, const Arguments& a) {
                  choice(a, 1, "unit", {"auto", "m", "dm", "cm", "mm", "in"});
                  take_argument(s.session(), a, 0).target.import.units = a[1];
                }});
  commands.add({"target.up", "Up axis of the target", "TAKE auto|x|y|z|-x|-y|-z", "", true, false,
                [](Studio& s, const Arguments& a) {
                  choice(a, 1, "axis", {"auto", "x", "y", "z", "-x", "-y", "-z"});
                  take_argument(s.session(), a, 0).target.import.up = a[1];
                }});
  commands.add({"target.yaw", "Turn the target", "TAKE DEGREES|auto: so that it faces +z", "", true, true,
                [](Studio& s, const Arguments& a) {
                  TargetOptions& target = take_argument(s.session(), a, 0).target;
                  target.forward = word(a, 1, "angle") == "auto";
                  target.import.yaw_deg = target.forward ? 0 : static_cast<float>(number(a, 1, "angle"));
                }});
  commands.add({"target.betas", "Shape of the target", "TAKE \"1.2,-0.5\"", "", true, true,
                [](Studio& s, const Arguments& a) {
                  take_argument(s.session(), a, 0).target.betas =
                      betas(word(a, 1, "list of shape parameters"));
                }});
}

/// Checks the chosen bones where the character is known, so that a wrong choice is refused at once.
void check_bones(const Studio& studio, size_t k) {
  const auto& character = studio.session().takes.at(k).character;
  if (!character) return;
  map_bones(character->character, character->bind.nodes, studio.session().document.takes[k].target.bones);
}

void add_rig(Commands& commands) {
  commands.add({"target.rig", "Rig of the target", "TAKE auto|theirs|ours", "", true, false,
                [](Studio& s, const Arguments& a) {
                  choice(a, 1, "rig", {"auto", "theirs", "ours"});
                  Take& take = take_argument(s.session(), a, 0);
                  const auto& character = s.session().takes[whole_number(a, 0, "take")].character;
                  US_CHECK(a[1] != "theirs" || !character || character->rigged, take.name,
                           " has no skeleton of its own whose bones are known");
                  take.target.rig = a[1];
                }});
  commands.add({"target.bone", "Bone of a joint", "TAKE JOINT BONE|none|auto", "", true, false,
                [](Studio& s, const Arguments& a) {
                  BoneChoices& bones = take_argument(s.session(), a, 0).target.bones;
                  const std::string joint = kJointNames[joint_argument(a, 1)];
                  const std::string& bone = word(a, 2, "bone");
                  if (bone == "auto")
                    bones.erase(joint);
                  else
                    bones[joint] = bone == "none" ? "" : bone;
                  check_bones(s, whole_number(a, 0, "take"));
                }});
  commands.add(
      {"target.bones_clear", "Reset to the bones found", "TAKE", "", true, false,
       [](Studio& s, const Arguments& a) { take_argument(s.session(), a, 0).target.bones.clear(); }});
}

/// One setting of a method, "engine=paper".
void set_method(Method& method, const std::string& key, const std::string& value) {
  const auto on = [&] { return on_off({value}, 0); };
  switch (choice(
      {key}, 0, "setting",
      {"engine", "extractor", "offsets", "root", "swaps", "smooth", "lengths", "feet", "contacts", "near"})) {
    case 0:
      choice({value}, 0, "engine", names_of(engines()));
      method.engine = value;
      break;
    case 1:
      choice({value}, 0, "extractor", names_of(extractors()));
      method.extractor = value;
      break;
    case 2:
      method.offsets = on();
      break;
    case 3:
      method.root = static_cast<RootMode>(choice({value}, 0, "path", kRootNames));
      break;
    case 4:
      method.repair_swaps = on();
      break;
    case 5:
      method.smooth_joints = on();
      break;
    case 6:
      method.fix_lengths = on();
      break;
    case 7:
      method.lock_feet = on();
      break;
    case 8:
      method.keep_contacts = on();
      break;
    default:
      method.near = on();
  }
}

void add_methods(Commands& commands) {
  const auto setting = [&commands](const char* key, const char* label, const std::string& usage) {
    const std::string name = key;
    commands.add({"method." + name, label, usage, "", true, false, [name](Studio& s, const Arguments& a) {
                    set_method(take_argument(s.session(), a, 0).method, name, word(a, 1, "setting"));
                  }});
  };
  setting("engine", "Motion transfer", "TAKE " + names_of(engines(), "|"));
  setting("extractor", "Skeleton extraction", "TAKE " + names_of(extractors(), "|"));
  setting("offsets", "Pose-corrective offsets", "TAKE on|off");
  setting("root", "Path", "TAKE scaled|original|in-place");
  commands.add({"method.filter", "Filter", "TAKE swaps|smooth|lengths|feet|contacts|near on|off", "", true,
                false, [](Studio& s, const Arguments& a) {
                  choice(a, 1, "filter", {"swaps", "smooth", "lengths", "feet", "contacts", "near"});
                  set_method(take_argument(s.session(), a, 0).method, a[1], word(a, 2, "switch"));
                }});
  commands.add(
      {"compare.add", "Compare with another method", "TAKE [SETTING=VALUE ...]", "", true, false,
       [](Studio& s, const Arguments& a) {
         Session& session = s.session();
         Take other = take_argument(session, a, 0);
         US_CHECK(session.document.takes.size() < kMostTakes, "there are ", kMostTakes, " takes already");
         for (size_t i = 1; i < a.size(); ++i) {
           const size_t equals = a[i].find('=');
           US_CHECK(equals != std::string::npos, "a setting is written as engine=paper, not ", a[i]);
           set_method(other.method, a[i].substr(0, equals), a[i].substr(equals + 1));
           other.name += (i == 1 ? " (" : ", ") + a[i].substr(0, equals) + " " + a[i].substr(equals + 1);
         }
         other.name += a.size() > 1 ? ")" : " (2)";
         session.document.takes.push_back(std::move(other));
       }});
}

}  // namespace

void add_take_commands(Commands& commands) {
  add_targets(commands);
  add_target_import(commands);
  add_rig(commands);
  add_methods(commands);
}

}  // namespace understudy::app
