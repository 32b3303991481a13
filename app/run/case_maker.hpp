// Makes suites of test cases from a folder of people and motions (see case_folder.hpp for what a case is).
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace understudy::app {

struct SuiteOptions {
  std::string data;  ///< folder with splits.json, see retarget/body/data_folder.hpp; creatures need none,
                     ///< style has two folders of clips there
  std::string out;   ///< folder; a case a folder is made in it
  std::string suite = "naked";  ///< see make_suite
  std::string split = "dev";
  std::string body;      ///< SMPL-format; empty: the data folder's own
  std::string from, to;  ///< of style: folders in `data`, the manner that is left and the one that is taken
  int frames =
      90;  ///< of a case; extraction and occluded have 12, of hands, scenes, partial and sensors fewer
  int points = 8000;   ///< of a scan, roughly
  int cases = 0;       ///< at most this many; 0: all
  int gap = 0;         ///< of inbetween and predict: frames that are not known; 0, of predict: 15
  int known = 0;       ///< of sparse: frames of 100 that are known
  int markers = 0;     ///< of sparse: 16, the markers on the body; 0: none
  bool walks = false;  ///< of inbetween, predict and sparse: walks and runs alone, with windows of their own
  uint32_t seed = 0;   ///< the same options give the same files
};

/// Writes the cases of a suite; reports each name as it is done. Returns their number. Truth is the same
/// local rotations on the target, its path the source's from where it starts, scaled by leg length and put on
/// the floor; every case is turned to a random heading. Throws Error naming what is missing. The suites:
///   naked: 4 targets (the tallest, shortest, heaviest, slimmest of the split) x 4 motions,
///     sources undressed, points drawn evenly on their surface
///   clothed: the same with 4 dressed targets
///   captured: the naked suite's targets; dressed sources as a rig of cameras would see them: uneven density,
///     holes, noise, outliers, some floor
///   bends: the naked suite's targets and four more; elbows, shoulders, knees and hips bent by 120 degrees
///   hands: the naked suite; the sources' fingers go from one random pose to another; at most 45 frames
///   extraction: 40 people and short clips, joints of the source only
///   occluded: the same in wide skirts, thick coats, much hair, with things in a hand, seen from one side or
///     without a limb (named by a tag)
///   partial: 4 kinds x 4 people cut at hips, thighs and knees or chest, or seated behind a desk; truths
///     hold which joints are seen; at most 30 frames, as those of
///   sensors: 1, 3 and 10 simulated depth cameras x 5,000 to 100,000 points, with the ground
///   scenes: 12 scenes of 1 to 4 people before 1 to 10 depth cameras, among ground, walls, furniture and a
///     ball: apart, crossing, shaking hands, leaving and coming back; at most 40 frames; `points` are for one
///     person, half as many more for each other. Truths hold the joints of each, and whose each point is;
///     each person is scanned alone, too
///   inbetween: each clip, with gaps (gap_plan.hpp) between 10 known frames on each side, a window every 15
///     frames; of `walks` 5 and every 3. Without points the truth is the source: the clip whole. With points
///     at most `frames` frames, gap after gap; the known frames have scans, the others' numbers are missing
///   predict: the same, but of each window the first 8 frames are known and the rest is not
///   sparse: see make_sparse_suite
///   style: clips of people who are to move in another manner: see make_style_suite
///   pose2d, pose2d-odd, pose2d-noisy, pose2d-seen: 2D poses, see make_flat_suite
///   lifting: 2D poses that are performed in space, see make_lift_suite
///   creatures: robots, animals and hands made by code, with people where there is a data folder, as bodies
///     whose rig is to be found: see make_creature_suite. Truths hold the rig (rig_truth_file.hpp)
///   creatures-captured: the same as a rig of cameras would see them, scaled to a body of 1.5 m
///   marionette-gaps: the true rigs of arms, hands, quadrupeds and people and what they perform, between
///     whose frames others are to be made
///   creatures-pairs: two of a kind made by code; what the one does the other shall perform
int make_suite(const SuiteOptions& options, const std::function<void(const std::string& name)>& done);

}  // namespace understudy::app
