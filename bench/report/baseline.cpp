// SPDX-License-Identifier: MIT
#include "bench/report/baseline.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "base/errors.h"
#include "base/text.h"

namespace fragtrace {

namespace {

BaselineEntry entryOf(const nlohmann::json& json) {
  if (json.at("schema") != 1) throw std::runtime_error("its \"schema\" is not 1");
  BaselineEntry e;
  e.scene = json.at("scene");
  e.options = json.at("options");
  e.renderer = json.at("gl_renderer");
  e.clock = json.at("clock");
  e.width = json.at("width");
  e.height = json.at("height");
  e.samplesPerDraw = json.at("samples_per_draw");
  e.triangles = json.at("triangles");
  e.medianMs = json.at("frame_ms").at("median");
  if (!(e.medianMs > 0.0)) throw std::runtime_error("its median frame time is not above 0");
  return e;
}

std::string nameOf(const std::string& scene, const std::string& options) {
  return options.empty() ? scene : scene + " " + options;
}

bool matches(const BaselineEntry& e, const BenchMachine& machine, const FrameSetting& s) {
  return e.scene == s.scene && e.triangles == s.triangles && e.options == s.options &&
         e.renderer == machine.glRenderer && e.clock == s.clock && e.width == s.width &&
         e.height == s.height && e.samplesPerDraw == s.samplesPerDraw;
}

}  // namespace

std::vector<BaselineEntry> parseBaseline(const std::string& text, const std::string& name) {
  std::vector<BaselineEntry> entries;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.empty()) continue;
    const auto refuse = [&](const std::string& why) {
      std::string said = name + ": line " + std::to_string(number) + " is none of `bench frame --json`: ";
      return InputError(said += why);
    };
    try {
      entries.push_back(entryOf(nlohmann::json::parse(line)));
    } catch (const nlohmann::json::parse_error& error) {
      throw refuse("no JSON from its character " + std::to_string(error.byte) + " on");
    } catch (const nlohmann::json::exception&) {
      throw refuse("a member is missing, or not of its type");
    } catch (const std::runtime_error& error) {
      throw refuse(error.what());
    }
  }
  if (entries.empty()) throw InputError(name + ": holds no setting of `bench frame --json`");
  return entries;
}

std::vector<BaselineChange> compareWithBaseline(const std::vector<BaselineEntry>& baseline,
                                                const BenchMachine& machine,
                                                const std::vector<FrameSetting>& settings, double tolerance) {
  std::vector<BaselineChange> changes;
  std::vector<bool> used(baseline.size(), false);
  for (const FrameSetting& s : settings) {
    const BaselineEntry* then = nullptr;
    for (size_t i = 0; i < baseline.size(); ++i) {
      if (!matches(baseline[i], machine, s)) continue;
      then = &baseline[i];
      used[i] = true;
    }
    BaselineChange change;
    change.name = nameOf(s.scene, s.options);
    if (then != nullptr) {
      change.ratio = summarize(s.frameMs).median / then->medianMs;
      change.slower = !(change.ratio <= 1.0 + tolerance);
    } else {
      const bool otherScene = std::ranges::any_of(
          baseline, [&](const BaselineEntry& e) { return e.scene == s.scene && e.triangles != s.triangles; });
      change.note = otherScene ? "the baseline's scene of that name has another number of triangles"
                               : "not in the baseline";
    }
    changes.push_back(std::move(change));
  }
  for (size_t i = 0; i < baseline.size(); ++i) {
    if (!used[i])
      changes.push_back({nameOf(baseline[i].scene, baseline[i].options), 0.0, false, "only in the baseline"});
  }
  return changes;
}

std::string baselineTable(const std::vector<BaselineChange>& changes, double tolerance) {
  std::string text =
      formatted("\nmedian frame time over that of the baseline (slower: above %.3g)\n", 1.0 + tolerance);
  for (const BaselineChange& c : changes) {
    text += c.note.empty() ? formatted("%8.3f  %s%s\n", c.ratio, c.name.c_str(), c.slower ? "  SLOWER" : "")
                           : formatted("%8s  %s: %s\n", "-", c.name.c_str(), c.note.c_str());
  }
  return text;
}

}  // namespace fragtrace
