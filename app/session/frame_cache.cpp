#include "app/session/frame_cache.hpp"

#include <algorithm>
#include <cstring>
#include <deque>
#include <list>
#include <map>
#include <new>
#include <tuple>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/worker.hpp"
#include "retarget/geometry/cloud_normals.hpp"
#include "retarget/skeleton/skinning.hpp"

namespace understudy::app {
namespace {

constexpr size_t kMostDemands = 64;  // what was asked for before these is asked for again if still wanted
constexpr size_t kMostPrefetches = 8;
constexpr size_t kFewestKept = 4;
constexpr int kSource = -1;
constexpr int kRest = -1;        // in place of a frame's number
constexpr int kPerforming = -2;  // and below: less the frame's number there

/// The points that are not in the box.
Points outside(const Box& box, const Points& points) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vec3 p = points.row(i);
    const bool in = (p.array() >= box.low.array()).all() && (p.array() <= box.high.array()).all();
    if (!in && p.allFinite()) rows.push_back(i);
  }
  return points(rows, Eigen::all);
}

/// What a picture is of: the source, or a take.
struct Key {
  int take = kSource, frame = 0;
  bool offsets = false;
  bool operator<(const Key& other) const {
    return std::tie(take, frame, offsets) < std::tie(other.take, other.frame, other.offsets);
  }
  bool operator==(const Key& other) const {
    return take == other.take && frame == other.frame && offsets == other.offsets;
  }
};

/// What a picture is made from. Of a scan only the version counts: that of the source and its edits.
struct Recipe {
  int64_t version = 0;  // of a take: its generation
  std::shared_ptr<const Deformer> deformer;
  std::shared_ptr<const Target> target;
  Pose pose;
  std::shared_ptr<const RowMatrix> weights{};  // of a rest pose

  /// Generations tell takes apart only as long as no take is removed or exchanged: hence the rest.
  bool operator==(const Recipe& other) const {
    return version == other.version && deformer == other.deformer && target == other.target &&
           weights == other.weights &&
           std::memcmp(&pose, &other.pose, sizeof pose) == 0;  // NOLINT: all floats; NaN equals itself
  }
};

struct Request {
  Key key;
  Recipe recipe;
};

struct Entry {
  Request of;
  std::shared_ptr<const ScanPicture> scan;
  std::shared_ptr<const PosedPicture> posed;
  int64_t bytes = 0;
};

template <class Matrix>
int64_t bytes_of(const Matrix& matrix) {
  return static_cast<int64_t>(matrix.size()) * static_cast<int64_t>(sizeof(typename Matrix::Scalar));
}

int64_t bytes_of(const Entry& entry) {
  int64_t bytes = sizeof(Entry);
  if (const auto& scan = entry.scan)
    bytes += bytes_of(scan->mesh.vertices) + bytes_of(scan->mesh.faces) + bytes_of(scan->mesh.colors) +
             bytes_of(scan->normals) + bytes_of(scan->cropped_away);
  if (const auto& posed = entry.posed)
    bytes += bytes_of(posed->vertices) + bytes_of(posed->normals) + bytes_of(posed->offsets);
  return bytes;
}

/// The finished pictures by key; drops the least recently used first. Not thread-safe.
class Store {
 public:
  const Entry* find(const Request& request) {
    const auto found = index_.find(request.key);
    if (found == index_.end()) return nullptr;
    if (!(found->second->of.recipe == request.recipe)) {
      erase(found->second);
      return nullptr;
    }
    used_.splice(used_.begin(), used_, found->second);
    return &*found->second;
  }
  void put(Entry entry) {
    const auto old = index_.find(entry.of.key);
    if (old != index_.end()) erase(old->second);
    bytes_ += entry.bytes;
    used_.push_front(std::move(entry));
    index_[used_.front().of.key] = used_.begin();
    shrink();
  }
  /// Drops the pictures for which `of` is true.
  template <class Of>
  void forget(Of&& of) {
    for (auto entry = used_.begin(); entry != used_.end();) {
      const auto next = std::next(entry);
      if (of(entry->of)) erase(entry);
      entry = next;
    }
  }
  void set_limit(int64_t bytes) {
    limit_ = bytes;
    shrink();
  }
  int64_t bytes() const { return bytes_; }

 private:
  using Place = std::list<Entry>::iterator;
  void erase(Place place) {
    bytes_ -= place->bytes;
    index_.erase(place->of.key);
    used_.erase(place);
  }
  void shrink() {
    while (bytes_ > limit_ && used_.size() > kFewestKept) erase(std::prev(used_.end()));
  }

