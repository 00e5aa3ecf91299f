// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "gl/context.h"
#include "gl/gl.h"
#include "gl/program.h"
#include "gl/scene_buffers.h"
#include "image/image.h"
#include "pack/guiding.h"
#include "render/film.h"
#include "render/film/path_share.h"
#include "scene/motion/moving_scene.h"
#include "scene/scene.h"
#include "scene/volume/grid.h"
#include "shader/render_options.h"
#include "shader/work.h"

namespace fragtrace {

// Cuts work into draws: small enough that none nears a driver's limits, large enough to keep it busy.

/// The largest tile whose paths may be suspended, in pixels. Their states are in one storage buffer of 60 to
/// 104 MiB (kPathRows of layout.glsl; a row has 16 bytes).
inline constexpr int kMaxTilePixels = 1 << 18;
inline constexpr int kMaxTileSide = 1 << 9;
/// The largest tile of a GPU, whose paths end in their draw: all of 1920 x 1080. At 1280 x 720 one draw takes
/// 0.83 (the room with the ball) and 0.66 (FlightHelmet) of the time of six, on an H200.
inline constexpr int kMaxGpuTilePixels = 1 << 21;
/// The sides of a tile of the wavefront: 1,024 lanes on software, 32,768 on a GPU, whose states take 145 MiB.
inline constexpr glm::ivec2 kWaveTile{128, 256};
inline constexpr glm::ivec2 kGpuWaveTile{1024, 1024};

/// A rectangle of the film (from the bottom left) and the samples that its pixels get: [from, to).
struct Work {
  glm::ivec2 corner{0};
  glm::ivec2 size{0};
  int from = 0;
  int to = 0;
  double busy = 1.0;  ///< part of its pixels that will draw (Film::setTargets)
};

/// Samples over all pixels of a work.
inline double pixelSamples(const Work& work) {
  return work.busy * work.size.x * work.size.y * (work.to - work.from);
}

/// Returns the same work in tiles.
inline std::vector<Work> tilesOf(const Work& work, glm::ivec2 tile) {
  std::vector<Work> tiles;
  for (int y = 0; y < work.size.y; y += tile.y) {
    for (int x = 0; x < work.size.x; x += tile.x) {
      const glm::ivec2 corner(x, y);
      tiles.push_back(
          {work.corner + corner, glm::min(tile, work.size - corner), work.from, work.to, work.busy});
    }
  }
  return tiles;
}

/// One round over the picture: each tile of size `tile` gets more samples.
struct DrawPlan {
  glm::ivec2 tile{0};
  int samples = 1;
};

/// The plan whose draws take about targetMs at a measured cost of msPerSample for a sample of a pixel (<= 0:
/// not yet known, a careful start). It has at most `remaining` samples, at most `most` samples per draw, and
/// at most `mostPixels` a tile. Small tiles with several samples are preferred to large tiles with one: a
/// pixel whose path ends early begins its next sample instead of waiting for its neighbours.
inline DrawPlan planDraws(glm::ivec2 picture, int remaining, int most, int mostPixels, double msPerSample,
                          double targetMs) {
  constexpr int kSmallest = 128;  // pixels per side: some tiles of 64 for each core of a software rasteriser
  constexpr double kEnoughSamples = 16.0;
  const double affordable = msPerSample > 0.0 ? targetMs / msPerSample : double(kSmallest) * kSmallest;
  const double pixels = double(picture.x) * picture.y;
  const double mostSamples = std::max(1, std::min(most, remaining));
  DrawPlan plan;
  const double wanted =
      std::clamp(affordable / (double(kSmallest) * kSmallest), 1.0, std::min(mostSamples, kEnoughSamples));
  if (pixels <= mostPixels && affordable >= pixels * wanted) {
    plan.tile = picture;
  } else {
    const double area = std::clamp(affordable / wanted, double(kSmallest) * kSmallest, double(mostPixels));
    const int side = std::max(kSmallest, int(std::sqrt(area)) / 64 * 64);
    plan.tile = {std::min(picture.x, side), std::min(picture.y, side)};
  }
  plan.samples = int(std::clamp(affordable / (double(plan.tile.x) * plan.tile.y), 1.0, mostSamples));
  return plan;
}

/// Does the same for the wavefront, whose draws are limited by steps. Paths continue from draw to draw, so a
/// tile gets many samples before the next one, and only its last paths leave lanes idle. Rounds double, up to
/// 64 samples, so that a picture that is stopped early has about as many samples everywhere.
inline DrawPlan planWaves(glm::ivec2 picture, glm::ivec2 tile, int done, int remaining) {
  return {glm::min(picture, tile), std::min(remaining, std::clamp(done, 1, 64))};
}

// The one renderer behind every front end: it advances a film by samples, draw by draw.

/// The objects that no two contexts share. They are made for a pass, so that a pass may draw in any context
/// that shares the other objects.
struct DrawTarget {
  GlFramebuffer framebuffer = makeFramebuffer();
  GlVertexArray vertexArray = makeVertexArray();
  void bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glBindVertexArray(vertexArray.name());
  }
};

