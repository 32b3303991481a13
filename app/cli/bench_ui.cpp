#include "app/cli/bench_ui.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <deque>
#include <filesystem>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "app/cli/machine.hpp"
#include "app/cli/studio.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/target_file.hpp"
#include "app/studio/application.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/formats/motion_writers.hpp"
#include "retarget/formats/surface_writer.hpp"
#include "retarget/pipeline/human_rest.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kFrames = 132, kScanPoints = 8000, kVertices = 13000, kManyVertices = 200000,
              kImported = 100000, kTries = 3, kStyled = 1050;
constexpr double kReading = 3, kSettling = 2;  // seconds

double seconds_since(Clock::time_point from) {
  return std::chrono::duration<double>(Clock::now() - from).count();
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  return values[static_cast<size_t>(std::lround(q * static_cast<double>(values.size() - 1)))];
}

// What is shown: the bundled samples, brought to the sizes asked for,
// the scan from its start again at its end.

/// Exactly `count` vertices: faces are cut into three, one after the other, then those made so.
Mesh with_vertices(Mesh mesh, int count) {
  const int first = mesh.vertices.rows(), faces = mesh.faces.rows();
  const int more = std::max(0, count - first);
  mesh.vertices.conservativeResize(first + more, 3);
  mesh.faces.conservativeResize(faces + 2 * more, 3);
  for (int i = 0; i < more; ++i) {
    const int a = mesh.faces(i, 0), b = mesh.faces(i, 1), c = mesh.faces(i, 2), centre = first + i;
    mesh.vertices.row(centre) = (mesh.vertices.row(a) + mesh.vertices.row(b) + mesh.vertices.row(c)) / 3;
    mesh.faces.row(i) << a, b, centre;
    mesh.faces.row(faces + 2 * i) << b, c, centre;
    mesh.faces.row(faces + 2 * i + 1) << c, a, centre;
  }
  return mesh;
}

/// Points drawn again from the scan, some millimetres aside, until there are as many as asked for.
Points dense_scan(const Points& points) {
  Rng rng(1);
  Points dense(kScanPoints, 3);
  for (int i = 0; i < kScanPoints; ++i) {
    const auto from = static_cast<Eigen::Index>(i) < points.rows() ? i : rng.below(points.rows());
    for (int axis = 0; axis < 3; ++axis)
      dense(i, axis) = points(from, axis) + (i < points.rows() ? 0 : 0.004f * rng.normal());
  }
  return dense;
}

/// A folder that goes when the measuring is over.
class BenchFiles {
 public:
  explicit BenchFiles(const std::string& samples) {
    std::string name = (fs::temp_directory_path() / "understudy-bench-XXXXXX").string();
    US_CHECK(mkdtemp(name.data()), name, ": cannot be made");
    folder_ = name;
    fs::create_directories(scan());
    SourceOptions from;
    from.path = samples + "/scan";
    from.quiet = true;
    auto source = open_source(from);
    for (int i = 0; i < kFrames; ++i) {
      auto frame = source->next();
      if (!frame) source = open_source(from), frame = source->next();
      write_file(scan() + printed("/frame_%05d.ply", i),
                 ply_bytes({}, dense_scan(frame->mesh.vertices), "scan"));
    }
    fs::create_directory_symlink(scan(), scan_again());
    const Character character = read_target(samples + "/target_adult.glb", {});
    const Mesh adult = merged_surface(character, bind_pose(character).vertices).mesh;
    for (const int vertices : {kVertices, kManyVertices}) {
      const Mesh mesh = with_vertices(adult, vertices);
      SurfaceTopology topology;
      topology.faces = mesh.faces;
      write_file(target(vertices), obj_text(topology, mesh.vertices, "a target"));
    }
    const Motion walk = builtin_motion("walk", human_rest());
    BvhWriter walks(motion(), human_rest(), walk.fps);
    for (size_t t = 0; t < kStyled; ++t) walks.push(walk.poses[t % walk.poses.size()]);
    walks.finish();
    Mesh person = with_vertices(adult, kImported);
    for (int i = 0; i < kTries; ++i) {  // not one like another: nothing is known of it yet
      write_gltf_character(imported(i), character_of_mesh(person, "imported"));
      person.vertices *= 1.01f;
    }
  }
  ~BenchFiles() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  BenchFiles(const BenchFiles&) = delete;
  BenchFiles& operator=(const BenchFiles&) = delete;
  std::string scan() const { return folder_ + "/scan"; }
  /// The same under another name: nothing is known of it yet.
  std::string scan_again() const { return folder_ + "/scan_again"; }
  /// A GLB without bones, the i-th of kTries.
  std::string imported(int i) const { return folder_ + "/imported_" + std::to_string(i) + ".glb"; }
  /// A walk of kStyled frames.
  std::string motion() const { return folder_ + "/walk.bvh"; }
  std::string target(int vertices) const { return folder_ + "/target_" + std::to_string(vertices) + ".obj"; }
  std::string document() const { return folder_ + "/two.understudy"; }
  std::string video() const { return folder_ + "/video.mp4"; }

