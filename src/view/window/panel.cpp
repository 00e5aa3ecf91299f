// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "base/text.h"
#include "gltf/edit/factors.h"
#include "image/display/tone_map.h"
#include "options/check_render.h"
#include "scene/parts.h"
#include "scene/sky/map_filter.h"
#include "view/files.h"
#include "view/view_state.h"
#include "view/window/input.h"
#include "view/window/widgets.h"

namespace fragtrace {

namespace {

// The choice among the file's scenes and material variants.

bool hasParts(const ViewState& state) {
  return state.scene->sceneNames.size() > 1 || !state.scene->materialVariants.empty();
}

void drawParts(const ViewState& state, ViewFacts& facts) {
  const ViewedScene& scene = *state.scene;
  const auto chooseFrom = [&](const char* name, const char* none, const std::vector<std::string>& names,
                              std::string SceneSelection::*part) {
    const std::string& current = scene.options.selection.*part;
    const auto nameOf = [&](size_t i) { return i == 0 ? none : partText(i - 1, names[i - 1]); };
    const std::optional<size_t> shown = current.empty() ? std::nullopt : findPart(current, names);
    const auto chosen = choose(name, names.size() + 1, shown ? *shown + 1 : 0, nameOf);
    const std::string wanted = chosen.value_or(0) == 0 ? "" : std::to_string(*chosen - 1);
    if (!chosen || wanted == current) return;
    facts.commands.push_back({.command = Command::Load, .load = scene.options});
    facts.commands.back().load->selection.*part = wanted;
  };
  if (scene.sceneNames.size() > 1)
    chooseFrom("Scene", "the file's own choice", scene.sceneNames, &SceneSelection::scene);
  if (!scene.materialVariants.empty())
    chooseFrom("Variant", "none", scene.materialVariants, &SceneSelection::materialVariant);
}

// Sliders for the numbers of materials and lights that are set by eye.

constexpr float kMostBrighter = 100.0f;  // than in the file

/// The room at the end of a row for the button that goes back to the file's value.
float roomForReset() { return ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x; }

/// Ends a row: sets its number if that has changed, and goes back to the file's by a button.
void endRow(ViewState& state, const char* name, bool changed, const SetNumber& now, const SetNumber& file) {
  if (changed) setNumber(state, now, file);
  if (isSame(now, file)) return;
  ImGui::SameLine(0.0f, ImGui::GetStyle().ItemInnerSpacing.x);
  ImGui::PushID(name);
  if (placed(std::string("reset ") + name, ImGui::Button("x", {ImGui::GetFrameHeight(), 0.0f})))
    setNumber(state, file, file);
  ImGui::PopID();
  tip("back to the file's value");
}

void drawFactor(ViewState& state, const Factor& factor, const Material& file, Material now) {
  label(factor.label);
  const std::string id = std::string("##") + factor.member;
  float* first = factor.at(now);
  const ImGuiSliderFlags flags = factor.logarithmic ? kBoundedLogarithmic : kBounded;
  bool changed = false;
  if (factor.width > 1) {
    glm::vec3 color = glm::make_vec3(first);
    changed = editColor(id.c_str(), color, 1.0f, true, roomForReset());
    std::copy_n(glm::value_ptr(color), 3, first);
  } else {
    ImGui::SetNextItemWidth(-roomForReset());
    changed = ImGui::SliderFloat(id.c_str(), first, factor.least, factor.most, "%.3f", flags);
  }
  endRow(state, factor.label, changed, numberOf(factor, now), numberOf(factor, file));
}

void drawLightSource(ViewState& state, size_t index) {
  const LightSource& file = state.scene->lights[index];
  LightSource now = file;
  setLight(now, index, state.edit.shared.selection.set);
  const float most = file.intensity > 0.0 ? kMostBrighter * float(file.intensity) : kMostBrighter;
  const bool brighter = slider({.name = "Light intensity",
                                .most = most,
                                .format = "%.4g",
                                .flags = kBoundedLogarithmic,
                                .spare = roomForReset()},
                               now.intensity);
  if (brighter) now.intensity = shortest(float(now.intensity));
  endRow(state, "Light intensity", brighter, intensityOf(now, index), intensityOf(file, index));
  label("Light colour");
  glm::vec3 color(now.color);
  const bool colored = editColor("##color", color, 1.0f, true, roomForReset());
  if (colored) now.color = {shortest(color.x), shortest(color.y), shortest(color.z)};
  endRow(state, "Light colour", colored, colorOf(now, index), colorOf(file, index));
}

void drawMaterial(ViewState& state, size_t index) {
  const Material& file = state.scene->materials[index];
  const Material now = shownMaterial(state, index);
  for (const Factor& factor : factors()) {
    if (isOffered(factor, file)) drawFactor(state, factor, file, now);
  }
}

// The scene's nodes, which can be selected and hidden, and its materials.

constexpr float kMostRows = 12.0f;
constexpr int kDepthOpen = 2;  ///< rows above are open at first

/// Returns the facts about a node that follow its name in brackets.
std::string notesOf(const SceneNode& node) {
  std::string notes;
  if (node.light) notes += notes.empty() ? "light" : ", light";
  if (node.camera) notes += notes.empty() ? "camera" : ", camera";
  if (node.hiddenInFile) notes += notes.empty() ? "hidden in the file" : ", hidden in the file";
  return notes.empty() ? "" : "  (" + notes + ")";
}

/// Draws a row: a box that shows or hides the node, and its name, which selects it. Returns true if the row
/// is open.
bool drawNode(ViewState& state, ViewFacts& facts, size_t i, bool parentShown) {
  const std::vector<SceneNode>& nodes = state.scene->nodes;
  const SceneNode& node = nodes[i];
  const bool leaf = i + 1 == nodes.size() || nodes[i + 1].depth <= node.depth;
  ImGui::PushID(int(i));
  bool shown = !isHidden(state, i) && !node.hiddenInFile;
  ImGui::BeginDisabled(node.hiddenInFile || !parentShown);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(0.0f, 0.0f));
  if (placed("show " + node.name, ImGui::Checkbox("##shown", &shown))) hideNode(state, i, !shown);
  ImGui::PopStyleVar();
  ImGui::EndDisabled();
  ImGui::SameLine();
  const bool selected = state.selectedNode == node.index;
  const bool open =
      ImGui::TreeNodeEx("##node",
                        ImGuiTreeNodeFlags_OpenOnArrow | ImGuiTreeNodeFlags_NoTreePushOnOpen |
                            (leaf ? ImGuiTreeNodeFlags_Leaf : 0) |
                            (node.depth < kDepthOpen ? ImGuiTreeNodeFlags_DefaultOpen : 0) |
                            (selected ? ImGuiTreeNodeFlags_Selected : 0),
                        "%s%s", shownText(node.name, kMostNameCharacters).c_str(), notesOf(node).c_str());
  if (ImGui::IsItemClicked() && !ImGui::IsItemToggledOpen())
    facts.commands.push_back({Command::SelectNode, int(node.index)});
  placed("node " + node.name, open);
  ImGui::PopID();
  return open;
}

void drawNodes(ViewState& state, ViewFacts& facts) {
  const std::vector<SceneNode>& nodes = state.scene->nodes;
  const float indent = ImGui::GetStyle().IndentSpacing;
  int deepest = nodes.empty() ? 0 : nodes[0].depth;  // depth of the deepest open row
  std::vector<bool> hiddenAt;                        // for each depth: true if the row above is hidden
  for (size_t i = 0; i < nodes.size(); ++i) {
    const int depth = nodes[i].depth;
    if (depth > deepest) continue;
    hiddenAt.resize(size_t(depth));
    const bool parentShown = std::ranges::none_of(hiddenAt, [](bool hidden) { return hidden; });
    hiddenAt.push_back(isHidden(state, i));
    const float in = indent * float(depth);
    if (in > 0.0f) ImGui::Indent(in);
    // Rows that are scrolled away take their room alone.
    const float height = ImGui::GetTextLineHeight();
    const ImVec2 row = ImGui::GetCursorScreenPos();
    const bool seen = ImGui::IsRectVisible(row, ImVec2(row.x + 1.0f, row.y + height));
    bool open = false;
    if (seen) {
      open = drawNode(state, facts, i, parentShown);
    } else {
      ImGui::PushID(int(i));
      open = ImGui::GetStateStorage()->GetInt(ImGui::GetID("##node"), depth < kDepthOpen ? 1 : 0) != 0;
      ImGui::PopID();
      ImGui::Dummy(ImVec2(1.0f, height));
    }
    if (in > 0.0f) ImGui::Unindent(in);
    deepest = open ? depth + 1 : depth;
  }
}

/// Begins a list that is as high as its rows, up to a limit.
bool beginList(const char* id, size_t rows, ImGuiWindowFlags flags = 0) {
  const float line = ImGui::GetTextLineHeightWithSpacing();
  return ImGui::BeginChild(id, ImVec2(0.0f, line * std::min(float(rows) + 0.5f, kMostRows)), false, flags);
}

void drawTree(ViewState& state, ViewFacts& facts) {
  if (beginList("nodes", state.scene->nodes.size(), ImGuiWindowFlags_HorizontalScrollbar))
    drawNodes(state, facts);
  ImGui::EndChild();
  const auto list = [](const std::string& name, const char* title, const auto& parts, const auto& draw) {
    const std::string id = "##" + name;
    const bool open = ImGui::TreeNodeEx(id.c_str(), ImGuiTreeNodeFlags_NoTreePushOnOpen, "%s (%d)", title,
                                        int(parts.size()));
    if (!placed(name + "s", open)) return;
    const bool seen = beginList(name.c_str(), size_t(kMostRows));
    for (size_t i = 0; seen && i < parts.size(); ++i) {
      ImGui::PushID(int(i));
      if (placed(name + " " + std::to_string(i),
                 ImGui::TreeNodeEx("##part", 0, "%s", partText(i, parts[i].name).c_str()))) {
        draw(i);
        ImGui::TreePop();
      }
      ImGui::PopID();
    }
    ImGui::EndChild();
  };
  list("material", "Materials", state.scene->materials, [&](size_t i) {
    drawMaterial(state, i);
    for (const std::string& line : materialLines(shownMaterial(state, i)))
      ImGui::TextUnformatted(line.c_str());
  });
  if (state.scene->lights.empty()) return;
  list("light", "Lights", state.scene->lights, [&](size_t i) { drawLightSource(state, i); });
}

// Exposure, tone map, environment and background.

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
    ImGui::Image(ImTextureID(intptr_t(found->second.name())), size);  // NOLINT(performance-no-int-to-ptr)
}

