// SPDX-License-Identifier: MIT
#include "render/renderer.h"

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <deque>

#include "base/errors.h"
#include "pack/pack_tree.h"
#include "scene/projection.h"

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
    const GLsizeiptr counts = (2 + room) * layout::kWorkCount;
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

}  // namespace fragtrace
