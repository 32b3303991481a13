// The forms of the extraction network behind one interface, "dense" and paper 1's, "paper"; and their input.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "retarget/networks/extractor_forward.hpp"
#include "retarget/nn/modules/skeleton_extractor.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy::nn {

class SkeletonForm : public torch::nn::Module {
 public:
  virtual ExtractorOutput forward(const ExtractorInput& input) = 0;
};

/// "dense" or "paper"; anything else is an Error.
std::shared_ptr<SkeletonForm> make_skeleton_form(const std::string& name);
/// Header for the weights of a form; the trainer adds the numbers.
WeightsHeader skeleton_header(const std::string& name);
/// Whether the weights hold all of the network: without kVisibilityHead, that gives what it was made with.
bool load_skeleton_form(const std::string& path, const std::string& name, SkeletonForm& form);

/// A batch of B scans, on the CPU. `recent`: the extracted joints of the frames before each scan; empty for
/// scans of no stream.
ExtractorInput extractor_input(const std::vector<ScanPatches>& patches,
                               const std::vector<RecentJoints>& recent = {});

}  // namespace understudy::nn
