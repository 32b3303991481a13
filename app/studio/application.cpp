#include "app/studio/application.hpp"

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <sstream>
#include <utility>

#include "app/run/version.hpp"
#include "app/session/follow.hpp"
#include "app/session/shown_pose_sender.hpp"
#include "app/studio/facts.hpp"
#include "app/studio/window_commands.hpp"
#include "render/gl/functions.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "ui/panels/panel.hpp"
#include "ui/panels/workspace.hpp"
#include "ui/viewport/panes.hpp"
#include "ui/viewport/views.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;
using render::InputEvent;
using Kind = InputEvent::Kind;

constexpr double kFastest = 1.0 / 60;    // seconds between frames
constexpr double kSharing = 1.0 / 24;    // the same while frames are being made
constexpr double kBriefest = 0.001;      // of a look at what happens
constexpr double kListening = 0.008;     // between looks at what works in the background
constexpr double kTooltips = 1.0;        // after the last input things may still appear by themselves
constexpr double kLookingAround = 0.05;  // between frames in that time
constexpr double kBlink = 0.25;          // while a text is being typed
constexpr double kBarMoves = 0.2;        // a job's bar: what draws less often leaves the job the cores
constexpr double kAsleep = 0.5;          // between looks at nothing, for autosave
constexpr double kLongest = 0.25;        // time that one frame plays: after a sleep nothing jumps
constexpr int kSettling = 3;             // frames that widgets take to come to rest
constexpr size_t kLogLines = 2000;
constexpr int kMostFailures = 10;  // frames on end

constexpr render::PixelSize kCardPicture{448, 256};

/// What the start screen offers: those of the bundled samples that are there.
std::vector<ui::SampleCard> sample_cards(const std::string& folder) {
  const struct {
    const char *title, *caption;
    std::vector<std::string> files;
    std::vector<std::string> then{};
    std::string up{};
  } kCards[] = {
      {"A dance, by a heavy man", "87 scans and a target", {"scan", "target_adult.glb"}},
      {"A walk, by a girl of six", "45 scans and a target", {"walk", "target_child.glb"}},
      {"The dance alone", "87 scans, for your own target", {"scan"}},
      {"An animal's walk",
       "48 scans, to find its skeleton in",
       {"animal"},
       {"source.up y", "panel.show bones on"},
       "y"},
  };
  std::vector<ui::SampleCard> cards;
  for (const auto& one : kCards) {
    ui::SampleCard card{one.title, one.caption, {}, nullptr, one.then, one.up};
    for (const std::string& file : one.files) card.paths.push_back((fs::path(folder) / file).string());
    const bool all =
        std::all_of(card.paths.begin(), card.paths.end(), [](const auto& p) { return fs::exists(p); });
    if (!folder.empty() && all) cards.push_back(std::move(card));
  }
  return cards;
}