/// A list of what can light the scene.
void chooseEnvironment(const ViewedScene& scene, ViewFacts& facts) {
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
    if (placed("environment " + choices[i].name,
               ImGui::Selectable(name.c_str(), i == current, 0, ImVec2(0.0f, height))))
      facts.commands.push_back(
          {.command = Command::Load, .load = withEnvironment(scene.options, choices[i])});
    ImGui::PopID();
  }
  if (placed("environment Open...", ImGui::Selectable("Open...")))
    facts.commands.push_back({Command::Open, 1});
  ImGui::EndCombo();
}

/// The sun of the sky, and its haze.
void drawSky(SkyOptions& sky) {
  SunPlace sun = sunOf(sky);
  double azimuth = std::remainder(sun.azimuth, 360.0);
  const bool lifted =
      slider({"Sun height", kLowestSun, 90.0f, "%.1f degrees", kBounded,
              "Degrees above the horizon (--sun-elevation). Shift and the right button drag the sun"},
             sun.elevation);
  const bool turned = slider({"Sun from", -180.0f, 180.0f, "%.0f degrees", kBounded,
                              "Degrees clockwise from north, which is -Z: 90 is east, +X (--sun-azimuth)"},
                             azimuth);
  if (turned) sun.azimuth = azimuth;
  if (lifted || turned) placeSun(sky, sun);
  slider({"Haze", 1.0f, 10.0f, "%.1f", kBounded, "1 is air without haze, 3 a clear day (--sky-turbidity)"},
         sky.turbidity);
}

