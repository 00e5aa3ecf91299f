// SPDX-License-Identifier: MIT
// The part of the renderer that draws caustics: passes of light paths.
#include <algorithm>
#include <cmath>

#include "render/renderer.h"

namespace fragtrace {

namespace {

/// A lane draws at most this many light paths of a column one after the other, so that no lane waits for the
/// longest path of the others. A row of lanes is as wide as the tile, since llvmpipe's threads share squares
/// of 64 pixels, and rows are even, since it draws two at a time.
constexpr int kSoftwarePathsPerLane = 16;
constexpr int kMargin = 4;  // pixels about the film; filters reach 2

/// Samples of a sequence that have kPixelsPerPath: a picture that moves has few more.
constexpr int kFirstLightSamples = 4;
/// The small picture in which measurePixelsPerPath() measures.
constexpr double kPilotPixels = 1024.0;
constexpr int kPilotSamples = 16;
constexpr uint32_t kPilotSeed = 0x70696c6fu;

int partsOf(int whole, int part) { return (whole + part - 1) / part; }

glm::ivec2 pilotSize(glm::ivec2 picture) {
  const double scale = std::sqrt(kPilotPixels / (double(picture.x) * picture.y));
  return glm::max(glm::ivec2(glm::round(glm::dvec2(picture) * std::min(scale, 1.0))), 1);
}

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
  const std::optional<ShaderVariant> light = lightPathVariant(pace_->drawn);
  if (!light) return;
  if (!lightPathFilm_) lightPathFilm_.emplace(glm::ivec2(kRecordSide, 2 * kRecordSide));
  const Work tiny{{0, 0}, glm::ivec2(8), 0, 1};
  ShaderVariant& variant = drawn(*light);
  drawPass({variant, *lightPathFilm_, view, {tiny}}, toTheEnd);
  splat({variant, film, view, {}}, glm::ivec2(1), 1.0f);
}

bool Renderer::addLightPaths(Film& film, const View& view, int passes, const GoOn& goOn) {
  const std::optional<ShaderVariant> light = lightPathVariant(pace_->drawn);
  // What they bring takes a bounce.
  if (!light || view.bounces == 0 || film.pixelsPerPath() == kNoLightPaths) return true;
  const glm::ivec2 whole = view.placement ? view.placement->whole : film.size();
  uint64_t before = 0;  // paths of the tiles before this one
  for (int pass = 0; pass < passes; ++pass) {
    const bool first = view.sampleOffset + pass < kFirstLightSamples;
    if (!first && film.pixelsPerPath() == 0) {
      film.setPixelsPerPath(view.pixelsPerPath > 0 ? view.pixelsPerPath
                                                   : measurePixelsPerPath(view, whole, goOn, false));
      if (film.pixelsPerPath() == 0) return false;
    }
    const glm::ivec2 paths(whole.x, partsOf(whole.y, first ? kPixelsPerPath : film.pixelsPerPath()));
    const float weight = float(partsOf(whole.y, kPixelsPerPath)) / float(paths.y);
    const uint64_t after = before + uint64_t(paths.x) * uint64_t(paths.y);
    if (after <= film.lightPaths().count) {
      before = after;
      continue;
    }
    for (const Work& tile : tilesOf({{0, 0}, paths, 0, 1}, glm::ivec2(kRecordSide))) {
      // Tiles of a pass that was stopped may be there already.
      const bool there = before < film.lightPaths().count;
      const RenderPass drawing{drawn(*light), film, view, {tile}};
      if (!there && !addLightTile(drawing, {whole, pass, weight}, goOn)) return false;
      before += uint64_t(tile.size.x) * uint64_t(tile.size.y);
    }
  }
  return true;
}

bool Renderer::chooseLightPaths(Film& film, const View& view, const GoOn& goOn) {
  const bool chosen = film.pixelsPerPath() > 0 || film.lightPaths().count > 0;
  if (chosen || !weighsLightPaths(view)) return true;
  int pixels = view.pixelsPerPath;
  guides_ = false;
  if (pixels == 0)
    pixels = measurePixelsPerPath(view, view.placement ? view.placement->whole : film.size(), goOn, true);
  if (pixels == kNoLightPaths) film.setPixelsPerPath(pixels);
  return pixels > 0;
}

int Renderer::measurePixelsPerPath(const View& view, glm::ivec2 picture, const GoOn& goOn, bool weighs) {
  Film film(pilotSize(picture));
  film.setPixelsPerPath(1);
  View pilot = view;
  pilot.placement.reset();
  pilot.seed = kPilotSeed;
  pilot.sampleOffset = kFirstLightSamples;
  const GoOn stays = [&](double) { return goOn(0.0); };
  const auto drawCameraPaths = [&] {
    for (int i = 0; i < kPilotSamples; ++i) {
      const std::vector<Work> tiles = tilesOf({{0, 0}, film.size(), i, i + 1}, kWaveTile);
      if (!storeReservoirs(film, pilot, i, stays)) return false;
      if (!drawPass({pace_->drawn, film, pilot, tiles}, stays)) return false;
    }
    return true;
  };
  if (!drawCameraPaths()) return 0;
  const FilmPixels camera = film.read();
  if (!addLightPaths(film, pilot, kPilotSamples / 4, stays)) return 0;
  const FilmTotals paths = totalsOf(lightPathFilm_->read());  // those of the last tile
  const double raysOfPath = double(paths.rays) / double(paths.samples);
  const int pixels = pixelsPerPath(camera, film.read(), raysOfPath);
  if (!weighs) return pixels;
  // Few light paths may land in the picture, so there are more of them.
  if (!addLightPaths(film, pilot, kPilotSamples, stays)) return 0;
  const FilmPixels both = film.read();
  film.clear();
  film.setPixelsPerPath(kNoLightPaths);
  if (!drawCameraPaths()) return 0;
  return cameraPathsSuffice(camera, both, raysOfPath, pixels, film.read()) ? kNoLightPaths : pixels;
}

bool Renderer::addLightTile(const RenderPass& pass, const LightPass& of, const GoOn& goOn) {
  const Work& tile = pass.work.front();
  View seen = pass.view;
  seen.sampleOffset += of.index;
  // The film of records holds the part of the paths that begins at the tile.
  seen.placement = Placement{{tile.corner.x, of.whole.y - tile.corner.y - 2 * kRecordSide}, of.whole};
  lightPathFilm_->clearCounts();
  if (!drawPass({pass.variant, *lightPathFilm_, seen, {rowsOfPaths(tile.size)}}, goOn)) return false;
  splat(pass, tile.size, of.weight);
  pass.film.countLightPaths(uint64_t(tile.size.x) * uint64_t(tile.size.y), of.weight);
  return true;
}

Work Renderer::rowsOfPaths(glm::ivec2 paths) const {
  const int rows = software_ ? 2 * partsOf(paths.y, 2 * kSoftwarePathsPerLane) : paths.y;
  return {{0, 0}, {paths.x, rows}, 0, partsOf(paths.y, rows)};
}

void Renderer::splat(const RenderPass& pass, glm::ivec2 tile, float weight) {
  Film& film = pass.film;
  const glm::ivec2 size = film.size();
  const Placement placed = pass.view.placement.value_or(Placement{{0, 0}, size});
  const GLuint program = programs_.splatter(pass.variant).name();
  const DrawTarget target;
  glNamedFramebufferTexture(target.framebuffer.name(), GL_COLOR_ATTACHMENT0, film.splats().name(), 0);
  target.bind();
  // If no viewport can be larger than the film, points beside it are lost.
  const int margin = std::max(size.x, size.y) + 2 * kMargin <= Film::mostSide() ? kMargin : 0;
  const glm::ivec2 viewport = size + 2 * margin;
  glViewport(-margin, -margin, viewport.x, viewport.y);
  glProgramUniform2f(program, 0, float(placed.corner.x), float(placed.whole.y - placed.corner.y - size.y));
  glProgramUniform2f(program, 1, float(viewport.x), float(viewport.y));
  glProgramUniform1f(program, 2, float(margin));
  glProgramUniform2i(program, 3, tile.x, tile.y);
  glProgramUniform1f(program, 4, weight);
  lightPathFilm_->bindTextures(0);
  glUseProgram(program);
  glEnable(GL_PROGRAM_POINT_SIZE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glDrawArrays(GL_POINTS, 0, 2 * tile.x * tile.y);
  glDisable(GL_BLEND);
  glDisable(GL_PROGRAM_POINT_SIZE);
  waitForDevice();
  checkGl("adding light paths to the film");
}

}  // namespace fragtrace
