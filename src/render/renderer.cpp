// SPDX-License-Identifier: MIT
#include "render/renderer.h"

#include <bit>
#include <cstddef>
#include <cstring>
#include <deque>

#include "base/errors.h"
#include "pack/pack_tree.h"
#include "scene/camera.h"

namespace fragtrace {

namespace {

using Clock = std::chrono::steady_clock;

/// llvmpipe ends all loops of an invocation after 65,535 iterations in total. It runs 8 pixels in lockstep,
/// and each iteration that one of them counts may cause up to two more that none counts: 65,535 / 24.
constexpr int kSoftwareStepBudget = 2700;
/// GPUs have no such limit; time alone bounds a draw.
constexpr int kHardwareStepBudget = 1 << 16;
/// The wavefront counts all iterations except those of searches while shading, so 8 lanes that never iterate
/// together stay below the limit.
constexpr int kSoftwareWaveBudget = 7500;

/// The time of a draw: short enough to stop within a second, and far from a GPU's watchdog.
constexpr double kSoftwareDrawMs = 200.0;
constexpr double kHardwareDrawMs = 20.0;

constexpr int kTinyTile = 8;        // pixels
constexpr uint32_t kGroupSide = 8;  // lanes per side of a work group, as in trace.comp

layout::Fog packFog(const Fog& fog, const LocalSpace& space) {
  const double falls = std::isfinite(fog.height) ? space.unit / fog.height : 0.0;
  return {glm::vec4(space.localOf(fog.center), fog.radius / space.unit),
          glm::vec4(fog.albedo, fog.anisotropy),
          glm::vec4(fog.extinction * space.unit, falls, (fog.base - space.origin.y) / space.unit, 0.0)};
}

layout::Shutter packShutter(const View& view) {
  layout::Shutter packed{};
  std::vector<CameraSegment> segments = view.motion;
  if (segments.empty()) segments.push_back({view.camera, {}});  // a program that is forced to have some
  packed.count.x = int(std::min(segments.size(), size_t(layout::kMostCameraSegments)));
  for (int i = 0; i < packed.count.x; ++i) {
    const auto& [middle, motion] = segments[size_t(i)];
    const CameraMotion turn = motionBetween(view.camera, middle);
    packed.camera[i] = {glm::vec4(turn.axis, turn.angle), glm::vec4(view.space.localOf(middle.position), 0.0),
                        glm::vec4(motion.axis, motion.angle), glm::vec4(motion.slide / view.space.unit, 0.0)};
  }
  return packed;
}

layout::Volume packVolume(const Volume& volume, const PackedGrid& grid, const LocalSpace& space) {
  glm::dmat4 local(space.unit);
  local[3] = glm::dvec4(space.origin, 1.0);
  const glm::dmat4 rows = glm::transpose(grid.fromFile * glm::inverse(volume.toWorld) * local);
  layout::Volume packed{};
  packed.toBricksX = glm::vec4(rows[0]);
  packed.toBricksY = glm::vec4(rows[1]);
  packed.toBricksZ = glm::vec4(rows[2]);
  packed.medium =
      glm::vec4(volume.source.color.value_or(glm::vec3(1.0f)), float(volume.source.anisotropy.value_or(0.0)));
  packed.extinction = glm::vec4(volume.source.density.value_or(1.0) * grid.largest * space.unit,
                                volume.source.emission.value_or(0.0) * grid.brightest, 0.0, 0.0);
  packed.table = glm::ivec4(grid.bricks, 0);
  return packed;
}

/// The groups that are started so that each of these is (shaders/work_group.glsl).
uint32_t workGroups(glm::uvec2 groups, bool gpu) {
  const auto roundUp = [](uint32_t count, uint32_t step) { return (count + step - 1u) / step * step; };
  if (!gpu) return roundUp(groups.x * groups.y, layout::kWorkGroupHands);
  return roundUp(groups.x, layout::kMortonSide) * roundUp(groups.y, layout::kMortonSide);
}

}  // namespace

Renderer::Renderer(const Context& context, GpuScene scene, BufferReads reads,
                   const std::filesystem::path& shaderFolder)
    : Renderer(context, std::move(scene), reads, ProgramCache(shaderSource(shaderFolder))) {}

Renderer::Renderer(const Context& context, GpuScene scene, BufferReads reads, ProgramCache programs,
                   SceneTextures textures)
    : programs_(std::move(programs)),
      buffers_(scene, reads),
      textures_(std::move(textures)),
      frameBuffer_(makeBuffer()),
      fogBuffer_(makeBuffer()),
      shutterBuffer_(makeBuffer()),
      volumeBuffer_(makeBuffer()),
      progressBuffer_(makeBuffer()),
      progressRead_(makeBuffer()),
      software_(context.software),
      targetMs_(context.software ? kSoftwareDrawMs : kHardwareDrawMs),
      inFlight_(context.software ? 1 : kMostInFlight) {
  glNamedBufferStorage(frameBuffer_.name(), sizeof(layout::Frame), nullptr, GL_DYNAMIC_STORAGE_BIT);
  glNamedBufferStorage(fogBuffer_.name(), sizeof(layout::Fog), nullptr, GL_DYNAMIC_STORAGE_BIT);
  glNamedBufferStorage(shutterBuffer_.name(), sizeof(layout::Shutter), nullptr, GL_DYNAMIC_STORAGE_BIT);
  glNamedBufferStorage(volumeBuffer_.name(), sizeof(layout::Volume), nullptr, GL_DYNAMIC_STORAGE_BIT);
  glNamedBufferStorage(progressBuffer_.name(), sizeof(layout::Progress), nullptr, GL_DYNAMIC_STORAGE_BIT);
  constexpr GLbitfield kRead = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  constexpr size_t kBytes = kMostInFlight * sizeof(layout::Progress);
  glNamedBufferStorage(progressRead_.name(), kBytes, nullptr, kRead);
  progressMapped_ =
      static_cast<const layout::Progress*>(glMapNamedBufferRange(progressRead_.name(), 0, kBytes, kRead));
  checkGl("making buffers");
  textures_.replace(scene);
  describeScene(scene);
}

void Renderer::replaceScene(GpuScene scene) {
  buffers_.replace(scene);
  textures_.replace(scene);
  describeScene(scene);
}

void Renderer::replaceSurroundings(GpuScene scene) {
  buffers_.replace(scene);
  scene.lightShare.emitters = lightShare_.emitters;
  scene.lightShare.anyEmitters = lightShare_.anyEmitters;
  describeSurroundings(scene);
}

void Renderer::describeSurroundings(const GpuScene& scene) {
  guidingPhotons_ = 0;
  frame_.environmentSize = scene.environmentSize;
  frame_.backdropSize = scene.backdropSize;
  frame_.catcherIrradiance = scene.upwardIrradiance;
  lightShare_ = scene.lightShare;
}

void Renderer::describeScene(const GpuScene& scene) {
  describeSurroundings(scene);
  frame_.sceneExtent = scene.extent;
  frame_.treeRounding = treeRounding(scene.extent);
  casters_ = scene.casters;
  wideLamps_ = scene.wideLamps;
  grid_ = scene.densities;
  frame_.emitterCount = float(scene.emitterCount);
  frame_.energyRow = float(scene.energyTableRow);
  frame_.punctualCount = float(scene.punctualLights);
  frame_.leafCount = int(scene.leafCount);
  frame_.objectRow = int(scene.objectRow);
  frame_.segments = scene.segments;
}

void Renderer::setFrame(const Film& film, const View& view) {
  const Camera& camera = view.camera;
  const Placement placed = view.placement.value_or(Placement{{0, 0}, film.size()});
  const glm::dvec2 half = halfExtents(camera, placed.whole.x, placed.whole.y, view.space.unit);
  const glm::dvec3 right = glm::normalize(glm::cross(camera.forward, camera.up));
  const glm::dvec3 up = glm::cross(right, camera.forward);
  frame_.cameraPosition = view.space.localOf(camera.position);
  frame_.orthographic = camera.type == CameraType::Orthographic ? 1.0f : 0.0f;
  frame_.cameraRight = right * half.x;
  frame_.firstInMiddle = view.firstInMiddle ? 1.0f : 0.0f;
  frame_.cameraUp = up * half.y;
  frame_.cameraSolids = view.cameraSolids;
  frame_.cameraForward = camera.forward;
  frame_.metresPerUnit = float(view.space.unit);
  frame_.background = view.background * view.surroundings;
  frame_.backgroundShows = view.seesNothing ? -1.0f : float(view.showEnvironment);
  frame_.environmentRotation = glm::dvec2(std::cos(view.hdriRotation), std::sin(view.hdriRotation));
  frame_.lens = glm::vec4(float(view.lens.radius / view.space.unit),
                          float(view.lens.focusDistance / view.space.unit), float(view.lens.blades), 0.0f);
  frame_.lensShift = 2.0 * camera.shift;
  frame_.environmentScale = float(view.hdriIntensity) * view.surroundings;
  frame_.environmentChance = environmentChance(lightShare_, view.hdriIntensity);
  sunChance_ = sunChance(lightShare_, view.hdriIntensity);
  frame_.pictureSize = placed.whole;
  frame_.seed = int(view.seed);
  frame_.maxBounces = view.bounces;
  frame_.rouletteDepth = view.rouletteDepth;
  frame_.firstSample = view.sampleOffset;
  frame_.clampBits = std::bit_cast<int>(view.clampIndirect);
  frame_.filmOffset = {placed.corner.x, placed.whole.y - placed.corner.y - film.size().y};
  frame_.worldOrigin = view.space.origin;
  frame_.shadowFade = glm::vec2(view.shadowFade);
  frame_.catcherHeight = float((view.catcherHeight - view.space.origin.y) / view.space.unit);
}

DrawTarget Renderer::begin(const RenderPass& pass) {
  DrawTarget target;
  setFrame(pass.film, pass.view);
  uploadFrame(0, sizeof frame_);
  pass.film.bind();
  buffers_.bind();
  textures_.bind();
  const glm::ivec2 size = pass.film.size();
  glNamedFramebufferParameteri(target.framebuffer.name(), GL_FRAMEBUFFER_DEFAULT_WIDTH, size.x);
  glNamedFramebufferParameteri(target.framebuffer.name(), GL_FRAMEBUFFER_DEFAULT_HEIGHT, size.y);
  target.bind();
  useProgram(pass);
  if (pass.variant.neighbours) reservoirs_->bindTextures(layout::kReservoirTextures);
  glBindBufferBase(GL_UNIFORM_BUFFER, layout::kFrameBinding, frameBuffer_.name());
  if (has(pass.variant.traits, Trait::Fog)) {
    const layout::Fog fog = packFog(pass.view.fog, pass.view.space);
    movedBytes() += sizeof fog;
    glNamedBufferSubData(fogBuffer_.name(), 0, sizeof fog, &fog);
    glBindBufferBase(GL_UNIFORM_BUFFER, layout::kFogBinding, fogBuffer_.name());
  }
  if (has(pass.variant.traits, Trait::MovingCamera)) {
    const layout::Shutter shutter = packShutter(pass.view);
    movedBytes() += sizeof shutter;
    glNamedBufferSubData(shutterBuffer_.name(), 0, sizeof shutter, &shutter);
    glBindBufferBase(GL_UNIFORM_BUFFER, layout::kShutterBinding, shutterBuffer_.name());
  }
  if (has(pass.variant.traits, Trait::DensityGrid)) {
    const layout::Volume volume = packVolume(pass.view.volume, grid_, pass.view.space);
    movedBytes() += sizeof volume;
    glNamedBufferSubData(volumeBuffer_.name(), 0, sizeof volume, &volume);
    glBindBufferBase(GL_UNIFORM_BUFFER, layout::kVolumeBinding, volumeBuffer_.name());
  }
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kProgressBinding, progressBuffer_.name());
  if (pass.variant.countsWork) bindWork(pass.work);
  return target;
}

