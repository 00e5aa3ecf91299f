// SPDX-License-Identifier: MIT
#include "bench/command/motion_run.h"

#include <pthread.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <deque>
#include <fstream>
#include <numbers>
#include <thread>

#include "base/errors.h"
#include "base/parallel.h"
#include "base/timeline.h"
#include "gltf/edit/factors.h"
#include "options/command_text.h"
#include "session/picture/denoising.h"
#include "view/camera_controller.h"
#include "view/live/view_tracer.h"
#include "view/view_state.h"

namespace fragtrace {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kDolly = 0.5;                    // the share of the distance
constexpr double kLowSun = 2.0, kHighSun = 60.0;  // degrees
constexpr double kSmooth = 0.1, kRough = 0.9;

using CameraPath = std::function<CameraPose(const CameraPose& start, double seconds)>;

/// The tracing thread for as long as it lives.
class TracingThread {
 public:
  TracingThread(ViewOptions options, Exchange& exchange)
      : exchange_(exchange),
        oidn_(openDenoiser(options.render)),
        tracer_(options, std::move(oidn_), exchange),
        thread_([this] {
          nameThread("trace");
          tracer_.run({});
        }) {}
  ~TracingThread() {
    exchange_.request([](Requests& r) { r.quit = true; });
    thread_.join();
  }
  TracingThread(const TracingThread&) = delete;
  TracingThread& operator=(const TracingThread&) = delete;

  double cpuMs() {
    clockid_t clock{};
    timespec time{};
    if (::pthread_getcpuclockid(thread_.native_handle(), &clock) != 0 || ::clock_gettime(clock, &time) != 0)
      return 0.0;
    return 1e3 * double(time.tv_sec) + 1e-6 * double(time.tv_nsec);
  }

 private:
  Exchange& exchange_;
  std::optional<OidnLibrary> oidn_;  ///< until the tracer has it
  ViewTracer tracer_;
  std::thread thread_;
};

/// A request that no picture has answered yet.
struct Asked {
  uint64_t number;
  double at;  ///< steadyMilliseconds()
  RenderOptions options;
};

CameraPose between(const CameraPose& a, const CameraPose& b, double part) {
  CameraPose pose = a;
  pose.position = glm::mix(a.position, b.position, part);
  pose.focalPoint = glm::mix(a.focalPoint, b.focalPoint, part);
  pose.viewUp = glm::normalize(glm::mix(a.viewUp, b.viewUp, part));
  pose.viewAngleDegrees = std::lerp(a.viewAngleDegrees, b.viewAngleDegrees, part);
  pose.halfHeight = std::lerp(a.halfHeight, b.halfHeight, part);
  return pose;
}

CameraPath pathThrough(const std::filesystem::path& file, double period, const RenderOptions& options) {
  std::ifstream lines(file);
  if (!lines) throw InputError(file.string() + ": cannot be read");
  std::vector<CameraOverrides> places;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.empty()) continue;
    try {
      places.push_back(withCameraText(options, line).camera.overrides);
    } catch (const UsageError& error) {
      throw InputError(file.string() + ":" + std::to_string(number) + ": " + error.what());
    }
  }
  if (places.size() < 2) throw InputError(file.string() + ": has fewer than two places of the camera");
  return [places, period](const CameraPose& start, double seconds) {
    const auto poseAt = [&](size_t i) {
      const CameraOverrides& o = places[i % places.size()];
      CameraPose pose = start;
      pose.position = o.position.value_or(start.position);
      pose.focalPoint = o.focalPoint.value_or(start.focalPoint);
      pose.viewUp = o.viewUp.value_or(start.viewUp);
      pose.viewAngleDegrees = o.viewAngleDegrees.value_or(start.viewAngleDegrees);
      pose.halfHeight = o.parallelScale.value_or(start.halfHeight);
      return pose;
    };
    const double at = seconds / period * double(places.size());
    const auto from = size_t(at);
    return between(poseAt(from), poseAt(from + 1), at - double(from));
  };
}

/// Sets what materials offer by that name as its slider does.
void setFactor(ViewState& state, std::string_view member, const std::function<float(size_t part)>& value) {
  for (size_t i = 0; i < state.scene->materials.size(); ++i) {
    const Material& file = state.scene->materials[i];
    for (const Factor& factor : factors()) {
      if (factor.member != member || !isOffered(factor, file)) continue;
      Material now = file;
      for (size_t part = 0; part < std::min<size_t>(factor.width, 3); ++part)
        factor.at(now)[part] = value(part);
      setNumber(state, numberOf(factor, now), numberOf(factor, file));
    }
  }
}