double seconds_between(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace

/// Lines of the log, from any thread.
struct Application::LogBox {
  std::mutex mutex;
  std::vector<LogLine> lines;
  log::Sink before;
  bool echo = true;
};

Application::Application(StudioServices services, std::unique_ptr<Surface> surface,
                         ApplicationOptions options)
    : options_(std::move(options)), surface_(std::move(surface)), log_(std::make_shared<LogBox>()) {
  log_->echo = options_.echo_log;
  log_->before = log::set_sink([box = log_](log::Level level, const std::string& text) {
    const std::lock_guard lock(box->mutex);
    box->lines.push_back({level == log::Level::Warning, text});
    if (box->echo && box->before) box->before(level, text);
  });
  studio_ = std::make_unique<Studio>(std::move(services));
  surface_->context().make_current();
  gui_ = std::make_unique<ui::Gui>(
      ui::Clipboard{[this] { return surface_->clipboard(); },
                    [this](const std::string& text) { surface_->set_clipboard(text); }});
  pass_ = std::make_unique<ui::DrawPass>();
  views_ = std::make_unique<ui::Views>();
  previews_ = std::make_unique<Previews>();
  study_pictures_ = std::make_unique<StudyPictures>(studio_->services());
  workspace_ = make_workspace();
  add_window_commands(studio_->commands(), *workspace_);
  ticked_at_ = drawn_at_ = input_at_ = Clock::now();
}

std::unique_ptr<ui::Workspace> Application::make_workspace() {
  ui::WorkspaceServices services;
  services.draw_views = [this] {
    ui::PanelContext context{gui_->ui(), queue_, studio_->commands()};
    views_->draw(session(), studio_->cache(), context);
  };
  services.samples = sample_cards(studio_->services().samples);
  samples_ = services.samples.size();
  services.about = [this] {
    return std::string(kProgram) + "\n" + surface_->context().description() +
           "\nWeights: " + (session().weights.empty() ? "not loaded yet" : session().weights);
  };
  auto workspace = std::make_unique<ui::Workspace>(std::move(services));
  if (const std::string& samples = studio_->services().samples; !samples.empty())
    workspace->browser().places.push_back({"Samples", samples, ui::Icon::Person});
  workspace->browser().preview = [this](const std::string& path) {
    const FilePreview& preview = previews_->of({path}, {320, 320}, session().settings.dark);
    return ui::FilePreview{preview.texture, static_cast<float>(preview.width),
                           static_cast<float>(preview.height), preview.text};
  };
  return workspace;
}

Application::~Application() {
  studio_.reset();  // its threads may still log
  log::set_sink(log_->before);
}

void Application::frame(double dt) {
  const std::vector<InputEvent> events = surface_->events(0);
  tick_and_draw(dt, [&] { draw(dt, events); });
}

bool Application::attempt(const std::function<void()>& part) {
  try {
    part();
    return true;
  } catch (const std::exception& error) {
    if (failures_ + 1 >= kMostFailures) throw;
    gui_->abandon_frame();
    const auto& errors = session().errors;
    if (errors.empty() || errors.back().text != error.what())
      studio_->fail(error.what(), "a frame of the studio");
    frames_wanted_ = kSettling;
    return false;
  }
}

/// Where frame after frame goes wrong nobody can read the dialog: the studio ends, and keeps what is unsaved.
void Application::tick_and_draw(double tick_dt, const std::function<void()>& drawing) {
  const bool ticked = attempt([&] { studio_->tick(tick_dt, std::min(tick_dt, kLongest)); }),
             drawn = attempt(drawing);
  failures_ = ticked && drawn ? 0 : failures_ + 1;
}

void Application::step() {
  const std::vector<InputEvent> events = surface_->events(patience_s());
  const Clock::time_point now = Clock::now();
  const double tick_dt = seconds_between(ticked_at_, now);
  ticked_at_ = now;
  if (!events.empty()) input_at_ = now;
  tick_and_draw(tick_dt, [&] {
    if (!events.empty() || due()) draw(std::min(seconds_between(drawn_at_, now), kLongest), events);
  });
}

void Application::run() {
  while (!session().quit) step();
}

/// The shortest time between two frames that no input asks for. While frames are being made they get half of
/// it at least.
double Application::fastest_s() const {
  return session().working ? std::max(kSharing, 2 * drawing_took_s_) : kFastest;
}

/// Whether the screen no longer shows what is.
bool Application::due() const {
  const Clock::time_point now = Clock::now();
  const double since_drawn = seconds_between(drawn_at_, now);
  if (since_drawn < fastest_s()) return false;
  if (frames_wanted_ > 0 || gui_->pending() || gui_->ui().moves()) return true;
  if (seconds_between(input_at_, now) < kTooltips && since_drawn > kLookingAround) return true;
  if (gui_->wants_text() && since_drawn > kBlink) return true;
  if (!session().jobs.empty() && since_drawn > kBarMoves) return true;
  return fingerprint(arrived()) != on_screen_;
}

/// How long nothing can happen but input, seconds.
double Application::patience_s() const {
  const Clock::time_point now = Clock::now();
  if (frames_wanted_ > 0 || gui_->pending()) return std::max(0.0, kFastest - seconds_between(drawn_at_, now));
  const Session& s = session();
  if (s.playback.playing || s.map.performance || s.view.turntable_deg_s != 0 || gui_->ui().moves() ||
      !studio_->idle() || study_pictures_->busy())
    return std::clamp(fastest_s() - seconds_between(drawn_at_, now), kBriefest, kListening);
  if (seconds_between(input_at_, now) < kTooltips) return kLookingAround;
  const double patience = gui_->wants_text() ? kBlink : kAsleep;
  return s.sends_to.empty() ? patience : std::min(patience, ShownPoseSender::kStillEvery_s);
}

/// Pictures and looks that other threads have made.
int64_t Application::arrived() const {
  return studio_->cache().made() + views_->arrived() + study_pictures_->made();
}

/// Changes with all that a frame shows and that no command changed.
std::string Application::fingerprint(int64_t arrived) const {
  const Session& s = session();
  std::string key = key_of(shown_frame(s), s.source.frames.size(), s.source.generation, s.notices.size(),
                           s.notices_made, s.errors.size(), s.question.has_value(), s.working, s.log.size(),
                           s.changed, s.truth != nullptr, arrived, s.view, s.flat.generation, s.sends_to);
  for (const TakeState& take : s.takes)
    key += key_of(take.ready, take.problem, take.paint_problem, take.generation, take.shown.poses.size(),
                  take.performed.size(), take.series.size(), take.as_loaded != nullptr, take.flat != nullptr);
  for (const JobView& job : s.jobs) key += key_of(job.id);
  if (const auto said = status_line(s)) key += key_of(said->text);
  return key;
}

bool Application::waiting() const {
  return views_->waiting() || previews_->busy() || study_pictures_->busy() || gui_->pending();
}

bool Application::shows_take(int k) const {
  return views_->shows_take(k);
}

/// The start screen's pictures, one a frame as they come.
void Application::show_previews() {
  if (session().document.source.path.empty() && session().document.takes.empty()) {
    for (size_t i = 0; i < samples_; ++i) {
      ui::SampleCard& card = workspace_->sample(i);
      card.picture = previews_->of(card.paths, kCardPicture, session().settings.dark, card.up).texture;
    }
  }
  const bool is_file = previews_->update(), is_trial = study_pictures_->update();
  if (is_file || is_trial) frames_wanted_ = kSettling;
}

ui::TrialPicture Application::trial_picture(float share) {
  const StudyState& state = session().study;
  const int i = chosen(state, StudyList::Trial);
  if (i < 0 || !studio_->services().networks) return {};
  return study_pictures_->of(*state.study, state.trials[static_cast<size_t>(i)], share);
}

void Application::handle(const InputEvent& event) {
  if (event.kind == Kind::Drop) queue_.emplace_back("open", event.paths);
  if (event.kind == Kind::Close) queue_.emplace_back("app.quit", Arguments{});
  if (event.kind != Kind::Resize || !options_.remember_size || event.width <= 0 || event.scale <= 0) return;
  Settings& settings = studio_->session().settings;
  settings.window_width = event.width, settings.window_height = event.height;
}

void Application::draw(double dt, const std::vector<InputEvent>& events) {
  drawn_at_ = Clock::now();                  // when it began: what takes long must not be waited for on top
  const int64_t arrived_before = arrived();  // what comes while it is drawn may not be in it
  if (observer_) observer_->input(dt, events, session());
  for (const InputEvent& event : events) handle(event);
  frames_wanted_ = events.empty() ? std::max(0, frames_wanted_ - 1) : kSettling;
  take_log();
  const render::RenderTarget target = surface_->target();
  if (target.size.width > 0 && target.size.height > 0) draw_interface(dt, events);
  on_screen_ = fingerprint(arrived_before);
  drawing_took_s_ = seconds_between(drawn_at_, Clock::now());
  run_queue();
  show_state();
}

void Application::draw_interface(double dt, const std::vector<InputEvent>& events) {
  const Session& s = session();
  const render::RenderTarget target = surface_->target();
  if (dt > 0) frame_rate_ += 0.1f * (static_cast<float>(1 / dt) - frame_rate_);
  ui::FrameInput input;
  input.size = target.size;
  input.scale = s.settings.scale > 0 ? s.settings.scale : surface_->content_scale();
  input.dt = static_cast<float>(dt);
  input.theme = s.settings.dark ? ui::ThemeKind::Dark : ui::ThemeKind::Light;
  surface_->context().make_current();
  show_previews();
  if (!ui::has_document(s)) views_->forget();
  gui_->begin_frame(input, events);
  ui::PanelContext context{gui_->ui(), queue_, studio_->commands()};
  context.trial_picture = [this](float share) { return trial_picture(share); };
  workspace_->draw(s, context, frame_rate_);
  const ImDrawData& data = gui_->end_frame();
  pass_->present(data, gui_->atlas(), target, gui_->ui().theme().backdrop);
  surface_->present();
  surface_->set_cursor(gui_->cursor());
  if (++drawn_ == 1) studio_->warm_up();
}

/// Runs the commands that the interface pushed; the next frame shows their effect.
void Application::run_queue() {
  if (queue_.empty()) return;
  if (observer_)
    for (const auto& [name, arguments] : queue_) observer_->command(name, arguments);
  studio_->run_all(queue_);
  frames_wanted_ = kSettling;
}

void Application::take_log() {
  std::vector<LogLine> lines;
  {
    const std::lock_guard lock(log_->mutex);
    lines.swap(log_->lines);
  }
  auto& log = studio_->session().log;
  for (LogLine& line : lines) line.time = session().time;
  log.insert(log.end(), lines.begin(), lines.end());
  while (log.size() > kLogLines) log.pop_front();
}

/// The window's title, and the marks file.
void Application::show_state() {
  const Session& s = session();
  const std::string name = s.path.empty() ? "Untitled" : std::filesystem::path(s.path).stem().string();
  surface_->set_title((s.changed || s.study.changed ? "● " : "") + name + " — Understudy");
  if (!options_.marks_file.empty()) write_marks();
}

std::vector<ui::Mark> Application::marks() const {
  std::vector<ui::Mark> all = gui_->marks();
  for (const ui::PaneContent& pane : ui::panes_of(session())) {
    const ui::Mark* view = gui_->find("view." + std::to_string(pane.number));
    std::optional<Joints> joints;
    if (ui::shows_rest(session(), pane))
      joints = ui::rest_joints(session(), pane.takes[0]);
    else if (const Joints* now = pane_joints(session(), pane.number, ui::pane_frame(session(), pane)))
      joints = *now;
    if (!view || view->rect.empty() || !joints) continue;
    const ui::PaneView whole{view->rect, ui::pane_camera(session(), pane)};
    const ui::PaneView seen = whole.shifted(ui::aside(session(), pane, pane.number));
    for (int j = 0; j < kJointCount; ++j) {
      const auto at = seen.project(joints->row(j));
      if (!at || !view->rect.contains(*at)) continue;
      const ui::Rect place{{at->x - 1, at->y - 1}, {at->x + 1, at->y + 1}};
      all.push_back({"joint." + std::to_string(pane.number) + "." + kJointNames[j], place, place, true});
    }
  }
  return all;
}

std::optional<ui::Mark> Application::find(const std::string& name) const {
  if (const ui::Mark* found = gui_->find(name)) return *found;
  if (starts_with(name, "joint."))
    for (const ui::Mark& mark : marks())
      if (mark.name == name) return mark;
  return std::nullopt;
}

void Application::write_marks() {
  std::ostringstream text;
  for (const auto& [key, value] : facts(session())) text << join_line("fact", {key, value}) << '\n';
  text << join_line("fact", {"focus", focus()}) << '\n';
  text << join_line("fact", {"pointer", gui_->pointer()}) << '\n';
  for (std::string& shown : shown_texts(session())) {
    std::replace(shown.begin(), shown.end(), '\n', ' ');
    text << join_line("text", {shown}) << '\n';
  }
  for (const ui::Mark& mark : marks()) {
    if (mark.visible.empty()) continue;
    text << join_line("mark", {mark.name}) << ' ' << mark.visible.min.x << ' ' << mark.visible.min.y << ' '
         << mark.visible.max.x << ' ' << mark.visible.max.y << (mark.enabled ? "" : " disabled") << '\n';
  }
  if (text.str() == marks_) return;
  marks_ = text.str();
  write_file(options_.marks_file, marks_, /*synced=*/false);
}

}  // namespace understudy::app
