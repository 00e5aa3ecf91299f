// SPDX-License-Identifier: MIT
#include "live/compile_context.h"

#include "gl/gl.h"

namespace fragtrace {

namespace {

constexpr GLsizei kBindings = 8;  // more than the renderer uses of images, uniform and storage buffers
constexpr GLsizei kTextures = 32;

/// What stays bound would stay in memory until the next job.
void bindNothing() {
  glBindBuffersBase(GL_SHADER_STORAGE_BUFFER, 0, kBindings, nullptr);
  glBindBuffersBase(GL_UNIFORM_BUFFER, 0, kBindings, nullptr);
  glBindImageTextures(0, kBindings, nullptr);
  glBindTextures(0, kTextures, nullptr);
  waitForDevice();
  checkGl("compiling programs");
}

}  // namespace

void CompileContext::run(const std::function<void()>& job) {
  struct Inside {
    explicit Inside(const OutsideContext& context) : outside(context) { outside.enter(); }
    ~Inside() { outside.leave(); }
    const OutsideContext& outside;
  };
  const Inside inside(outside_);
  job();
  bindNothing();
}

}  // namespace fragtrace
