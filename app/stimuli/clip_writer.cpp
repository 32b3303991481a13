#include "app/stimuli/clip_writer.hpp"

#include <deque>
#include <exception>

#include "retarget/base/worker.hpp"

namespace understudy::app {
namespace {

constexpr size_t kWaiting = 6;  // pictures

}  // namespace

struct ClipWriter::Impl {
  std::vector<std::unique_ptr<render::VideoWriter>> films;
  std::deque<std::vector<render::Image>> waiting;
  std::exception_ptr failed;
  Worker worker{"encoding clips", [this] { return next(); }, Worker::Priority::AsDrawing};  // last

  Worker::Task next() {
    if (waiting.empty() || failed) return nullptr;
    auto pictures = std::make_shared<std::vector<render::Image>>(std::move(waiting.front()));
    waiting.pop_front();
    return [this, pictures] {
      try {
        for (size_t i = 0; i < films.size(); ++i) films[i]->push((*pictures)[i]);
      } catch (...) {
        const auto held = worker.lock();
        failed = std::current_exception();
      }
    };
  }
  /// Until at most so many are waiting.
  std::unique_lock<std::mutex> wait(size_t most, bool rest) {
    auto held = worker.lock();
    worker.wait(held,
                [&] { return failed != nullptr || (waiting.size() <= most && !(rest && worker.working())); });
    if (failed) std::rethrow_exception(failed);
    return held;
  }
};

ClipWriter::ClipWriter(const std::vector<Film>& films) : impl_(std::make_unique<Impl>()) {
  for (const Film& film : films)
    impl_->films.push_back(std::make_unique<render::VideoWriter>(film.path, film.options));
}

ClipWriter::~ClipWriter() = default;

void ClipWriter::push(std::vector<render::Image> pictures) {
  const auto held = impl_->wait(kWaiting - 1, false);
  impl_->waiting.push_back(std::move(pictures));
  impl_->worker.wake();
}

void ClipWriter::finish() {
  impl_->wait(0, true);
  for (const auto& film : impl_->films) film->finish();
}

}  // namespace understudy::app
