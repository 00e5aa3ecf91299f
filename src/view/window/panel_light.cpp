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
    if (ImGui::Selectable(name.c_str(), i == current, 0, ImVec2(0.0f, height)))
      facts.commands.push_back(
          {.command = Command::Load, .load = withEnvironment(scene.options, choices[i])});
    addItemPlace(places, "environment " + choices[i].name);
    ImGui::PopID();
  }
  if (ImGui::Selectable("Open...")) facts.commands.push_back({Command::Open, 1});
  addItemPlace(places, "environment Open...");
  ImGui::EndCombo();
}

/// The sun of the sky, and its haze.
void drawSky(ViewState& state, Places& places) {
  SkyOptions& sky = state.edit.shared.light.sky;
  SunPlace sun = sunOf(sky);
  if (slider(places, "Sun height", sun.elevation, kLowestSun, 90.0f, "%.1f degrees")) placeSun(sky, sun);
  tip(places, "Degrees above the horizon (--sun-elevation). Shift and the right button drag the sun");
  double azimuth = std::remainder(sun.azimuth, 360.0);
  if (slider(places, "Sun from", azimuth, -180.0f, 180.0f, "%.0f degrees")) {
    sun.azimuth = azimuth;
    placeSun(sky, sun);
  }
  tip(places, "Degrees clockwise from north, which is -Z: 90 is east, +X (--sun-azimuth)");
  slider(places, "Haze", sky.turbidity, 1.0f, 10.0f, "%.1f");
  tip(places, "1 is air without haze, 3 a clear day (--sky-turbidity)");
}

/// Fog round the scene.
void drawFog(ViewState& state, Places& places) {
  FogOptions& fog = state.edit.shared.fog;
  const std::string reason = whyNoFog(state);
  ImGui::BeginDisabled(!reason.empty());
  label(places, "Fog");
  // The box of its colour stands on the same line.
  if (fog.density > 0.0) ImGui::SetNextItemWidth(-ImGui::GetFrameHeight() - ImGui::GetStyle().ItemSpacing.x);
  float density = float(fog.density);
  const char* format = !reason.empty() ? reason.c_str() : density > 0.0f ? "%.3f / m" : "none";
  if (ImGui::SliderFloat("##fog", &density, 0.0f, kMostFog, format, kBoundedLogarithmic))
    fog.density = density;
  tip(places,
      "How dense the fog round the scene is: at 0.2 / m, light goes 5 m on average before it meets some "
      "(--fog-density). --fog-distance says how far the fog reaches");
  if (fog.density > 0.0) {
    ImGui::SameLine();
    glm::vec3 color = fog.color.value_or(glm::vec3(1.0f));
    constexpr ImGuiColorEditFlags kColor = ImGuiColorEditFlags_Float | ImGuiColorEditFlags_NoInputs;
    if (ImGui::ColorEdit3("##fogcolor", glm::value_ptr(color), kColor))
      fog.color = glm::clamp(color, glm::vec3(0.0f), glm::vec3(1.0f));
    addItemPlace(places, "Fog colour");
    tip(places, "The part of the light that the fog scatters rather than swallows (--fog-color)");
    slider(places, "Fog forward", fog.anisotropy, -kMostForward, kMostForward, "%.2f");
    tip(places,
        "Where the fog scatters light: above 0 rather forwards, as mist before a lamp; below 0 rather "
        "back (--fog-anisotropy)");
    double height = fog.height.value_or(0.0);
    if (slider(places, "Fog height", height, 0.0f, kMostFogHeight, height > 0.0 ? "%.2f m" : "no limit",
               kBoundedLogarithmic))
      fog.height = height > 0.0 ? std::optional(height) : std::nullopt;
    tip(places,
        "Ground fog: every so many metres up, it is thinner by a factor of e. At 0 it is as dense above "
        "as below (--fog-height)");
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
    if (ImGui::ColorEdit3("##color", glm::value_ptr(color),
                          ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR | ImGuiColorEditFlags_NoInputs))
      light.backgroundColor = glm::clamp(color, glm::vec3(0.0f), glm::vec3(kMostColor));
    addItemPlace(places, "Background colour");
  }
}

}  // namespace

void drawLight(ViewState& state, ViewFacts& facts) {
  Places& places = facts.places;
  RenderOptions& o = state.edit.shared;
  double exposure = o.output.exposure.value_or(0.0);
  if (slider(places, "Exposure", exposure, -8.0f, 8.0f, "%.1f EV")) o.output.exposure = exposure;
  label(places, "Tone map");
  choose("##curve", toneMapNames(), o.output.toneMap);
  const bool map = state.scene->surroundings == Surroundings::Map;
  label(places, "Environment");
  chooseEnvironment(*state.scene, facts);
  label(places, "Rotation");
  ImGui::BeginDisabled(!map);
  auto degrees = float(std::remainder(o.light.hdriRotationDegrees, 360.0));
  // Typed values beyond the ends wrap around.
  if (ImGui::SliderFloat("##rotation", &degrees, -180.0f, 180.0f,
                         map ? "%.0f degrees" : "no environment map"))
    o.light.hdriRotationDegrees = std::isfinite(degrees) ? std::remainder(degrees, 360.0f) : 0.0f;
  ImGui::EndDisabled();
  label(places, "Intensity");
  const bool lit = has(state.scene->present, Trait::Environment);
  ImGui::BeginDisabled(!lit);
  float intensity = float(o.light.hdriIntensity);
  if (ImGui::SliderFloat("##intensity", &intensity, 0.0f, kMostIntensity, lit ? "%.2f" : "no environment",
                         kBoundedLogarithmic))
    o.light.hdriIntensity = intensity;
  ImGui::EndDisabled();
  if (o.light.sky.on) drawSky(state, places);
  if (!state.scene->options.light.hdriFile.empty() || state.scene->options.light.sky.on) {
    label(places, "Blur");
    const double blur = state.scene->options.light.backgroundBlur;
    // The map is blurred once, when the slider is let go.
    float wanted = state.blur.value_or(float(blur));
    if (ImGui::SliderFloat("##blur", &wanted, 0.0f, kMostBlur, wanted > 0.0f ? "%.1f degrees" : "none",
                           kBounded))
      state.blur = wanted;
    if (ImGui::IsItemDeactivatedAfterEdit() && state.blur) {
      facts.commands.push_back({.command = Command::Load, .load = state.scene->options});
      facts.commands.back().load->light.backgroundBlur = *state.blur < kLeastBlur ? 0.0 : double(*state.blur);
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
