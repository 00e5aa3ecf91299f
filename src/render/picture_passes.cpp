// SPDX-License-Identifier: MIT
#include "render/picture_passes.h"

#include <array>
#include <string>
#include <vector>

#include "base/timeline.h"
#include "gl/program.h"
#include "render/picture_texture.h"

namespace fragtrace {

namespace {

constexpr int kBlock = 16;  // the same as in shaders/picture/picture.glsl

glm::ivec2 blocksOf(glm::ivec2 size) { return (size + kBlock - 1) / kBlock; }

}  // namespace

void makePasses(const ShaderSource& source,
                std::initializer_list<std::pair<GlProgram*, const char*>> programs) {
  const TimelineSpan span("compile programs of pictures");
  const std::string vertex = assembleShader(source, "entry/fullscreen.vert", {});
  std::vector<StartedProgram> started;
  for (const auto& [program, entry] : programs)
    started.push_back(startProgram(vertex, assembleShader(source, entry, {})));
  auto next = started.begin();
  for (const auto& [program, entry] : programs) *program = finished(std::move(*next++));
  checkGl("building the programs of pictures");
}

PicturePasses::PicturePasses(const ShaderSource& source)
    : vertexArray_(makeVertexArray()), framebuffer_(makeFramebuffer()) {
  makePasses(source, {{&sums_, "picture/sums.frag"}});
}

void PicturePasses::draw(const GlProgram& program, glm::ivec2 size, glm::ivec2 drawn,
                         std::initializer_list<const GlTexture*> from,
                         std::initializer_list<const GlTexture*> into) {
  std::array<GLenum, 8> buffers{};
  size_t count = 0;
  for (const GlTexture* target : into) {
    buffers.at(count) = GLenum(GL_COLOR_ATTACHMENT0 + count);
    glNamedFramebufferTexture(framebuffer_.name(), buffers[count++], target->name(), 0);
  }
  for (size_t i = count; i < attached_; ++i)
    glNamedFramebufferTexture(framebuffer_.name(), GLenum(GL_COLOR_ATTACHMENT0 + i), 0, 0);
  attached_ = count;
  glNamedFramebufferDrawBuffers(framebuffer_.name(), GLsizei(count), buffers.data());
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glBindVertexArray(vertexArray_.name());
  glViewport(0, 0, drawn.x, drawn.y);
  glUseProgram(program.name());
  glProgramUniform2i(program.name(), 0, size.x, size.y);
  GLuint unit = 0;
  for (const GlTexture* source : from) glBindTextureUnit(unit++, source ? source->name() : 0);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  checkGl("drawing over a picture");
}

void PicturePasses::sum(const GlProgram& program, glm::ivec2 size,
                        std::initializer_list<const GlTexture*> from, const GlTexture& texel) {
  if (grows(room_, size)) {
    blocks_ = makePictureTexture(GL_RGBA32F, blocksOf(room_));
    wider_ = makePictureTexture(GL_RGBA32F, blocksOf(blocksOf(room_)));
  }
  glm::ivec2 left = blocksOf(size);
  draw(program, size, left, from, {&blocks_});
  const GlTexture* latest = &blocks_;
  for (const GlTexture* turn = &wider_; left != glm::ivec2(1); left = blocksOf(left)) {
    const glm::ivec2 next = blocksOf(left);
    const bool last = next == glm::ivec2(1);
    draw(sums_, left, next, {latest}, {last ? &texel : turn});
    if (last) return;
    std::swap(latest, turn);
  }
  draw(sums_, left, left, {latest}, {&texel});
}

}  // namespace fragtrace