/// Fog round the scene.
void drawFog(ViewState& state) {
  FogOptions& fog = state.edit.shared.fog;
  const std::string reason = whyNoFog(state);
  ImGui::BeginDisabled(!reason.empty());
  // The box of its colour stands on the same line.
  const float box = fog.density > 0.0 ? ImGui::GetFrameHeight() + ImGui::GetStyle().ItemSpacing.x : 0.0f;
  slider({"Fog", 0.0f, kMostFog, fog.density > 0.0 ? "%.3f / m" : "none", kBoundedLogarithmic,
          "How dense the fog round the scene is: at 0.2 / m, light goes 5 m on average before it meets some "
          "(--fog-density). --fog-distance says how far the fog reaches",
          reason, box},
         fog.density);
  if (fog.density > 0.0) {
    ImGui::SameLine();
    glm::vec3 color = fog.color.value_or(glm::vec3(1.0f));
    if (placed("Fog colour", editColor("##fogcolor", color))) fog.color = color;
    tip("The part of the light that the fog scatters rather than swallows (--fog-color)");
    slider({"Fog forward", -kMostForward, kMostForward, "%.2f", kBounded,
            "Where the fog scatters light: above 0 rather forwards, as mist before a lamp; below 0 rather "
            "back (--fog-anisotropy)"},
           fog.anisotropy);
    double height = fog.height.value_or(0.0);
    if (slider({"Fog height", 0.0f, kMostFogHeight, height > 0.0 ? "%.2f m" : "no limit", kBoundedLogarithmic,
                "Ground fog: every so many metres up, it is thinner by a factor of e. At 0 it is as dense "
                "above as below (--fog-height)"},
               height))
      fog.height = height > 0.0 ? std::optional(height) : std::nullopt;
  } else {
    fog = FogOptions();
  }
  ImGui::EndDisabled();
}

