// A window and its context by GLFW.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <array>
#include <cstdlib>
#include <exception>

#include "render/context/window.hpp"
#include "retarget/base/error.hpp"

namespace understudy::render {
namespace {

/// GLFW's own words for what went wrong last, for the end of a sentence: " (...)".
std::string last_words() {
  const char* words = nullptr;
  return glfwGetError(&words) == GLFW_NO_ERROR || words == nullptr ? "" : " (" + std::string(words) + ")";
}

/// GLFW started once for the process; it ends with it.
void start_glfw(bool software) {
  static bool started = false;
  if (started) return;
  if (software) setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);  // Mesa reads it when it loads its driver
  glfwInitHint(GLFW_JOYSTICK_HAT_BUTTONS, GLFW_FALSE);
  US_CHECK(glfwInit() == GLFW_TRUE, "no window can be opened: there is no display here", last_words());
  std::atexit(glfwTerminate);
  started = true;
}

GLFWwindow* opened(const WindowOptions& options) {
  start_glfw(options.software);
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, options.debug == gl::DebugMode::Off ? GLFW_FALSE : GLFW_TRUE);
  glfwWindowHint(GLFW_VISIBLE, options.visible ? GLFW_TRUE : GLFW_FALSE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);  // everything with depth is drawn into pictures of our own
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  glfwWindowHintString(GLFW_X11_CLASS_NAME, "understudy");
  glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "understudy");
  GLFWmonitor* const monitor = options.full_screen ? glfwGetPrimaryMonitor() : nullptr;
  const GLFWvidmode* const mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
  const int width = mode != nullptr ? mode->width : options.width;
  const int height = mode != nullptr ? mode->height : options.height;
  GLFWwindow* window = glfwCreateWindow(width, height, options.title.c_str(), monitor, nullptr);
  US_CHECK(window != nullptr, "the graphics driver has no OpenGL 3.3", last_words(),
           "; try the software renderer: --software, or LIBGL_ALWAYS_SOFTWARE=1 in the environment");
  return window;
}

/// Keys that follow one another here and in GLFW.
struct KeyRange {
  int first, last;  // GLFW's
  Key key;          // of the first
};
constexpr KeyRange kKeyRanges[] = {{GLFW_KEY_A, GLFW_KEY_Z, Key::A},
                                   {GLFW_KEY_0, GLFW_KEY_9, Key::Digit0},
                                   {GLFW_KEY_F1, GLFW_KEY_F12, Key::F1},
                                   {GLFW_KEY_KP_0, GLFW_KEY_KP_EQUAL, Key::Keypad0},
                                   {GLFW_KEY_ESCAPE, GLFW_KEY_END, Key::Escape},
                                   {GLFW_KEY_SPACE, GLFW_KEY_SPACE, Key::Space},
                                   {GLFW_KEY_APOSTROPHE, GLFW_KEY_APOSTROPHE, Key::Apostrophe},
                                   {GLFW_KEY_COMMA, GLFW_KEY_SLASH, Key::Comma},
                                   {GLFW_KEY_SEMICOLON, GLFW_KEY_SEMICOLON, Key::Semicolon},
                                   {GLFW_KEY_EQUAL, GLFW_KEY_EQUAL, Key::Equal},
                                   {GLFW_KEY_LEFT_BRACKET, GLFW_KEY_RIGHT_BRACKET, Key::LeftBracket},
                                   {GLFW_KEY_GRAVE_ACCENT, GLFW_KEY_GRAVE_ACCENT, Key::Grave},
                                   {GLFW_KEY_LEFT_SHIFT, GLFW_KEY_MENU, Key::LeftShift},
                                   {GLFW_KEY_CAPS_LOCK, GLFW_KEY_PAUSE, Key::CapsLock}};

Key key_from_glfw(int code) {
  for (const KeyRange& range : kKeyRanges)
    if (code >= range.first && code <= range.last)
      return static_cast<Key>(static_cast<int>(range.key) + code - range.first);
  return Key::Unknown;
}

/// GLFW names keys by their place on a US keyboard; for letters, the key's label counts (AZERTY).
Key key_as_labelled(int code, int scancode) {
  const Key placed = key_from_glfw(code);
  if (code < GLFW_KEY_APOSTROPHE || code > GLFW_KEY_GRAVE_ACCENT) return placed;
  const char* label = glfwGetKeyName(code, scancode);
  if (label == nullptr || label[0] == 0 || label[1] != 0) return placed;
  if (label[0] >= 'a' && label[0] <= 'z') return key_from_glfw(GLFW_KEY_A + label[0] - 'a');
  return placed;
}

Modifiers modifiers_of(int bits) {
  return {(bits & GLFW_MOD_SHIFT) != 0, (bits & GLFW_MOD_CONTROL) != 0, (bits & GLFW_MOD_ALT) != 0,
          (bits & GLFW_MOD_SUPER) != 0};
}

