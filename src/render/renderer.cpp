// SPDX-License-Identifier: MIT
#include "render/renderer.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

#include "errors.h"
#include "render/draw_plan.h"

namespace fragtrace {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

/// llvmpipe ends all loops of an invocation after 65,535 iterations in sum. It runs 8 pixels in lockstep,
/// each iteration that any of them counts may bring up to two more that none counts: 65,535 / 24.
constexpr int kSoftwareStepBudget = 2700;
/// GPUs have no such limit; time alone bounds a draw.
constexpr int kHardwareStepBudget = 1 << 16;
/// The wavefront counts all iterations but those of searches while shading, so 8 lanes that never iterate
/// together stay below the limit.
constexpr int kSoftwareWaveBudget = 7500;

/// A draw's time: short enough to stop within a second and to stay far from a GPU's watchdog.
constexpr double kSoftwareDrawMs = 200.0;
constexpr double kHardwareDrawMs = 20.0;

constexpr int kTinyTile = 8;        // pixels
constexpr uint32_t kGroupSide = 8;  // lanes a side of a work group, as in trace.comp

/// Half extents of the view at distance 1 (perspective) or in local space (orthographic).
glm::dvec2 halfExtents(const Camera& camera, double unit, glm::ivec2 size) {
  const double height = camera.perspective ? std::tan(0.5 * camera.fovY) : camera.halfHeight / unit;
  return {height * size.x / size.y, height};
}

}  // namespace

Renderer::Renderer(const Context& context, GpuScene scene, BufferReads reads,
                   const std::filesystem::path& shaderFolder)
    : Renderer(context, std::move(scene), reads, ProgramCache(shaderSource(shaderFolder))) {}

Renderer::Renderer(const Context& context, GpuScene scene, BufferReads reads, ProgramCache programs)
    : programs_(std::move(programs)),
      buffers_(scene, reads),
      frameBuffer_(makeBuffer()),
      progressBuffer_(makeBuffer()),
      vertexArray_(makeVertexArray()),
      framebuffer_(makeFramebuffer()),
      timer_(context.software ? GlQuery() : makeTimer()),
      software_(context.software),
      targetMs_(context.software ? kSoftwareDrawMs : kHardwareDrawMs) {
  glNamedBufferStorage(frameBuffer_.name(), sizeof(layout::Frame), nullptr, GL_DYNAMIC_STORAGE_BIT);
  glNamedBufferStorage(progressBuffer_.name(), sizeof(layout::Progress), nullptr, GL_DYNAMIC_STORAGE_BIT);
  checkGl("making buffers");
  describeScene(scene);
}

void Renderer::replaceScene(GpuScene scene) {
  buffers_.replace(scene);
  describeScene(scene);
}

void Renderer::describeScene(const GpuScene& scene) {
  frame_.gridOrigin = glm::vec4(scene.grid.origin, 0.0f);
  frame_.gridCell = glm::vec4(scene.grid.cell, 0.0f);
  frame_.environment = glm::vec4(scene.environmentSize, 1.0f, 0.0f);
  lightShare_ = scene.lightShare;
  casters_ = scene.casters;
  frame_.lightChoice =
      glm::vec4(0.0f, float(scene.emitterCount), float(scene.energyTableRow), float(scene.punctualLights));
  frame_.limits = {0, 0, 0, int(scene.leafCount)};
  frame_.catcherLight = glm::vec4(scene.upwardIrradiance, 0.0f);
  frame_.sampling.w = int(scene.objectRow);
  frame_.part = {0, 0, scene.backdropSize};
}