 private:
  std::string folder_;
};

// The hand: moves the mouse over the views from a thread of its own, as a device would, and remembers when.

class Hand {
 public:
  explicit Hand(OffscreenSurface& surface) : surface_(surface), thread_([this] { move(); }) {}
  ~Hand() {
    stop_ = true;
    thread_.join();
  }
  /// When the oldest `count` movements not yet asked for were made.
  std::vector<Clock::time_point> taken(size_t count) {
    const std::lock_guard lock(mutex_);
    count = std::min(count, moved_.size());
    std::vector<Clock::time_point> times(moved_.begin(), moved_.begin() + static_cast<std::ptrdiff_t>(count));
    moved_.erase(moved_.begin(), moved_.begin() + static_cast<std::ptrdiff_t>(count));
    return times;
  }

 private:
  void move() {
    Rng rng(7);
    for (int i = 0; !stop_; ++i) {
      render::InputEvent event;
      event.x = 400 + 150 * std::sin(0.05f * static_cast<float>(i));
      event.y = 300 + 60 * std::cos(0.07f * static_cast<float>(i));
      {
        const std::lock_guard lock(mutex_);
        moved_.push_back(Clock::now());
        surface_.push(event);
      }
      // Not in step with the frames: every delay that can be is seen.
      std::this_thread::sleep_for(std::chrono::microseconds(15000 + rng.below(10000)));
    }
  }
  OffscreenSurface& surface_;
  std::mutex mutex_;
  std::deque<Clock::time_point> moved_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// Counts the input that a frame has taken.
struct InputCounter final : InputListener {
  size_t events = 0;
  void input(double, const std::vector<render::InputEvent>& input, const Session&) override {
    for (const render::InputEvent& event : input) events += event.kind == render::InputEvent::Kind::MouseMove;
  }
  void command(const std::string&, const Arguments&) override {}
};

class UiBench {
 public:
  explicit UiBench(const UiBenchOptions& options) : seconds_(options.seconds) {
    OffscreenSurface::Options seen;
    seen.context.kind = context_kind(options.context);
    auto surface = std::make_unique<OffscreenSurface>(seen);
    surface_ = surface.get();
    ApplicationOptions how;
    how.echo_log = false;
    application_ = std::make_unique<Application>(studio_services(options.weights), std::move(surface), how);
    application_->observe(&counter_);
  }

  void run() {
    start();
    sample_card();
    const BenchFiles files(application_->studio().services().samples);
    reopen(files);
    open(files, kVertices);
    turn();
    idle();
    fill();
    point_at_steps();
    play("playing kept frames", kVertices);
    video(files);
    live(files);
    scrub();
    memory();
    drag_style(files);
    open(files, kManyVertices);
    play("playing", kManyVertices);
    import(files);
  }

