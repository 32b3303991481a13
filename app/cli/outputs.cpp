#include "app/cli/outputs.hpp"

#include "retarget/base/error.hpp"
#include "retarget/formats/glb_writer.hpp"
#include "retarget/formats/result_writer.hpp"

namespace understudy::app {
namespace {

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// All figures as arrays, for others to judge; vertices as the target's file has them.
class FiguresOutput final : public Output {
 public:
  FiguresOutput(const std::string& path, const PreparedCharacter& character)
      : surface_(character.surface), writer_(path, static_cast<int64_t>(surface_.in_file.size())) {}
  void push(const PerformedFrame& frame) override {
    writer_.push(surface_.in_file_order(frame.result.vertices), frame.result.joints, frame.result.pose.local,
                 frame.source_joints);
  }
  void finish() override { writer_.finish(); }

 private:
  const MergedSurface& surface_;
  ResultWriter writer_;
};

/// The target with its skin and the motion.
class AnimationOutput final : public Output {
 public:
  AnimationOutput(const std::string& path, const Retargeter& retargeter, double fps)
      : writer_(path, {retargeter.target().mesh, retargeter.target().joints, retargeter.weights()}),
        fps_(fps) {}
  void push(const PerformedFrame& frame) override {
    writer_.push(frame.result.pose, static_cast<float>(static_cast<double>(writer_.frames()) / fps_));
  }
  void finish() override { writer_.finish(); }

 private:
  GlbWriter writer_;
  double fps_;
};

}  // namespace

void check_output_format(const std::string& path) {
  US_CHECK(path.empty() || ends_with(path, ".npz") || ends_with(path, ".glb"), path,
           ": this output format is not known, use .glb or .npz");
}

std::unique_ptr<Output> open_output(const std::string& path, const PreparedCharacter& character,
                                    const Retargeter& retargeter, double fps) {
  check_output_format(path);
  if (ends_with(path, ".glb")) return std::make_unique<AnimationOutput>(path, retargeter, fps);
  return std::make_unique<FiguresOutput>(path, character);
}

}  // namespace understudy::app
