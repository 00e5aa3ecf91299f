// SPDX-License-Identifier: MIT
// Exposure, tone map, environment and background.
#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "image/display/tone_map.h"
#include "scene/sky/blurred_map.h"
#include "view/environments.h"
#include "view/window/draw/text.h"
#include "view/window/panel_parts.h"

namespace fragtrace {

namespace {

constexpr float kMostColor = 1e4f;
constexpr float kMostIntensity = 100.0f;  // the command line takes more
constexpr float kMostFog = 10.0f;         // 1/m; as below, the command line takes more
constexpr float kMostForward = 0.95f;
constexpr float kMostFogHeight = 1000.0f;  // metres
constexpr float kLowestSun = -18.0f;       // degrees; the command line takes less
constexpr float kMostBlur = 30.0f;         // degrees; the command line takes more

/// Draws a thumbnail twice as wide as high, or leaves room if there is none, or none yet.
void drawThumbnail(const ViewFacts& facts, const EnvironmentChoice& choice, float height) {
  const ImVec2 size(2.0f * height, height);
  const bool map = choice.studio || !choice.file.empty();
  const auto found = map ? facts.thumbnails.find(choice.file) : facts.thumbnails.end();
  if (found == facts.thumbnails.end())
    ImGui::Dummy(size);
  else
    // Dear ImGui's pointer is a texture's name to its part for OpenGL.
    ImGui::Image(ImTextureID(intptr_t(found->second)), size);  // NOLINT(performance-no-int-to-ptr)
}

/// A list of what can light the scene.
void chooseEnvironment(const ViewedScene& scene, ViewFacts& facts) {
  Places& places = facts.places;
  const std::vector<EnvironmentChoice> choices = environmentChoices(scene);
  const size_t current = currentChoice(scene, choices);
  if (!ImGui::BeginCombo("##environment", shownText(choices[current].name, kMostNameCharacters).c_str()))
    return;
  facts.wantsThumbnails = true;
  const float height = 1.6f * ImGui::GetFontSize();
  for (size_t i = 0; i < choices.size(); ++i) {
    ImGui::PushID(int(i));
    drawThumbnail(facts, choices[i], height);
    ImGui::SameLine();
    const std::string name = shownText(choices[i].name, kMostNameCharacters);
    if (placed(places, "environment " + choices[i].name,
               ImGui::Selectable(name.c_str(), i == current, 0, ImVec2(0.0f, height))))
      facts.commands.push_back(
          {.command = Command::Load, .load = withEnvironment(scene.options, choices[i])});
    ImGui::PopID();
  }
  if (placed(places, "environment Open...", ImGui::Selectable("Open...")))
    facts.commands.push_back({Command::Open, 1});
  ImGui::EndCombo();
}

/// The sun of the sky, and its haze.
void drawSky(ViewState& state, Places& places) {
  SkyOptions& sky = state.edit.shared.light.sky;
  SunPlace sun = sunOf(sky);
  if (slider(places,
             {"Sun height", kLowestSun, 90.0f, "%.1f degrees", kBounded,
              "Degrees above the horizon (--sun-elevation). Shift and the right button drag the sun"},
             sun.elevation))
    placeSun(sky, sun);
  double azimuth = std::remainder(sun.azimuth, 360.0);
  if (slider(places,
             {"Sun from", -180.0f, 180.0f, "%.0f degrees", kBounded,
              "Degrees clockwise from north, which is -Z: 90 is east, +X (--sun-azimuth)"},
             azimuth)) {
    sun.azimuth = azimuth;
    placeSun(sky, sun);
  }
  slider(places,
         {"Haze", 1.0f, 10.0f, "%.1f", kBounded, "1 is air without haze, 3 a clear day (--sky-turbidity)"},
         sky.turbidity);
}

/// Fog round the scene.
void drawFog(ViewState& state, Places& places) {
  FogOptions& fog = state.edit.shared.fog;
  const std::string reason = whyNoFog(state);
  ImGui::BeginDisabled(!reason.empty());
  // The box of its colour stands on the same line.
  const float box = fog.density > 0.0 ? ImGui::GetFrameHeight() + ImGui::GetStyle().ItemSpacing.x : 0.0f;
  slider(places,
         {"Fog", 0.0f, kMostFog, fog.density > 0.0 ? "%.3f / m" : "none", kBoundedLogarithmic,
          "How dense the fog round the scene is: at 0.2 / m, light goes 5 m on average before it meets some "
          "(--fog-density). --fog-distance says how far the fog reaches",
          reason, box},
         fog.density);
  if (fog.density > 0.0) {
    ImGui::SameLine();
    glm::vec3 color = fog.color.value_or(glm::vec3(1.0f));
    constexpr ImGuiColorEditFlags kColor = ImGuiColorEditFlags_Float | ImGuiColorEditFlags_NoInputs;
    if (placed(places, "Fog colour", ImGui::ColorEdit3("##fogcolor", glm::value_ptr(color), kColor)))
      fog.color = glm::clamp(color, glm::vec3(0.0f), glm::vec3(1.0f));
    tip(places, "The part of the light that the fog scatters rather than swallows (--fog-color)");
    slider(places,
           {"Fog forward", -kMostForward, kMostForward, "%.2f", kBounded,
            "Where the fog scatters light: above 0 rather forwards, as mist before a lamp; below 0 rather "
            "back (--fog-anisotropy)"},
           fog.anisotropy);
    double height = fog.height.value_or(0.0);
    if (slider(places,
               {"Fog height", 0.0f, kMostFogHeight, height > 0.0 ? "%.2f m" : "no limit", kBoundedLogarithmic,
                "Ground fog: every so many metres up, it is thinner by a factor of e. At 0 it is as dense "
                "above as below (--fog-height)"},
               height))
      fog.height = height > 0.0 ? std::optional(height) : std::nullopt;
  } else {
    fog = FogOptions();
  }
  ImGui::EndDisabled();
}

void drawBackground(ViewState& state, Places& places) {
  LightOptions& light = state.edit.shared.light;
  label(places, "Background");
  ImGui::Checkbox("##background", &light.background);
  if (light.background && state.scene->surroundings != Surroundings::Map) {
    ImGui::SameLine();
    glm::vec3 color = light.backgroundColor.value_or(glm::vec3(0.0f));
    constexpr ImGuiColorEditFlags kColor =
        ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR | ImGuiColorEditFlags_NoInputs;
    if (placed(places, "Background colour", ImGui::ColorEdit3("##color", glm::value_ptr(color), kColor)))
      light.backgroundColor = glm::clamp(color, glm::vec3(0.0f), glm::vec3(kMostColor));
  }
}

}  // namespace

void drawLight(ViewState& state, ViewFacts& facts) {
  Places& places = facts.places;
  RenderOptions& o = state.edit.shared;
  double exposure = o.output.exposure.value_or(0.0);
  if (slider(places, {"Exposure", -8.0f, 8.0f, "%.1f EV"}, exposure)) o.output.exposure = exposure;
  choose(places, "Tone map", toneMapNames(), o.output.toneMap);
  label(places, "Environment");
  chooseEnvironment(*state.scene, facts);
  const bool map = state.scene->surroundings == Surroundings::Map;
  double degrees = std::remainder(o.light.hdriRotationDegrees, 360.0);
  // Typed values beyond the ends wrap around.
  if (slider(places,
             {"Rotation", -180.0f, 180.0f, "%.0f degrees", 0, nullptr, map ? "" : "no environment map"},
             degrees))
    o.light.hdriRotationDegrees = std::isfinite(degrees) ? std::remainder(degrees, 360.0) : 0.0;
  const bool lit = has(state.scene->present, Trait::Environment);
  slider(
      places,
      {"Intensity", 0.0f, kMostIntensity, "%.2f", kBoundedLogarithmic, nullptr, lit ? "" : "no environment"},
      o.light.hdriIntensity);
  if (o.light.sky.on) drawSky(state, places);
  const LightOptions& loaded = state.scene->options.light;
  if (!loaded.hdriFile.empty() || loaded.sky.on) {
    // The map is blurred once, when the slider is let go.
    double wanted = state.blur.value_or(loaded.backgroundBlur);
    if (slider(places, {"Blur", 0.0f, kMostBlur, wanted > 0.0 ? "%.1f degrees" : "none"}, wanted))
      state.blur = wanted;
    if (ImGui::IsItemDeactivatedAfterEdit() && state.blur) {
      facts.commands.push_back({.command = Command::Load, .load = state.scene->options});
      facts.commands.back().load->light.backgroundBlur = *state.blur < kLeastBlur ? 0.0 : *state.blur;
      state.blur.reset();
    }
  }
  drawFog(state, places);
  drawBackground(state, places);
  const bool paths = has(state.side().stages, Stage::Gi);
  ImGui::BeginDisabled(!paths);
  commandBox(facts, "Shadow catcher", o.light.shadowCatcher && paths, Command::ToggleGround);
  ImGui::EndDisabled();
  dimAtEnd(paths ? keyOf(Command::ToggleGround) : "only path traced");
}

}  // namespace fragtrace
