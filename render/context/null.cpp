// A context that draws nothing: every function exists, names are handed out and counted, shaders always
// compile.
#include <algorithm>

#include "render/context/backends.hpp"

namespace understudy::render {
namespace {

thread_local NullCounts counts;
thread_local GLuint last_name = 0;

template <class F>
struct Nothing;
template <class R, class... Args>
struct Nothing<R (*)(Args...)> {
  static R call(Args...) { return R(); }
};

void make_names(GLsizei count, GLuint* names) {
  for (GLsizei i = 0; i < count; ++i) names[i] = ++last_name;
  counts.live_names += count;
}
void delete_names(GLsizei count, const GLuint*) {
  counts.live_names -= count;
}
GLuint make_name() {
  return ++counts.live_names, ++last_name;
}
void delete_name(GLuint) {
  --counts.live_names;
}

void count_names(gl::Functions& f) {
  f.GenBuffers = f.GenFramebuffers = f.GenRenderbuffers = f.GenTextures = f.GenVertexArrays = make_names;
  f.DeleteBuffers = f.DeleteFramebuffers = f.DeleteRenderbuffers = f.DeleteTextures = f.DeleteVertexArrays =
      delete_names;
  f.CreateProgram = make_name;
  f.CreateShader = [](GLenum) { return make_name(); };
  f.DeleteProgram = f.DeleteShader = delete_name;
}

void agree_to_everything(gl::Functions& f) {
  f.GetShaderiv = f.GetProgramiv = [](GLuint, GLenum, GLint* value) { *value = GL_TRUE; };
  f.CheckFramebufferStatus = [](GLenum) -> GLenum { return GL_FRAMEBUFFER_COMPLETE; };
  f.GetString = [](GLenum) { return reinterpret_cast<const GLubyte*>("null"); };
  f.GetIntegerv = [](GLenum what, GLint* value) {
    std::fill_n(value, what == GL_VIEWPORT || what == GL_SCISSOR_BOX ? 4 : 1, 0);
  };
  f.GetBooleanv = [](GLenum what, GLboolean* value) {
    std::fill_n(value, what == GL_COLOR_WRITEMASK ? 4 : 1, static_cast<GLboolean>(GL_TRUE));
  };
  f.DrawArrays = [](GLenum, GLint, GLsizei) { ++counts.draws; };
  f.DrawElements = [](GLenum, GLsizei, GLenum, const void*) { ++counts.draws; };
  f.DrawElementsBaseVertex = [](GLenum, GLsizei, GLenum, const void*, GLint) { ++counts.draws; };
}

class NullContext final : public Context {
 public:
  NullContext() {
    counts = {};
#define UNDERSTUDY_GL_NULL(name) functions_.name = Nothing<decltype(functions_.name)>::call;
    UNDERSTUDY_GL_FUNCTIONS(UNDERSTUDY_GL_NULL)
#undef UNDERSTUDY_GL_NULL
    count_names(functions_);
    agree_to_everything(functions_);
  }
  ~NullContext() override {
    if (gl::api_or_null() == &functions_) gl::set_api(nullptr);
  }
  void make_current() override {
    gl::set_api(&functions_);
  }
  std::string description() const override {
    return "null";
  }

 private:
  gl::Functions functions_;
};

}  // namespace

std::unique_ptr<Context> make_null_context() {
  return std::make_unique<NullContext>();
}
NullCounts null_counts() {
  return counts;
}

}  // namespace understudy::render
