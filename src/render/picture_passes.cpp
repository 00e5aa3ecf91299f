// SPDX-License-Identifier: MIT
#include "render/picture_passes.h"

#include <array>
#include <string>

#include "base/timeline.h"
#include "gl/program.h"
#include "scene/camera.h"

namespace fragtrace {

namespace {

constexpr int kBlock = 16;  // the same as in shaders/picture/picture.glsl

glm::ivec2 blocksOf(glm::ivec2 size) { return (size + kBlock - 1) / kBlock; }

/// Writes the camera in the layout of shaders/picture/reproject.frag, relative to a point, so that floats are
/// exact around the camera.
void putCamera(glm::vec4* rows, const SeenPicture& picture, const glm::dvec3& origin) {
  const Projection p = projectionOf(picture.camera, double(picture.size.x) / picture.size.y);
  rows[0] = glm::vec4(glm::vec3(p.position - origin), 0.0f);
  rows[1] = glm::vec4(glm::vec3(p.right), p.shift.x);
  rows[2] = glm::vec4(glm::vec3(p.up), p.shift.y);
  rows[3] = glm::vec4(glm::vec3(p.forward), float(p.type));
}

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

SeenPasses::SeenPasses(const ShaderSource& source) {
  makePasses(source, {{&film_, "picture/film.frag"},
                      {&reproject_, "picture/reproject.frag"},
                      {&join_, "picture/join.frag"},
                      {&show_, "picture/show.frag"},
                      {&showFilm_, "picture/show_film.frag"},
                      {&totals_, "picture/totals.frag"}});
}

void SeenPasses::read(const Film& film, const Film& guides, const GlTexture& raw, const NoisyTextures& fresh,
                      const NoisyTextures& surfaces, PicturePasses& passes) {
  const auto from = film.textures();
  const auto beside = guides.textures();
  glProgramUniform2f(film_.name(), 1, float(film.lightPaths().weight), float(film.lightPaths().squared));
  passes.draw(film_, film.size(), {from[0], from[1], from[2], from[3], beside[0], beside[1], beside[2]},
              {&raw, &fresh.radiance, &fresh.counts, &surfaces.albedo, &surfaces.normal});
}

void SeenPasses::join(const NoisyTextures& fresh, const SeenPicture& now, const SeenPicture& past,
                      double most, PicturePasses& passes) {
  std::array<glm::vec4, 8> cameras{};
  putCamera(&cameras[0], now, now.camera.position);
  putCamera(&cameras[4], past, now.camera.position);
  if (grows(room_, now.size)) {
    past_ = makePictureTexture(GL_RGBA32F, room_);
    apart_ = makePictureTexture(GL_RGBA32F, room_);
  }
  const NoisyTextures& a = now.noisy;
  const NoisyTextures& b = past.noisy;
  glProgramUniform2i(reproject_.name(), 1, past.size.x, past.size.y);
  glProgramUniform4fv(reproject_.name(), 2, GLsizei(cameras.size()), &cameras[0].x);
  passes.draw(
      reproject_, now.size,
      {&fresh.radiance, &fresh.counts, &a.albedo, &a.normal, &b.radiance, &b.counts, &b.albedo, &b.normal},
      {&past_, &apart_});
  glProgramUniform1f(join_.name(), 1, float(most));
  passes.draw(join_, now.size, {&fresh.radiance, &fresh.counts, &past_, &apart_}, {&a.radiance, &a.counts});
}

void SeenPasses::show(const GlTexture& raw, const GlTexture& filtered, double share, Behind behind,
                      glm::ivec2 size, const GlTexture& shown, PicturePasses& passes) {
  glProgramUniform1f(show_.name(), 1, float(share));
  glProgramUniform1i(show_.name(), 2, behind == Behind::Background ? 1 : 0);
  glProgramUniform1i(show_.name(), 3, behind == Behind::White ? 1 : 0);
  passes.draw(show_, size, {&raw, &filtered}, {&shown});
}

void SeenPasses::show(const Film& film, bool background, const GlTexture& shown, PicturePasses& passes) {
  const auto from = film.textures();
  glProgramUniform2f(showFilm_.name(), 1, float(film.lightPaths().weight), float(film.lightPaths().squared));
  glProgramUniform1i(showFilm_.name(), 2, background ? 1 : 0);
  passes.draw(showFilm_, film.size(), {from[0], from[1], from[2], from[3]}, {&shown});
}

void SeenPasses::count(const Film& film, const GlTexture& texel, PicturePasses& passes) {
  passes.sum(totals_, film.size(), {film.textures()[2]}, texel);
}

}  // namespace fragtrace