void drawLight(ViewState& state, ViewFacts& facts) {
  RenderOptions& o = state.edit.shared;
  LightOptions& light = o.light;
  slider({"Exposure", -8.0f, 8.0f, "%.1f EV"}, o.output.exposure);
  choose("Tone map", toneMapNames(), o.output.toneMap);
  label("Environment");
  chooseEnvironment(*state.scene, facts);
  const bool map = state.scene->surroundings == Surroundings::Map;
  double degrees = std::remainder(light.hdriRotationDegrees, 360.0);
  // Typed values beyond the ends wrap around.
  if (slider({"Rotation", -180.0f, 180.0f, "%.0f degrees", 0, nullptr, map ? "" : "no environment map"},
             degrees))
    light.hdriRotationDegrees = std::isfinite(degrees) ? std::remainder(degrees, 360.0) : 0.0;
  const bool lit = has(state.scene->present, Trait::Environment);
  slider(
      {"Intensity", 0.0f, kMostIntensity, "%.2f", kBoundedLogarithmic, nullptr, lit ? "" : "no environment"},
      light.hdriIntensity);
  if (light.sky.on) drawSky(light.sky);
  const LightOptions& loaded = state.scene->options.light;
  if (!loaded.hdriFile.empty() || loaded.sky.on) {
    // The map is blurred once, when the slider is let go.
    double wanted = state.blur.value_or(loaded.backgroundBlur);
    if (slider({"Blur", 0.0f, kMostBlur, wanted > 0.0 ? "%.1f degrees" : "none"}, wanted))
      state.blur = wanted;
    if (ImGui::IsItemDeactivatedAfterEdit() && state.blur) {
      facts.commands.push_back({.command = Command::Load, .load = state.scene->options});
      facts.commands.back().load->light.backgroundBlur = *state.blur < kLeastBlur ? 0.0 : *state.blur;
      state.blur.reset();
    }
  }
  drawFog(state);
  label("Background");
  ImGui::Checkbox("##background", &light.background);
  if (light.background && !map) {
    ImGui::SameLine();
    glm::vec3 color = light.backgroundColor.value_or(glm::vec3(0.0f));
    if (placed("Background colour", editColor("##color", color, kMostColor))) light.backgroundColor = color;
  }
  const bool paths = has(state.side().stages, Stage::Gi);
  bool catches = light.shadowCatcher && paths;
  if (box("Shadow catcher", catches, paths ? "" : "only path traced", keyOf(Command::ToggleGround)))
    facts.commands.push_back({Command::ToggleGround});
}

// The histogram of the radiance in the active side's picture.

constexpr float kPlotHeight = 72.0f;  // pixels at 96 dots an inch
constexpr std::array<ImU32, 3> kPlotColors{IM_COL32(220, 70, 70, 150), IM_COL32(70, 190, 80, 150),
                                           IM_COL32(90, 120, 240, 150)};

