#include "ui/gui/gui.hpp"

#include <imgui_freetype.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include "retarget/base/log.hpp"

namespace understudy::ui {
namespace {

using render::InputEvent;
using render::Key;
using Kind = InputEvent::Kind;

constexpr size_t kKeys = static_cast<size_t>(Key::Count);
static_assert(kKeys <= 512, "ImGui keeps 512 keys");

constexpr float kBody = 16, kSmall = 14, kTitle = 23;  // line heights in pixels at scale 1

// Latin, Greek, Cyrillic, and the signs of captions, units and keys.
constexpr ImWchar kWords[] = {0x20,   0xFF,   0x100,  0x17F,  0x370,  0x3FF,  0x400,  0x45F,  0x2010, 0x2027,
                              0x2032, 0x2033, 0x2070, 0x2089, 0x2190, 0x2193, 0x21E7, 0x21E7, 0x2206, 0x2206,
                              0x2212, 0x2212, 0x221E, 0x221E, 0x2248, 0x2248, 0x2260, 0x2265, 0};

std::string first_existing(std::initializer_list<const char*> paths) {
  for (const char* path : paths)
    if (std::filesystem::exists(path)) return path;
  return {};
}

std::string regular_file() {
  return first_existing({"/usr/share/fonts/opentype/inter/Inter-Regular.otf",
                         "/usr/share/fonts/truetype/inter/Inter-Regular.ttf",
                         "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"});
}

std::string strong_file() {
  return first_existing({"/usr/share/fonts/opentype/inter/Inter-SemiBold.otf",
                         "/usr/share/fonts/truetype/inter/Inter-SemiBold.ttf",
                         "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"});
}

ImFont* add(ImFontAtlas& atlas, const std::string& file, float size) {
  ImFontConfig config;
  config.PixelSnapH = true;
  config.FontBuilderFlags = ImGuiFreeTypeBuilderFlags_LightHinting;
  if (!file.empty())
    if (ImFont* font = atlas.AddFontFromFileTTF(file.c_str(), size, &config, kWords)) return font;
  log::warn_once("no font found (fonts-inter): the interface uses a plain one");
  config.SizePixels = std::round(size * 0.8f);
  return atlas.AddFontDefault(&config);
}

/// Gives every digit the widest digit's advance, each in the middle of it.
void make_digits_equal(ImFont& font) {
  float widest = 0;
  for (ImWchar c = '0'; c <= '9'; ++c) widest = std::max(widest, font.GetCharAdvance(c));
  for (ImFontGlyph& glyph : font.Glyphs) {
    if (glyph.Codepoint < '0' || glyph.Codepoint > '9') continue;
    const float shift = std::floor((widest - glyph.AdvanceX) / 2);
    glyph.X0 += shift, glyph.X1 += shift, glyph.AdvanceX = widest;
  }
  font.BuildLookupTable();
}

/// Fills an empty atlas with Inter (else DejaVu Sans, else ImGui's own, with a warning in the log) and makes
/// its pixels. `scale` 1 to 3. Digits are all equally wide, so that numbers that change stay in place.
Fonts load_fonts(ImFontAtlas& atlas, float scale) {
  const std::string regular = regular_file(), strong = strong_file();
  const auto size = [scale](float at_one) { return std::round(at_one * scale); };
  atlas.FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
  atlas.Flags |= ImFontAtlasFlags_NoMouseCursors;
  Fonts fonts;
  fonts.body = add(atlas, regular, size(kBody));
  fonts.strong = add(atlas, strong, size(kBody));
  fonts.title = add(atlas, strong, size(kTitle));
  fonts.small = add(atlas, regular, size(kSmall));
  atlas.Build();
  for (ImFont* font : atlas.Fonts) make_digits_equal(*font);
  return fonts;
}

/// Keys that write a character: their order against Char events of one frame does not matter.
bool writes(Key key) {
  return (key >= Key::A && key <= Key::Digit9) || (key >= Key::Apostrophe && key <= Key::Grave) ||
         key == Key::Space || key >= Key::LeftShift;
}

}  // namespace

struct Gui::Changes {
  bool moved = false, scrolled = false, typed = false, commanded = false;
  bool key_down = false;        // a key that is no modifier
  bool pressed = false;         // such a key or a button, down or up
  render::Modifiers modifiers;  // that were held then
  std::bitset<static_cast<size_t>(render::MouseButton::Count)> buttons;
  std::bitset<kKeys> keys;
};

Gui::Gui(Clipboard clipboard) : clipboard_(std::move(clipboard)) {
  if (!clipboard_.get) clipboard_.get = [this] { return copied_; };
  if (!clipboard_.set) clipboard_.set = [this](const std::string& text) { copied_ = text; };
  IMGUI_CHECKVERSION();
  ImGuiContext* before = ImGui::GetCurrentContext();
  context_ = ImGui::CreateContext();
  ImGui::SetCurrentContext(context_);
  io().IniFilename = nullptr;
  io().LogFilename = nullptr;
  io().BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset | ImGuiBackendFlags_HasMouseCursors;
  io().ConfigWindowsMoveFromTitleBarOnly = true;
  io().ClipboardUserData = this;
  io().GetClipboardTextFn = [](void* self) {
    Gui& gui = *static_cast<Gui*>(self);
    gui.pasted_ = gui.clipboard_.get();
    return gui.pasted_.c_str();
  };
  io().SetClipboardTextFn = [](void* self, const char* text) {
    static_cast<Gui*>(self)->clipboard_.set(text);
  };
  set_up_keys();
  if (before != nullptr) ImGui::SetCurrentContext(before);
}

Gui::~Gui() {
  ImGui::DestroyContext(context_);
}

const ImGuiIO& Gui::io() const {
  return const_cast<Gui*>(this)->io();
}

ImGuiIO& Gui::io() {
  ImGuiContext* before = ImGui::GetCurrentContext();
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  if (before != nullptr) ImGui::SetCurrentContext(before);
  return io;
}

void Gui::set_up_keys() {
  constexpr std::pair<ImGuiKey_, Key> kMap[] = {
      {ImGuiKey_Tab, Key::Tab},
      {ImGuiKey_LeftArrow, Key::Left},
      {ImGuiKey_RightArrow, Key::Right},
      {ImGuiKey_UpArrow, Key::Up},
      {ImGuiKey_DownArrow, Key::Down},
      {ImGuiKey_PageUp, Key::PageUp},
      {ImGuiKey_PageDown, Key::PageDown},
      {ImGuiKey_Home, Key::Home},
      {ImGuiKey_End, Key::End},
      {ImGuiKey_Insert, Key::Insert},
      {ImGuiKey_Delete, Key::Delete},
      {ImGuiKey_Backspace, Key::Backspace},
      {ImGuiKey_Space, Key::Space},
      {ImGuiKey_Enter, Key::Enter},
      {ImGuiKey_Escape, Key::Escape},
      {ImGuiKey_KeyPadEnter, Key::KeypadEnter},
      {ImGuiKey_A, Key::A},
      {ImGuiKey_C, Key::C},
      {ImGuiKey_V, Key::V},
      {ImGuiKey_X, Key::X},
      {ImGuiKey_Y, Key::Y},
      {ImGuiKey_Z, Key::Z},
  };
  for (const auto& [theirs, ours] : kMap) io().KeyMap[theirs] = static_cast<int>(ours);
}

void Gui::begin_frame(const FrameInput& input, const std::vector<InputEvent>& events) {
  ImGui::SetCurrentContext(context_);
  io().DisplaySize = {static_cast<float>(input.size.width), static_cast<float>(input.size.height)};
  set_look(input);
  queue_.insert(queue_.end(), events.begin(), events.end());
  io().DeltaTime = std::max(input.dt, 1e-6f);
  Changes changes;
  Focus& focus = ui_.focus_;
  while (!queue_.empty() && !focus.moving() && fits(queue_.front(), changes)) {
    apply(queue_.front(), changes);
    queue_.pop_front();
  }
  io().ConfigFlags = Focus::in_menu() ? ImGuiConfigFlags_NavEnableKeyboard : ImGuiConfigFlags_None;
  ImGui::NewFrame();
  focus.begin_frame();
}

const ImDrawData& Gui::end_frame() {
  ui_.focus_.finish_frame(ui_);
  ImGui::Render();
  ui_.finish_frame();
  return *ImGui::GetDrawData();
}

void Gui::abandon_frame() {
  ImGui::SetCurrentContext(context_);
  if (!context_->WithinFrameScope) return;
  ImGui::ErrorCheckEndFrameRecover(nullptr);
  ImGui::EndFrame();
  ui_.finish_frame();
}

void Gui::set_look(const FrameInput& input) {
  const ImVec2 display = io().DisplaySize;
  // in steps: letters cost 20 ms
  const float room = std::floor(4 * std::min(display.x / 360, display.y / 240)) / 4;
  const float scale = std::clamp(input.scale, 1.f, std::clamp(room, 1.f, 3.f));
  const Theme& wanted = theme(input.theme);
  const bool first = ui_.fonts_.body == nullptr;
  if (first || scale != ui_.scale_) {
    io().Fonts->Clear();
    ui_.fonts_ = load_fonts(*io().Fonts, scale);
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io().Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
  }
  if (first || scale != ui_.scale_ || &wanted != ui_.theme_) ui::apply(wanted, scale, ImGui::GetStyle());
  ui_.scale_ = scale;
  ui_.theme_ = &wanted;
}

/// Whether a frame that has seen `changes` would still notice the event in its right place.
bool Gui::fits(const InputEvent& event, const Changes& changes) const {
  const bool modified = event.kind == Kind::Key || event.kind == Kind::MouseButton;
  if (modified && changes.pressed && !(event.modifiers == changes.modifiers))
    return false;  // Ctrl may be let go before the A of Ctrl+A was noticed
  const bool is_press = event.kind == Kind::Key && event.pressed && event.key < Key::LeftShift;
  if (is_press && changes.key_down && !wants_text())
    return false;  // the first may open what the second is typed into
  switch (event.kind) {
    case Kind::MouseMove:
      return changes.buttons.none() && !changes.scrolled;
    case Kind::MouseButton:  // a drag must see its last place before it ends
      return !changes.buttons[static_cast<size_t>(event.button)] && !changes.scrolled &&
             (event.pressed || !changes.moved);
    case Kind::Scroll:
      return changes.buttons.none();
    case Kind::Key:
      return !changes.keys[static_cast<size_t>(event.key)] && changes.buttons.none() &&
             (writes(event.key) ? !changes.commanded : !changes.typed && !changes.commanded);
    case Kind::Char:
      return !changes.commanded && changes.buttons.none();
    default:
      return true;
  }
}

void Gui::apply(const InputEvent& event, Changes& changes) {
  ImGuiIO& to = io();
  if (event.kind == Kind::Key || event.kind == Kind::MouseButton) {
    to.KeyShift = event.modifiers.shift, to.KeyCtrl = event.modifiers.control;
    to.KeyAlt = event.modifiers.alt, to.KeySuper = event.modifiers.super;
    changes.key_down |= event.kind == Kind::Key && event.pressed && event.key < Key::LeftShift;
    changes.pressed |= event.kind == Kind::MouseButton || event.key < Key::LeftShift;
    changes.modifiers = event.modifiers;
  }
  if (ui_.focus_.take(event)) {
    changes.commanded = true;
    return;
  }
  switch (event.kind) {
    case Kind::MouseMove:
      to.MousePos = {event.x, event.y};
      changes.moved = true;
      break;
    case Kind::MouseButton:
      to.MousePos = {event.x, event.y};
      to.MouseDown[static_cast<size_t>(event.button)] = event.pressed;
      changes.buttons.set(static_cast<size_t>(event.button));
      break;
    case Kind::Scroll:
      to.MousePos = {event.x, event.y};
      to.MouseWheel += event.dy, to.MouseWheelH += event.dx;
      changes.scrolled = true;
      break;
    case Kind::Key:
      if (event.repeated) break;  // ImGui repeats held keys itself
      to.KeysDown[static_cast<size_t>(event.key)] = event.pressed;
      changes.keys.set(static_cast<size_t>(event.key));
      changes.commanded |= !writes(event.key);
      break;
    case Kind::Char:
      to.AddInputCharacter(static_cast<unsigned>(event.codepoint));
      changes.typed = true;
      break;
    case Kind::Focus:
      if (!event.pressed) release_all();
      break;
    default:  // drops, sizes and closing are the application's
      break;
  }
}

/// Without the focus no release arrives, so nothing may stay pressed.
void Gui::release_all() {
  ImGuiIO& to = io();
  std::fill(std::begin(to.KeysDown), std::end(to.KeysDown), false);
  std::fill(std::begin(to.MouseDown), std::end(to.MouseDown), false);
  to.KeyShift = to.KeyCtrl = to.KeyAlt = to.KeySuper = false;
}

std::string Gui::pointer() const {
  const ImGuiIO& now = io();
  const auto whole = [](float at) { return std::to_string(static_cast<int>(std::clamp(at, -1.0f, 1e6f))); };
  return whole(now.MousePos.x) + " " + whole(now.MousePos.y) + (now.MouseDown[0] ? " down" : "");
}

render::CursorShape Gui::cursor() const {
  ImGui::SetCurrentContext(context_);
  using Shape = render::CursorShape;
  // In the order of ImGuiMouseCursor_: Arrow, TextInput, ResizeAll, NS, EW, NESW, NWSE, Hand, NotAllowed.
  constexpr std::array<Shape, ImGuiMouseCursor_COUNT> kShapes = {
      Shape::Arrow,     Shape::Text,      Shape::ResizeAll, Shape::ResizeVertical, Shape::ResizeHorizontal,
      Shape::ResizeAll, Shape::ResizeAll, Shape::Hand,      Shape::Arrow};
  const int wanted = ImGui::GetMouseCursor();
  return wanted == ImGuiMouseCursor_None ? Shape::Hidden : kShapes[wanted];
}

bool key_pressed(Key key, bool repeat) {
  return ImGui::IsKeyPressed(static_cast<int>(key), repeat);
}

}  // namespace understudy::ui