  std::list<Entry> used_;  // the last used first
  std::map<Key, Place> index_;
  int64_t bytes_ = 0, limit_ = 0;
};

/// Reads scans of one source, on the cache's thread.
class ScanReader {
 public:
  explicit ScanReader(FrameCache::Open open) : open_(std::move(open)) {}

  void set_source(const SourceOptions& options, const ScanEdits& edits) {
    SourceOptions wanted = options;
    wanted.quiet = true;
    wanted.follow = false;  // never wait for what is not there yet
    if (!same(wanted, options_) || wanted.made != options_.made) source_.reset();
    options_ = wanted;
    edits_ = wanted.complete > 0 ? ScanEdits() : edits;  // they were applied before it was completed
  }

  /// Never throws: an error becomes the picture's problem.
  ScanPicture picture(int frame) {
    ScanPicture picture;
    try {
      picture = made(frame);
    } catch (const std::bad_alloc&) {
      picture.problem = "frame " + std::to_string(frame) + ": there is not enough memory";
    } catch (const std::exception& error) {
      picture.problem = error.what();
    }
    if (picture.problem.empty()) return picture;
    picture = {{}, {}, {}, 0, false, picture.problem};
    return picture;
  }

 private:
  ScanFrame read(int frame) {
    try {
      return read_from_open(frame);
    } catch (const Error&) {
      source_.reset();  // it may have stopped half-way, or know fewer frames than there are by now
      return read_from_open(frame);
    }
  }
  ScanFrame read_from_open(int frame) {
    if (!source_) {
      source_ = open_(options_);
      next_ = 0;
    }
    if (frame != next_) source_->seek(frame);
    next_ = -1;
    std::optional<ScanFrame> scan = source_->next();
    US_CHECK(scan, options_.path, ": has no frame ", frame);
    next_ = frame + 1;
    return std::move(*scan);
  }

  ScanPicture made(int frame) {
    ScanFrame scan = read(frame);
    US_CHECK(scan.usable, scan.problem);
    ScanEdits edits = edits_;
    if (edits.empty() && !scan.mesh.vertices.allFinite())  // what is not finite goes with any edit
      edits.crop = Box{Vec3::Constant(-kOpenSide / 2), Vec3::Constant(kOpenSide / 2)};
    ScanPicture picture;
    if (edits_.crop) picture.cropped_away = outside(*edits_.crop, scan.mesh.vertices);
    picture.mesh = edits.empty() ? std::move(scan.mesh) : apply(edits, scan.mesh);
    const Points& vertices = picture.mesh.vertices;
    US_CHECK(vertices.rows() > 0, "frame ", frame, ": the edits leave nothing of the scan");
    picture.spacing = point_spacing(vertices);
    picture.normals =
        picture.mesh.is_cloud() ? estimated_normals(vertices) : vertex_normals(vertices, picture.mesh.faces);
    return picture;
  }

  FrameCache::Open open_;
  SourceOptions options_;
  ScanEdits edits_;
  std::unique_ptr<Source> source_;
  int next_ = -1;  // frame that next() gives; -1: not known
};

/// Never throws: a target that cannot be posed is a picture without vertices.
PosedPicture posed_picture(const Request& request) {
  PosedPicture picture;
  const Recipe& recipe = request.recipe;
  const Mesh& mesh = recipe.target->mesh;
  const bool rests = request.key.frame == kRest;
  try {
    picture.vertices = rests ? linear_blend_skinning(mesh.vertices, *recipe.weights, recipe.target->joints,
                                                     forward_kinematics(recipe.target->joints, recipe.pose))
                             : recipe.deformer->deform(recipe.pose);
    if (!mesh.is_cloud()) picture.normals = vertex_normals(picture.vertices, mesh.faces);
    if (request.key.offsets) picture.offsets = recipe.deformer->offsets(recipe.pose);
    return picture;
  } catch (const std::exception& error) {
    const std::string what = rests ? "the rest pose" : "frame " + std::to_string(request.key.frame);
    log::warn_once(what + " cannot be shown: " + error.what());
  }
  return {};
}

/// The newest of a key replaces older ones; true when there was one.
bool remove(std::deque<Request>& requests, const Key& key) {
  const auto found = std::find_if(requests.begin(), requests.end(), [&](auto& r) { return r.key == key; });
  if (found == requests.end()) return false;
  requests.erase(found);
  return true;
}