void Renderer::setFrame(const Film& film, const View& view) {
  const Camera& camera = view.camera;
  const Placement placed = view.placement.value_or(Placement{{0, 0}, film.size()});
  const glm::dvec2 half = halfExtents(camera, view.space.unit, placed.whole);
  const glm::dvec3 right = glm::normalize(glm::cross(camera.forward, camera.up));
  const glm::dvec3 up = glm::cross(right, camera.forward);
  frame_.cameraPosition =
      glm::vec4(glm::vec3(view.space.localOf(camera.position)), camera.perspective ? 0.0f : 1.0f);
  frame_.cameraRight = glm::vec4(glm::vec3(right * half.x), 0.0f);
  frame_.cameraUp = glm::vec4(glm::vec3(up * half.y), 0.0f);
  frame_.cameraForward = glm::vec4(glm::vec3(camera.forward), float(view.space.unit));
  frame_.background = glm::vec4(view.background, view.showEnvironment ? 1.0f : 0.0f);
  frame_.environment.z = float(std::cos(view.hdriRotation));
  frame_.environment.w = float(std::sin(view.hdriRotation));
  frame_.lens = glm::vec4(float(view.lens.radius / view.space.unit),
                          float(view.lens.focusDistance / view.space.unit), float(view.lens.blades), 0.0f);
  frame_.catcherLight.w = float(view.hdriIntensity);
  frame_.lightChoice.x = environmentChance(lightShare_, view.hdriIntensity);
  frame_.picture = {placed.whole, 0, int(view.seed)};
  frame_.limits.x = view.bounces;
  frame_.limits.y = view.rouletteDepth;
  frame_.sampling.x = view.sampleOffset;
  frame_.sampling.y = std::bit_cast<int>(view.clampIndirect);
  frame_.sampling.z = 0;
  frame_.part.x = placed.corner.x;
  frame_.part.y = placed.whole.y - placed.corner.y - film.size().y;
  const glm::dvec3& origin = view.space.origin;
  frame_.worldOrigin = glm::vec4(glm::vec3(origin), float((view.catcherHeight - origin.y) / view.space.unit));
  film.bind();
  buffers_.bind();
  glNamedFramebufferParameteri(framebuffer_.name(), GL_FRAMEBUFFER_DEFAULT_WIDTH, film.size().x);
  glNamedFramebufferParameteri(framebuffer_.name(), GL_FRAMEBUFFER_DEFAULT_HEIGHT, film.size().y);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glBindVertexArray(vertexArray_.name());
  if (variant_.resumable || variant_.wavefront) bindPathStates();
  glUseProgram(programs_.tracer(variant_).name());
  glBindBufferBase(GL_UNIFORM_BUFFER, layout::kFrameBinding, frameBuffer_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kProgressBinding, progressBuffer_.name());
}

void Renderer::bindPathStates() {
  const bool twoLevels = has(variant_.traits, Trait::Instances);
  const uint32_t rows = (twoLevels ? layout::kTwoLevelPathStateRows : layout::kPathStateRows) +
                        (isLightPart(variant_.feature) || variant_.lightPaths ? 1 : 0);
  const int64_t count =
      variant_.wavefront ? int64_t(kMaxWaveLanes) * layout::kWaveLaneRows : int64_t(kMaxTilePixels) * rows;
  if (count > pathStateRows_) {
    pathStates_ = makeBuffer();
    glNamedBufferStorage(pathStates_.name(), GLsizeiptr(count) * 16, nullptr, 0);
    pathStateRows_ = count;
    pathStateView_ = GlTexture();
  }
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kPathStatesBinding, pathStates_.name());
  if (variant_.waveUnit >= 0) {
    if (pathStateView_.name() == 0) {
      pathStateView_ = makeTexture(GL_TEXTURE_BUFFER);
      glTextureBuffer(pathStateView_.name(), GL_RGBA32UI, pathStates_.name());
    }
    glBindImageTexture(GLuint(variant_.waveUnit), pathStateView_.name(), 0, GL_FALSE, 0, GL_READ_ONLY,
                       GL_RGBA32UI);
  }
  checkGl("making room for the states of paths");
}

void Renderer::makeResumable() {
  variant_.resumable = true;
  variant_.wavefront = false;
  variant_.waveUnit = -1;
  if (variant_.lightPaths) setCasters();
  bindPathStates();
  glUseProgram(programs_.tracer(variant_).name());
}

int Renderer::stepBudget() const {
  if (variant_.wavefront) return waveBudget_;
  return software_ ? kSoftwareStepBudget : kHardwareStepBudget;
}

void Renderer::adaptBudget(double ms) {
  const int most = software_ ? kSoftwareWaveBudget : kHardwareStepBudget;
  waveBudget_ = std::clamp(int(waveBudget_ * std::clamp(targetMs_ / ms, 0.5, 2.0)), kLeastWaveBudget, most);
}

