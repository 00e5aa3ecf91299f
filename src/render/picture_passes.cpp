// SPDX-License-Identifier: MIT
#include "render/picture_passes.h"

#include <array>

#include "gl/program.h"
#include "render/picture_texture.h"

namespace fragtrace {

namespace {

constexpr int kBlock = 16;  // as in shaders/picture/picture.glsl

}  // namespace

GlProgram passProgram(const ShaderSource& source, const char* entry) {
  GlProgram program =
      buildProgram(assembleShader(source, "entry/fullscreen.vert", {}), assembleShader(source, entry, {}));
  checkGl("building the programs of pictures");
  return program;
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

glm::ivec2 PictureSums::blocksOf(glm::ivec2 size) { return (size + kBlock - 1) / kBlock; }

const GlTexture& PictureSums::blocks(glm::ivec2 size) {
  if (grows(room_, size)) {
    blocks_ = makePictureTexture(GL_RGBA32F, blocksOf(room_));
    wider_ = makePictureTexture(GL_RGBA32F, blocksOf(blocksOf(room_)));
  }
  return blocks_;
}

void PictureSums::into(const GlTexture& texel, glm::ivec2 size, PicturePasses& passes) {
  glm::ivec2 left = blocksOf(size);
  const GlTexture* from = &blocks_;
  for (const GlTexture* turn = &wider_; left != glm::ivec2(1); left = blocksOf(left)) {
    const glm::ivec2 next = blocksOf(left);
    const bool last = next == glm::ivec2(1);
    passes.draw(sums_, left, next, {from}, {last ? &texel : turn});
    if (last) return;
    std::swap(from, turn);
  }
  passes.draw(sums_, left, left, {from}, {&texel});
}

}  // namespace fragtrace