ViewedScene awaitScene(Exchange& exchange) {
  for (;;) {
    Results results = exchange.take();
    for (Result& result : results.queue) {
      if (auto* scene = std::get_if<ViewedScene>(&result)) return std::move(*scene);
    }
    if (!results.status.error.empty()) throw InputError(results.status.error);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

/// Adds what one picture says of itself.
void count(MotionFigures& figures, const TracedPicture& picture) {
  ++figures.pictures;
  figures.pixels += double(picture.size.x) * picture.size.y;
  // Pictures that are kept for the comparison are read back, which no picture of a viewer is.
  const double readBack = double(picture.image.values.size()) * sizeof(float);
  figures.movedBytes += std::max(0.0, double(picture.statistics.movedBytes) - readBack);
  for (size_t pass = 0; pass < kPassNames.size(); ++pass) {
    figures.passes.cpu[pass] += picture.statistics.passes.cpu[pass];
    figures.passes.wall[pass] += picture.statistics.passes.wall[pass];
  }
}

/// Returns true if another picture must be kept once `pictures` have counted.
bool isDue(const MotionFigures& figures, const MotionPlan& plan, int pictures) {
  return figures.kept.size() < size_t(pictures) * size_t(plan.compared) / size_t(plan.pictures);
}

}  // namespace

Motion motionOf(const std::string& name, double period, const RenderOptions& options) {
  const auto turnAt = [period](double s) { return kTurn * s / period; };
  const auto shareAt = [turnAt](double s) { return 0.5 * (1.0 - std::cos(turnAt(s))); };  // 0 to 1 and back
  if (name == "sun") {
    if (!options.light.sky.on) throw UsageError("--path sun: needs --sky");
    return [shareAt](ViewState& state, const CameraPose&, double s) {
      SkyOptions& sky = state.edit.shared.light.sky;
      placeSun(sky, {std::lerp(kLowSun, kHighSun, shareAt(s)), sunOf(sky).azimuth});
    };
  }
  if (name == "roughness") {
    return [shareAt](ViewState& state, const CameraPose&, double s) {
      setFactor(state, "roughnessFactor",
                [&](size_t) { return float(std::lerp(kSmooth, kRough, shareAt(s))); });
    };
  }
  if (name == "color") {
    return [turnAt](ViewState& state, const CameraPose&, double s) {
      setFactor(state, "baseColorFactor", [&](size_t part) {
        return float(0.5 + 0.25 * std::cos(turnAt(s) - kTurn * double(part) / 3.0));
      });
    };
  }
  CameraPath path;
  if (name == "orbit") {
    path = [turnAt](const CameraPose& start, double s) { return orbit(start, turnAt(s), 0.0); };
  } else if (name == "dolly") {
    path = [shareAt](const CameraPose& start, double s) {
      return zoom(start, -std::log(1.0 - kDolly * shareAt(s)));
    };
  } else {
    path = pathThrough(name, period, options);
  }
  return [path](ViewState& state, const CameraPose& start, double s) { state.edit.pose = path(start, s); };
}

namespace {

/// The viewer's state once the scene is loaded.
ViewState loadedState(const MotionPlan& plan, Exchange& exchange) {
  exchange.request(&Requests::load, {plan.view.render});
  ViewState state;
  state.edit = editOf(plan.view.render);
  showScene(state, awaitScene(exchange));
  state.size = plan.size;
  state.edit.posed = true;
  return state;
}

}  // namespace

MotionFigures runMotion(const MotionPlan& plan, const std::function<bool(double fraction)>& goOn) {
  Exchange exchange;
  TracingThread thread(plan.view, exchange);
  ViewState state = loadedState(plan, exchange);
  const CameraPose start = state.edit.pose;
  MotionFigures figures;
  std::deque<Asked> unanswered;
  uint64_t asked = 0;
  const int all = plan.warmUp + plan.pictures;
  int seen = 0;
  const double begin = steadyMilliseconds();
  double next = begin;
  double counted = 0.0;  // since when
  double cpuBefore = 0.0;
  double last = 0.0;
  RenderOptions answered;  // the options that the latest picture answers
  // A picture that is to be kept may come after the last that counts, as it has to be asked for.
  while ((seen < all || figures.kept.size() < size_t(plan.compared)) &&
         goOn(std::min(double(seen) / all, 1.0))) {
    const double now = steadyMilliseconds();
    if (now >= next) {
      plan.move(state, start, 1e-3 * (now - begin));
      const bool kept = isDue(figures, plan, std::min(figures.pictures + 1, plan.pictures));
      exchange.request(&Requests::trace, {++asked, tracedSides(state), plan.size, true, kept});
      unanswered.push_back({asked, now, renderOptionsOf(state, 0)});
      next = std::max(next + plan.intervalMs, now);
    }
    Results results = exchange.take();
    if (!results.status.error.empty()) throw RenderError(results.status.error);
    for (TracedPicture& picture : results.pictures) {
      const double at = steadyMilliseconds();
      ++seen;
      if (seen == plan.warmUp) {
        counted = at;
        cpuBefore = thread.cpuMs();
      }
      const bool counts = seen > plan.warmUp && seen <= all;
      while (!unanswered.empty() && unanswered.front().number <= picture.request) {
        if (counts) figures.latencyMs.push_back(at - unanswered.front().at);
        answered = std::move(unanswered.front().options);
        unanswered.pop_front();
      }
      if (counts) {
        figures.gapMs.push_back(at - last);
        figures.seconds = 1e-3 * (at - counted);
        figures.cpuMs = thread.cpuMs() - cpuBefore;
        count(figures, picture);
      }
      if (seen > plan.warmUp && isDue(figures, plan, figures.pictures) && picture.image.width > 0)
        figures.kept.push_back({std::move(picture.image), answered});
      last = at;
    }
    if (results.pictures.empty()) std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
  return figures;
}

}  // namespace fragtrace
