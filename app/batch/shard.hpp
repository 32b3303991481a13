// Which of a manifest's jobs one process of several takes: the labs' schedulers start them, and number them.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace understudy::app {

/// Number `index` of `count`, from 0.
struct Shard {
  int index = 0, count = 1;
};

/// "2/8". Throws Error: no such text, none of none ("0/0"), a number that is not below the count.
Shard parse_shard(const std::string& text);

/// Gives a variable of the environment; null where it is not set.
using Environment = std::function<const char*(const char* name)>;

/// What a scheduler says of this process: SLURM_ARRAY_TASK_ID, numbered from SLURM_ARRAY_TASK_MIN in steps of
/// SLURM_ARRAY_TASK_STEP, SLURM_ARRAY_TASK_COUNT of them; or Kubernetes' JOB_COMPLETION_INDEX, whose count is
/// `shards`. Where `shards` is given (above 0) it is the count of either and numbers are from 0. The whole
/// where nobody says anything and `shards` is 0. Throws Error where it cannot be understood.
Shard shard_from(const Environment& environment, int shards);

/// Numbers of the jobs, of so many, that are this shard's: every count-th, so that long ones that stand
/// together are shared out.
std::vector<size_t> jobs_of(const Shard& shard, size_t jobs);

}  // namespace understudy::app