 private:
  void line(const std::string& what, const std::string& figures) {
    std::printf("%-44s %s\n", what.c_str(), figures.c_str());
    std::fflush(stdout);
  }
  void command(const std::string& name, const Arguments& arguments = {}) {
    application_->studio().run(name, arguments);
  }
  void settle() {
    application_->studio().wait_idle();
    for (int i = 0; i < 10; ++i) {
      application_->frame(1.0 / 60);
      application_->studio().cache().wait();
    }
  }
  void step() {
    check_interrupt("while measuring");
    application_->step();
  }
  static std::string milliseconds(const std::vector<double>& times) {
    return printed("%.1f ms median (%.0f frames/s), p95 %.1f ms", 1e3 * quantile(times, 0.5),
                   1 / quantile(times, 0.5), 1e3 * quantile(times, 0.95));
  }

  void start() {
    application_->frame(0);
    line("start to the first frame", printed("%.2f s", seconds_since_start()));
  }

  /// Until the first performed frame of so many takes has been presented.
  double until_performed(size_t takes, Clock::time_point began) {
    const auto performed = [](const TakeState& take) { return take.ready && !take.performed.empty(); };
    const auto& all = application_->session().takes;
    while (static_cast<size_t>(std::count_if(all.begin(), all.end(), performed)) < takes || !shown_whole())
      step();
    application_->frame(0);
    return seconds_since(began);
  }

  /// The start page stands for as long as somebody takes to read it; then a sample is chosen.
  void sample_card() {
    for (const auto began = Clock::now(); seconds_since(began) < kReading;) step();
    const std::string& samples = application_->studio().services().samples;
    const auto began = Clock::now();
    command("open", {samples + "/scan", samples + "/target_adult.glb"});
    line("sample card to its first performed frame", printed("%.2f s", until_performed(1, began)));
  }

  /// A document of two takes, opened again.
  void reopen(const BenchFiles& files) {
    const std::string& samples = application_->studio().services().samples;
    command("target.add", {samples + "/target_child.glb"});
    settle();
    command("document.save_as", {files.document()});
    std::vector<double> first, both;
    for (int i = 0; i < kTries; ++i) {
      clear();
      const auto began = Clock::now();
      command("document.open", {files.document()});
      first.push_back(until_performed(1, began));
      both.push_back(until_performed(2, began));
      settle();
    }
    line("document of two takes to its first performed frame",
         printed("%.2f s median of %d, %.2f s at most; of both %.2f s", quantile(first, 0.5), kTries,
                 quantile(first, 1), quantile(both, 0.5)));
  }

  /// Nothing is asked of it and nothing moves.
  void idle() {
    settle();
    for (const auto began = Clock::now(); seconds_since(began) < kSettling;) step();
    const std::clock_t used = std::clock();  // of all threads
    const int64_t drawn = application_->drawn();
    const auto began = Clock::now();
    while (seconds_since(began) < seconds_) step();
    const double busy = static_cast<double>(std::clock() - used) / CLOCKS_PER_SEC;
    line("idle", printed("%.1f %% of a core, %lld frames drawn in %.0f s", 100 * busy / seconds_since(began),
                         static_cast<long long>(application_->drawn() - drawn), seconds_since(began)));
  }

  /// All frames, as the dialog proposes them.
  void video(const BenchFiles& files) {
    const auto began = Clock::now();
    command("video.save", {files.video(), "1280", "720"});
    do step();
    while (!application_->session().jobs.empty());
    line("video of 1280 x 720",
         printed("%.1f s for %d frames", seconds_since(began), frame_count(application_->session())));
  }

  /// Whether scan and target of the shown frame have been made.
  bool shown_whole() {
    const Session& s = application_->session();
    const int frame = shown_frame(s);
    if (frame < 0 || !application_->studio().cache().scan(frame)) return false;
    for (size_t k = 0; k < s.takes.size(); ++k)
      if (s.takes[k].ready &&
          !application_->studio().cache().posed(s.takes[k], {static_cast<int>(k), frame, false}))
        return false;
    return true;
  }

  void clear() {
    command("document.new");
    if (application_->session().question) command("question.answer", {"discard"});
    while (!application_->studio().idle() || frame_count(application_->session()) > 0 ||
           application_->shows_take(0))
      step();
  }