/// Computed again only for another picture or exposure.
const Histogram& current(const ViewState& state, ViewFacts& facts) {
  const size_t side = state.shownSide();
  ShownHistogram& shown = facts.histogram;
  const double exposure = state.edit.shared.output.exposure.value_or(0.0);
  const PictureValues& values = facts.values[side];
  facts.wantsHistogram = true;
  const bool whole = values.whole.x > 0 && values.area.size == values.whole;
  const bool known = shown.picture == values.picture && shown.side == side && shown.exposure == exposure;
  if (whole && !known) shown = {histogramOf(values.image, exposure), values.picture, side, exposure};
  return shown.histogram;
}

void plot(const Histogram& histogram, ImVec2 corner, ImVec2 size) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(corner, {corner.x + size.x, corner.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg));
  const float width = size.x / float(kHistogramBins);
  for (size_t channel = 0; channel < 3; ++channel) {
    for (size_t bin = 0; bin < kHistogramBins; ++bin) {
      const float share = histogram.shares[channel][bin] / std::max(histogram.highest, 1e-6f);
      const float top = corner.y + size.y * (1.0f - std::min(share, 1.0f));
      const float left = corner.x + width * float(bin);
      list.AddRectFilled({left, top}, {left + width, corner.y + size.y}, kPlotColors[channel]);
    }
  }
  // A radiance of 1, which is white without a tone map.
  const float white = corner.x + size.x * float(-kLowestStop / (kHighestStop - kLowestStop));
  list.AddLine({white, corner.y}, {white, corner.y + size.y}, ImGui::GetColorU32(ImGuiCol_Text));
}

void drawHistogram(const ViewState& state, ViewFacts& facts) {
  const Histogram& histogram = current(state, facts);
  const float scale = ImGui::GetFontSize() / 14.0f;
  const ImVec2 size(ImGui::GetContentRegionAvail().x, kPlotHeight * scale);
  plot(histogram, ImGui::GetCursorScreenPos(), size);
  ImGui::Dummy(size);
  placed("histogram");
  tip(formatted("radiance from 2^%g to 2^%g with the exposure; the line is at 1", kLowestStop, kHighestStop));
  ImGui::TextDisabled("mean %.3g   max %.3g   above 1: %.2g %%", histogram.mean, histogram.most,
                      100.0 * histogram.above);
}

// The camera: projection, cameras of the scene, views with a name.

constexpr float kMostFocus = 1000.0f;  // metres; the range that the panel offers

/// A line for a new name, then one a view: go there, or forget it.
void drawBookmarks(ViewState& state, ViewFacts& facts) {
  const float button = ImGui::CalcTextSize("Keep view").x + 4 * ImGui::GetStyle().FramePadding.x;
  ImGui::SetNextItemWidth(-button);
  shownText(state.bookmarkName.data(), state.bookmarkName.size());  // the font gets what is typed
  const bool typed =
      placed("Bookmark name",
             ImGui::InputTextWithHint("##bookmark", "name of this view", state.bookmarkName.data(),
                                      state.bookmarkName.size(), ImGuiInputTextFlags_EnterReturnsTrue));
  ImGui::SameLine();
  const auto& all = facts.remembered.bookmarks;
  const auto found = all.find(std::filesystem::absolute(state.scene->options.scene).string());
  const size_t count = found == all.end() ? 0 : found->second.size();
  if (placed("Keep view", ImGui::Button("Keep view", ImVec2(-1, 0))) || typed) {
    const std::string name(state.bookmarkName.data());
    facts.commands.push_back(
        {.command = Command::AddBookmark, .text = name.empty() ? "View " + std::to_string(count + 1) : name});
    state.bookmarkName = {};
  }
  for (size_t i = 0; i < count; ++i) {
    ImGui::PushID(int(i));
    if (closeButton("forget view " + std::to_string(i)))
      facts.commands.push_back({Command::RemoveBookmark, int(i)});
    const std::string name = shownText(found->second[i].name, kMostNameCharacters) + "##view";
    if (placed("view " + std::to_string(i), ImGui::Selectable(name.c_str())))
      facts.commands.push_back({Command::ShowBookmark, int(i)});
    ImGui::PopID();
  }
}

