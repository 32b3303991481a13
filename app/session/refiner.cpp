#include "app/session/refiner.hpp"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "app/session/background_thread.hpp"
#include "app/session/frame_figures.hpp"
#include "retarget/base/error.hpp"

namespace understudy::app {

Refined refine(const RefineRequest& request) {
  Refined result;
  result.take_id = request.take_id;
  result.shown = request.performed;
  if (!request.edits.empty() && !request.performed.poses.empty()) {
    try {
      const EditedBody body = EditedBody::from(request.target->mesh.vertices, request.target->joints);
      result.shown = apply_poses(request.edits, request.performed, body);
      result.cost = edit_cost(request.performed, result.shown, request.target->joints);
    } catch (const Error& error) {
      result.shown = request.performed;
      result.problem = error.what();
    }
  }
  result.joints.reserve(result.shown.poses.size());
  for (const Pose& pose : result.shown.poses)
    result.joints.push_back(forward_kinematics(request.target->joints, pose).joints);
  result.series = joint_figures({result.shown, result.joints, request.source, request.truth.get()});
  return result;
}

struct Refiner::Impl {
  mutable std::mutex mutex;
  std::condition_variable wake;
  std::vector<RefineRequest> waiting;
  std::vector<Refined> finished;
  bool stop = false, working = false;
  std::thread thread;

  void run() {
    yield_to_drawing();
    std::unique_lock<std::mutex> lock(mutex);
    while (true) {
      wake.wait(lock, [this] { return stop || !waiting.empty(); });
      if (stop) return;
      const RefineRequest request = std::move(waiting.front());
      waiting.erase(waiting.begin());
      working = true;
      lock.unlock();
      Refined result = refine(request);
      lock.lock();
      finished.push_back(std::move(result));
      working = false;
    }
  }
};

Refiner::Refiner() : impl_(std::make_unique<Impl>()) {
  impl_->thread = std::thread([impl = impl_.get()] { impl->run(); });
}

Refiner::~Refiner() {
  {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    impl_->stop = true;
  }
  impl_->wake.notify_all();
  impl_->thread.join();
}

void Refiner::request(RefineRequest request) {
  {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    auto& waiting = impl_->waiting;
    waiting.erase(
        std::remove_if(waiting.begin(), waiting.end(),
                       [&](const RefineRequest& other) { return other.take_id == request.take_id; }),
        waiting.end());
    waiting.push_back(std::move(request));
  }
  impl_->wake.notify_all();
}

std::vector<Refined> Refiner::drain() {
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  return std::exchange(impl_->finished, {});
}

bool Refiner::busy() const {
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  return impl_->working || !impl_->waiting.empty() || !impl_->finished.empty();
}

}  // namespace understudy::app