layout::Progress Renderer::draw() {
  layout::Progress progress{};
  glNamedBufferSubData(progressBuffer_.name(), 0, sizeof progress, &progress);
  const auto start = Clock::now();
  if (timer_.name() != 0) glBeginQuery(GL_TIME_ELAPSED, timer_.name());
  if (variant_.dispatch == Dispatch::Compute) {
    const uint32_t slots = variant_.wavefront ? layout::kWaveSlots : 1;
    const glm::uvec2 lanes(frame_.tile.z, (uint32_t(frame_.tile.w) + slots - 1u) / slots);
    const glm::uvec2 groups = (lanes + kGroupSide - 1u) / kGroupSide;
    constexpr uint32_t kHands = layout::kWorkGroupHands;
    glDispatchCompute((groups.x * groups.y + kHands - 1u) / kHands * kHands, 1, 1);
  } else {
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  if (timer_.name() != 0) glEndQuery(GL_TIME_ELAPSED);
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                  GL_BUFFER_UPDATE_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT |
                  GL_TEXTURE_FETCH_BARRIER_BIT);
  glFinish();
  if (timer_.name() != 0) {
    GLuint64 nanoseconds = 0;
    glGetQueryObjectui64v(timer_.name(), GL_QUERY_RESULT, &nanoseconds);
    drawnMs_ += 1e-6 * double(nanoseconds);
  } else {
    drawnMs_ += milliseconds(start, Clock::now());
  }
  glGetNamedBufferSubData(progressBuffer_.name(), 0, sizeof progress, &progress);
  checkGl("drawing");
  return progress;
}

bool Renderer::drawTile(Film& film, glm::ivec2 corner, glm::ivec2 tile, int target,
                        const std::function<bool()>& goOn) {
  frame_.tile = {corner, tile};
  frame_.picture.z = target;
  frame_.sampling.z = 0;
  glViewport(corner.x, corner.y, tile.x, tile.y);
  overBudget_ = false;
  for (;;) {
    const auto start = Clock::now();
    frame_.limits.z = stepBudget();
    glNamedBufferSubData(frameBuffer_.name(), 0, sizeof frame_, &frame_);
    const layout::Progress progress = draw();
    film.addCut((progress.cutHigh * 0x1p32 + progress.cutLow) / layout::kCutUnits);
    if (!goOn()) return false;
    if (progress.unfinished == 0) return true;
    if (variant_.wavefront) adaptBudget(milliseconds(start, Clock::now()));
    if (progress.stuck > 0 && !variant_.resumable) makeResumable();
    overBudget_ = true;
    frame_.sampling.z = 1;
  }
}

double Renderer::compile(const ShaderVariant& variant, Film& film, const View& view) {
  const auto start = Clock::now();
  paces_[asked_] = {variant_, msPerSample_, mostSamplesPerDraw_};
  asked_ = variant_ = variant;
  setFrame(film, view);
  keepLight(film, view, 0, [] { return true; });
  drawTile(film, {0, 0}, glm::min(film.size(), glm::ivec2(kTinyTile)), 1, [] { return true; });
  compileLightPaths(film, view);
  film.clear();
  mostSamplesPerDraw_ = 1;
  msPerSample_ = 0.0;
  return milliseconds(start, Clock::now());
}

void Renderer::use(const ShaderVariant& variant) {
  if (variant == asked_) return;
  paces_[asked_] = {variant_, msPerSample_, mostSamplesPerDraw_};
  const Pace& pace = paces_.at(variant);
  asked_ = variant;
  variant_ = pace.drawn;
  msPerSample_ = pace.msPerSample;
  mostSamplesPerDraw_ = pace.mostSamplesPerDraw;
}

void Renderer::adaptPace(int samples) {
  mostSamplesPerDraw_ = overBudget_ ? std::max(1, samples / 2) : std::max(mostSamplesPerDraw_, samples * 2);
}

