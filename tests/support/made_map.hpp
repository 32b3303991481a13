// Maps of made-up codes.
#pragma once

#include <string>
#include <vector>

#include "retarget/base/rng.hpp"
#include "retarget/motion_space/motion_map.hpp"
#include "retarget/pipeline/human_rest.hpp"

namespace understudy::tests {

/// Motions of five actions by turns, whose steps follow on each other; codes of `size` numbers about a centre
/// of their action. Figures stand.
inline std::vector<MappedMotion> made_motions(int motions, int steps, int size = 8) {
  static const char* const kActions[] = {"walk", "run", "jump", "dance", "climb"};
  std::vector<int16_t> figure(kFigureNumbers, 0);
  for (int k = 0; k < kFigureMoments; ++k) {
    int16_t* const root = &figure[static_cast<size_t>((k + 1) * (kJointCount + 1) * 3 - 3)];
    root[1] = 1000, root[2] = static_cast<int16_t>(50 * k);
  }
  Rng rng(5);
  std::vector<MappedMotion> all;
  for (int m = 0; m < motions; ++m) {
    MappedMotion motion;
    const int action = m % 5;
    motion.action = kActions[action];
    motion.name = motion.action + "_" + std::to_string(m) + ".bvh";
    motion.path = "/motions/" + motion.name;
    motion.clip = "1";
    motion.frames = 30 * steps + 1;
    motion.rest = human_rest();
    for (int s = 0; s < steps; ++s) {
      MappedStep step;
      step.first = 30 * s, step.last = 30 * s + 29;
      step.seconds = 0.6f + 0.1f * static_cast<float>(m % 7);
      step.speed_m_s = 0.5f + 0.25f * static_cast<float>(action);
      for (int d = 0; d < size; ++d)
        step.code.push_back((d == action ? 3.0f : 0.0f) + 0.4f * static_cast<float>(rng.uniform()));
      step.figure = figure;
      motion.steps.push_back(std::move(step));
    }
    all.push_back(std::move(motion));
  }
  return all;
}

}  // namespace understudy::tests
