#include "app/run/motion_blender.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <optional>
#include <utility>

#include "retarget/base/checksum.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/motion/moving_person.hpp"
#include "retarget/motion/read_motion.hpp"
#include "retarget/motion_space/blend.hpp"
#include "retarget/motion_space/knot_coder.hpp"
#include "retarget/motion_space/steps.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

// From which on two movements are told to be unlike each other: a walk and a run are 0.1 m apart, a walk
// and a punch 0.15 m.
constexpr float kUnlike_m = 0.125f;

/// A file as it was read.
struct ReadFile {
  std::string path, checksum;
  fs::file_time_type time;
  MovingPerson person;
};

ReadFile read_part(const std::string& path) {
  std::error_code failed;
  US_CHECK(fs::exists(path, failed), path, ": is blended, but there is no such file any more");
  ReadFile read{path, checksum_of_file(path), fs::last_write_time(path, failed), {}};
  const std::optional<Character> moving = read_motion(path);
  US_CHECK(moving, path, ": is no skeletal motion, only these are blended");
  read.person = moving_person(SkeletalMotion(*moving, {}));
  return read;
}

bool is_as_read(const ReadFile& read) {
  std::error_code failed;
  const auto time = fs::last_write_time(read.path, failed);
  return !failed && time == read.time;
}

/// A movement as it goes into the blend.
struct Taken {
  BlendInput input;
  UsedPart used;
  std::string note;
};

Taken take_frames(const ReadFile& file, const BlendRange& range) {
  Taken taken;
  taken.input = {movement_of(file.person.motion, range.first, range.last), file.person.rest};
  taken.used = {file.path, range, false, left_lead(taken.input.movement), taken.input.movement.duration()};
  return taken;
}

void mirror(Taken& taken) {
  taken.input = {mirrored(std::move(taken.input.movement)), mirrored(taken.input.rest)};
  taken.used.mirrored = true;
  taken.used.lead *= -1;
  taken.note = file_name(taken.used.path) + " is mirrored, so that the same foot strides first";
}

/// Whether both stride, with different feet.
bool are_opposed(float lead, float wanted) {
  return lead * wanted < 0;
}

/// The step that looks most like one, of those with the wanted foot first where there are any.
Taken take_best_step(const ReadFile& file, float wanted) {
  const std::vector<Step> steps = find_steps(file.person.motion);
  US_CHECK(!steps.empty(), file.path, ": nobody steps in it: tell the frames that are blended, ",
           file_name(file.path), "@FIRST:LAST");
  const auto rank = [&](const Step& step) {
    return std::pair(are_opposed(step.left_first ? 1 : -1, wanted), step.distance);
  };
  const Step best = *std::min_element(steps.begin(), steps.end(),
                                      [&](const Step& a, const Step& b) { return rank(a) < rank(b); });
  Taken taken = take_frames(file, {best.first, best.last});
  if (are_opposed(taken.used.lead, wanted)) mirror(taken);
  return taken;
}

/// The range asked for; half a cycle later or earlier, or mirrored, where the other foot strides first.
Taken take_range(const ReadFile& file, const BlendRange& range, float wanted) {
  const int count = static_cast<int>(ssize(file.person.motion.poses));
  US_CHECK(range.last < count, file.path, ": has no frames ", range.first, " to ", range.last,
           ", its last is ", count - 1);
  Taken taken = take_frames(file, range);
  if (!are_opposed(taken.used.lead, wanted)) return taken;
  const int half = (range.last - range.first + 1) / 2;
  for (const int by : {half, -half}) {
    if (range.first + by < 0 || range.last + by >= count) continue;
    Taken later = take_frames(file, {range.first + by, range.last + by});
    if (later.used.lead == 0 || are_opposed(later.used.lead, wanted)) continue;
    later.note = file_name(file.path) + " begins " + std::to_string(std::abs(by)) + " frames " +
                 (by > 0 ? "later" : "earlier") + ", so that the same foot strides first";
    return later;
  }
  mirror(taken);
  return taken;
}

/// All but the weights.
std::string key_of_parts(const BlendRecipe& blend) {
  BlendRecipe bare = blend;
  for (BlendPart& part : bare.parts) part.weight = 1;
  bare.cycles = 1;
  return key_of(bare);
}

}  // namespace