bool Renderer::addSamples(Film& film, const View& view, int from, int to, RenderTimes& times,
                          const Progress& progress) {
  setFrame(film, view);
  const double drawnBefore = drawnMs_;
  const double total = double(film.size().x) * film.size().y * (to - from);
  double pixelSamplesDone = 0.0;
  for (int done = from; done < to;) {
    // Pixels take light samples of others in the same sample, which are kept for one at a time.
    const int left = variant_.neighbours ? 1 : to - done;
    const DrawPlan plan = variant_.wavefront
                              ? planWaves(film.size(), done, left)
                              : planDraws(film.size(), left, mostSamplesPerDraw_, msPerSample_, targetMs_);
    const auto roundStart = Clock::now();
    if (!keepLight(film, view, done, [&] { return progress(pixelSamplesDone / total); })) {
      times.renderMs += milliseconds(roundStart, Clock::now());
      times.drawMs += drawnMs_ - drawnBefore;
      return false;
    }
    double tileMs = 0.0;
    for (int y = 0; y < film.size().y; y += plan.tile.y) {
      for (int x = 0; x < film.size().x; x += plan.tile.x) {
        const glm::ivec2 corner(x, y);
        const glm::ivec2 tile = glm::min(plan.tile, film.size() - corner);
        const auto start = Clock::now();
        const double fraction = pixelSamplesDone / total;
        if (!drawTile(film, corner, tile, done + plan.samples, [&] { return progress(fraction); })) {
          times.renderMs += milliseconds(roundStart, Clock::now());
          times.drawMs += drawnMs_ - drawnBefore;
          return false;
        }
        tileMs += milliseconds(start, Clock::now());
        pixelSamplesDone += double(tile.x) * tile.y * plan.samples;
      }
    }
    const double roundMs = milliseconds(roundStart, Clock::now());
    msPerSample_ = tileMs / (double(film.size().x) * film.size().y * plan.samples);
    times.renderMs += roundMs;
    if (times.frameMs.empty()) times.firstFrameMs = roundMs / plan.samples;
    times.frameMs.insert(times.frameMs.end(), size_t(plan.samples), roundMs / plan.samples);
    done += plan.samples;
    adaptPace(plan.samples);
    const auto lightStart = Clock::now();
    const bool lit = addLightPaths(film, view, done, [&] { return progress(pixelSamplesDone / total); });
    const double lightMs = milliseconds(lightStart, Clock::now());
    times.renderMs += lightMs;
    for (int i = 0; i < plan.samples; ++i) *(times.frameMs.rbegin() + i) += lightMs / plan.samples;
    if (!lit) {
      times.drawMs += drawnMs_ - drawnBefore;
      return false;
    }
  }
  times.drawMs += drawnMs_ - drawnBefore;
  progress(1.0);
  return true;
}

bool Renderer::addSamples(Film& film, const View& view, std::span<const Work> parts, RenderTimes& times,
                          const Progress& progress) {
  setFrame(film, view);
  double total = 0.0;
  for (const Work& w : parts) total += w.busy * w.size.x * w.size.y * (w.to - w.from);
  double pixelSamplesDone = 0.0;
  double drawMs = 0.0;
  const double drawnBefore = drawnMs_;
  const auto start = Clock::now();
  bool complete = true;
  for (const Work& w : parts) {
    const double pixels = w.busy * w.size.x * w.size.y;
    for (int done = w.from; complete && done < w.to;) {
      const double affordable = msPerSample_ > 0.0 ? targetMs_ / (msPerSample_ * pixels) : 1.0;
      const int most = std::min(mostSamplesPerDraw_, w.to - done);
      const int samples = variant_.wavefront ? w.to - done : int(std::clamp(affordable, 1.0, double(most)));
      const auto drawStart = Clock::now();
      const double fraction = pixelSamplesDone / total;
      complete = drawTile(film, w.corner, w.size, done + samples, [&] { return progress(fraction); });
      drawMs += milliseconds(drawStart, Clock::now());
      pixelSamplesDone += pixels * samples;
      msPerSample_ = drawMs / pixelSamplesDone;
      done += samples;
      adaptPace(samples);
    }
  }
  int most = 0;
  for (const Work& w : parts) most = std::max(most, w.to);
  if (complete)
    complete = addLightPaths(film, view, most, [&] { return progress(pixelSamplesDone / total); });
  times.renderMs += milliseconds(start, Clock::now());
  times.drawMs += drawnMs_ - drawnBefore;
  return complete;
}

}  // namespace fragtrace
