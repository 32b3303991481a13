#include <CLI/CLI.hpp>

#include "app/cli/commands.hpp"
#include "app/run/interrupt.hpp"
#include "retarget/base/error.hpp"
#include "retarget/networks/networks.hpp"

namespace understudy::app {

Action declare_train(CLI::App& command) {
  const auto options = std::make_shared<nn::TrainOptions>();
  command.add_option("network", options->network, "skeleton, part, motion or deformation")
      ->required()
      ->check(CLI::IsMember({"skeleton", "part", "motion", "deformation"}));
  command.add_option("--data", options->data, "folder with body/, motion/ and splits.json")->required();
  command.add_option("--out", options->out, "the weights file; its checkpoint lies beside it and is resumed")
      ->required();
  command.add_option("--curve", options->curve, "learning curve as CSV (default: OUT.csv)");
  command.add_option("--minutes", options->minutes, "stop after this long")->check(CLI::NonNegativeNumber);
  command.add_option("--samples", options->samples, "stop after this many samples in all")
      ->check(CLI::NonNegativeNumber);
  command
      .add_option("--threads", options->threads, "0: the network's own: one a core for skeleton, else one")
      ->check(CLI::Range(0, 1024));
  command.add_option("--batch", options->batch, "samples a step; 0: the network's own")
      ->check(CLI::Range(0, 65536));
  command.add_option("--seed", options->seed, "of the data and the first weights");
  command.add_option("--form", options->form, "of the skeleton network: dense, or paper 1's")
      ->check(CLI::IsMember({"dense", "paper"}));
  command
      .add_option("--poses", options->poses,
                  "of the skeleton network: all, or rest (T-poses, for the joints of targets)")
      ->check(CLI::IsMember({"all", "rest"}));
  command
      .add_option("--rotation", options->rotation,
                  "what the motion network says of rotations: 6d or quaternion")
      ->check(CLI::IsMember({"6d", "quaternion"}));
  command.add_flag("!--no-rotation-loss", options->rotation_loss, "the motion network without its L_rot");
  command
      .add_option("--context", options->context,
                  "frames of the motion network's sequences (default: 30; at "
                  "most 60, as clips are cut)")
      ->check(CLI::Range(3, 60));
  command.add_option("--device", options->device, "cpu, or cuda where LibTorch has it")
      ->check(CLI::IsMember({"cpu", "cuda"}));
  const auto init = command.add_option("--init", options->init, "weights to start from");
  command
      .add_option("--keep", options->keep,
                  "share of the weights to start from that is mixed into those written (skeleton and part)")
      ->needs(init)
      ->check(CLI::Range(0.0, 0.95));
  return [options] {
    US_CHECK(options->minutes > 0 || options->samples > 0, "training wants an end: --minutes or --samples");
    US_CHECK(options->device == "cpu" || options->network != "part", "part is trained on the cpu");
    options->cancelled = interrupted;
    return nn::train(*options);
  };
}

}  // namespace understudy::app
