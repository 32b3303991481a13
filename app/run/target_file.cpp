#include "app/run/target_file.hpp"

#include <filesystem>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/body.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/formats/npz.hpp"

namespace understudy::app {
namespace {

CharacterOptions character_options(const TargetOptions& options) {
  CharacterOptions result;
  result.choices = options.bones;
  result.units = options.import.units;
  result.up = options.import.up.empty() ? "y" : options.import.up;
  result.turn_if_lying = options.import.up.empty();
  result.floor = options.import.floor;
  result.height = options.import.height;
  result.not_a_person = options.not_a_person;
  if (!options.forward || options.import.turn_deg != 0) result.turn_deg = options.import.turn_deg;
  result.own_joints = options.rig != Rig::Ours;
  return result;
}

/// The work's result; an error of it begins with the file's name.
template <class Work>
auto naming(const std::string& path, Work work) {
  try {
    return work();
  } catch (const Error& error) {
    const std::string what = error.what(), named = what.find(path) != what.npos ? what : path + ": " + what;
    if (dynamic_cast<const NotAPersonError*>(&error)) throw NotAPersonError(named);
    throw Error(named);
  }
}

}  // namespace

Character read_target(const std::string& path, const std::vector<float>& betas) {
  if (can_be(path, kBody)) {
    const Npz npz = read_npz(path);
    if (npz.count("v_template")) {
      const ShapedBody person = read_smpl_body(path).shaped(Eigen::VectorXf::Map(betas.data(), betas.size()));
      return character_of_mesh({person.vertices, person.faces}, std::filesystem::path(path).stem().string());
    }
    US_CHECK(!npz.count("poses"), path, ": is a motion, not a character");
  }
  US_CHECK(betas.empty(), path, ": only an SMPL-format body takes --betas");
  return read_character(path);
}

std::shared_ptr<PreparedCharacter> load_target(const TargetOptions& options) {
  Character character = read_target(options.path, options.betas);
  US_CHECK(character.vertex_count() > 0, options.path, ": holds no mesh");
  auto prepared = std::make_shared<PreparedCharacter>(
      naming(options.path, [&] { return load_character(std::move(character), character_options(options)); }));
  US_CHECK(options.rig != Rig::Own || prepared->rigged, options.path,
           ": has no skeleton of its own that can be driven: ", prepared->map.count(),
           " of 22 joints have a bone");
  return prepared;
}

bool needs_extractor(const TargetOptions& options, const PreparedCharacter& character) {
  return !on_their_rig(options, character);
}

std::shared_ptr<const PreparedCharacter> bind_target(std::shared_ptr<PreparedCharacter> character,
                                                     const TargetOptions& options, const Networks& networks) {
  naming(options.path, [&] {
    find_t_pose(*character, networks.extractor.get(), networks.rest_extractor.get(),
                character_options(options));
  });
  for (const std::string& note : character->notes) log::info(options.path + ": " + note);
  if (character->rigged)
    log::info(options.path + ": " + std::to_string(character->map.count()) + " of 22 joints are mapped " +
              character->map.how);
  return character;
}

std::shared_ptr<const PreparedCharacter> open_target(const TargetOptions& options, const Networks& networks) {
  try {
    return bind_target(load_target(options), options, networks);
  } catch (const NotAPersonError& error) {
    throw NotAPersonError(std::string(error.what()) + " (--use-anyway uses it all the same)");
  }
}

bool on_their_rig(const TargetOptions& options, const PreparedCharacter& character) {
  return options.rig != Rig::Ours && character.rigged;
}

}  // namespace understudy::app