template <class Of>
void remove_if(std::deque<Request>& requests, Of&& of) {
  requests.erase(std::remove_if(requests.begin(), requests.end(), of), requests.end());
}

}  // namespace

struct FrameCache::Impl {
  Store store;
  std::deque<Request> demands;     // the newest last, made first
  std::deque<Request> prefetches;  // made in their order
  std::optional<Request> making;
  bool making_demanded = false;
  int64_t pictures_made = 0;

  SourceOptions source;
  ScanEdits edits;
  int64_t source_version = 0, reader_version = 0;
  std::map<int, std::pair<int64_t, std::shared_ptr<const Deformer>>> takes;  // as last asked for
  ScanReader reader;
  Worker worker{"making pictures", [this] { return next(); }, Worker::Priority::AsDrawing};  // looked at

  explicit Impl(Open open) : reader(std::move(open)) {}

  void ask(Request request);
  void prefetch(Request request);
  bool is_made_now(const Request& request) const {
    return making && making->key == request.key && making->recipe == request.recipe;
  }
  template <class Of>
  void forget(const Of& of) {
    store.forget(of);
    remove_if(demands, of);
    remove_if(prefetches, of);
  }
  Request scan_request(int frame) const {
    Request request;
    request.key.frame = frame;
    request.recipe.version = source_version;
    return request;
  }
  std::optional<Request> posed_request(const TakeState& take, const Wanted& wanted);
  void see(const TakeState& take, int k);
  std::shared_ptr<const PosedPicture> posed(const std::optional<Request>& request);
  bool still_wanted(const Request& request) const;
  void take_next();
  Worker::Task next();
};

void FrameCache::Impl::ask(Request request) {
  if (is_made_now(request)) {
    making_demanded = true;
    return;
  }
  remove(prefetches, request.key);
  remove(demands, request.key);
  demands.push_back(std::move(request));
  if (demands.size() > kMostDemands) demands.pop_front();
  worker.wake();
}

void FrameCache::Impl::prefetch(Request request) {
  const Key& key = request.key;
  const auto asked = std::find_if(demands.begin(), demands.end(), [&](auto& r) { return r.key == key; });
  if (is_made_now(request) || asked != demands.end()) return;
  remove(prefetches, key);
  prefetches.push_back(std::move(request));
  if (prefetches.size() > kMostPrefetches) prefetches.pop_front();
  worker.wake();
}

/// A take of another generation forgets what was made of it before.
void FrameCache::Impl::see(const TakeState& take, int k) {
  const auto now = std::make_pair(take.generation, take.deformer);
  auto& known = takes[k];
  if (known == now) return;
  known = now;
  forget([&](const Request& request) { return request.key.take == k; });
}

/// Nothing where there is no such frame.
std::optional<Request> FrameCache::Impl::posed_request(const TakeState& take, const Wanted& wanted) {
  const size_t frame = wanted.frame;
  if (!take.deformer || !take.target || wanted.frame < 0 || frame >= take.shown.poses.size()) return {};
  see(take, wanted.take);
  return Request{{wanted.take, wanted.frame, wanted.offsets},
                 {take.generation, take.deformer, take.target, take.shown.poses[frame]}};
}

/// Asks for what is not made yet.
std::shared_ptr<const PosedPicture> FrameCache::Impl::posed(const std::optional<Request>& request) {
  if (!request) return nullptr;
  if (const Entry* made = store.find(*request)) return made->posed;
  ask(*request);
  return nullptr;
}

bool FrameCache::Impl::still_wanted(const Request& request) const {
  if (request.key.take == kSource) return request.recipe.version == source_version;
  const auto known = takes.find(request.key.take);
  return known != takes.end() &&
         known->second == std::make_pair(request.recipe.version, request.recipe.deformer);
}

/// Moves the next request into `making`; there is one.
void FrameCache::Impl::take_next() {
  making_demanded = !demands.empty();
  if (!demands.empty()) {
    making = std::move(demands.back());
    demands.pop_back();
  } else {
    making = std::move(prefetches.front());
    prefetches.pop_front();
  }
}

Worker::Task FrameCache::Impl::next() {
  if (demands.empty() && prefetches.empty()) return nullptr;
  take_next();
  if (making->key.take == kSource && reader_version != source_version) {
    reader.set_source(source, edits);
    reader_version = source_version;
  }
  return [this, request = *making] {
    Entry entry;
    entry.of = request;
    const std::string problem = failure_of([&] {
      if (request.key.take == kSource)
        entry.scan = std::make_shared<const ScanPicture>(reader.picture(request.key.frame));
      else
        entry.posed = std::make_shared<const PosedPicture>(posed_picture(request));
      entry.bytes = bytes_of(entry);
    });
    if (!problem.empty()) log::warn_once("a picture cannot be made: " + problem);
    const auto held = worker.lock();
    making.reset();
    if (still_wanted(entry.of)) store.put(std::move(entry)), ++pictures_made;
  };
}