MouseButton button_of(int button) {
  constexpr MouseButton kButtons[] = {MouseButton::Left, MouseButton::Right, MouseButton::Middle,
                                      MouseButton::Back, MouseButton::Forward};
  return button >= 0 && button < 5 ? kButtons[button] : MouseButton::Count;
}

class GlfwContext final : public Context {
 public:
  explicit GlfwContext(GLFWwindow* window) : window_(window) {}
  ~GlfwContext() override {
    if (gl::api_or_null() != &functions_) return;
    gl::set_api(nullptr);
    glfwMakeContextCurrent(nullptr);
  }
  void make_current() override {
    glfwMakeContextCurrent(window_);
    US_CHECK(glfwGetCurrentContext() == window_, "the window's OpenGL context cannot be used", last_words());
    if (functions_.Clear == nullptr)
      functions_ = gl::load_functions(
          [](const char* name) { return reinterpret_cast<void*>(glfwGetProcAddress(name)); });
    gl::set_api(&functions_);
  }
  std::string description() const override {
    return std::string("window, ") + reinterpret_cast<const char*>(functions_.GetString(GL_RENDERER));
  }

 private:
  GLFWwindow* window_;
  gl::Functions functions_;
};

}  // namespace

struct Window::Parts {
  explicit Parts(const WindowOptions& options) : window(opened(options)), context(window) {
    glfwSetWindowUserPointer(window, this);
    listen();
  }
  ~Parts() {
    for (GLFWcursor* cursor : cursors)
      if (cursor != nullptr) glfwDestroyCursor(cursor);
    glfwSetWindowUserPointer(window, nullptr);
  }

  void listen();
  void listen_to_keys();
  void deliver(InputEvent event) noexcept;
  InputEvent at_pointer(InputEvent::Kind kind) const;
  void tell_size();
  void deliver() {
    if (failure) std::rethrow_exception(std::exchange(failure, nullptr));
  }
  static Parts& of(GLFWwindow* window) { return *static_cast<Parts*>(glfwGetWindowUserPointer(window)); }

  /// Destroyed after the context that draws into it.
  struct Handle {
    GLFWwindow* window;
    Handle(GLFWwindow* w) : window(w) {}  // NOLINT: converts
    ~Handle() { glfwDestroyWindow(window); }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    operator GLFWwindow*() const { return window; }  // NOLINT: converts
  };
  Handle window;
  GlfwContext context;
  Handler handler;
  std::exception_ptr failure;  ///< of the handler: an exception must not cross GLFW's C code
  std::array<GLFWcursor*, static_cast<size_t>(CursorShape::Count)> cursors{};
};

void Window::Parts::deliver(InputEvent event) noexcept {
  if (!handler || failure) return;
  try {
    handler(std::move(event));
  } catch (...) {
    failure = std::current_exception();
  }
}

InputEvent Window::Parts::at_pointer(InputEvent::Kind kind) const {
  double x = 0, y = 0;
  int width = 0, height = 0, pixels_wide = 0, pixels_high = 0;
  glfwGetCursorPos(window, &x, &y);
  glfwGetWindowSize(window, &width, &height);
  glfwGetFramebufferSize(window, &pixels_wide, &pixels_high);
  InputEvent event;
  event.kind = kind;
  event.x = static_cast<float>(width > 0 ? x * pixels_wide / width : x);
  event.y = static_cast<float>(height > 0 ? y * pixels_high / height : y);
  return event;
}

void Window::Parts::tell_size() {
  InputEvent event;
  event.kind = InputEvent::Kind::Resize;
  glfwGetFramebufferSize(window, &event.width, &event.height);
  glfwGetWindowContentScale(window, &event.scale, nullptr);
  deliver(std::move(event));
}

void Window::Parts::listen() {
  glfwSetCursorPosCallback(window, [](GLFWwindow* w, double, double) {
    of(w).deliver(of(w).at_pointer(InputEvent::Kind::MouseMove));
  });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int bits) {
    InputEvent event = of(w).at_pointer(InputEvent::Kind::MouseButton);
    event.button = button_of(button);
    event.pressed = action == GLFW_PRESS;
    event.modifiers = modifiers_of(bits);
    if (event.button != MouseButton::Count) of(w).deliver(std::move(event));
  });
  glfwSetScrollCallback(window, [](GLFWwindow* w, double dx, double dy) {
    InputEvent event = of(w).at_pointer(InputEvent::Kind::Scroll);
    event.dx = static_cast<float>(dx);
    event.dy = static_cast<float>(dy);
    of(w).deliver(std::move(event));
  });
  glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
    InputEvent event = of(w).at_pointer(InputEvent::Kind::Drop);
    event.paths.assign(paths, paths + count);
    of(w).deliver(std::move(event));
  });
  glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int focused) {
    InputEvent event;
    event.kind = InputEvent::Kind::Focus;
    event.pressed = focused == GLFW_TRUE;
    of(w).deliver(std::move(event));
  });
  glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { of(w).tell_size(); });
  glfwSetWindowContentScaleCallback(window, [](GLFWwindow* w, float, float) { of(w).tell_size(); });
  glfwSetWindowCloseCallback(window, [](GLFWwindow* w) {
    InputEvent event;
    event.kind = InputEvent::Kind::Close;
    of(w).deliver(std::move(event));
  });
  listen_to_keys();
}