struct MotionBlender::Impl {
  std::mutex mutex;
  LoadCoder load;
  std::shared_ptr<MotionCoder> learned;
  std::unique_ptr<MotionCoder> plain = make_knot_coder();
  std::string no_coder;  // why there is no learned one
  // What was coded last.
  std::string key;
  std::vector<ReadFile> files;
  std::vector<Taken> taken;
  std::string coder;
  std::optional<Blend> blend;

  MotionCoder& coder_for(const BlendRecipe& recipe) {
    if (recipe.coder == plain->name()) return *plain;
    if (load) {
      no_coder = failure_of([&] { learned = std::exchange(load, nullptr)(); });
    } else if (!learned && no_coder.empty()) {
      no_coder = "there is no learned coder of movements";
    }
    if (!learned) return *plain;
    US_CHECK(recipe.coder == learned->name(), "the blend was made by the coder '", recipe.coder,
             "', there is only '", learned->name(), "' and '", plain->name(), "'");
    return *learned;
  }

  void code(const BlendRecipe& recipe) {
    const std::string wanted = key_of_parts(recipe);
    if (blend && wanted == key && std::all_of(files.begin(), files.end(), is_as_read)) return;
    blend.reset();
    taken.clear();
    std::vector<ReadFile> read;
    for (const BlendPart& part : recipe.parts) {
      const auto known = [&](const std::vector<ReadFile>& all) -> const ReadFile* {
        const auto found = std::find_if(all.begin(), all.end(), [&](const ReadFile& file) {
          return file.path == part.path && is_as_read(file);
        });
        return found == all.end() ? nullptr : &*found;
      };
      const ReadFile* const now = known(read);
      const ReadFile* const before = now ? now : known(files);
      read.push_back(before ? ReadFile(*before) : read_part(part.path));
    }
    files = std::move(read);
    std::vector<BlendInput> inputs;
    for (size_t i = 0; i < recipe.parts.size(); ++i) {
      const float lead = taken.empty() ? 0 : taken[0].used.lead;
      const auto& range = recipe.parts[i].range;
      taken.push_back(range ? take_range(files[i], *range, lead) : take_best_step(files[i], lead));
      inputs.push_back(taken.back().input);
    }
    MotionCoder& by = coder_for(recipe);
    coder = by.name();
    blend.emplace(by, std::move(inputs));
    key = wanted;
  }

  void note(const BlendRecipe& recipe, BlendedMotion& made) const {
    for (size_t i = 0; i < taken.size(); ++i) {
      made.parts.push_back(taken[i].used);
      if (!taken[i].note.empty()) made.notes.push_back(taken[i].note);
      const std::string& checksum = recipe.parts[i].checksum;
      if (!checksum.empty() && checksum != files[i].checksum)
        made.warnings.push_back(files[i].path +
                                ": has changed since it was blended, so the blend is another");
    }
    if (coder != recipe.coder)
      made.warnings.push_back(no_coder + ": the blend goes straight from pose to pose");
    for (size_t i = 0; i < taken.size(); ++i)
      for (size_t j = i + 1; j < taken.size(); ++j)
        if (const float apart = blend->distance(i, j); apart > kUnlike_m)
          made.warnings.push_back(
              file_name(taken[i].used.path) + " and " + file_name(taken[j].used.path) +
              printed(" are unlike each other, %.0f cm apart on average: what lies between them may be no "
                      "movement of a person",
                      static_cast<double>(100 * apart)));
  }
};

MotionBlender::MotionBlender(LoadCoder load) : impl_(std::make_unique<Impl>()) {
  impl_->load = std::move(load);
}
MotionBlender::~MotionBlender() = default;

BlendedMotion MotionBlender::make(const BlendRecipe& recipe, double fps) {
  US_CHECK(recipe.parts.size() >= Blend::kFewest && recipe.parts.size() <= Blend::kMost,
           "a blend is made of ", Blend::kFewest, " to ", Blend::kMost, " movements, not of ",
           recipe.parts.size());
  const std::lock_guard lock(impl_->mutex);
  impl_->code(recipe);
  std::vector<float> weights;
  for (const BlendPart& part : recipe.parts) weights.push_back(part.weight);
  const Blended blended = impl_->blend->at(weights);
  BlendedMotion made;
  made.motion =
      played(blended, fps > 0 ? static_cast<float>(fps) : impl_->files[0].person.motion.fps, recipe.cycles);
  made.rest = blended.rest;
  made.seconds = blended.movement.duration();
  made.decoded_seconds = blended.decoded_s;
  made.coder = impl_->coder;
  impl_->note(recipe, made);
  return made;
}

}  // namespace understudy::app
