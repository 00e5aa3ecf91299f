// SPDX-License-Identifier: MIT
#include "gl/context.h"

#include "advice.h"
#include "base/errors.h"
#include "gl/driver_choice.h"
#include "gl/gl.h"

namespace fragtrace {

bool loadFunctions(Context& context, GetProcAddress getProcAddress, std::string& reason) {
  const int version = gladLoadGL(getProcAddress);
  if (version < GLAD_MAKE_VERSION(4, 5)) {
    reason = "OpenGL " + std::to_string(GLAD_VERSION_MAJOR(version)) + "." +
             std::to_string(GLAD_VERSION_MINOR(version)) + " is older than 4.5";
    return false;
  }
  const auto text = [](GLenum name) {
    const GLubyte* value = glGetString(name);
    return std::string(value ? reinterpret_cast<const char*>(value) : "");
  };
  context.renderer = text(GL_RENDERER);
  context.version = text(GL_VERSION);
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "SwiftShader", "Software"}) {
    context.software = context.software || context.renderer.find(name) != std::string::npos;
  }
  // The driver may use as many threads as it likes to compile programs that are started together.
  if (GLAD_GL_KHR_parallel_shader_compile) glMaxShaderCompilerThreadsKHR(~0u);
  return true;
}

namespace {

class Adopted : public Context {
 public:
  explicit Adopted(const OutsideContext& outside) : leave_(outside.leave) {
    backend = "window";
    outside.enter();
  }
  ~Adopted() override { leave_(); }

 private:
  std::function<void()> leave_;
};

}  // namespace

std::unique_ptr<Context> makeContext(const OutsideContext& outside) {
  auto context = std::make_unique<Adopted>(outside);
  std::string reason;
  if (!loadFunctions(*context, outside.functions, reason))
    throw ContextError("the window's driver: " + reason);
  return context;
}

std::unique_ptr<Context> makeContext(Backend backend, VectorWidth width) {
  setVectorWidth(width);
  std::string tried;
  std::unique_ptr<Context> context;
  if (backend != Backend::OsMesa) context = makeEglContext(tried);
  if (!context && backend != Backend::Egl) context = makeOsMesaContext(tried);
  if (!context) {
    if (tried.ends_with("; ")) tried.resize(tried.size() - 2);
    throw ContextError("no OpenGL 4.5 context; tried " + tried + kDriverAdvice);
  }
  return context;
}

}  // namespace fragtrace
