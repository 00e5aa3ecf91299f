// SPDX-License-Identifier: MIT
#include "bench/report/frame_report.h"

#include <algorithm>

#include "base/text.h"
#include "bench/report/json.h"

namespace fragtrace {

namespace {

Json timesJson(const std::vector<double>& ms) {
  const Summary s = summarize(ms);
  return {{"median", s.median}, {"mean", s.mean}, {"stddev", s.stddev}, {"min", s.min}, {"p95", s.p95}};
}

Json machineJson(const BenchMachine& m) { return {{"processor", m.processor}, {"cores", m.cores}}; }

Json pictureJson(const PictureVerdict& p) {
  Json json = {{"right", p.wrong.empty()}, {"against", p.against}};
  if (!p.wrong.empty()) json["wrong"] = p.wrong;
  json["rmse"] = p.rmse;
  json["differing_pixels"] = p.differing;
  json["mean_errors"] = p.meanErrors;
  json["far_blocks"] = p.farBlocks;
  return json;
}

}  // namespace

double FrameSetting::megaPathsPerSecond() const {
  const double ms = summarize(frameMs).median;
  return ms > 0.0 ? double(width) * height / ms / 1000.0 : 0.0;
}

std::optional<PairedRatio> ratioOf(const std::vector<double>& ms, const std::vector<double>& othersMs) {
  std::vector<double> ratios;
  for (size_t i = 0; i < std::min(ms.size(), othersMs.size()); ++i) {
    if (othersMs[i] > 0.0) ratios.push_back(ms[i] / othersMs[i]);
  }
  if (ratios.empty()) return std::nullopt;
  return PairedRatio{summarize(ratios), std::ranges::max(ratios)};
}

std::string ratioText(const std::optional<PairedRatio>& ratio) {
  if (!ratio) return "-";
  return formatted("%.3g (%.3g to %.3g)", ratio->summary.median, ratio->summary.min, ratio->most);
}

const FrameSetting& firstOfScene(const std::vector<FrameSetting>& settings, const FrameSetting& setting) {
  return *std::ranges::find(settings, setting.scene, &FrameSetting::scene);
}

std::string frameTable(const BenchMachine& machine, const std::vector<FrameSetting>& settings) {
  std::string text;
  const FrameSetting* before = nullptr;
  for (const FrameSetting& s : settings) {
    if (before == nullptr || before->scene != s.scene) {
      if (before != nullptr) text += '\n';
      text += formatted("%s, %d x %d, %zu triangles: milliseconds per frame by %s, %s\n", s.scene.c_str(),
                        s.width, s.height, s.triangles, s.clock.c_str(), machine.glRenderer.c_str());
      text += formatted("%-18s %10s %10s %8s %10s %10s %10s  %-22s %s\n", "configuration", "median", "mean",
                        "stddev", "p95", "Mpaths/s", "Mrays/s", "ratio to the first", "n");
    }
    before = &s;
    const Summary t = summarize(s.frameMs);
    const FrameSetting& first = firstOfScene(settings, s);
    text += formatted("%-18s %10.4g %10.4g %8.3g %10.4g %10.4g %10.4g  %-22s %zu x %d\n",
                      s.configuration.c_str(), t.median, t.mean, t.stddev, t.p95, s.megaPathsPerSecond(),
                      s.megaPathsPerSecond() * s.raysPerPath,
                      &first == &s ? "1" : ratioText(ratioOf(s.frameMs, first.frameMs)).c_str(),
                      s.frameMs.size(), s.frames);
    text +=
        formatted("%-18s compiled in %.4g ms, first frame %.4g ms; picture %s\n", "", s.compileMs,
                  s.firstFrameMs, s.picture.wrong.empty() ? "right" : ("WRONG: " + s.picture.wrong).c_str());
  }
  return text;
}

std::string frameJson(const BenchMachine& machine, const std::vector<FrameSetting>& settings) {
  std::string text;
  for (const FrameSetting& s : settings) {
    Json json;
    json["schema"] = 1;
    json["command"] = "frame";
    json["program"] = machine.program;
    json["date"] = machine.date;
    json["machine"] = machineJson(machine);
    json["gl_renderer"] = machine.glRenderer;
    json["gl_version"] = machine.glVersion;
    json["backend"] = machine.backend;
    json["scene"] = s.scene;
    json["triangles"] = s.triangles;
    json["width"] = s.width;
    json["height"] = s.height;
    json["configuration"] = s.configuration;
    json["options"] = s.options;
    json["variant"] = s.variant;
    json["clock"] = s.clock;
    json["rounds"] = s.frameMs.size();
    json["frames_per_round"] = s.frames;
    json["samples_per_draw"] = s.samplesPerDraw;
    json["compile_ms"] = s.compileMs;
    json["first_frame_ms"] = s.firstFrameMs;
    json["frame_ms"] = timesJson(s.frameMs);
    json["wall_frame_ms"] = timesJson(s.wallFrameMs);
    json["round_frame_ms"] = s.frameMs;
    json["mpaths_per_s"] = s.megaPathsPerSecond();
    json["rays_per_path"] = s.raysPerPath;
    json["mrays_per_s"] = s.megaPathsPerSecond() * s.raysPerPath;
    const FrameSetting& first = firstOfScene(settings, s);
    if (const auto ratio = ratioOf(s.frameMs, first.frameMs); ratio && &first != &s) {
      json["ratio"] = {{"to", first.configuration},   {"median", ratio->summary.median},
                       {"mean", ratio->summary.mean}, {"stddev", ratio->summary.stddev},
                       {"min", ratio->summary.min},   {"max", ratio->most}};
    }
    json["nonfinite_pixels"] = s.nonfinitePixels;
    json["budget_hits"] = s.budgetHits;
    json["picture"] = pictureJson(s.picture);
    text += jsonLine(json);
  }
  return text;
}

}  // namespace fragtrace
