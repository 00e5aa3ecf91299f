// SPDX-License-Identifier: MIT
// The one renderer behind every front end: it advances a film by samples, draw by draw.
#pragma once

#include <functional>
#include <vector>

#include "gl/context.h"
#include "gl/program.h"
#include "gl/scene_buffers.h"
#include "render/film.h"
#include "stage/options.h"

namespace fragtrace {

/// What can change from picture to picture without touching program or buffers.
struct View {
  Camera camera;                ///< world space
  glm::dvec3 sceneOrigin{0.0};  ///< world position of the local origin
  double hdriRotation = 0.0;    ///< radians about +Y
  glm::vec3 background{0.0f};   ///< seen by camera rays that miss
  bool showEnvironment = true;  ///< camera rays that miss see the environment map instead
  int bounces = 16;
  int rouletteDepth = 3;
  uint32_t seed = 0;
};

/// Time of the draws so far; frames are one sample in every pixel.
struct RenderTimes {
  double renderMs = 0.0;
  double firstFrameMs = 0.0;
  std::vector<double> frameMs;
};

class Renderer {
 public:
  Renderer(const Context& context, const GpuScene& scene, const ShaderVariant& variant,
           const std::filesystem::path& shaderFolder = {});

  /// Builds the program and draws one tiny tile, which is where llvmpipe compiles. Returns milliseconds.
  double compile(Film& film, const View& view);

  /// Called after each draw with the fraction of the work done, 0..1; false stops the work.
  using Progress = std::function<bool(double fraction)>;

  /// Adds samples to every pixel. False when progress stopped it; the film then holds what was finished.
  bool addSamples(Film& film, const View& view, int samples, RenderTimes& times, const Progress& progress);

 private:
  void setFrame(const Film& film, const View& view);
  /// From now on paths are suspended between draws: for scenes with paths that take more than one draw.
  void makeResumable();
  layout::Progress draw();
  /// Advances a tile to `target` samples in as many draws as its step budget takes; false when stopped.
  bool drawTile(glm::ivec2 corner, glm::ivec2 tile, int target, const std::function<bool()>& goOn);

  ProgramCache programs_;
  SceneBuffers buffers_;
  ShaderVariant variant_;
  layout::Frame frame_{};
  GlBuffer frameBuffer_;
  GlBuffer progressBuffer_;
  GlBuffer pathStates_;
  GlVertexArray vertexArray_;
  GlFramebuffer framebuffer_;
  double targetMs_;
  int samplesDone_ = 0;
  int mostSamplesPerDraw_ = 1;
  bool overBudget_ = false;  ///< the last tile needed more than one draw
};

}  // namespace fragtrace
