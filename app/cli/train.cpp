#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/cli/commands.hpp"
#include "app/cli/progress.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/style_teacher.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/networks/networks.hpp"
#include "retarget/networks/train_options.hpp"
#include "retarget/pipeline/keypoint_finder.hpp"
#include "retarget/pipeline/method_table.hpp"

namespace understudy::app {
namespace {

void add_common(CLI::App& command, nn::TrainOptions& options) {
  command.add_option("--data", options.data, "folder with body/, motion/ and splits.json")->required();
  command.add_option("--out", options.out, "the weights file; a checkpoint beside it is resumed")->required();
  command.add_option("--curve", options.curve, "learning curve as CSV (default: OUT.csv)");
  command.add_option("--minutes", options.minutes, "stop after this long")->check(CLI::NonNegativeNumber);
  command.add_option("--samples", options.samples, "stop after this many samples in all")
      ->check(CLI::NonNegativeNumber);
  command.add_option("--threads", options.threads, "0: one per core for skeleton, otherwise one")
      ->check(CLI::Range(0, 1024));
  command.add_option("--batch", options.batch, "samples per step; 0: the network's default")
      ->check(CLI::Range(0, 65536));
  command.add_option("--seed", options.seed, "seed of the data and the initial weights");
  command.add_option("--device", options.device, "cpu, or cuda if LibTorch supports it")
      ->check(CLI::IsMember({"cpu", "cuda"}));
  const auto init = command.add_option("--init", options.init, "weights to start from");
  command
      .add_option("--keep", options.keep, "share of the initial weights that is mixed into the written ones")
      ->needs(init)
      ->check(CLI::Range(0.0, 0.95));
}

void add_own(CLI::App& command, nn::SkeletonTrainOptions& options) {
  command.add_option("--form", options.form, help_of(extractors()))
      ->check(CLI::IsMember(names_of(extractors())));
  command.add_option("--poses", options.poses, "all, or rest (T-poses, for the joints of targets)")
      ->check(CLI::IsMember({"all", "rest"}));
}

void add_own(CLI::App& command, nn::MotionTrainOptions& options) {
  command.add_option("--rotation", options.rotation, "how rotations are represented: 6d or quaternion")
      ->check(CLI::IsMember({"6d", "quaternion"}));
  command.add_flag("!--no-rotation-loss", options.rotation_loss, "trains without L_rot");
  command
      .add_option("--context", options.context,
                  "frames of a sequence (default: 30; at most 60, as clips are cut)")
      ->check(CLI::Range(3, 60));
}

void add_own(CLI::App& command, nn::PartTrainOptions& options) {
  command.add_option("--kinds", options.kinds, "hand, head, foot, arm, leg: which to train (default: all)")
      ->delimiter(',')
      ->check(CLI::IsMember(std::vector<std::string>(nn::kPartKindNames.begin(), nn::kPartKindNames.end())));
}
void add_own(CLI::App&, nn::DeformationTrainOptions&) {}
void add_own(CLI::App&, nn::ProportionsTrainOptions&) {}
void add_own(CLI::App&, nn::PointsTrainOptions&) {}
/// Whose keypoints or motions.
void add_kind(CLI::App& command, std::string& kind) {
  command.add_option("--kind", kind, "person, quadruped, hand or arm (default: person)")
      ->check(CLI::IsMember(std::vector<std::string>(kBodyKinds.begin(), kBodyKinds.end())));
}
/// For ablations.
void add_losses(CLI::App& command, nn::MarionetteLosses& losses) {
  command.add_flag("!--no-vol", losses.volume, "without L_vol, which spreads keypoints over the body");
  command.add_flag("!--no-traj", losses.trajectory, "without L_traj: what goes alike hangs together");
  command.add_flag("!--no-local", losses.local, "without L_local: what is near hangs together");
  command.add_flag("!--no-time", losses.time, "without L_time: what stays as far apart hangs together");
}
void add_own(CLI::App& command, nn::MarionetteSlotsTrainOptions& options) {
  add_kind(command, options.kind);
  add_losses(command, options.losses);
}
void add_own(CLI::App& command, nn::MarionettePaperTrainOptions& options) {
  add_kind(command, options.kind);
  command.add_option("--grid", options.grid, "cells along an edge: 32 (default), 64 (the paper's), ...")
      ->check(CLI::Range(32, 128));
  command.add_option("--width", options.width, "channels of features: 32 (default) ... 128 (the paper's)")
      ->check(CLI::Range(16, 256));
  add_losses(command, options.losses);
}
void add_own(CLI::App& command, nn::Pose2dTrainOptions& options) {
  command
      .add_option("--links", options.links,
                  "between people: virtual (default), ranking (the loss that it comes from) or none")
      ->check(CLI::IsMember({"virtual", "ranking", "none"}));
  command.add_flag("!--no-angles", options.angles, "without the loss of bones' angles");
  command
      .add_option("--pairs", options.pairs,
                  "links between all points (default), bones alone, or bones and ends")
      ->check(CLI::IsMember({"all", "bones", "ends"}));
  command.add_option("--directions", options.directions, "that links are seen along (default: 4)")
      ->check(CLI::Range(1, 32));
  command.add_option("--first-direction", options.first_direction, "of them, degrees (default: 0)")
      ->check(CLI::Range(0.0, 180.0));
}
void add_own(CLI::App& command, nn::LifterTrainOptions& options) {
  command.add_option("--frames", options.frames, "frames of a sequence (default: 40)")
      ->check(CLI::Range(2, 1000));
}
void add_own(CLI::App& command, nn::MarionetteDynamicsTrainOptions& options) {
  add_kind(command, options.kind);
  command
      .add_option("--form", options.form,
                  "rotations (default); positions, of joints, which paper 3 compares with")
      ->check(CLI::IsMember({"rotations", "positions"}));
}
void add_own(CLI::App& command, nn::MotionSpaceTrainOptions& options) {
  command
      .add_option(
          "--form", options.form,
          "space: windows with holes, for filling (default); paper: steps as codes, paper 2's network")
      ->check(CLI::IsMember({"space", "paper"}));
  const std::string of_paper = " (--form paper)";
  command.add_option("--code", options.code, "numbers of a code (default: 64)" + of_paper)
      ->check(CLI::Range(1, 1024));
  command.add_option("--kl", options.kl, "weight of the divergence of codes (default: 0.01)" + of_paper)
      ->check(CLI::Range(0.0, 100.0));
  command.add_option("--clips", options.clips, "share of the clips to learn from (default: 1)" + of_paper)
      ->check(CLI::Range(0.01, 1.0));
  command.add_flag("!--no-surface", options.surface, "without phase 2, on vertices" + of_paper);
  command.add_flag("!--not-told", options.told, "the decoder is not told the body" + of_paper);
  command.add_flag("!--no-times", options.timed, "without time stamps" + of_paper);
}

/// Of weights that are learned from clips of one's own.
template <class Options>
void add_origin(CLI::App& command, Options& options) {
  command.add_option("--licence", options.licence, "of the clips, written into the weights")->required();
  command.add_option("--attribution", options.attribution, "whom to name, written into the weights");
  command.add_option("--made-from", options.made_from, "what the clips are, written into the weights");
}

void add_own(CLI::App& command, nn::StyleJudgeTrainOptions& options) {
  command
      .add_option("--contents", options.contents,
                  "what a clip shows: actions, its first one (default), or descriptions, its sentence")
      ->check(CLI::IsMember({"actions", "descriptions"}));
  command.add_flag("--legs", options.legs, "hips and knees are judged too; depth cameras do not see them");
  add_origin(command, options);
}

/// A style of either engine.
struct StyleTraining {
  nn::StyleTrainOptions words;
  std::string engine = "manner", label;
  bool single = false;  ///< of a manner: gains of single joints
};

void add_style_domains(CLI::App& command, nn::StyleTrainOptions& options) {
  command.add_option("--from", options.from, "folder in DATA of clips in the manner to be left")->required();
  command.add_option("--to", options.to, "folder in DATA of clips in the manner to be taken")->required();
  command.add_option("--smooth", options.smooth, "Gaussian over both domains' clips, frames (default: 1.5)")
      ->check(CLI::Range(0.0, 6.0));
  add_origin(command, options);
}

void add_style_engines(CLI::App& command, StyleTraining& options) {
  nn::StyleTrainOptions& words = options.words;
  command
      .add_option(
          "--engine", options.engine,
          "manner: fitted in seconds, OUT is .json (default); words: paper 4's network, OUT is .weights")
      ->check(CLI::IsMember({"manner", "words"}));
  command.add_option("--label", options.label, "what a list calls it (default: --to)");
  command
      .add_option(
          "--joints", words.joints,
          "all (default); trunk-and-limbs: ankles, toes and wrists stay the source's, as depth cameras "
          "see them badly; upper-body: legs, too")
      ->check(CLI::IsMember({"all", "trunk-and-limbs", "upper-body"}));
  command.add_flag("--single", options.single,
                   "each joint's movement gets a gain by itself; they are not coupled (manner)");
  command
      .add_option("--convolution", words.convolution,
                  "joint: kernels of each joint's own (default); overall: over all joints (words)")
      ->check(CLI::IsMember({"joint", "overall"}));
  const auto weight = [&](const char* name, double& value, const char* help) {
    command.add_option(name, value, help)->check(CLI::Range(0.0, 1000.0));
  };
  weight("--cycle", words.cycle, "weight of the cycle loss (words; default: 15)");
  weight("--coherence", words.coherence, "weight of the coherence loss (words; default: 30)");
  weight("--transition", words.transition, "weight of the transition loss (words; default: 0)");
  command.add_flag("--velocities", words.velocities,
                   "coherence is judged against the source's, not by itself (words)");
}

/// Fits a manner and writes it.
int fit_style(const StyleTraining& options) {
  const nn::StyleTrainOptions& words = options.words;
  US_CHECK(file_suffix(words.out) == ".json", words.out, ": a manner is written as .json");
  check_writable(words.out);
  StyleLesson lesson;
  lesson.from = words.data + "/" + words.from;
  lesson.to = words.data + "/" + words.to;
  lesson.joints = words.joints;
  lesson.coupled = !options.single;
  lesson.smooth = words.smooth;
  lesson.note.label = options.label.empty() ? words.to : options.label;
  lesson.note.licence = words.licence;
  lesson.note.attribution = words.attribution;
  lesson.note.made_from = words.made_from;
  NetworkParts parts;
  parts.extractor = true;
  Progress progress("style", 0, false, "recording");
  const MannerFile file =
      teach_style(lesson, nn::load_networks({}, parts), [&](size_t done, size_t, const std::string&) {
        check_interrupt("nothing was written");
        progress.step(static_cast<int64_t>(done));
      });
  progress.finish();
  write_file(words.out, to_json(file));
  std::printf("%s: %s\n", words.out.c_str(), file.origins.at("coupling").source.c_str());
  return 0;
}

void add_style(CLI::App& train, const std::shared_ptr<Action>& chosen) {
  const auto options = std::make_shared<StyleTraining>();
  CLI::App& command =
      *train.add_subcommand(nn::StyleTrainOptions::kNetwork, "a style, from clips in two manners of moving");
  add_common(command, options->words);
  add_style_domains(command, options->words);
  add_style_engines(command, *options);
  command.callback([options, chosen] {
    options->words.cancelled = interrupted;
    *chosen = [options] {
      return options->engine == "manner" ? fit_style(*options) : nn::train(options->words);
    };
  });
}

/// A subcommand of `train`: a network with the options that all have and its own.
template <class Options>
void add_network(CLI::App& train, const char* help, const std::shared_ptr<Action>& chosen) {
  const auto options = std::make_shared<Options>();
  CLI::App& command = *train.add_subcommand(Options::kNetwork, help);
  add_common(command, *options);
  add_own(command, *options);
  command.callback([options, chosen] {
    options->cancelled = interrupted;
    *chosen = [options] { return nn::train(*options); };
  });
}

}  // namespace

Action declare_train(CLI::App& command) {
  const auto chosen = std::make_shared<Action>();
  command.require_subcommand(1);
  add_network<nn::SkeletonTrainOptions>(command, "the skeleton in a scan", chosen);
  add_network<nn::PartTrainOptions>(command, "the part refiner: arms, hands, legs, feet, head", chosen);
  add_network<nn::MotionTrainOptions>(command, "motion transfer of paper 1", chosen);
  add_network<nn::DeformationTrainOptions>(command, "skin weights and pose-corrective offsets", chosen);
  add_network<nn::MotionSpaceTrainOptions>(command, "what lies between known frames, and steps as codes",
                                           chosen);
  add_style(command, chosen);
  add_network<nn::StyleJudgeTrainOptions>(command, "judges of style, from a folder of clips for each",
                                          chosen);
  add_network<nn::ProportionsTrainOptions>(command, "how long a person's bones are, from a 2D pose", chosen);
  add_network<nn::Pose2dTrainOptions>(command, "2D poses performed by others, paper 5's network", chosen);
  add_network<nn::LifterTrainOptions>(command, "skeletons in space, from 2D poses", chosen);
  add_network<nn::PointsTrainOptions>(command, "the filter of 2D points", chosen);
  add_network<nn::MarionetteSlotsTrainOptions>(
      command, "keypoints and tree of a kind of body, from its scans alone", chosen);
  add_network<nn::MarionettePaperTrainOptions>(
      command, "keypoints and tree of a kind of body from its scans alone, paper 3's network", chosen);
  add_network<nn::MarionetteDynamicsTrainOptions>(command, "how bodies of a kind move, paper 3's network",
                                                  chosen);
  return [chosen] { return (*chosen)(); };
}

}  // namespace understudy::app
