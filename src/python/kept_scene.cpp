// SPDX-License-Identifier: MIT
#include "python/kept_scene.h"

#include <unistd.h>

#include <deque>
#include <stdexcept>
#include <thread>
#include <utility>

#include <CLI/CLI.hpp>

#include "base/errors.h"
#include "base/parallel.h"
#include "options/option_row.h"
#include "options/parse_render.h"
#include "session/interrupt.h"
#include "session/picture/denoising.h"
#include "session/picture/sequence.h"
#include "session/say.h"
#include "session/shutter.h"

namespace fragtrace {

namespace {

/// The queue lives as long as the process, since the thread does.
struct Queue {
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<std::shared_ptr<DrawJob>> jobs;
  std::shared_ptr<DrawJob> current;
  std::atomic<bool> stopping = false;
  pid_t process = 0;
};

Queue& queue() {
  static auto* const theOne = new Queue;
  return *theOne;
}

void perform(DrawJob& job) {
  const InterruptSource interrupted(job.interrupts);
  const SaidHere heard(job.said);
  try {
    job.work(job);
  } catch (...) {
    job.error = std::current_exception();
  }
  job.work = nullptr;  // frees what it holds in this thread
}

[[noreturn]] void performAll() {
  Queue& q = queue();
  while (true) {
    std::unique_lock lock(q.mutex);
    q.changed.wait(lock, [&] { return !q.jobs.empty(); });
    q.current = std::move(q.jobs.front());
    q.jobs.pop_front();
    const std::shared_ptr<DrawJob> job = q.current;
    lock.unlock();
    perform(*job);
    lock.lock();
    q.current.reset();
    lock.unlock();
    job->end();
    q.changed.notify_all();
  }
}

/// The device, and the scenes that have data on it.
struct DrawingState {
  Device device;
  std::string chosen;  ///< --device of the context
  std::vector<std::weak_ptr<KeptScene>> scenes;
};

/// The state of the drawing thread. It is never destroyed, since the driver may be unloaded first.
DrawingState& drawing() {
  static auto* const theOne = new DrawingState;
  return *theOne;
}

/// Throws UsageError unless the options draw by the context of the process, which all scenes share.
void checkBackend(const RenderOptions& options) {
  const Device& device = drawing().device;
  std::string& chosen = drawing().chosen;
  if (!device.context) {
    chosen = options.device.device;
    return;
  }
  if (!options.device.device.empty() && options.device.device != chosen)
    throw UsageError("--device: this process draws on " + device.context->renderer +
                     " already; another needs another process");
  const std::string& name = device.context->backend;
  const bool other = (options.device.backend == Backend::Egl && name != "egl") ||
                     (options.device.backend == Backend::OsMesa && name != "osmesa");
  if (other)
    throw UsageError("--rendering-backend: this process draws by " + name +
                     " already; another needs another process");
}

/// The driver has lost all that was on the device.
void forgetDevice() {
  DrawingState& state = drawing();
  for (const auto& kept : state.scenes) {
    if (const auto scene = kept.lock()) scene->session.forgetTracer();
  }
  state.device.filter.reset();
  state.device.driverLog.reset();
  state.device.context.reset();
}

/// The options of a sequence, with the camera that shows all poses of its animation.
const RenderOptions& placed(KeptScene& kept, const RenderOptions& options) {
  if (!kept.placed) {
    std::shared_ptr<KeptDocument> document;
    RenderOptions settled = options;
    if (options.output.sequence.frames) settled = placedForAllPoses(options, document);
    kept.session = Session(std::numeric_limits<double>::infinity(), true, std::move(document));
    kept.placed = std::move(settled);
  }
  return *kept.placed;
}

std::optional<DrawnPicture> draw(KeptScene& kept, const RenderOptions& asked, int index, DrawJob& job) {
  RenderOptions options = asked;
  Device& device = drawing().device;
  device.oidn = openDenoiser(options);
  checkBackend(options);
  Statistics stats;
  Renewal renewal = Renewal::None;
  if (isSequence(asked)) {
    const SequenceOptions& sequence = asked.output.sequence;
    const SequenceFrame frame = frameOf(placed(kept, asked), index);
    options = frame.options;
    stats = prepareFrame(kept.session, device, frame, sequence);
    turnView(kept.session.loaded(), options, frame, sequence);
  } else {
    renewal = kept.session.set(withGuides(options), device, stats);
  }
  if (!kept.isKept) kept.session.releaseGeometry();
  const PictureJob picture{options, kept.session.loaded(), kept.session.tracer(), false,
                           [&](double fraction) { job.fraction = fraction; }};
  DrawingPlan plan = planDrawing(picture, device, stats);
  CheckpointKeeper keeper(options);
  std::optional<Image> image = drawSamples(picture, plan, device, keeper, 0, stats);
  if (!image || !finishPicture(*image, picture, plan, device, 0, stats)) return std::nullopt;
  sayHowItEnded(options, stats);
  return DrawnPicture{std::move(*image), statisticsText(stats), stats.complete, renewal};
}

}  // namespace

void DrawJob::end() {
  const std::lock_guard lock(mutex_);
  ended_ = true;
  changed_.notify_all();
}

bool DrawJob::wait(int milliseconds) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, std::chrono::milliseconds(milliseconds), [&] { return ended_; });
}

