// SPDX-License-Identifier: MIT
#include "render/seen_picture.h"

#include <array>

#include "scene/projection.h"

namespace fragtrace {

namespace {

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
