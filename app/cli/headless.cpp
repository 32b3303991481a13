#include "app/cli/headless.hpp"

#include <chrono>
#include <filesystem>
#include <thread>

#include "app/cli/progress.hpp"
#include "app/cli/studio.hpp"
#include "app/run/interrupt.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

/// What a studio asks that nobody looks at.
void check_questions(const Session& session) {
  US_CHECK(!session.question || session.question->kind != Question::Kind::MissingFiles,
           session.question->missing[0], ": is a file of the document, but does not exist");
  US_CHECK(!session.question || session.question->kind != Question::Kind::PaintMisfit,
           session.question->text);
  for (const Question::Kind kind : {Question::Kind::NotAPerson, Question::Kind::Canvas})
    US_CHECK(!session.question || session.question->kind != kind, session.question->text);
}

}  // namespace

std::unique_ptr<Studio> headless_studio(const std::string& weights) {
  const StudioServices program = studio_services(weights);
  StudioServices services;
  services.networks = program.networks;
  services.motion_space = program.motion_space;
  services.motion_coder = program.motion_coder;
  services.lifter = program.lifter;
  services.lengths = program.lengths;
  services.flat_engine = program.flat_engine;
  return std::make_unique<Studio>(std::move(services));
}

void make_takes(Studio& studio, size_t take, const MakeOptions& options) {
  const Session& session = studio.session();
  const auto look = [&] {
    check_questions(session);
    US_CHECK(options.with_errors || session.errors.empty(), session.errors.front().text);
  };
  Progress progress(options.from + " -> " + session.document.takes[take].name, 0);
  do {
    studio.tick(0);
    look();
    progress.step(static_cast<int64_t>(session.takes[take].performed.size()));
    check_interrupt("after " + std::to_string(session.takes[take].performed.size()) + " frames");
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  } while (!studio.made());
  studio.tick(0);
  look();
  progress.finish();
}

std::string clip_name(const std::string& path) {
  const std::string stem = std::filesystem::path(file_name(path)).stem().string();
  return stem.empty() ? "motion" : stem;
}

}  // namespace understudy::app
