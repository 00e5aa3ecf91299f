// SPDX-License-Identifier: MIT
#include "view/window/overlay.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/summary.h"
#include "image/files/whole_file.h"
#include "options/option_row.h"
#include "view/window/glfw_window.h"

namespace fragtrace {

namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kMostTimes = 512;

Json timesJson(const std::deque<double>& ms) {
  if (ms.empty()) return nullptr;
  const Summary s = summarize({ms.begin(), ms.end()});
  return {{"median", s.median}, {"p95", s.p95}, {"max", *std::ranges::max_element(ms)}, {"count", ms.size()}};
}

Json sideJson(const RenderOptions& options, const ViewFacts& facts, size_t side) {
  const SideStatistics& s = facts.statistics[side];
  Json stages = Json::array();
  for (const StageRow& row : stageRows()) {
    if (has(options.stages, row.stage)) stages.push_back(row.name);
  }
  return {{"samples", s.samples},
          {"error", s.error},
          {"seconds", s.seconds},
          {"frame_ms", s.frameMs},
          {"frame_p95_ms", s.frameP95Ms},
          {"mrays_per_s", s.megaRaysPerSecond},
          {"mpaths_per_s", s.megaPathsPerSecond},
          {"resting", s.resting},
          {"filtered", s.filtered},
          {"filter_ms", s.filterMs},
          {"copied", s.copied},
          {"variant", s.variant},
          {"width", facts.pictureSize[side].x},
          {"height", facts.pictureSize[side].y},
          {"stages", stages}};
}

const char* stateName(const ViewState& state, const ViewFacts& facts, const WindowReport& report) {
  if (report.end) return report.end;
  if (facts.trace.load.busy) return "loading";
  if (!state.scene) return "empty";
  if (!facts.trace.note.empty()) return "compiling";
  const bool resting = facts.trace.resting && facts.trace.request == report.asked;
  return resting ? "resting" : "drawing";
}

std::string textOf(const Json& json) {
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json animationJson(const ViewState& state) {
  const int animation = shownAnimation(state);
  if (animation < 0) return {};
  const std::optional<double>& time = state.edit.shared.selection.animationTime;
  return {{"index", animation},
          {"playing", state.playback.playing},
          {"length", animationLength(state)},
          {"time", time ? Json(*time) : Json()}};
}

Json boundsJson(const BoundsDouble& b) {
  if (b.empty()) return {};
  return {b.minimum.x, b.minimum.y, b.minimum.z, b.maximum.x, b.maximum.y, b.maximum.z};
}

Json setJson(const std::vector<SetNumber>& numbers) {
  Json json = Json::object();
  for (const SetNumber& set : numbers)
    json[set.pointer] = set.word.empty() ? Json(set.values) : Json(set.word);
  return json;
}

/// As the latest frame has seen it.
Json mouseJson() {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  return ImGui::IsMousePosValid(&mouse) ? Json({mouse.x, mouse.y}) : Json();
}

}  // namespace

void keepTime(std::deque<double>& times, double ms) {
  times.push_back(ms);
  if (times.size() > kMostTimes) times.pop_front();
}

std::string failureText(const std::string& error) {
  return textOf({{"schema", 1}, {"state", "failed"}, {"error", error}});
}

std::string statusText(const ViewState& state, const ViewFacts& facts, const WindowReport& report) {
  const RenderOptions& shared = state.edit.shared;
  Json json;
  json["schema"] = 1;
  json["state"] = stateName(state, facts, report);
  json["scene"] = state.scene ? state.scene->options.scene.string() : "";
  json["environment"] = state.scene ? state.scene->options.light.hdriFile.string() : "";
  json["variant"] = state.scene ? state.scene->options.selection.materialVariant : "";
  json["width"] = state.size.x;
  json["height"] = state.size.y;
  json["asked"] = report.asked;
  json["answered"] = report.answered;
  json["pictures"] = report.pictures;
  json["frames"] = report.frames;
  json["overview"] = state.overview;
  json["split"] = state.edit.split;
  json["bar"] = state.bar;
  json["comparison"] = kComparisonNames[size_t(state.comparison)];
  json["magnified"] = std::exp2(state.magnifier.steps);
  json["fullscreen"] = state.fullscreen;
  json["fly_speed"] = state.flySpeed;
  json["status"] = facts.status;
  json["panel"] = state.panel;
  json["sheet"] = state.sheet;
  json["sheet_lines"] = facts.sheetLines;
  json["sides"] = Json::array();
  const std::vector<RenderOptions> sides = tracedSides(state);
  for (size_t i = 0; i < sides.size(); ++i) json["sides"].push_back(sideJson(sides[i], facts, i));
  json["camera"] = report.camera;
  json["exposure"] = shared.output.exposure.value_or(0.0);
  json["tone_map"] = toneMapNames()[size_t(shared.output.toneMap)];
  json["thumbnails"] = facts.thumbnails.size();
  json["reference"] = state.reference.string();
  json["up"] = state.scene ? rowOf("--up").words(state.scene->options).front() : "";
  json["hidden"] = shared.selection.hiddenNodes;
  json["set"] = setJson(shared.selection.set);
  json["hdri_rotation"] = shared.light.hdriRotationDegrees;
  json["sun"] = {sunOf(shared.light.sky).elevation, sunOf(shared.light.sky).azimuth};
  json["hdri_intensity"] = shared.light.hdriIntensity;
  json["background"] = shared.light.background;
  json["animation"] = animationJson(state);
  json["load_step"] = facts.trace.load.step;
  json["load_fraction"] = facts.trace.load.fraction;
  json["error"] = facts.trace.error;
  json["messages"] = Json::array();
  for (const Message& message : facts.messages) json["messages"].push_back(message.text);
  json["dialog"] = facts.dialog ? "desktop" : "";
  json["focus"] = Interface::focus();
  json["mouse"] = mouseJson();
  json["places"] = places();
  json["pick"] = facts.pick ? Json(pickLines(state, *facts.pick)) : Json();
  json["measured"] =
      facts.pick && facts.pick->end ? Json(distanceText(facts.pick->point, *facts.pick->end)) : Json();
  json["selected"] = boundsJson(state.selected);
  json["gl_errors"] = report.glErrors;
  json["loop_ms"] = timesJson(report.loopMs);
  json["longest_loop_ms"] = report.longestLoopMs;
  json["answer_ms"] = timesJson(report.answerMs);
  return textOf(json);
}

void writeStatusFile(const std::filesystem::path& file, const std::string& text) {
  if (file.empty()) return;
  replaceFile(file, {reinterpret_cast<const uint8_t*>(text.data()), text.size()}, Kept::Briefly);
}

}  // namespace fragtrace
