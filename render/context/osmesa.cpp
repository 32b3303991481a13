// OSMesa: Mesa's software renderer with no EGL, X or kernel driver at all.
#include <array>

#include "render/context/backends.hpp"
#include "retarget/base/error.hpp"

namespace understudy::render {
namespace {

// The few declarations of GL/osmesa.h that are needed; that header needs GL/gl.h, which clashes with the core
// one.
using OsContext = void*;
constexpr int kFormat = 0x22, kDepthBits = 0x30, kProfile = 0x33, kCoreProfile = 0x34, kMajor = 0x36,
              kMinor = 0x37;

struct OsMesa {
  Library library{"libOSMesa.so.8"};
  OsContext (*create)(const int*, OsContext) =
      function<OsContext (*)(const int*, OsContext)>(library, "OSMesaCreateContextAttribs");
  void (*destroy)(OsContext) = function<void (*)(OsContext)>(library, "OSMesaDestroyContext");
  GLboolean (*make_current)(OsContext, void*, GLenum, GLsizei, GLsizei) =
      function<GLboolean (*)(OsContext, void*, GLenum, GLsizei, GLsizei)>(library, "OSMesaMakeCurrent");
  void* (*address)(const char*) = function<void* (*)(const char*)>(library, "OSMesaGetProcAddress");
};

class OsMesaContext final : public Context {
 public:
  OsMesaContext() {
    const int wanted[] = {kFormat, GL_RGBA, kDepthBits, 0, kProfile, kCoreProfile,
                          kMajor,  3,       kMinor,     3, 0,        0};
    context_ = osmesa_.create(wanted, nullptr);
    US_CHECK(context_ != nullptr, "OSMesa cannot make an OpenGL 3.3 core context");
  }

  ~OsMesaContext() override {
    if (gl::api_or_null() == &functions_) {
      gl::set_api(nullptr);
      osmesa_.make_current(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0);
    }
    osmesa_.destroy(context_);
  }

  void make_current() override {
    US_CHECK(osmesa_.make_current(context_, pixels_.data(), GL_UNSIGNED_BYTE, kSize, kSize) == GL_TRUE,
             "OSMesa cannot make its context current");
    if (functions_.Clear == nullptr)
      functions_ = gl::load_functions([this](const char* name) { return osmesa_.address(name); });
    gl::set_api(&functions_);
  }

  std::string description() const override {
    return std::string("OSMesa, ") + reinterpret_cast<const char*>(functions_.GetString(GL_RENDERER));
  }

 private:
  static constexpr int kSize = 16;  // its own surface is never drawn to, but must exist
  OsMesa osmesa_;
  std::array<unsigned char, kSize * kSize * 4> pixels_{};
  OsContext context_ = nullptr;
  gl::Functions functions_;
};

}  // namespace

std::unique_ptr<Context> make_osmesa_context(bool) {
  return std::make_unique<OsMesaContext>();
}

}  // namespace understudy::render