/// A thin lens.
struct Lens {
  double radius = 0.0;         ///< metres; 0: a pinhole
  double focusDistance = 1.0;  ///< along the view, metres
  int blades = 0;              ///< blades of a polygonal aperture; 0: a round one
};

/// Returns true if this driver can add points to a film of 32-bit floats, as caustics need.
bool canSplat();

/// View::cameraSolids of a camera at this point of local space.
uint32_t cameraSolids(const Solids& solids, const glm::dvec3& point);

/// Settings that can change from picture to picture without touching program or buffers.
struct View {
  Camera camera;                      ///< world space
  std::vector<CameraSegment> motion;  ///< the camera's motion, if the variant has one
  LocalSpace space;                   ///< the scene's local space
  Lens lens;                          ///< the lens, if the variant has one
  double hdriRotation = 0.0;          ///< radians about +Y
  double hdriIntensity = 1.0;         ///< factor of the environment's radiance
  float surroundings = 1.0f;          ///< factor of all light from outside the scene, also where the camera
                                      ///< sees it; it does not change which samples are drawn
  glm::vec3 background{0.0f};         ///< seen by camera rays that miss
  bool showEnvironment = true;  ///< camera rays that miss see the environment map instead, or its backdrop
  bool seesNothing = false;     ///< they see nothing: the picture is to be laid over another one
  Fog fog;                      ///< the fog, if the variant has one
  Volume volume;                ///< the volume, if the variant has one; its grid is packed
  uint32_t cameraSolids = layout::kPrimitiveNone;  ///< as Frame::cameraSolids
  glm::dvec2 shadowFade{0.0};                      ///< as in LightOptions
  double catcherHeight = 0.0;  ///< Y of the shadow catcher in world space, when the variant has one
  bool firstInMiddle = false;  ///< the first sample of each pixel is in its middle, for edges without chance
  int bounces = 16;
  int rouletteDepth = 6;
  uint32_t seed = 0;
  int sampleOffset = 0;         ///< index of sample 0 of the film in the seed's sequence
  float clampIndirect = 0.0f;   ///< largest indirect radiance of a sample, when the variant clamps
  int pixelsPerPath = 0;        ///< as in Film; 0: measured
  bool needsLightPaths = true;  ///< there are light paths, also where camera paths alone are less noisy
  std::optional<Placement> placement;  ///< place of the film in the picture; none: it is the whole
};

/// The times of the draws so far; a frame is one sample in every pixel.
struct RenderTimes {
  double renderMs = 0.0;   ///< wall clock, with all that happens between draws
  double drawMs = 0.0;     ///< time of the draws alone, by Renderer::clock()
  double guidingMs = 0.0;  ///< the part of renderMs that trains guiding
  double firstFrameMs = 0.0;
  std::vector<double> frameMs;
  WorkCounts work;
};

