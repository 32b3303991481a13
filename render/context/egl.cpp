// Surfaceless EGL: draws into framebuffer objects only, so it needs neither a display nor a surface.
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "render/context/backends.hpp"
#include "retarget/base/error.hpp"

namespace understudy::render {
namespace {

struct Egl {
  Library library{"libEGL.so.1"};
#define UNDERSTUDY_EGL(name) \
  decltype(&::egl##name) name = function<decltype(&::egl##name)>(library, "egl" #name);
  UNDERSTUDY_EGL(GetProcAddress)
  UNDERSTUDY_EGL(GetPlatformDisplay)
  UNDERSTUDY_EGL(Initialize)
  UNDERSTUDY_EGL(BindAPI)
  UNDERSTUDY_EGL(CreateContext)
  UNDERSTUDY_EGL(DestroyContext)
  UNDERSTUDY_EGL(MakeCurrent)
#undef UNDERSTUDY_EGL
};

class EglContext final : public Context {
 public:
  explicit EglContext(bool debug) {
    display_ = egl_.GetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    US_CHECK(display_ != EGL_NO_DISPLAY, "EGL has no surfaceless display");
    US_CHECK(egl_.Initialize(display_, nullptr, nullptr) == EGL_TRUE, "EGL does not start");
    US_CHECK(egl_.BindAPI(EGL_OPENGL_API) == EGL_TRUE, "EGL has no desktop OpenGL");
    const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                             3,
                             EGL_CONTEXT_MINOR_VERSION,
                             3,
                             EGL_CONTEXT_OPENGL_PROFILE_MASK,
                             EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                             EGL_CONTEXT_OPENGL_DEBUG,
                             debug ? EGL_TRUE : EGL_FALSE,
                             EGL_NONE};
    context_ = egl_.CreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
    US_CHECK(context_ != EGL_NO_CONTEXT, "EGL cannot make an OpenGL 3.3 core context");
  }

  // The display stays open: it is one for the whole process, and other contexts may be using it.
  ~EglContext() override {
    if (gl::api_or_null() == &functions_) {
      gl::set_api(nullptr);
      egl_.MakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    egl_.DestroyContext(display_, context_);
  }

  void make_current() override {
    egl_.BindAPI(EGL_OPENGL_API);
    US_CHECK(egl_.MakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE,
             "EGL cannot make its context current");
    if (functions_.Clear == nullptr)
      functions_ = gl::load_functions(
          [this](const char* name) { return reinterpret_cast<void*>(egl_.GetProcAddress(name)); });
    gl::set_api(&functions_);
  }

  std::string description() const override {
    return std::string("EGL, ") + reinterpret_cast<const char*>(functions_.GetString(GL_RENDERER));
  }

 private:
  Egl egl_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
  gl::Functions functions_;
};

}  // namespace

std::unique_ptr<Context> make_egl_context(bool debug) {
  return std::make_unique<EglContext>(debug);
}

}  // namespace understudy::render
