// A studio test with the scans of an arm that bends, in which bones are found.
#pragma once

#include "retarget/base/error.hpp"
#include "retarget/formats/npz.hpp"
#include "tests/retarget/discovery/bending_arm.hpp"
#include "tests/session/studio_fixture.hpp"

namespace understudy::app {

class ArmStudioTest : public StudioTest {
 protected:
  void SetUp() override {
    StudioTest::SetUp();
    write_arm("arm.npz", understudy::kFrames);
  }

  /// Its first frames, `scale` times as large, of `count` points: few are searched quickly. goes: in a frame.
  void write_arm(const std::string& name, int frames, float scale = 1, int count = 1000,
                 const Vec3& goes = Vec3::Zero()) {
    NpyArray points;
    for (int t = 0; t < frames; ++t) {
      Points frame = scale * sparse(bent_arm(angle_at(t), static_cast<uint64_t>(t)), count).vertices;
      frame.rowwise() += static_cast<float>(t) * goes.transpose();
      points.shape = {frames, frame.rows(), 3};
      points.values.insert(points.values.end(), frame.data(), frame.data() + frame.size());
    }
    write_npz(path(name), {{"points", points}});
  }

  /// Opened as it is: metres, y up.
  void open_arm(Studio& studio) {
    studio.run("open", {path("arm.npz")});
    studio.run("source.units", {"m"});
    studio.run("source.up", {"y"});
    studio.wait_idle();
  }
  void find(Studio& studio) {
    open_arm(studio);
    studio.run("bones.find", {"2"});  // noise in few points could make one more
    studio.wait_idle();
    ASSERT_TRUE(studio.session().bones.rig) << studio.session().bones.problem;
  }
  static const understudy::Rig& rig(const Studio& studio) { return studio.session().bones.rig->found.rig; }
  template <class Command>
  static std::string refusal(const Command& command) {
    return failure_of(command);
  }
};

}  // namespace understudy::app