  /// From the command until a frame with the character in it has been presented, and until it is bound.
  void import(const BenchFiles& files) {
    std::vector<double> seen, bound;
    for (int i = 0; i < kTries; ++i) {
      clear();
      const auto began = Clock::now();
      command("target.add", {files.imported(i)});
      while (!application_->shows_take(0)) step();
      seen.push_back(seconds_since(began));
      while (!application_->session().takes[0].ready) step();
      bound.push_back(seconds_since(began));
    }
    line("import of 100,000 vertices to first picture",
         printed("%.2f s median of %d, %.2f s at most; bound after %.2f s", quantile(seen, 0.5), kTries,
                 quantile(seen, 1), quantile(bound, 0.5)));
  }

  /// From the command until all frames have been made, and until their surfaces have been evaluated, too.
  void open(const BenchFiles& files, int vertices) {
    const auto began = Clock::now();
    clear();
    command("open", {files.scan(), files.target(vertices)});
    while (!application_->studio().made()) {
      check_interrupt("while measuring");
      application_->studio().tick(0);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    const double made = seconds_since(began);
    settle();
    line("opened and retargeted",
         printed("%.1f s for %d frames of %d points, %d vertices; evaluated after %.1f s", made,
                 frame_count(application_->session()), kScanPoints, vertices, seconds_since(began)));
  }

  void turn() {
    std::vector<double> times;
    command("playback.pause");
    for (const auto began = Clock::now(); seconds_since(began) < seconds_;) {
      const auto start = Clock::now();
      command("view.orbit", {"1", "0"});
      application_->frame(1.0 / 60);
      times.push_back(seconds_since(start));
    }
    line("interface and two views, turning", milliseconds(times));
  }

  /// From the command until the learned answer is seen; the network is loaded by the first.
  void fill() {
    command("playback.frame", {"35"});
    std::vector<double> times;
    for (int i = 0; i <= kTries; ++i) {
      settle();
      const auto began = Clock::now();
      command("edit.fill", {"0", "20", "49"});
      do step();
      while (!application_->studio().made() || !shown_whole());
      application_->frame(0);
      times.push_back(seconds_since(began));
      command("edit.undo");
    }
    const double first = times.front();
    times.erase(times.begin());
    line("30 frames filled, click to seen",
         milliseconds(times) + printed("; the first %.0f ms", 1e3 * first));
  }

  /// Whether every target is seen in what it performs now of the map.
  bool performance_shown() {
    const Session& s = application_->session();
    US_CHECK(s.map.performance, "the map was closed while it was measured");
    for (size_t k = 0; k < s.takes.size(); ++k) {
      const int frame = s.map.performance->frame_at(s.time, k);
      if (frame >= 0 && !application_->studio().cache().performing(s.takes[k], static_cast<int>(k),
                                                                   s.map.performance->takes[k], frame))
        return false;
    }
    return true;
  }

  /// From pointing at a step of the map until the target is seen in it, each time from another frame.
  void point_at_steps() {
    constexpr int kPointed = 12;
    command("panel.show", {"motion_map", "on"});
    command("map.index");
    settle();
    std::vector<double> times;
    for (int i = 0; i < kPointed; ++i) {
      command("playback.frame", {std::to_string(10 * i)});
      settle();
      const auto began = Clock::now();
      command("map.perform", {std::to_string(i % application_->session().map.map->size())});
      do step();
      while (!performance_shown());
      application_->frame(0);
      times.push_back(seconds_since(began));
      command("map.perform");
    }
    command("panel.show", {"inspector", "on"});
    line("a step of the map, pointed at to performed", milliseconds(times));
  }

  /// Plays in real time, 45 frames of the source a second: every picture is of the next frame or one soon
  /// after.
  void play(const std::string& what, int vertices) {
    std::vector<double> times;
    command("playback.rate", {"1.5"});
    command("playback.play");
    for (int i = 0; i < 30; ++i) step();
    int advanced = 0, last = -1;
    const auto began = Clock::now();
    auto before = began;
    while (seconds_since(began) < seconds_) {
      const int64_t drawn = application_->drawn();
      step();
      if (application_->drawn() == drawn) continue;
      times.push_back(seconds_since(before));
      before = Clock::now();
      advanced += shown_whole() && shown_frame(application_->session()) != last;
      last = shown_frame(application_->session());
    }
    command("playback.pause");
    line(what + ", " + std::to_string(vertices) + " vertices",
         milliseconds(times) + printed("; new frames complete %.1f/s", advanced / seconds_since(began)));
  }

  /// The shown target advances while frames are made and the mouse moves.
  void live(const BenchFiles& files) {
    clear();
    command("open", {files.scan_again(), files.target(kVertices)});
    std::vector<double> delays;
    std::set<int> shown;
    while (frame_count(application_->session()) < 1) step();
    counter_.events = 0;
    Hand hand(*surface_);
    const auto began = Clock::now();
    do {
      const int64_t drawn = application_->drawn();
      step();
      if (application_->drawn() == drawn) continue;
      for (const auto moved : hand.taken(std::exchange(counter_.events, 0)))
        delays.push_back(seconds_since(moved));
      shown.insert(shown_frame(application_->session()));
    } while (application_->session().working && seconds_since(began) < 60);
    const double seconds = seconds_since(began);
    line("retargeting live", printed("target advances %.1f/s (%zu frames in %.1f s)",
                                     static_cast<double>(shown.size()) / seconds, shown.size(), seconds));
    line("  input to presented frame",
         printed("p50 %.1f ms, p99 %.1f ms, worst %.1f ms of %zu", 1e3 * quantile(delays, 0.5),
                 1e3 * quantile(delays, 0.99), 1e3 * quantile(delays, 1), delays.size()));
  }

  /// Jumps to frames that have been forgotten since.
  void scrub() {
    settle();
    std::vector<double> times;
    Rng rng(3);
    const int count = frame_count(application_->session());
    for (int i = 0; i < 60; ++i) {
      application_->studio().cache().set_limit(1);  // forgets all but the newest few
      application_->studio().cache().set_limit(512);
      const auto start = Clock::now();
      command("playback.frame", {std::to_string(rng.below(count))});
      application_->frame(1.0 / 60);
      while (!shown_whole()) step();
      application_->frame(0);
      times.push_back(seconds_since(start));
    }
    line("scrubbing to any frame",
         printed("%.0f ms median, %.0f ms at most", 1e3 * quantile(times, 0.5), 1e3 * quantile(times, 1)));
  }

  /// The strength of a style is dragged: from the last movement of the hand until every frame is made anew.
  void drag_style(const BenchFiles& files) {
    clear();
    command("open", {files.motion(), files.target(kVertices)});
    settle();
    command("method.style", {"0", "child"});
    settle();
    std::vector<double> times;
    for (int i = 0; i < kTries; ++i) {
      Clock::time_point began;
      for (int moved = 1; moved <= 20; ++moved) {
        command("method.style_strength", {"0", printed("%.3f", 1 - 0.015 * moved - 0.01 * i)});
        began = Clock::now();
        step();
      }
      do step();
      while (!application_->studio().made());
      times.push_back(seconds_since(began));
      settle();
    }
    line("a style's strength, dragged to all frames made",
         printed("%.2f s median of %d, %.2f s at most, for %d frames", quantile(times, 0.5), kTries,
                 quantile(times, 1), frame_count(application_->session())));
  }

  void memory() {
    double after[2] = {0, 0};
    for (double& mb : after) {
      for (int frame = 0; frame < frame_count(application_->session()); ++frame) {
        command("playback.frame", {std::to_string(frame)});
        application_->frame(1.0 / 60);
        application_->studio().cache().wait();
        application_->frame(1.0 / 60);
      }
      mb = resident_mb();
    }
    line("memory, all frames looked at",
         printed("%.0f MB, after the second time %.0f MB (x %.3f)", after[0], after[1], after[1] / after[0]));
  }

  double seconds_;
  InputCounter counter_;
  OffscreenSurface* surface_ = nullptr;
  std::unique_ptr<Application> application_;
};

}  // namespace

int bench_ui(const UiBenchOptions& options) {
  UiBench bench(options);
  bench.run();
  std::printf("%-44s %s\n", "machine", processor().c_str());
  return 0;
}

}  // namespace understudy::app