/// Depth of field: sharp at the focal point, unless the command line says where.
void drawLens(ViewState& state) {
  LensOptions& lens = state.edit.shared.camera.lens;
  bool blurred = lens.fStop.has_value();
  if (box("Depth of field", blurred))
    lens.fStop = blurred ? std::optional(firstStop(state.edit.pose)) : std::nullopt;
  if (!lens.fStop) return;
  slider({"F-stop", float(kLeastStop), float(kMostStop), "f / %.3g", kBoundedLogarithmic}, *lens.fStop);
  slider(
      {"Focus distance", 0.0f, kMostFocus, lens.focusDistance.value_or(0.0) > 0.0 ? "%.3g m" : "focal point",
       kBoundedLogarithmic, "Metres along the view (--focus-distance); Ctrl+click on what is to be sharp"},
      lens.focusDistance);
  if (lens.focusDistance == 0.0) lens.focusDistance.reset();
  if (slider({"Blades", 2, 12, lens.blades < 3 ? "round" : "%d"}, lens.blades) && lens.blades < 3)
    lens.blades = 0;
}

void drawCamera(ViewState& state, ViewFacts& facts) {
  CameraType type = state.edit.pose.type;
  choose("Projection", kCameraTypeNames, type);
  if (type != state.edit.pose.type) {
    state.edit.pose = withProjection(state.edit.pose, type);
    state.edit.posed = true;
  }
  const bool fisheye = type == CameraType::Fisheye;
  if (fisheye || type == CameraType::Perspective) {
    if (slider({"View angle", 1.0f, fisheye ? 360.0f : 170.0f, "%.1f degrees"},
               fisheye ? state.edit.pose.fisheyeDegrees : state.edit.pose.viewAngleDegrees))
      state.edit.posed = true;
  }
  if (type == CameraType::Perspective) {
    double millimetres = 1000.0 * focalLengthOf(glm::radians(state.edit.pose.viewAngleDegrees));
    if (slider({"Focal length", 2.0f, 1000.0f, "%.1f mm", kBoundedLogarithmic,
                "On a sensor 24 mm high (--focal-length)"},
               millimetres)) {
      state.edit.pose.viewAngleDegrees = glm::degrees(viewAngleOf(millimetres, 1000.0 * kSensorHeight));
      state.edit.posed = true;
    }
    drawLens(state);
  }
  if (const std::vector<Camera>& cameras = state.scene->cameras; !cameras.empty()) {
    const auto nameOf = [&](size_t i) { return partText(i, cameras[i].name); };
    if (const auto chosen = choose("Scene camera", cameras.size(), size_t(state.edit.sceneCamera), nameOf))
      facts.commands.push_back({Command::SceneCamera, int(*chosen)});
  }
  commandButtons(facts, {{"Frame all", Command::FrameAll, 1},
                         {"Reset view", Command::ResetCamera},
                         {"Copy", Command::CopyCommand},
                         {"Paste", Command::PasteCommand}});
  drawBookmarks(state, facts);
}

constexpr int kMostBouncesShown = 64;

void drawPresets(const ViewState& state, ViewFacts& facts) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float count = float(kPresets.size());
  const float width = (ImGui::GetContentRegionAvail().x - (count - 1) * style.ItemSpacing.x) / count;
  for (const Preset& preset : kPresets) {
    const bool chosen = isPreset(state.side().stages, preset);
    if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, kAccent);
    if (&preset != kPresets.data()) ImGui::SameLine();
    if (placed(preset.name, ImGui::Button(preset.name, {width, 0.0f})))
      facts.commands.push_back({Command::StagesUpTo, int(preset.last)});
    if (chosen) ImGui::PopStyleColor();
    tip(preset.sentence);
  }
}

/// Draws the stages that build on each other, or the switches.
void drawStages(ViewState& state, bool cumulative) {
  RenderOptions& side = state.side();
  for (const StageRow& row : stageRows()) {
    if (row.cumulative != cumulative) continue;
    const std::string reason = row.stage == Stage::Flat ? "always on" : whyGrey(state, row.stage);
    bool on = has(side.stages, row.stage) && (reason.empty() || row.stage == Stage::Flat);
    if (box(row.label, on, reason, keyOf(Command::ToggleStage, int(row.stage)), row.sentence))
      side.stages.set(size_t(row.stage), on);
  }
}