/// Samples that one program adds to a film: camera paths, light paths, records of light, layers of first
/// hits.
struct RenderPass {
  ShaderVariant& variant;  ///< becomes resumable where a path is longer than a draw
  Film& film;
  const View& view;
  std::vector<Work> work;
  bool photons = false;  ///< light paths end where they land, and are stored for guiding
};

inline double millisecondsBetween(std::chrono::steady_clock::time_point from,
                                  std::chrono::steady_clock::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

class Renderer {
  static constexpr int kLeastWaveBudget = 2000;  // a round of 32 pixels takes a few hundred steps

 public:
  /// Uploads the scene, which must hold all that later variants read. Its arrays are freed one by one.
  Renderer(const Context& context, GpuScene scene, BufferReads reads,
           const std::filesystem::path& shaderFolder = {});
  /// Takes programs that may have been built already, and textures that may have been prepared.
  Renderer(const Context& context, GpuScene scene, BufferReads reads, ProgramCache programs,
           SceneTextures textures = {});

  /// Replaces the scene by the next one of a sequence, which is read in the same way. Programs stay.
  void replaceScene(GpuScene scene);

  /// The textures, for preparing those of the next scene.
  SceneTextures& textures() { return textures_; }

  /// Replaces arrays by others of the same numbers of rows, except those that are unchanged. The same samples
  /// are drawn: guiding stays as it was trained.
  void replaceArrays(GpuScene scene) {
    buffers_.replace(scene);
    textures_.replace(scene);
    if (guidingPhotons_ > 0) buffers_.writeLastLights(lobes_);
  }

  /// Replaces the surroundings alone (packSurroundings).
  void replaceSurroundings(GpuScene scene);

  /// Builds the variant's program and draws one tiny tile, which makes llvmpipe compile. Later draws use it.
  /// The film is empty afterwards. Returns milliseconds.
  double compile(const ShaderVariant& variant, Film& film, const View& view);

  /// Returns true if compile() has seen the variant.
  bool knows(const ShaderVariant& variant) const { return paces_.contains(variant); }
  /// Draws with such a variant from now on, at the pace that it had.
  void use(const ShaderVariant& variant) { pace_ = &paces_.at(variant); }

  /// Forgets all programs, which are built again at their next use. None may be drawing.
  void forgetPrograms();

  /// Called after each draw with the fraction of the work done, 0..1; false stops the work.
  using Progress = std::function<bool(double fraction)>;
  static bool toTheEnd(double) { return true; }

  /// Adds samples to parts of the film, one after the other. Returns false if progress stopped it; the film
  /// then holds the finished samples. compile() or use() has chosen the variant.
  bool addSamples(Film& film, const View& view, std::span<const Work> parts, RenderTimes& times,
                  const Progress& progress = toTheEnd);
  /// Adds samples [from, to) to every pixel of the film.
  bool addSamples(Film& film, const View& view, int from, int to, RenderTimes& times,
                  const Progress& progress = toTheEnd) {
    const Work whole{{0, 0}, film.size(), from, to};
    return addSamples(film, view, {&whole, 1}, times, progress);
  }

  /// Returns true if the first sample of such a film waits until a small picture has told if it needs light
  /// paths.
  bool weighsLightPaths(const View& view) const {
    return wideLamps_ && pace_ != nullptr && !view.needsLightPaths && view.bounces > 0 &&
           usesGuiding(pace_->drawn);
  }

  /// The programs that are built.
  const ProgramCache& programs() const { return programs_; }
  /// Gives them away; nothing may be drawn afterwards.
  ProgramCache takePrograms() { return std::move(programs_); }

  /// The milliseconds that one sample of one pixel takes, as the latest work measured them; 0 if not yet
  /// known.
  double msPerSample() const { return pace_ ? pace_->msPerSample : 0.0; }

  /// The clock of RenderTimes::drawMs: the GPU's timer, or the wall clock around glFinish where a software
  /// driver's timer is wrong.
  const char* clock() const { return software_ ? "wall clock" : "gpu timer"; }

  /// Sets the time that a draw may take from now on; for benchmarks, whose frames are known to be short.
  void setDrawTime(double ms) { targetMs_ = ms; }

  /// Sets how many draws are queued at a time: 1 or 2, by default 2 on hardware.
  void setDrawsInFlight(size_t draws) { inFlight_ = std::clamp(draws, size_t(1), kMostInFlight); }

 private:
  /// Sets the members of the uniform block that depend on the scene, or on its surroundings alone.
  void describeSurroundings(const GpuScene& scene);
  void describeScene(const GpuScene& scene);
  /// Sets the members of the uniform block that depend on a film and a view.
  void setFrame(const Film& film, const View& view);
  /// Binds all that the draws of a pass have in common; they draw to the result.
  DrawTarget begin(const RenderPass& pass);
  /// Uploads these bytes of the uniform block for later draws.
  void uploadFrame(size_t from, size_t to);
  void useProgram(const RenderPass& pass);
  void bindPathStates(const ShaderVariant& variant);
  /// Binds a buffer for the counts of work, with room for the samples of these tiles.
  void bindWork(std::span<const Work> tiles);
  /// Adds the counts of the draws so far.
  void collectWork();
  /// Loop iterations that a lane may take in one draw.
  int stepBudget(const ShaderVariant& variant) const;
  /// Adapts the wavefront's budget to the time of a draw that used it up.
  void adaptBudget(double ms);
  /// A draw that the device may not have done yet.
  struct Flight {
    Work tile;
    size_t slot = 0;  ///< index of its progress buffer
    GlQuery timer;    ///< none: the wall's clock
    void* done = nullptr;
    std::chrono::steady_clock::time_point start;
    /// The tile takes about the time of Pace. A part of it does not: a wait that sleeps for half of the
    /// whole's time would double that time with every two parts.
    bool timeKnown = false;
  };
  static constexpr size_t kMostInFlight = 2;
  /// Draws a tile. `goesOn`: the tile was drawn before and is not finished.
  Flight submit(const ShaderVariant& variant, const Work& tile, bool goesOn);
  /// Waits for the draw, and returns its progress.
  layout::Progress land(Flight& flight);
  /// Called after each draw with the pixel-samples that a pass has finished; false stops it.
  using GoOn = std::function<bool(double pixelSamples)>;
  /// Does the work of a pass; false when stopped.
  bool drawPass(const RenderPass& pass, const GoOn& goOn);
  /// Waits for the draw, and draws the tile again until it is finished. False if it was stopped.
  bool finishTile(const RenderPass& pass, Flight flight, const std::function<bool()>& goOn);
  bool addParts(Film& film, const View& view, std::span<const Work> parts, RenderTimes& times,
                const Progress& progress);
  /// Traces light paths until the film has `passes` passes, if its picture has any. Returns false if it was
  /// stopped.
  bool addLightPaths(Film& film, const View& view, int passes, const GoOn& goOn);
  /// Settles before the first sample if camera paths alone draw the film, where a small picture can tell.
  /// Returns false if it was stopped.
  bool chooseLightPaths(Film& film, const View& view, const GoOn& goOn);
  /// Film::pixelsPerPath for a picture of this size, from the variances in a small one (path_share.h) with
  /// random numbers of its own: the same for all seeds and parts. 0 if it was stopped; kNoLightPaths only if
  /// it weighs them against camera paths alone.
  int measurePixelsPerPath(const View& view, glm::ivec2 picture, const GoOn& goOn, bool weighs);
  void compileLightPaths(Film& film, const View& view);
  /// Fits the guiding lobes before the second sample; the first picture does not wait for it. Returns false
  /// if it was stopped.
  bool trainGuiding(const Film& film, const View& view, int sample, RenderTimes& times, const GoOn& goOn);
  /// Traces this part of the light paths of guiding, which has so many rows of them, and adds those that
  /// land; false if it was stopped.
  bool tracePhotons(const View& view, const Work& paths, int height, std::vector<Photon>& photons,
                    const GoOn& goOn);
  /// The rows of lanes that draw so many light paths.
  Work rowsOfPaths(glm::ivec2 paths) const;
  /// The light paths of one sample.
  struct LightPass {
    glm::ivec2 whole;  ///< pixels of the picture
    int index = 0;     ///< that of the sample
    float weight = 1.0f;
  };
  /// Draws a tile of these light paths. `pass` has the film to which they are added.
  bool addLightTile(const RenderPass& pass, const LightPass& of, const GoOn& goOn);
  /// Stores the light samples of all pixels in their sample `index`, if the picture's pixels take those of
  /// others; false if it was stopped.
  bool storeReservoirs(const Film& film, const View& view, int index, const GoOn& goOn);
  /// Draws the records of a tile into the film of splats, through the pixel filter.
  void splat(const RenderPass& pass, glm::ivec2 tile, float weight);
  /// Allows more samples per draw as long as they fit into the step budget.
  void adaptPace(int samples);

  /// The amount of a variant's work that goes into one draw.
  struct Pace {
    ShaderVariant drawn;  ///< resumable where it had to be
    double msPerSample = 0.0;
    int mostSamplesPerDraw = 1;
  };
  /// The variant as it is drawn.
  ShaderVariant& drawn(const ShaderVariant& variant) {
    return paces_.try_emplace(variant, Pace{variant}).first->second.drawn;
  }

  ProgramCache programs_;
  SceneBuffers buffers_;
  SceneTextures textures_;
  std::map<ShaderVariant, Pace> paces_;
  Pace* pace_ = nullptr;  ///< pace of the variant that draws
  layout::Frame frame_{};
  LightShare lightShare_;
  PackedGrid grid_;
  std::vector<glm::vec4> casters_;  ///< the casters of GpuScene
  bool wideLamps_ = false;          ///< as in GpuScene
  bool guides_ = false;             ///< the pass is guided
  size_t guidingPhotons_ = 0;       ///< photons that the lobes were to be fitted to; 0: there are none yet
  Words lobes_;                     ///< the lobes of guiding, as in the last rows of the lights
  float sunChance_ = 0.0f;          ///< probability that a light path of the frame begins at the sun
  /// Light paths of a draw along each side. It is the same for every picture and driver, so that sums have
  /// the same bits.
  static constexpr int kRecordSide = 256;
  std::optional<Film> lightPathFilm_;  ///< two texels per light path (storeRecord of film.glsl)
  std::optional<Film>
      reservoirs_;  ///< a reservoir per pixel, for this sample (shaders/reuse/neighbours.glsl)
  GlBuffer frameBuffer_;
  GlBuffer fogBuffer_;
  GlBuffer shutterBuffer_;
  GlBuffer volumeBuffer_;
  GlBuffer progressBuffer_;
  GlBuffer progressRead_;                             ///< copies of it, a slot a flight
  const layout::Progress* progressMapped_ = nullptr;  ///< the same; null where the driver maps none
  size_t flights_ = 0;
  GlBuffer workBuffer_;   ///< counts of work (shaders/work/count.glsl)
  int64_t workRoom_ = 0;  ///< pixels of a tile that fit into it
  WorkCounts work_;       ///< of all draws
  GlBuffer pathStates_;
  GlTexture pathStateView_;  ///< the path states as an image
  int64_t pathStateRows_ = 0;
  bool software_;
  double drawnMs_ = 0.0;  ///< sum over all draws
  double targetMs_;
  size_t inFlight_;
  bool overBudget_ = false;  ///< the last tile needed more than one draw
  int waveBudget_ = kLeastWaveBudget;
};

}  // namespace fragtrace
