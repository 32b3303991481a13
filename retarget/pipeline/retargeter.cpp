#include "retarget/pipeline/retargeter.hpp"

#include <utility>

#include "retarget/base/error.hpp"

namespace understudy {

Retargeter::Retargeter(Networks networks, const RetargetOptions& options)
    : networks_(std::move(networks)), options_(options), observer_(networks_.extractor) {
  if (!networks_.transfer && !networks_.deformer) performer_.emplace(options);
}

void Retargeter::set_target(const Mesh& mesh) {
  US_CHECK(networks_.extractor, "the pipeline has no skeleton extractor");
  set_target(
      prepare_target(mesh, networks_.rest_extractor ? *networks_.rest_extractor : *networks_.extractor));
}

void Retargeter::set_target(Target target) {
  performer_.emplace(std::move(target), networks_.transfer, networks_.deformer, options_);
  observer_.restart();
}

void Retargeter::restart() {
  performer().restart();
  observer_.restart();
}

Performer& Retargeter::performer() {
  US_CHECK(performer_, "there is no target yet");
  return *performer_;
}

}  // namespace understudy