void drawSampling(ViewState& state) {
  RenderOptions& side = state.side();
  int bounces = std::min(side.sampling.bounces, kMostBouncesShown);
  const bool unlimited = side.sampling.bounces >= kMostBouncesShown;
  if (slider({"Bounces", 0, kMostBouncesShown, unlimited ? "unlimited" : "%d"}, bounces))
    side.sampling.bounces = bounces >= kMostBouncesShown ? kUnlimitedBounces : bounces;
  slider({"Roulette from", 1, 32, "%d"}, side.sampling.rouletteDepth);
  double& goal = state.edit.shared.sampling.noise;
  double percent = 100.0 * goal;
  if (slider({"Noise to reach", 0.1f, 20.0f, "%.2f %%", kBoundedLogarithmic}, percent)) goal = 0.01 * percent;
  choose("Pixel filter", kPixelFilterNames, side.camera.pixelFilter);
  double& clamp = side.sampling.clampIndirect;
  slider({"Clamp indirect", 0.0f, 100.0f, clamp > 0.0 ? "%.2f (biased)" : "off", kBoundedLogarithmic}, clamp);
  choose("Traversal", kTraversalNames, side.device.traversal);
}

void drawAnimation(ViewState& state, ViewFacts& facts) {
  const int shown = shownAnimation(state);
  const std::vector<std::string>& names = state.scene->animationNames;
  const auto nameOf = [&](size_t i) { return i < names.size() ? partText(i, names[i]) : "all at once"; };
  if (const auto chosen = choose("Clip", size_t(animationCount(state)), size_t(shown), nameOf))
    showAnimation(state, int(*chosen), 0.0);
  const std::optional<double> posed = state.edit.shared.selection.animationTime;
  double time = posed.value_or(0.0);
  if (slider({"Time", 0.0f, float(animationLength(state)), posed ? "%.2f s" : "at rest"}, time)) {
    state.playback.playing = false;
    showAnimation(state, shown, time);
  }
  slider({"Speed", 0.1f, 10.0f, "%.2f", kBoundedLogarithmic}, state.playback.speed);
  if (placed("Play", ImGui::Button(state.playback.playing ? "Pause" : "Play")))
    facts.commands.push_back({Command::PlayAnimation});
  ImGui::SameLine();
  box("Loop", state.playback.loops, {}, keyOf(Command::PlayAnimation));
}

/// Draws the choice of the side whose settings are shown. If side B is a file, draws its name instead.
void drawSides(ViewState& state, ViewFacts& facts) {
  if (!state.reference.empty()) {
    if (closeButton("close reference")) facts.commands.push_back({Command::DropReference});
    ImGui::Text("B: %s", shownText(state.reference.filename().string(), kMostNameCharacters).c_str());
    return;
  }
  int active = int(state.edit.active);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Settings of");
  ImGui::SameLine();
  ImGui::RadioButton("A (left)", &active, 0);
  ImGui::SameLine();
  ImGui::RadioButton("B (right)", &active, 1);
  state.edit.active = size_t(active);
}

void drawCompare(ViewState& state, ViewFacts& facts) {
  bool splits = state.edit.split;
  if (box("Split view", splits)) facts.commands.push_back({Command::ToggleSplit});
  stayOnLineFor("[ ] Denoise");
  const std::string reason = whyWithoutNoise(state.options());
  bool denoises = state.side().output.denoise != Denoise::None && reason.empty();
  ImGui::BeginDisabled(!reason.empty());
  if (box("Denoise", denoises)) facts.commands.push_back({Command::ToggleDenoise});
  ImGui::EndDisabled();
  tip(reason.empty() ? "all of it up to 64 samples per pixel, nothing from 256 on" : reason);
  dimAtEnd(keyOf(Command::ToggleSplit) + ", " + keyOf(Command::ToggleDenoise));
  if (!state.edit.split) return;
  int comparison = int(state.comparison);
  constexpr std::array kNames{"bar", "A", "B", "difference"};
  for (int i = 0; i < int(kNames.size()); ++i) {
    if (i > 0) ImGui::SameLine();
    placed(std::string("compare ") + kNames[size_t(i)],
           ImGui::RadioButton(kNames[size_t(i)], &comparison, i));
  }
  state.comparison = CompareMode(comparison);
  if (state.comparison == CompareMode::Difference)
    slider({"Amplify", -8.0f, 16.0f, shortText(std::exp2(state.differenceStops)).c_str()},
           state.differenceStops);
  drawSides(state, facts);
}