std::shared_ptr<DrawJob> postJob(std::function<void(DrawJob&)> work) {
  Queue& q = queue();
  // A fork copies no threads, but perhaps a locked mutex.
  if (q.process != 0 && q.process != ::getpid()) {
    throw std::runtime_error(
        "this process was forked from one that has drawn already, and OpenGL does not survive that; start "
        "processes with "
        "multiprocessing.get_context('spawn')");
  }
  auto job = std::make_shared<DrawJob>();
  job->work = std::move(work);
  const std::lock_guard lock(q.mutex);
  if (q.stopping) {
    job->end();
    return job;
  }
  if (q.process == 0) {
    q.process = ::getpid();
    std::thread([] {
      nameThread("trace");
      performAll();
    }).detach();
  }
  q.jobs.push_back(job);
  q.changed.notify_all();
  return job;
}

void stopDrawing() {
  Queue& q = queue();
  if (q.process != ::getpid()) return;
  std::unique_lock lock(q.mutex);
  q.stopping = true;
  for (const auto& job : q.jobs) job->interrupts = 2;
  if (q.current) q.current->interrupts = 2;
  q.changed.wait(lock, [&] { return q.jobs.empty() && !q.current; });
}

bool isDrawingStopped() { return queue().stopping; }

std::optional<DrawnPicture> drawKept(const std::shared_ptr<KeptScene>& scene, const RenderOptions& options,
                                     int index, DrawJob& job) {
  if (job.interrupts > 0) return std::nullopt;
  std::vector<std::weak_ptr<KeptScene>>& scenes = drawing().scenes;
  std::erase_if(scenes, [&](const auto& other) { return other.expired() || other.lock() == scene; });
  scenes.push_back(scene);
  try {
    return draw(*scene, options, index, job);
  } catch (const ContextLost&) {
    forgetDevice();
    throw;
  }
}

void releaseLater(std::shared_ptr<KeptScene> scene) {
  postJob([scene = std::move(scene)](DrawJob&) mutable { scene.reset(); });
}

namespace {

struct RawWords {
  RawRender render;
  std::string config;
};

void addWords(CLI::App& app, RawWords& raw) {
  app.set_help_flag();
  raw.render.anyOutput = true;
  addOption(app, "file", raw.render)->required();
  for (const OptionGroup group :
       {OptionGroup::Tracing, OptionGroup::Output, OptionGroup::Sequence, OptionGroup::Filter})
    addOptions(app, group, raw.render);
  addConfigOption(app, raw.config);
}

}  // namespace

std::vector<std::string> optionNames() {
  RawWords raw;
  CLI::App app("", "fragtrace.render");
  addWords(app, raw);
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  }
  return names;
}

std::string optionLike(const std::string& unknown) {
  std::vector<std::string> names = optionNames();
  for (std::string& name : names) name.insert(0, "--");
  return suggestedOption(unknown, names);
}

RenderOptions optionsOfWords(std::vector<std::string> words) {
  RawWords raw;
  CLI::App app("", "fragtrace.render");
  addWords(app, raw);
  parseWords(app, std::move(words));
  RenderOptions options = finishConfigured(raw.render, raw.config, app);
  if (options.output.checkpointSeconds > 0.0 || options.output.resume)
    throw UsageError("--checkpoint: needs a file, so the command `fragtrace render`");
  if (options.output.treeLevel)
    throw UsageError("--tree-level: is drawn over files, so needs the command `fragtrace render`");
  if (!options.output.traceFile.empty())
    throw UsageError("--trace-file: needs the command `fragtrace render`");
  if (!options.output.shaderText.empty())
    throw UsageError("--shader-text: needs the command `fragtrace render`");
  if (!options.output.statsFile.empty()) throw UsageError("--stats: the picture has its statistics with it");
  RenderOptions numbered = options;
  numbered.output.file = "#.exr";
  if (isSequence(options)) checkSequence(numbered);
  return options;
}

}  // namespace fragtrace
