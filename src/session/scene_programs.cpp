// SPDX-License-Identifier: MIT
#include "session/scene_programs.h"

#include <algorithm>

#include "base/errors.h"
#include "base/parallel.h"
#include "gl/gl.h"
#include "options/option_row.h"
#include "pack/textures/pack_textures.h"

namespace fragtrace {

namespace {

void bindNothing() {
  glBindBuffersBase(GL_SHADER_STORAGE_BUFFER, 0, driverCount(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS), nullptr);
  glBindBuffersBase(GL_UNIFORM_BUFFER, 0, driverCount(GL_MAX_UNIFORM_BUFFER_BINDINGS), nullptr);
  glBindImageTextures(0, driverCount(GL_MAX_IMAGE_UNITS), nullptr);
  glBindTextures(0, driverCount(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS), nullptr);
  waitForDevice();
  checkGl("compiling programs");
}

/// Runs the job in the calling thread with that context current, whose functions are loaded already; nothing
/// stays bound there, since that would stay in memory, too. Throws as the job does, and RenderError.
void runIn(const OutsideContext& context, const std::function<void()>& job) {
  struct Inside {
    explicit Inside(const OutsideContext& outside) : outside(outside) { outside.enter(); }
    ~Inside() { outside.leave(); }
    const OutsideContext& outside;
  };
  const Inside inside(context);
  job();
  bindNothing();
}

/// A draw's time: a wish waits for one draw at most.
constexpr double kSoftwareWishMs = 30.0;
constexpr double kHardwareWishMs = 10.0;
/// Programs are kept as long as they are few and small, but always those of two sides.
constexpr size_t kLeastKept = 2;
constexpr size_t kMostKept = 6;
constexpr size_t kMostKeptBytes = size_t(1) << 29;

/// The picture's program, if it can be had, and those of its features; the picture's draws what comes next.
void compileAll(SceneProgram& program, const View& view) {
  if (!program.error.empty()) return;
  Tracer& tracer = program.tracer;
  try {
    Film tiny(kCompiledFor);
    for (const ShaderVariant& aov : tracer.aovs) tracer.renderer->compile(aov, tiny, view);
    if (program.asksForCones)
      for (const ShaderVariant& cones : tracer.cones) tracer.renderer->compile(cones, tiny, view);
    tracer.renderer->compile(tracer.variant, tiny, view);
  } catch (const ContextLost&) {
    throw;
  } catch (const RenderError& error) {
    program.error = error.what();
  }
}

/// The part of the options that decides which program draws, and what it reads.
RenderOptions programPart(const RenderOptions& options) {
  RenderOptions part = programOptions(options);
  if (part.output.debugView == DebugView::Samples || part.output.debugView == DebugView::Variance)
    part.output.debugView = DebugView::None;  // drawn by the picture's own
  part.sampling.clampIndirect = part.sampling.clampIndirect > 0.0 ? 1.0 : 0.0;
  takeStep(part, {}, Renewal::Surroundings);
  part.output.aovs.clear();
  part.output.lightGroups.clear();
  part.selection.camera.clear();
  if (has(part.stages, Stage::Gi) && part.output.debugView == DebugView::None)
    part.output.aovs = {Aov::Guides};
  return part;
}

}  // namespace

bool ScenePrograms::has(const RenderOptions& options) const {
  return std::ranges::any_of(programs_,
                             [part = programPart(options)](const auto& p) { return p->options == part; });
}

std::shared_ptr<SceneProgram> ScenePrograms::of(const RenderOptions& options) {
  const RenderOptions part = programPart(options);
  const auto found = std::ranges::find_if(programs_, [&](const auto& p) { return p->options == part; });
  if (found != programs_.end()) {
    programs_.splice(programs_.begin(), programs_, found);
    return programs_.front();
  }
  if (!sameTree(treeOptions_, part)) {
    waitForCompiler();
    loaded_.bvh = buildTree(loaded_.scene, part);
  }
  treeOptions_ = part;
  keep(make(part));
  return programs_.front();
}

std::shared_ptr<SceneProgram> ScenePrograms::soon(const RenderOptions& options) {
  const RenderOptions part = programPart(options);
  if (!aside_ || has(options) || !sameTree(treeOptions_, part)) return of(options);
  if (compiling()) return nullptr;
  startAside([this, part] { return makeAside(part); });
  return nullptr;
}

void ScenePrograms::addCones(const std::shared_ptr<SceneProgram>& program) {
  if (!aside_ || compiling() || program->asksForCones || program->tracer.cones.empty()) return;
  program->asksForCones = true;
  startAside([this, program] {
    runIn(aside_->context, [&] { makeCones(*program); });
    return program;
  });
}

void ScenePrograms::startAside(std::function<std::shared_ptr<SceneProgram>()> make) {
  std::packaged_task<std::shared_ptr<SceneProgram>()> task(std::move(make));
  coming_ = task.get_future();
  compiler_ = std::jthread([task = std::move(task), came = aside_->came]() mutable {
    nameThread("compile");
    task();
    came();
  });
}

bool ScenePrograms::takeCompiled() {
  if (compiling() && coming_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
    waitForCompiler();
  return std::exchange(compiled_, false);
}

void ScenePrograms::waitForCompiler() {
  if (!compiling()) return;
  compiled_ = true;
  const std::shared_ptr<SceneProgram> program = coming_.get();
  compileAll(*program, loaded_.view);
  if (program->asksForCones) program->hasCones = program->error.empty();
  keep(program);
}

void ScenePrograms::forget() {
  waitForCompiler();
  programs_.clear();
}

void ScenePrograms::keep(std::shared_ptr<SceneProgram> program) {
  heldText_ = heldText_ || program->tracer.variant.traversal == TraversalMethod::Literals;
  programs_.remove(program);
  programs_.push_front(std::move(program));
  size_t bytes = 0;
  size_t count = 0;
  for (auto p = programs_.begin(); p != programs_.end(); ++count) {
    bytes += (*p)->bytes;
    // A program that a side draws with is kept: otherwise it would be made again at once.
    const bool kept =
        p->use_count() > 1 || count < kLeastKept || (count < kMostKept && bytes <= kMostKeptBytes);
    p = kept ? std::next(p) : programs_.erase(p);
  }
}

void ScenePrograms::show(Renewal renewed, const RenderOptions& options) {
  // The thread that compiles aside packs the scene.
  if (compiling()) throw std::logic_error("the scene was changed while a program was made for it");
  const bool posed = renewed >= Renewal::Pose;
  std::erase_if(programs_, [&](const auto& p) {
    const bool isText = p->tracer.variant.traversal == TraversalMethod::Literals;
    return p.use_count() == 1 || !p->error.empty() || (renewed == Renewal::Surfaces && isText);
  });
  if (posed) treeOptions_ = options;
  for (const std::shared_ptr<SceneProgram>& program : programs_) {
    if (renewed == Renewal::Surroundings) {
      replaceSurroundings(program->tracer, loaded_);
      continue;
    }
    takePose(program->options, options);
    if (posed && !sameTree(treeOptions_, program->options))
      loaded_.bvh = buildTree(loaded_.scene, program->options);
    if (posed) treeOptions_ = program->options;
    replace(*program, renewed == Renewal::Surfaces);
  }
}

void ScenePrograms::replace(SceneProgram& program, bool surfacesAlone) const {
  Statistics stats;
  const std::vector<TexturePlace> places = program.tracer.textures.places;
  replaceScene(program.tracer, context_, loaded_, program.options, stats, surfacesAlone);
  program.variant = stats.variant;
  if (!surfacesAlone) program.bytes = stats.sceneBytes;
  // The scene may need another program, as for a deeper tree.
  Renderer& renderer = *program.tracer.renderer;
  Film tiny(kCompiledFor);
  if (renderer.knows(program.tracer.variant))
    renderer.use(program.tracer.variant);
  else
    renderer.compile(program.tracer.variant, tiny, loaded_.view);
  const std::vector<ShaderVariant>& cones = program.tracer.cones;
  const bool keepsCones = !cones.empty() && places == program.tracer.textures.places &&
                          std::ranges::all_of(cones, [&](const auto& v) { return renderer.knows(v); });
  if (!keepsCones) program.asksForCones = program.hasCones = false;
}

std::shared_ptr<SceneProgram> ScenePrograms::makeAside(const RenderOptions& part) const {
  std::shared_ptr<SceneProgram> program;
  runIn(aside_->context, [&] {
    DebugLog log;
    program = make(part);
    compileAll(*program, loaded_.view);
    // Mesa crashes where programs are deleted that several contexts have drawn with (seen with 22.3): the
    // context that draws makes its own, out of the driver's cache.
    if (program->tracer.renderer) program->tracer.renderer->forgetPrograms();
    program->driverLog = log.take();
  });
  return program;
}

/// Fills the levels, and compiles the variants for the driver's cache: an empty scene will do.
void ScenePrograms::makeCones(const SceneProgram& program) const {
  const Tracer& tracer = program.tracer;
  addLevels(tracer.textures, tracer.renderer->textures().memory());
  Renderer renderer(context_, GpuScene{}, tracer.reads, program.options.device.shaderFolder);
  Film tiny(kCompiledFor);
  try {
    for (const ShaderVariant& cones : tracer.cones) renderer.compile(cones, tiny, loaded_.view);
  } catch (const ContextLost&) {
    throw;
  } catch (const RenderError&) {
    return;  // the context that draws says so
  }
}

std::shared_ptr<SceneProgram> ScenePrograms::make(const RenderOptions& part) const {
  auto program = std::make_shared<SceneProgram>();
  program->options = part;
  const auto fail = [&](const std::exception& error) { program->error = error.what(); };
  try {
    Statistics stats;
    program->tracer = makeTracer(context_, loaded_, part, stats, {.hash = true, .levels = true});
    program->variant = stats.variant;
    program->bytes = stats.sceneBytes;
    Film tiny(kCompiledFor);
    program->tracer.renderer->setDrawTime(context_.software ? kSoftwareWishMs : kHardwareWishMs);
    program->tracer.renderer->compile(program->tracer.variant, tiny, loaded_.view);
  } catch (const ContextLost&) {
    throw;
  } catch (const RenderError& error) {
    fail(error);
  } catch (const UsageError& error) {
    fail(error);
  } catch (const InputError& error) {
    fail(error);
  }
  return program;
}

}  // namespace fragtrace
