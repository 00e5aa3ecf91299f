// SPDX-License-Identifier: MIT
#include "view/live/run_in.h"

#include "gl/gl.h"

namespace fragtrace {

namespace {

void bindNothing() {
  const auto most = [](GLenum limit) { return GLsizei(driverLimit(limit)); };
  glBindBuffersBase(GL_SHADER_STORAGE_BUFFER, 0, most(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS), nullptr);
  glBindBuffersBase(GL_UNIFORM_BUFFER, 0, most(GL_MAX_UNIFORM_BUFFER_BINDINGS), nullptr);
  glBindImageTextures(0, most(GL_MAX_IMAGE_UNITS), nullptr);
  glBindTextures(0, most(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS), nullptr);
  waitForDevice();
  checkGl("compiling programs");
}

}  // namespace

void runIn(const OutsideContext& context, const std::function<void()>& job) {
  struct Inside {
    explicit Inside(const OutsideContext& outside) : outside(outside) { outside.enter(); }
    ~Inside() { outside.leave(); }
    const OutsideContext& outside;
  };
  const Inside inside(context);
  job();
  bindNothing();
}

}  // namespace fragtrace
