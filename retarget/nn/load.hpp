// The networks as stages of the pipeline, with the weights of a file. Each throws Error when that is missing,
// damaged, of another network or of another version.
#pragma once

#include <memory>
#include <string>

#include "retarget/marionette/motion_dynamics.hpp"
#include "retarget/pipeline/interfaces.hpp"
#include "retarget/pipeline/keypoint_finder.hpp"
#include "retarget/pipeline/motion_coder.hpp"
#include "retarget/pipeline/motion_space.hpp"
#include "retarget/style/motion_words.hpp"
#include "retarget/style/style_judge.hpp"

namespace understudy::nn {

/// Joints by paper 1's own network: the extractor `paper`. (`dense` is retarget/networks/dense_extractor.)
std::unique_ptr<SkeletonExtractor> load_paper_extractor(const std::string& path);

/// Motion transfer by the recurrent network of paper 1, section 3.1: the engine `paper`. Its push() throws
/// Error when joints are not finite or the network's answer is not.
std::unique_ptr<MotionTransfer> load_paper_transfer(const std::string& path);

/// Fills gaps by the network that corrects smooth curves (InbetweenNet): the motion space `space`.
std::unique_ptr<MotionSpace> load_inbetween_space(const std::string& path);

/// Codes movements of one cycle of the legs by the network of paper 2, section 3 (StepCvae).
std::unique_ptr<MotionCoder> load_step_coder(const std::string& path);

/// Translates motion words by the network of paper 4 (WordsPair).
std::unique_ptr<WordTranslator> load_words(const std::string& path);

/// How bodies of a kind move (RotationVrnn).
std::unique_ptr<MotionDynamics> load_dynamics(const std::string& path);

/// Judges style by three small networks (JudgeNet).
std::unique_ptr<StyleJudge> load_judges(const std::string& path);

/// Finds the keypoints of a kind by slots (SlotNet), with the tree that its affinities make.
std::unique_ptr<KeypointFinder> load_slots(const std::string& path);

/// Finds the keypoints of a kind by paper 3's own network (VoxelKeypointsNet), with the tree that its
/// affinities make. It tells no turns. The grid and its width are the file's.
std::unique_ptr<KeypointFinder> load_paper_keypoints(const std::string& path);

}  // namespace understudy::nn