void Renderer::bindWork(std::span<const Work> tiles) {
  int64_t room = std::max<int64_t>(workRoom_, 1);
  for (const Work& tile : tiles) room = std::max(room, int64_t(tile.size.x) * tile.size.y);
  if (room > workRoom_) {
    workBuffer_ = makeBuffer();
    workRoom_ = room;
    const GLsizeiptr counts = (2 + room) * kWorkNames.size();
    glNamedBufferStorage(workBuffer_.name(), counts * GLsizeiptr(sizeof(uint32_t)), nullptr,
                         GL_DYNAMIC_STORAGE_BIT);
    checkGl("making room for counts of work");
  }
  glClearNamedBufferData(workBuffer_.name(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kWorkBinding, workBuffer_.name());
}

void Renderer::collectWork() {
  std::array<uint32_t, 2 * kWorkNames.size()> sums{};
  glGetNamedBufferSubData(workBuffer_.name(), 0, sizeof sums, sums.data());
  checkGl("reading counts of work");
  for (size_t i = 0; i < work_.numbers.size(); ++i)
    work_.numbers[i] += sums[2 * i] + (uint64_t(sums[2 * i + 1]) << 32u);
}

void Renderer::forgetPrograms() {
  glUseProgram(0);
  programs_.clear();
}

void Renderer::uploadFrame(size_t from, size_t to) {
  movedBytes() += to - from;
  glNamedBufferSubData(frameBuffer_.name(), GLintptr(from), GLsizeiptr(to - from),
                       reinterpret_cast<const char*>(&frame_) + from);
}

void Renderer::useProgram(const RenderPass& pass) {
  const ShaderVariant& variant = pass.variant;
  if (variant.resumable || variant.wavefront) bindPathStates(variant);
  const GLuint program = programs_.tracerProgram(variant).name();
  if (variant.lightPaths || usesGuiding(variant)) {
    glProgramUniform4fv(program, 0, GLsizei(casters_.size()), casters_.empty() ? nullptr : &casters_[0].x);
    const bool alone = pass.film.pixelsPerPath() == kNoLightPaths;
    glProgramUniform1i(program, GLint(layout::kMostCasters),
                       alone                           ? -1
                       : variant.lightPaths || guides_ ? int(casters_.size())
                                                       : 0);
  }
  if (variant.lightPaths) {
    glProgramUniform1i(program, GLint(layout::kMostCasters) + 2, pass.photons ? 1 : 0);
    if (samplesSun(variant.traits)) glProgramUniform1f(program, GLint(layout::kMostCasters) + 1, sunChance_);
  }
  glUseProgram(program);
}

void Renderer::bindPathStates(const ShaderVariant& variant) {
  const int rows = int(layout::kPathRows + layout::kPathOwnRows) + 1 + variant.stackSize / 4;
  const glm::ivec2 wave = software_ ? kWaveTile : kGpuWaveTile;
  const int64_t lanes = int64_t(wave.x) * wave.y / layout::kWaveSlots;
  const int64_t count = variant.wavefront ? lanes * layout::kWaveLaneRows : int64_t(kMaxTilePixels) * rows;
  if (count > pathStateRows_) {
    pathStates_ = makeBuffer();
    glNamedBufferStorage(pathStates_.name(), GLsizeiptr(count) * 16, nullptr, 0);
    pathStateRows_ = count;
    pathStateView_ = GlTexture();
  }
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kPathStatesBinding, pathStates_.name());
  if (variant.waveUnit >= 0) {
    if (pathStateView_.name() == 0) {
      pathStateView_ = makeTexture(GL_TEXTURE_BUFFER);
      glTextureBuffer(pathStateView_.name(), GL_RGBA32UI, pathStates_.name());
    }
    glBindImageTexture(GLuint(variant.waveUnit), pathStateView_.name(), 0, GL_FALSE, 0, GL_READ_ONLY,
                       GL_RGBA32UI);
  }
  checkGl("making room for the states of paths");
}