void drawAdvanced(ViewState& state, ViewFacts& facts) {
  RenderOptions& side = state.side();
  const auto nameOf = [](size_t i) { return std::string(kDebugViewRows[i].label); };
  if (const auto chosen = choose("Show", kDebugViewRows.size(), size_t(side.output.debugView), nameOf,
                                 ImGuiComboFlags_HeightLargest))
    side.output.debugView = DebugView(*chosen);
  box("Boxes of the tree", state.edit.treeBoxes, {}, keyOf(Command::ToggleTreeBoxes));
  slider({"Level", 0, 31, "%d"}, state.edit.treeLevel);
  box("Figures over the picture", state.figures, {}, keyOf(Command::ToggleHud));
  ImGui::TextDisabled("Features in the shader");
  std::string variant = facts.statistics[state.shownSide()].variant;
  std::ranges::replace(variant, '+', ' ');
  drawText(variant, kMostLineCharacters, 0.0f);
}

/// The left edge of a docked panel can be dragged (Input).
void drawEdge(const WindowLayout& layout) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const bool near =
      std::abs(mouse.x - float(layout.picture.x)) <= kEdgePixels * layout.scale && mouse.y < layout.panel.y;
  if (near) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
}

void drawButtons(ViewFacts& facts) {
  ImGui::Separator();
  commandButtons(facts, {{"Open...", Command::Open},
                         {"Save as...", Command::SaveAs},
                         {"Save model...", Command::SaveModel},
                         {"Write .exr", Command::WriteExr},
                         {"Reload", Command::Reload},
                         {"Reset all", Command::ResetAll},
                         {"Keep as default", Command::KeepDefaults},
                         {"Full screen", Command::Fullscreen}});
  ImGui::TextDisabled("%s: all keys   %s: this panel", keyOf(Command::ToggleSheet).c_str(),
                      keyOf(Command::TogglePanel).c_str());
}

}  // namespace

void drawPanel(ViewState& state, ViewFacts& facts, const WindowLayout& layout) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float margin = layout.docked ? 0.0f : layout.margin;
  ImGui::SetNextWindowPos({display.x - layout.panel.x - margin, margin});
  if (layout.docked)
    ImGui::SetNextWindowSize({layout.panel.x, layout.panel.y});
  else
    ImGui::SetNextWindowSizeConstraints({layout.panel.x, 0.0f}, {layout.panel.x, layout.panel.y});
  ImGui::SetNextWindowBgAlpha(layout.docked ? 1.0f : 0.94f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, layout.docked ? 0.0f : ImGui::GetStyle().WindowRounding);
  const ImGuiWindowFlags flags = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoNav |
                                 ImGuiWindowFlags_NoResize |
                                 (layout.docked ? 0 : ImGuiWindowFlags_AlwaysAutoResize);
  if (ImGui::Begin("Settings", nullptr, flags)) {
    addWindowPlace("panel");
    if (layout.docked) drawEdge(layout);
    drawPresets(state, facts);
    drawCompare(state, facts);
    const auto open = [&](const char* name, bool first = true) {
      return placed(std::string("section ") + name,
                    ImGui::CollapsingHeader(name, first ? ImGuiTreeNodeFlags_DefaultOpen : 0));
    };
    if (shownAnimation(state) >= 0 && open("Animation")) drawAnimation(state, facts);
    if (hasParts(state) && open("File")) drawParts(state, facts);
    const std::optional<uint32_t> picked = facts.pick ? facts.pick->material : std::nullopt;
    if (picked && *picked < state.scene->materials.size() && open("Material")) {
      ImGui::TextDisabled("%s", partText(*picked, state.scene->materials[*picked].name).c_str());
      drawMaterial(state, *picked);
    }
    if (open("Scene", false)) drawTree(state, facts);
    if (open("Light and display")) drawLight(state, facts);
    if (open("Histogram", false)) drawHistogram(state, facts);
    if (open("Camera")) drawCamera(state, facts);
    if (open("Stages")) drawStages(state, true);
    if (open("Switches", false)) drawStages(state, false);
    if (open("Sampling", false)) drawSampling(state);
    if (open("Advanced", false)) drawAdvanced(state, facts);
    if (open("Shown before", false)) drawRecentFiles(facts);
    drawButtons(facts);
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace fragtrace