void Window::Parts::listen_to_keys() {
  glfwSetKeyCallback(window, [](GLFWwindow* w, int code, int scancode, int action, int bits) {
    InputEvent event;
    event.kind = InputEvent::Kind::Key;
    event.key = key_as_labelled(code, scancode);
    event.pressed = action != GLFW_RELEASE;
    event.repeated = action == GLFW_REPEAT;
    event.modifiers = modifiers_of(bits);
    // For a modifier's own key X11 gives the state before it.
    if (event.key == Key::LeftShift || event.key == Key::RightShift) event.modifiers.shift = event.pressed;
    if (event.key == Key::LeftControl || event.key == Key::RightControl)
      event.modifiers.control = event.pressed;
    if (event.key == Key::LeftAlt || event.key == Key::RightAlt) event.modifiers.alt = event.pressed;
    if (event.key == Key::LeftSuper || event.key == Key::RightSuper) event.modifiers.super = event.pressed;
    if (event.key != Key::Unknown) of(w).deliver(std::move(event));
  });
  glfwSetCharCallback(window, [](GLFWwindow* w, unsigned codepoint) {
    InputEvent event;
    event.kind = InputEvent::Kind::Char;
    event.codepoint = codepoint;
    of(w).deliver(std::move(event));
  });
}

Window::Window(const WindowOptions& options) : parts_(std::make_unique<Parts>(options)) {
  parts_->context.make_current();
  glfwSwapInterval(options.vsync ? 1 : 0);
  gl::install_debug(options.debug);
}
Window::~Window() = default;
Window::Window(Window&&) noexcept = default;
Window& Window::operator=(Window&&) noexcept = default;

Context& Window::context() {
  return parts_->context;
}
std::pair<int, int> Window::size() const {
  std::pair<int, int> size;
  glfwGetFramebufferSize(parts_->window, &size.first, &size.second);
  return size;
}
float Window::content_scale() const {
  float scale = 1;
  glfwGetWindowContentScale(parts_->window, &scale, nullptr);
  return scale;
}
void Window::swap() {
  glfwSwapBuffers(parts_->window);
}

void Window::set_title(const std::string& title) {
  glfwSetWindowTitle(parts_->window, title.c_str());
}
void Window::set_size(int width, int height) {
  glfwSetWindowSize(parts_->window, width, height);
}

void Window::set_cursor(CursorShape shape) {
  // By CursorShape; 3.3 has no all-ways arrow, so the hand stands for it.
  constexpr int kShapes[] = {GLFW_ARROW_CURSOR,     GLFW_IBEAM_CURSOR,   GLFW_HAND_CURSOR,
                             GLFW_CROSSHAIR_CURSOR, GLFW_HRESIZE_CURSOR, GLFW_VRESIZE_CURSOR,
                             GLFW_HAND_CURSOR};
  glfwSetInputMode(parts_->window, GLFW_CURSOR,
                   shape == CursorShape::Hidden ? GLFW_CURSOR_HIDDEN : GLFW_CURSOR_NORMAL);
  const auto at = static_cast<size_t>(shape);
  if (at >= std::size(kShapes)) return;
  GLFWcursor*& cursor = parts_->cursors[at];
  if (cursor == nullptr) cursor = glfwCreateStandardCursor(kShapes[at]);
  glfwSetCursor(parts_->window, cursor);
}

std::string Window::clipboard() const {
  const char* text = glfwGetClipboardString(parts_->window);
  return text == nullptr ? "" : text;
}
void Window::set_clipboard(const std::string& text) {
  glfwSetClipboardString(parts_->window, text.c_str());
}

void Window::set_handler(Handler handler) {
  parts_->handler = std::move(handler);
}
void Window::poll() {
  glfwPollEvents();
  parts_->deliver();
}
void Window::wait(double seconds) {
  if (seconds > 0)
    glfwWaitEventsTimeout(seconds);
  else
    glfwPollEvents();
  parts_->deliver();
}
void Window::wake() {
  glfwPostEmptyEvent();
}

}  // namespace understudy::render
