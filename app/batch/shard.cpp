#include "app/batch/shard.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

constexpr int64_t kMostShards = 1000000;

/// A variable's whole number; `missing` where it is not set.
int64_t number_in(const Environment& environment, const char* name, int64_t missing) {
  const char* const text = environment(name);
  if (text == nullptr || *text == '\0') return missing;
  int64_t value = 0;
  US_CHECK(parse_integer(text, value) && value >= 0 && value < int64_t{1} << 31, name, "=", excerpt(text),
           " is no number of a task");
  return value;
}

Shard checked_shard(int64_t index, int64_t count, const std::string& told) {
  US_CHECK(count >= 1 && count <= kMostShards, told, ": there must be 1 shard or more, up to ", kMostShards);
  US_CHECK(index >= 0 && index < count, told, ": shards are numbered from 0, so the last of ", count, " is ",
           count - 1);
  return {static_cast<int>(index), static_cast<int>(count)};
}

}  // namespace

Shard parse_shard(const std::string& text) {
  const std::vector<std::string> parts = split(text, '/');
  int64_t index = 0, count = 0;
  US_CHECK(parts.size() == 2 && parse_integer(parts[0], index) && parse_integer(parts[1], count), "--shard ",
           excerpt(text), ": is I/N, such as 0/8 for the first of eight");
  return checked_shard(index, count, "--shard " + text);
}

Shard shard_from(const Environment& environment, int shards) {
  const int64_t none = -1, slurm = number_in(environment, "SLURM_ARRAY_TASK_ID", none);
  if (slurm >= 0) {
    const std::string told = "SLURM_ARRAY_TASK_ID=" + std::to_string(slurm);
    if (shards > 0) return checked_shard(slurm, shards, told + " of --shards " + std::to_string(shards));
    const int64_t count = number_in(environment, "SLURM_ARRAY_TASK_COUNT", none);
    const int64_t first = number_in(environment, "SLURM_ARRAY_TASK_MIN", 0);
    const int64_t last = number_in(environment, "SLURM_ARRAY_TASK_MAX", none);
    const int64_t step = std::max<int64_t>(1, number_in(environment, "SLURM_ARRAY_TASK_STEP", 1));
    US_CHECK(count > 0, told, ": SLURM_ARRAY_TASK_COUNT does not say of how many; --shards does");
    const bool regular = (slurm - first) % step == 0 && (last < 0 || (last - first) / step + 1 == count);
    US_CHECK(regular, told, ": the array's tasks are not numbered evenly; --shards says how many there are");
    return checked_shard((slurm - first) / step, count, told);
  }
  const int64_t kubernetes = number_in(environment, "JOB_COMPLETION_INDEX", none);
  if (kubernetes >= 0) {
    const std::string told = "JOB_COMPLETION_INDEX=" + std::to_string(kubernetes);
    US_CHECK(shards > 0, told, ": --shards must say how many completions there are");
    return checked_shard(kubernetes, shards, told + " of --shards " + std::to_string(shards));
  }
  US_CHECK(shards == 0, "--shards ", shards,
           ": neither SLURM_ARRAY_TASK_ID nor JOB_COMPLETION_INDEX says which of them this is; --shard I/N "
           "does");
  return {};
}

std::vector<size_t> jobs_of(const Shard& shard, size_t jobs) {
  std::vector<size_t> mine;
  for (size_t k = static_cast<size_t>(shard.index); k < jobs; k += static_cast<size_t>(shard.count))
    mine.push_back(k);
  return mine;
}

}  // namespace understudy::app