int Renderer::stepBudget(const ShaderVariant& variant) const {
  if (variant.wavefront) return waveBudget_;
  // A walk through a grid is not interrupted.
  const int walk = has(variant.traits, Trait::DensityGrid) ? layout::kMostVolumeSteps : 0;
  return (software_ ? kSoftwareStepBudget : kHardwareStepBudget) - walk;
}

void Renderer::adaptBudget(double ms) {
  const int most = software_ ? kSoftwareWaveBudget : kHardwareStepBudget;
  waveBudget_ = std::clamp(int(waveBudget_ * std::clamp(targetMs_ / ms, 0.5, 2.0)), kLeastWaveBudget, most);
}

Renderer::Flight Renderer::submit(const ShaderVariant& variant, const Work& tile, bool goesOn) {
  Flight flight{tile, flights_++ % kMostInFlight, software_ ? GlQuery() : makeQuery(GL_TIME_ELAPSED), nullptr,
                Clock::now()};
  ++work_.draws;
  // Light paths and samples of lights have draws of their own.
  const bool camera = pace_ && &variant == &pace_->drawn;
  flight.timeKnown = !software_ && camera && !variant.wavefront && !variant.resumable;
  frame_.tile = {tile.corner, tile.size};
  frame_.samplesWanted = tile.to;
  frame_.tileGoesOn = goesOn ? 1 : 0;
  frame_.stepBudget = stepBudget(variant);
  uploadFrame(offsetof(layout::Frame, pictureSize), offsetof(layout::Frame, filmOffset));
  glViewport(tile.corner.x, tile.corner.y, tile.size.x, tile.size.y);
  glClearNamedBufferData(progressBuffer_.name(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
  if (!software_) glBeginQuery(GL_TIME_ELAPSED, flight.timer.name());
  if (variant.dispatch == Dispatch::Compute) {
    const uint32_t slots = variant.wavefront ? layout::kWaveSlots : 1;
    const glm::uvec2 lanes(frame_.tile.z, (uint32_t(frame_.tile.w) + slots - 1u) / slots);
    const glm::uvec2 groups = (lanes + kGroupSide - 1u) / kGroupSide;
    glDispatchCompute(workGroups(groups, variant.gpu), 1, 1);
  } else {
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  if (!software_) glEndQuery(GL_TIME_ELAPSED);
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                  GL_BUFFER_UPDATE_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT |
                  GL_TEXTURE_FETCH_BARRIER_BIT | GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
  // The shader counts in the device's own memory.
  glCopyNamedBufferSubData(progressBuffer_.name(), progressRead_.name(), 0,
                           GLintptr(flight.slot * sizeof(layout::Progress)), sizeof(layout::Progress));
  flight.done = makeFence();
  return flight;
}

layout::Progress Renderer::land(Flight& flight) {
  layout::Progress progress{};
  movedBytes() += sizeof progress;
  const double expectedMs = flight.timeKnown ? pace_->msPerSample * pixelSamples(flight.tile) -
                                                   millisecondsBetween(flight.start, Clock::now())
                                             : 0.0;
  finishFence(std::exchange(flight.done, nullptr), expectedMs);
  if (software_) {
    drawnMs_ += millisecondsBetween(flight.start, Clock::now());
  } else {
    GLuint64 nanoseconds = 0;
    glGetQueryObjectui64v(flight.timer.name(), GL_QUERY_RESULT, &nanoseconds);
    drawnMs_ += 1e-6 * double(nanoseconds);
  }
  if (progressMapped_)
    std::memcpy(&progress, progressMapped_ + flight.slot, sizeof progress);
  else
    glGetNamedBufferSubData(progressRead_.name(), GLintptr(flight.slot * sizeof progress), sizeof progress,
                            &progress);
  checkGl("drawing");
  return progress;
}

bool Renderer::finishTile(const RenderPass& pass, Flight flight, const std::function<bool()>& goOn) {
  ShaderVariant& variant = pass.variant;
  overBudget_ = false;
  for (;;) {
    const layout::Progress progress = land(flight);
    pass.film.addCut((progress.cutHigh * 0x1p32 + progress.cutLow) / layout::kCutUnits);
    if (!goOn()) return false;
    if (progress.unfinished == 0) return true;
    if (variant.wavefront && !variant.countsWork)
      adaptBudget(millisecondsBetween(flight.start, Clock::now()));
    if (progress.stuck > 0 && !variant.resumable) {
      variant.resumable = true;
      variant.wavefront = false;
      variant.waveUnit = -1;
      useProgram(pass);
      // The states of suspended paths have less room than a GPU's tile.
      return std::ranges::all_of(tilesOf(flight.tile, glm::ivec2(kMaxTileSide)), [&](const Work& part) {
        return finishTile(pass, submit(variant, part, true), goOn);
      });
    }
    overBudget_ = true;
    flight = submit(variant, flight.tile, true);
  }
}

bool Renderer::drawPass(const RenderPass& pass, const GoOn& goOn) {
  const DrawTarget target = begin(pass);
  double done = 0.0;
  bool goesOn = true;
  std::deque<Flight> flights;
  const auto finish = [&] {
    const Work tile = flights.front().tile;
    goesOn = finishTile(pass, std::move(flights.front()), [&] { return goesOn && goOn(done); }) && goesOn;
    flights.pop_front();
    done += pixelSamples(tile);
  };
  for (const Work& tile : pass.work) {
    // States of suspended paths are kept for one tile at a time.
    const bool alone = pass.variant.resumable || pass.variant.wavefront;
    while (!flights.empty() && (alone || flights.size() >= inFlight_)) finish();
    if (!goesOn) break;
    flights.push_back(submit(pass.variant, tile, false));
  }
  while (!flights.empty()) finish();
  if (pass.variant.countsWork) collectWork();
  return goesOn;
}

double Renderer::compile(const ShaderVariant& variant, Film& film, const View& view) {
  const auto start = Clock::now();
  pace_ = &paces_.insert_or_assign(variant, Pace{variant}).first->second;
  const Work tiny{{0, 0}, glm::min(film.size(), glm::ivec2(kTinyTile)), 0, 1};
  storeReservoirs(film, view, 0, toTheEnd);
  drawPass({pace_->drawn, film, view, {tiny}}, toTheEnd);
  compileLightPaths(film, view);
  film.clear();
  return millisecondsBetween(start, Clock::now());
}

// The part of the renderer that cuts samples into passes over the picture, by the time that draws took
// before.

/// Counts of work take a plan that no time changes: so many samples of a pixel in a draw, at most.
constexpr int kMostCountedSamples = 4;

void Renderer::adaptPace(int samples) {
  int& most = pace_->mostSamplesPerDraw;
  most = overBudget_ ? std::max(1, samples / 2) : std::max(most, samples * 2);
}

bool Renderer::addSamples(Film& film, const View& view, std::span<const Work> parts, RenderTimes& times,
                          const Progress& progress) {
  const double drawnBefore = drawnMs_;
  const WorkCounts workBefore = work_;
  const auto start = Clock::now();
  const bool complete = addParts(film, view, parts, times, progress);
  times.renderMs += millisecondsBetween(start, Clock::now());
  times.drawMs += drawnMs_ - drawnBefore;
  times.work = times.work + (work_ - workBefore);
  if (complete) progress(1.0);
  return complete;
}

bool Renderer::addParts(Film& film, const View& view, std::span<const Work> parts, RenderTimes& times,
                        const Progress& progress) {
  double total = 0.0;
  for (const Work& part : parts) total += pixelSamples(part);
  double done = 0.0;  // pixel-samples
  double doneMs = 0.0;
  const GoOn goOn = [&](double more) { return progress((done + more) / total); };
  const GoOn stays = [&](double) { return goOn(0.0); };
  if (!chooseLightPaths(film, view, stays)) return false;
  ShaderVariant& variant = pace_->drawn;
  for (const Work& part : parts) {
    for (Work pass = part; pass.from < part.to; pass.from = pass.to) {
      // Step: plan a pass. Where pixels take light samples of others in the same sample, these are stored
      // for one sample at a time.
      int left = variant.neighbours ? 1 : part.to - pass.from;
      if (!trainGuiding(film, view, pass.from, times, stays)) return false;
      if (usesGuiding(variant) && !guides_ && film.pixelsPerPath() != kNoLightPaths) left = 1;
      const int mostPixels = software_ || variant.resumable ? kMaxTilePixels : kMaxGpuTilePixels;
      const DrawPlan plan =
          variant.wavefront    ? planWaves(part.size, software_ ? kWaveTile : kGpuWaveTile, pass.from, left)
          : variant.countsWork ? planDraws(part.size, left, kMostCountedSamples, mostPixels, 0.0, targetMs_)
                               : planDraws(part.size, left, pace_->mostSamplesPerDraw, mostPixels,
                                           pace_->msPerSample * part.busy, targetMs_);
      pass.to = pass.from + plan.samples;
      const auto start = Clock::now();

      // Step: draw it.
      if (!storeReservoirs(film, view, pass.from, stays)) return false;
      const auto drawStart = Clock::now();
      if (!drawPass({variant, film, view, tilesOf(pass, plan.tile)}, goOn)) return false;
      done += pixelSamples(pass);
      doneMs += millisecondsBetween(drawStart, Clock::now());
      pace_->msPerSample = doneMs / done;
      adaptPace(plan.samples);
      const bool lit = addLightPaths(film, view, pass.to, stays);

      // Step: note its time, if it is that of whole frames.
      const double frameMs = millisecondsBetween(start, Clock::now()) / plan.samples;
      if (part.size == film.size() && part.busy == 1.0) {
        if (times.frameMs.empty()) times.firstFrameMs = frameMs;
        times.frameMs.insert(times.frameMs.end(), size_t(plan.samples), frameMs);
      }
      if (!lit) return false;
    }
  }
  return true;
}

// The part of the renderer that draws caustics: passes of light paths.

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

uint32_t cameraSolids(const Solids& solids, const glm::dvec3& point) {
  const std::vector<uint32_t> around = solidsAround(solids, point);
  if (around.empty()) return layout::kPrimitiveNone;
  constexpr uint32_t kNoOuter = 0xffff;
  return solids.nested ? around[0] | (around.size() > 1 ? around[1] : kNoOuter) << 16 : around[0];
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
  // If no viewport can be larger than the film, points next to it are lost.
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

// The part of the renderer that stores light samples for the pixels near them.

bool Renderer::storeReservoirs(const Film& film, const View& view, int index, const GoOn& goOn) {
  const std::optional<ShaderVariant> records = reservoirVariant(pace_->drawn);
  if (!records) return true;
  const glm::ivec2 size = film.size();
  const glm::ivec2 tile(software_ ? 256 : 2048);  // pixels of a draw
  if (!reservoirs_ || reservoirs_->size() != size) reservoirs_.emplace(size);
  reservoirs_->clear();
  View sample = view;
  sample.sampleOffset += index;
  return drawPass({drawn(*records), *reservoirs_, sample, tilesOf({{0, 0}, size, 0, 1}, tile)}, goOn);
}

// The part of the renderer that trains guiding (shaders/caustics/guiding.glsl).

namespace {

/// All seeds have the same lobes: random numbers of its own keep it apart from what it guides.
constexpr uint32_t kSeed = 0x6775696du;

/// The lobes for a picture of so many pixels are fitted to this many photons. A larger picture takes longer,
/// and pays for more.
size_t photonsFor(glm::ivec2 picture) {
  return std::clamp(size_t(picture.x) * size_t(picture.y) * 4, size_t(1) << 12, size_t(1) << 17);
}
/// At most this many light paths are traced for each of the photons, where few land.
constexpr size_t kMostPathsPerPhoton = 8;

}  // namespace

bool Renderer::trainGuiding(const Film& film, const View& view, int sample, RenderTimes& times,
                            const GoOn& goOn) {
  const auto start = std::chrono::steady_clock::now();
  guides_ = usesGuiding(pace_->drawn) && film.pixelsPerPath() != kNoLightPaths && view.bounces > 0 &&
            view.sampleOffset + sample > 0;
  const size_t wanted = photonsFor(view.placement ? view.placement->whole : film.size());
  if (!guides_ || guidingPhotons_ == wanted) return true;
  std::vector<Photon> photons;
  const int rows = int(std::min(wanted / kRecordSide, size_t(kRecordSide)));
  const int height = int(wanted * kMostPathsPerPhoton / kRecordSide);
  for (int row = 0; row < height && photons.size() < wanted; row += rows) {
    if (!tracePhotons(view, {{0, row}, {kRecordSide, rows}, 0, 1}, height, photons, goOn)) return false;
  }
  lobes_ = fitGuiding(photons, casters_);
  buffers_.writeLastLights(lobes_);
  guidingPhotons_ = wanted;
  times.guidingMs += millisecondsBetween(start, std::chrono::steady_clock::now());
  return true;
}

bool Renderer::tracePhotons(const View& view, const Work& paths, int height, std::vector<Photon>& photons,
                            const GoOn& goOn) {
  ShaderVariant& variant = drawn(*lightPathVariant(pace_->drawn));
  View seen = view;
  seen.seed = kSeed;
  seen.sampleOffset = 0;
  seen.placement = Placement{{0, height - paths.corner.y - lightPathFilm_->size().y}, {kRecordSide, height}};
  lightPathFilm_->clearCounts();
  if (!drawPass({variant, *lightPathFilm_, seen, {rowsOfPaths(paths.size)}, true}, goOn)) return false;
  const FilmState records = lightPathFilm_->save();
  for (size_t i = 0; i < size_t(paths.size.x) * size_t(paths.size.y) * 4; i += 4) {
    const float* at = &records.sum[i];
    const float* from = &records.compensation[i];
    if (at[3] > 0.0f)
      photons.push_back({{at[0], at[1], at[2]}, {from[0], from[1], from[2]}, at[3], uint32_t(from[3])});
  }
  return true;
}

}  // namespace fragtrace
