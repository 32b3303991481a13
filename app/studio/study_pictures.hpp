// Pictures of the trials of a study, for the study panel.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "app/session/studio.hpp"
#include "app/stimuli/stage.hpp"
#include "app/study/trials.hpp"
#include "render/gl/object.hpp"
#include "render/image.hpp"
#include "retarget/base/worker.hpp"
#include "ui/panels/panel.hpp"

namespace understudy::app {

/// Retargets and draws in a thread of its own, with a context of its own; update() only shows what it made.
/// Make, use and destroy it with one context current.
class StudyPictures {
 public:
  explicit StudyPictures(const StudioServices& services);
  ~StudyPictures();  ///< stops what is being made
  StudyPictures(const StudyPictures&) = delete;
  StudyPictures& operator=(const StudyPictures&) = delete;

  /// The trial at a share (0..1) of its clip. While it is made there is no texture, and the text says so; of
  /// what is asked for meanwhile only the last is made. The study is one that check() accepts. Never waits.
  ui::TrialPicture of(const Study& study, const Trial& trial, float share);
  /// Takes what has been made. True when there is a new picture.
  bool update();
  /// Whether something is being made or waits for update().
  bool busy() const;
  /// Pictures made so far, from any thread.
  int64_t made() const { return made_; }

 private:
  struct Wanted {
    std::string key, stage_key;
    Study study;
    Trial trial;
    float share = 0;
  };
  struct Made {
    std::string key;
    render::Image image;
    std::string problem;  ///< why there is none; empty: there is
  };
  struct Picture {
    ui::TrialPicture shown;
    std::unique_ptr<render::gl::Texture> texture;
    int64_t used = 0;
  };
  Worker::Task next();
  render::Image draw(const Wanted& wanted);
  void forget_oldest();

  std::function<Networks(const Method&, const NetworkParts&)> networks_;
  std::function<std::shared_ptr<MotionCoder>()> motion_coder_;
  // Of the thread alone.
  std::string stage_key_;
  std::unique_ptr<StageMaker> maker_;
  std::shared_ptr<const Stage> stage_;
  // Shared.
  std::optional<Wanted> wanted_;
  std::string at_work_;  ///< the key of what is being made
  std::optional<Made> finished_;
  std::atomic<bool> stopped_{false};
  std::atomic<int64_t> made_{0};
  // Of the window.
  std::map<std::string, Picture> pictures_;
  int64_t uses_ = 0;
  Worker worker_{"trials", [this] { return next(); }};
};

}  // namespace understudy::app