FrameCache::FrameCache(int64_t limit_mb, Open open) : impl_(std::make_unique<Impl>(std::move(open))) {
  set_limit(limit_mb);
}

FrameCache::~FrameCache() = default;

void FrameCache::set_source(const SourceOptions& source, const ScanEdits& edits) {
  const auto held = impl_->worker.lock();
  const bool is_same = same(source, impl_->source) && same(edits, impl_->edits);
  if (is_same && source.made && source.made != impl_->source.made) {
    impl_->source.made = source.made;
    ++impl_->source_version;
  }
  if (is_same) return;
  impl_->source = source;
  impl_->edits = edits;
  ++impl_->source_version;
  impl_->forget([](const Request& request) { return request.key.take == kSource; });
}

void FrameCache::forget_takes() {
  const auto held = impl_->worker.lock();
  impl_->takes.clear();
  impl_->forget([](const Request& request) { return request.key.take != kSource; });
}

void FrameCache::set_limit(int64_t limit_mb) {
  const auto held = impl_->worker.lock();
  impl_->store.set_limit(std::max<int64_t>(limit_mb, 0) << 20);
}

std::shared_ptr<const ScanPicture> FrameCache::scan(int frame) {
  const auto held = impl_->worker.lock();
  if (frame < 0 || impl_->source.path.empty()) return nullptr;
  const Request request = impl_->scan_request(frame);
  if (const Entry* made = impl_->store.find(request)) return made->scan;
  impl_->ask(request);
  return nullptr;
}

std::shared_ptr<const PosedPicture> FrameCache::posed(const TakeState& take, const Wanted& wanted) {
  const auto held = impl_->worker.lock();
  return impl_->posed(impl_->posed_request(take, wanted));
}

std::shared_ptr<const PosedPicture> FrameCache::rest(const TakeState& take, int k, const Pose& pose) {
  const auto held = impl_->worker.lock();
  if (!take.target || !take.weights) return nullptr;
  impl_->see(take, k);
  return impl_->posed(
      Request{{k, kRest, false}, {take.generation, take.deformer, take.target, pose, take.weights}});
}

std::shared_ptr<const PosedPicture> FrameCache::performing(const TakeState& take, int k,
                                                           const std::vector<StepPerformance::Frame>& frames,
                                                           int now) {
  constexpr int kBack = 16;  // frames
  const auto held = impl_->worker.lock();
  if (!take.deformer || !take.target) return nullptr;
  impl_->see(take, k);
  const auto request = [&](int frame) {
    return Request{{k, kPerforming - frame, false},
                   {take.generation, take.deformer, take.target, frames[frame].pose}};
  };
  auto picture = impl_->posed(request(now));
  for (int frame = now - 1; picture == nullptr && frame >= std::max(0, now - kBack); --frame)
    if (const Entry* made = impl_->store.find(request(frame))) picture = made->posed;
  return picture;
}

void FrameCache::prefetch_scan(int frame) {
  const auto held = impl_->worker.lock();
  if (frame < 0 || impl_->source.path.empty()) return;
  const Request request = impl_->scan_request(frame);
  if (!impl_->store.find(request)) impl_->prefetch(request);
}

void FrameCache::prefetch_posed(const TakeState& take, const Wanted& wanted) {
  const auto held = impl_->worker.lock();
  const std::optional<Request> request = impl_->posed_request(take, wanted);
  if (request && !impl_->store.find(*request)) impl_->prefetch(*request);
}

void FrameCache::wait() const {
  auto held = impl_->worker.lock();
  impl_->worker.wait(held,
                     [this] { return impl_->demands.empty() && !(impl_->making && impl_->making_demanded); });
}

int64_t FrameCache::bytes() const {
  const auto held = impl_->worker.lock();
  return impl_->store.bytes();
}

int64_t FrameCache::made() const {
  const auto held = impl_->worker.lock();
  return impl_->pictures_made;
}

bool FrameCache::busy() const {
  const auto held = impl_->worker.lock();
  return impl_->making || !impl_->demands.empty() || !impl_->prefetches.empty();
}

}  // namespace understudy::app
