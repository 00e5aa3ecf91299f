// SPDX-License-Identifier: MIT
// The camera: projection, cameras of the scene, views with a name.
#include <algorithm>

#include "view/window/draw/text.h"
#include "view/window/panel_parts.h"

namespace fragtrace {

namespace {

constexpr double kLeastStop = 0.001;  // the range that the panel offers
constexpr double kMostStop = 32.0;

/// A line for a new name, then one a view: go there, or forget it.
void drawBookmarks(ViewState& state, ViewFacts& facts) {
  Places& places = facts.places;
  const float button = ImGui::CalcTextSize("Keep view").x + 4 * ImGui::GetStyle().FramePadding.x;
  ImGui::SetNextItemWidth(-button);
  const bool typed =
      placed(places, "Bookmark name",
             ImGui::InputTextWithHint("##bookmark", "name of this view", state.bookmarkName.data(),
                                      state.bookmarkName.size(), ImGuiInputTextFlags_EnterReturnsTrue));
  ImGui::SameLine();
  const auto& all = facts.remembered.bookmarks;
  const auto found = all.find(std::filesystem::absolute(state.scene->options.scene).string());
  const size_t count = found == all.end() ? 0 : found->second.size();
  if (placed(places, "Keep view", ImGui::Button("Keep view", ImVec2(-1, 0))) || typed) {
    const std::string name(state.bookmarkName.data());
    facts.commands.push_back(
        {.command = Command::AddBookmark, .text = name.empty() ? "View " + std::to_string(count + 1) : name});
    state.bookmarkName = {};
  }
  for (size_t i = 0; i < count; ++i) {
    ImGui::PushID(int(i));
    if (placed(places, "forget view " + std::to_string(i), ImGui::SmallButton("x")))
      facts.commands.push_back({Command::RemoveBookmark, int(i)});
    ImGui::SameLine();
    const std::string name = shownText(found->second[i].name, kMostNameCharacters) + "##view";
    if (placed(places, "view " + std::to_string(i), ImGui::Selectable(name.c_str())))
      facts.commands.push_back({Command::ShowBookmark, int(i)});
    ImGui::PopID();
  }
}

/// An f-number whose blur can be seen, whatever the size of the scene.
double firstStop(const CameraPose& pose) {
  constexpr double kRadius = 0.02;  // the radius in parts of the distance to the focal point
  const double focalLength = focalLengthOf(glm::radians(pose.viewAngleDegrees));
  const double distance = glm::distance(pose.position, pose.focalPoint);
  return std::clamp(focalLength / (2.0 * kRadius * distance), kLeastStop, kMostStop);
}

/// Depth of field: sharp at the focal point, unless the command line says where.
void drawLens(ViewState& state, Places& places) {
  LensOptions& lens = state.edit.shared.camera.lens;
  bool blurred = lens.fStop.has_value();
  if (placed(places, "Depth of field", ImGui::Checkbox("Depth of field", &blurred)))
    lens.fStop = blurred ? std::optional(firstStop(state.edit.pose)) : std::nullopt;
  if (!lens.fStop) return;
  slider(places, {"F-stop", float(kLeastStop), float(kMostStop), "f / %.3g", kBoundedLogarithmic},
         *lens.fStop);
  if (slider(places, {"Blades", 2, 12, lens.blades < 3 ? "round" : "%d"}, lens.blades) && lens.blades < 3)
    lens.blades = 0;
}

}  // namespace

void drawCamera(ViewState& state, ViewFacts& facts) {
  Places& places = facts.places;
  CameraType type = state.edit.pose.type;
  choose(places, "Projection", kCameraTypeNames, type);
  if (type != state.edit.pose.type) {
    state.edit.pose = withProjection(state.edit.pose, type);
    state.edit.posed = true;
  }
  const bool fisheye = type == CameraType::Fisheye;
  if (fisheye || type == CameraType::Perspective) {
    if (slider(places, {"View angle", 1.0f, fisheye ? 360.0f : 170.0f, "%.1f degrees"},
               fisheye ? state.edit.pose.fisheyeDegrees : state.edit.pose.viewAngleDegrees))
      state.edit.posed = true;
  }
  if (type == CameraType::Perspective) drawLens(state, places);
  if (const std::vector<Camera>& cameras = state.scene->cameras; !cameras.empty()) {
    const auto nameOf = [&](size_t i) { return partText(i, cameras[i].name); };
    if (const auto chosen =
            choose(places, "Scene camera", cameras.size(), size_t(state.edit.sceneCamera), nameOf))
      facts.commands.push_back({Command::SceneCamera, int(*chosen)});
  }
  commandButton(facts, "Frame all", Command::FrameAll, 1);
  stayOnLineFor("Reset view");
  commandButton(facts, "Reset view", Command::ResetCamera);
  stayOnLineFor("Copy");
  commandButton(facts, "Copy", Command::CopyCommand);
  stayOnLineFor("Paste");
  commandButton(facts, "Paste", Command::PasteCommand);
  drawBookmarks(state, facts);
}

}  // namespace fragtrace
