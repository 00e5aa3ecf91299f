// SPDX-License-Identifier: MIT
// The part of the renderer that draws caustics: passes of light paths.
#include <algorithm>

#include "render/renderer.h"

namespace fragtrace {

namespace {

/// Light paths of a draw, a side. The same for every picture and driver, so that sums have the same bits.
constexpr int kRecordSide = 256;
/// Of a column of these, at most so many are drawn by a lane one after the other, so that none waits for the
/// longest path of the others. A row of lanes is as wide as the tile, since llvmpipe's threads share squares
/// of 64 pixels, and rows are even, since it draws two at a time.
constexpr int kSoftwarePathsPerLane = 16;
/// Pixels of the picture that a pass has a light path for: caustics are less noisy than the rest with fewer.
constexpr int kPixelsPerPath = 4;
constexpr int kMargin = 4;  // pixels about the film; filters reach 2

int partsOf(int whole, int part) { return (whole + part - 1) / part; }

}  // namespace

bool canSplat() {
  GLint blends = GL_NONE;
  glGetInternalformativ(GL_TEXTURE_2D, GL_RGBA32F, GL_FRAMEBUFFER_BLEND, 1, &blends);
  GLfloat sizes[2] = {1.0f, 1.0f};
  glGetFloatv(GL_POINT_SIZE_RANGE, sizes);
  checkGl("asking what can be blended");
  return blends == GL_FULL_SUPPORT && sizes[1] >= 5.0f;
}

void Renderer::compileLightPaths(Film& film, const View& view) {
  const std::optional<ShaderVariant> light = lightPathVariant(variant_);
  if (!light) return;
  const ShaderVariant camera = variant_;
  if (!lightPathFilm_) lightPathFilm_.emplace(glm::ivec2(kRecordSide));
  variant_ = *light;
  setFrame(*lightPathFilm_, view);
  setCasters();
  drawTile(*lightPathFilm_, {0, 0}, glm::ivec2(8), 1, [] { return true; });
  splat(film, view, glm::ivec2(1));
  variant_ = camera;
}

void Renderer::setCasters() {
  const GLuint program = programs_.tracer(variant_).name();
  glProgramUniform4fv(program, 0, GLsizei(casters_.size()), casters_.empty() ? nullptr : &casters_[0].x);
  glProgramUniform1i(program, GLint(layout::kMostCasters), int(casters_.size()));
}

bool Renderer::addLightPaths(Film& film, const View& view, int passes, const std::function<bool()>& goOn) {
  const std::optional<ShaderVariant> light = lightPathVariant(variant_);
  if (!light) return true;
  const glm::ivec2 whole = view.placement ? view.placement->whole : film.size();
  const glm::ivec2 paths(whole.x, partsOf(whole.y, kPixelsPerPath));
  const uint64_t perPass = uint64_t(paths.x) * uint64_t(paths.y);
  if (film.lightPaths() >= perPass * uint64_t(passes)) return true;
  const ShaderVariant camera = variant_;
  variant_ = *light;
  setCasters();
  View seen = view;
  seen.placement = Placement{{0, 0}, whole};
  bool complete = true;
  while (complete && film.lightPaths() < perPass * uint64_t(passes)) {
    const uint64_t pass = film.lightPaths() / perPass;
    seen.sampleOffset = view.sampleOffset + int(pass);
    uint64_t before = pass * perPass;  // paths of the tiles before this one
    for (int y = 0; complete && y < paths.y; y += kRecordSide) {
      for (int x = 0; complete && x < paths.x; x += kRecordSide) {
        const glm::ivec2 tile = glm::min(glm::ivec2(kRecordSide), paths - glm::ivec2(x, y));
        // Tiles of a pass that was stopped are there already.
        if (before >= film.lightPaths()) complete = addLightTile(film, view, seen, {x, y}, tile, goOn);
        before += uint64_t(tile.x) * uint64_t(tile.y);
      }
    }
  }
  variant_ = camera;
  setFrame(film, view);
  return complete;
}

bool Renderer::addLightTile(Film& film, const View& view, const View& seen, glm::ivec2 corner,
                            glm::ivec2 tile, const std::function<bool()>& goOn) {
  lightPathFilm_->clearCounts();
  setFrame(*lightPathFilm_, seen);
  frame_.part.x = corner.x;
  frame_.part.y = corner.y;
  const int rows = software_ ? 2 * partsOf(tile.y, 2 * kSoftwarePathsPerLane) : tile.y;
  if (!drawTile(*lightPathFilm_, {0, 0}, {tile.x, rows}, partsOf(tile.y, rows), goOn)) return false;
  splat(film, view, tile);
  film.countLightPaths(uint64_t(tile.x) * uint64_t(tile.y));
  return true;
}

void Renderer::splat(Film& film, const View& view, glm::ivec2 tile) {
  const glm::ivec2 size = film.size();
  const Placement placed = view.placement.value_or(Placement{{0, 0}, size});
  const GLuint program = programs_.splatter(variant_).name();
  if (splatTarget_.name() == 0) splatTarget_ = makeFramebuffer();
  glNamedFramebufferTexture(splatTarget_.name(), GL_COLOR_ATTACHMENT0, film.splats().name(), 0);
  glBindFramebuffer(GL_FRAMEBUFFER, splatTarget_.name());
  // Where no viewport is larger than the film, points beside it are lost.
  const int margin = std::max(size.x, size.y) + 2 * kMargin <= Film::mostSide() ? kMargin : 0;
  const glm::ivec2 viewport = size + 2 * margin;
  glViewport(-margin, -margin, viewport.x, viewport.y);
  glProgramUniform2f(program, 0, float(placed.corner.x), float(placed.whole.y - placed.corner.y - size.y));
  glProgramUniform2f(program, 1, float(viewport.x), float(viewport.y));
  glProgramUniform1f(program, 2, float(margin));
  glProgramUniform1i(program, 3, tile.x);
  lightPathFilm_->bindTextures(0);
  glUseProgram(program);
  glEnable(GL_PROGRAM_POINT_SIZE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glDrawArrays(GL_POINTS, 0, tile.x * tile.y);
  glDisable(GL_BLEND);
  glDisable(GL_PROGRAM_POINT_SIZE);
  glNamedFramebufferTexture(splatTarget_.name(), GL_COLOR_ATTACHMENT0, 0, 0);
  glFinish();
  checkGl("adding light paths to the film");
}

}  // namespace fragtrace
