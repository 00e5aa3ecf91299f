// SPDX-License-Identifier: MIT
#include "bench/report/error_report.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text.h"
#include "bench/report/json.h"

namespace fragtrace {

namespace {

constexpr double kEnoughSamples = 64.0;  // from which on errors fall as 1 / N, or faster

/// Returns the curve of that name as it was drawn, without a filter, or null.
const ErrorCurve* curveNamed(const ErrorReport& report, const std::string& name) {
  for (const ErrorCurve& curve : report.curves) {
    if (curve.name == name && curve.filter.empty()) return &curve;
  }
  return nullptr;
}

/// The same pictures filtered, if they were.
const ErrorCurve* filteredOf(const ErrorReport& report, const ErrorCurve& drawn) {
  const ErrorCurve* next = &drawn + 1;
  const bool there = drawn.filter.empty() && next != report.curves.data() + report.curves.size();
  return there && !next->filter.empty() ? next : nullptr;
}

std::string labelOf(const ErrorCurve& curve) {
  return curve.name + (curve.filter.empty() ? "" : " denoised");
}

/// The factors by which `curve` needs less time and fewer samples than `slower` to reach the goal.
struct Gain {
  double time = 0.0;
  double samples = 0.0;
  bool extrapolated = false;
};

std::optional<Gain> gainOver(const ErrorReport& report, const ErrorCurve& slower, const ErrorCurve& curve) {
  const auto a = timeToReach(slower, report.goal);
  const auto b = timeToReach(curve, report.goal);
  if (!a || !b) return std::nullopt;
  return Gain{a->seconds / b->seconds, a->samples / b->samples, a->extrapolated || b->extrapolated};
}

std::string gainText(const ErrorReport& report, const ErrorCurve& slower, const ErrorCurve& curve) {
  const auto gain = gainOver(report, slower, curve);
  return gain ? formatted("%s against %s: %.4g times sooner, %.4g times fewer samples\n",
                          labelOf(curve).c_str(), labelOf(slower).c_str(), gain->time, gain->samples)
              : "";
}

/// Returns the members that every curve's entry has.
Json measuredJson(const ErrorReport& report, const ErrorCurve& curve) {
  Json entry;
  entry["compile_ms"] = curve.compileMs;
  entry["near_reference"] = curve.nearReference;
  entry["slope"] = slopeOf(curve);
  if (const auto reached = timeToReach(curve, report.goal)) {
    entry["goal"] = {{"seconds", reached->seconds},
                     {"samples", reached->samples},
                     {"extrapolated", reached->extrapolated}};
  }
  return entry;
}

Json repetitionsJson(const ErrorCurve& curve) {
  Json repetitions = Json::array();
  for (const auto& repetition : curve.repetitions) {
    Json steps = Json::array();
    for (const ErrorSample& s : repetition) {
      steps.push_back({{"samples", s.samples},
                       {"seconds", s.seconds},
                       {"mse", s.mse},
                       {"relmse", s.relmse},
                       {"flip", s.flip}});
    }
    repetitions.push_back(std::move(steps));
  }
  return repetitions;
}

Json gainJson(const Gain& gain) {
  return {{"times_sooner", gain.time}, {"times_fewer_samples", gain.samples}};
}

/// The figures of the filtered pictures, for the entry of the unfiltered ones.
Json filteredJson(const ErrorReport& report, const ErrorCurve& drawn, const ErrorCurve& curve) {
  Json entry = {{"filter", curve.filter}};
  entry.update(measuredJson(report, curve));
  if (const auto gain = gainOver(report, drawn, curve)) entry["denoised_is"] = gainJson(*gain);
  entry["repetitions"] = repetitionsJson(curve);
  return entry;
}

}  // namespace

std::vector<ErrorStep> stepsOf(const ErrorCurve& curve) {
  std::vector<ErrorStep> steps;
  if (curve.repetitions.empty()) return steps;
  const double count = double(curve.repetitions.size());
  for (size_t i = 0; i < curve.repetitions.front().size(); ++i) {
    ErrorStep step;
    step.lowRelmse = curve.repetitions.front()[i].relmse;
    for (const auto& repetition : curve.repetitions) {
      const ErrorSample& s = repetition[i];
      step.mean.samples += s.samples / count;
      step.mean.seconds += s.seconds / count;
      step.mean.mse += s.mse / count;
      step.mean.relmse += s.relmse / count;
      step.mean.flip += s.flip / count;
      step.lowRelmse = std::min(step.lowRelmse, s.relmse);
      step.highRelmse = std::max(step.highRelmse, s.relmse);
    }
    // Adaptive goals that one number of samples meets are one step.
    if (!steps.empty() && steps.back().mean.samples == step.mean.samples) steps.pop_back();
    steps.push_back(step);
  }
  return steps;
}

std::optional<Reached> timeToReach(const ErrorCurve& curve, double relmse) {
  const std::vector<ErrorStep> steps = stepsOf(curve);
  for (size_t i = 0; i < steps.size(); ++i) {
    const ErrorSample& here = steps[i].mean;
    if (!(here.relmse <= relmse)) continue;
    if (i == 0 || here.relmse <= 0.0) return Reached{here.seconds, here.samples, false};
    const ErrorSample& before = steps[i - 1].mean;
    const double part = std::log(before.relmse / relmse) / std::log(before.relmse / here.relmse);
    return Reached{before.seconds * std::pow(here.seconds / before.seconds, part),
                   before.samples * std::pow(here.samples / before.samples, part), false};
  }
  if (steps.empty() || steps.back().mean.samples < kEnoughSamples || !curve.filter.empty())
    return std::nullopt;
  const ErrorSample& last = steps.back().mean;
  if (!std::isfinite(last.relmse)) return std::nullopt;
  const double factor = last.relmse / relmse;
  return Reached{last.seconds * factor, last.samples * factor, true};
}

double slopeOf(const ErrorCurve& curve) {
  std::vector<double> samples;
  std::vector<double> errors;
  for (const ErrorStep& step : stepsOf(curve)) {
    samples.push_back(step.mean.samples);
    errors.push_back(step.mean.relmse);
  }
  return logLogSlope(samples, errors);
}

std::string errorTable(const ErrorReport& report) {
  std::string text = report.scene + ", " + std::to_string(report.width) + " x " +
                     std::to_string(report.height) + ", reference: " + report.reference + "\n" +
                     report.renderer + "\n\n";
  text += formatted("%-18s %10s %10s %10s %10s %10s %8s\n", "configuration", "samples", "seconds", "MSE",
                    "relMSE", "FLIP", "slope");
  for (const ErrorCurve& curve : report.curves) {
    const std::vector<ErrorStep> steps = stepsOf(curve);
    for (size_t i = 0; i < steps.size(); ++i) {
      const ErrorSample& s = steps[i].mean;
      text += formatted("%-18s %10.4g %10.4g %10.3e %10.3e %10.4f", i == 0 ? labelOf(curve).c_str() : "",
                        s.samples, s.seconds, s.mse, s.relmse, s.flip);
      text += i + 1 == steps.size() ? formatted(" %8.2f\n", slopeOf(curve)) : "\n";
    }
  }
  for (const ErrorCurve& curve : report.curves) {
    if (curve.nearReference)
      text += "\nwarning: " + labelOf(curve) +
              " has more than an eighth of the reference's samples: the reference's own noise counts in its "
              "error";
  }
  text += formatted("\ntime to a relative MSE of %g\n", report.goal);
  for (const ErrorCurve& curve : report.curves) {
    const auto reached = timeToReach(curve, report.goal);
    text += formatted("%-18s ", labelOf(curve).c_str());
    text += reached ? formatted("%10.4g s %12.4g samples%s\n", reached->seconds, reached->samples,
                                reached->extrapolated ? "  (extrapolated as 1 / N)" : "")
            : curve.filter.empty() ? "not reached, nor foreseen: that takes 64 samples (--spp)\n"
                                   : "not reached\n";
  }
  const ErrorCurve* best = curveNamed(report, "default");
  const ErrorCurve* bestFiltered = best ? filteredOf(report, *best) : nullptr;
  for (const ErrorCurve& curve : report.curves) {
    const ErrorCurve* filtered = filteredOf(report, curve);
    if (filtered) text += gainText(report, curve, *filtered);
    if (!best || &curve == best || !curve.filter.empty()) continue;
    text += gainText(report, curve, *best);
    if (bestFiltered) text += gainText(report, curve, *bestFiltered);
  }
  return text;
}

std::string errorJson(const ErrorReport& report) {
  Json json;
  json["schema"] = 1;
  json["scene"] = report.scene;
  json["reference"] = report.reference;
  json["width"] = report.width;
  json["height"] = report.height;
  json["gl_renderer"] = report.renderer;
  json["goal_relmse"] = report.goal;
  const ErrorCurve* best = curveNamed(report, "default");
  for (const ErrorCurve& curve : report.curves) {
    if (!curve.filter.empty()) continue;
    Json entry = {{"name", curve.name}, {"options", curve.options}, {"variant", curve.variant}};
    entry.update(measuredJson(report, curve));
    if (const auto gain = best && &curve != best ? gainOver(report, curve, *best) : std::nullopt)
      entry["default_is"] = gainJson(*gain);
    entry["repetitions"] = repetitionsJson(curve);
    if (const ErrorCurve* filtered = filteredOf(report, curve))
      entry["denoised"] = filteredJson(report, curve, *filtered);
    json["configurations"].push_back(std::move(entry));
  }
  return json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace fragtrace
