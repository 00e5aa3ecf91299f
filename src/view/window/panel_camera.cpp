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
      ImGui::InputTextWithHint("##bookmark", "name of this view", state.bookmarkName.data(),
                               state.bookmarkName.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  addItemPlace(places, "Bookmark name");
  ImGui::SameLine();
  const auto& all = facts.remembered.bookmarks;
  const auto found = all.find(std::filesystem::absolute(state.scene->options.scene).string());
  const size_t count = found == all.end() ? 0 : found->second.size();
  if (ImGui::Button("Keep view", ImVec2(-1, 0)) || typed) {
    const std::string name(state.bookmarkName.data());
    facts.commands.push_back(
        {.command = Command::AddBookmark, .text = name.empty() ? "View " + std::to_string(count + 1) : name});
    state.bookmarkName = {};
  }
  addItemPlace(places, "Keep view");
  for (size_t i = 0; i < count; ++i) {
    ImGui::PushID(int(i));
    if (ImGui::SmallButton("x")) facts.commands.push_back({Command::RemoveBookmark, int(i)});
    addItemPlace(places, "forget view " + std::to_string(i));
    ImGui::SameLine();
    const std::string name = shownText(found->second[i].name, kMostNameCharacters) + "##view";
    if (ImGui::Selectable(name.c_str())) facts.commands.push_back({Command::ShowBookmark, int(i)});
    addItemPlace(places, "view " + std::to_string(i));
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
  if (ImGui::Checkbox("Depth of field", &blurred))
    lens.fStop = blurred ? std::optional(firstStop(state.edit.pose)) : std::nullopt;
  addItemPlace(places, "Depth of field");
  if (lens.fStop) {
    slider(places, "F-stop", *lens.fStop, float(kLeastStop), float(kMostStop), "f / %.3g",
           kBoundedLogarithmic);
    label(places, "Blades");
    if (ImGui::SliderInt("##blades", &lens.blades, 2, 12, lens.blades < 3 ? "round" : "%d", kBounded))
      lens.blades = lens.blades < 3 ? 0 : lens.blades;
  }
}

}  // namespace

void drawCamera(ViewState& state, ViewFacts& facts) {
  Places& places = facts.places;
  label(places, "Projection");
  CameraType type = state.edit.pose.type;
  choose("##projection", kCameraTypeNames, type);
  if (type != state.edit.pose.type) {
    state.edit.pose = withProjection(state.edit.pose, type);
    state.edit.posed = true;
  }
  const bool fisheye = type == CameraType::Fisheye;
  if (fisheye || type == CameraType::Perspective) {
    if (slider(places, "View angle",
               fisheye ? state.edit.pose.fisheyeDegrees : state.edit.pose.viewAngleDegrees, 1.0f,
               fisheye ? 360.0f : 170.0f, "%.1f degrees"))
      state.edit.posed = true;
  }
  if (type == CameraType::Perspective) drawLens(state, places);
  if (state.scene && !state.scene->cameras.empty()) {
    label(places, "Scene camera");
    const auto& cameras = state.scene->cameras;
    const auto nameOf = [&](int i) {
      if (i < 0 || size_t(i) >= cameras.size()) return std::string("none");
      return partText(size_t(i), cameras[size_t(i)].name);
    };
    if (ImGui::BeginCombo("##camera", nameOf(state.edit.sceneCamera).c_str())) {
      for (int i = 0; i < int(cameras.size()); ++i) {
        if (ImGui::Selectable(nameOf(i).c_str(), i == state.edit.sceneCamera))
          facts.commands.push_back({Command::SceneCamera, i});
      }
      ImGui::EndCombo();
    }
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
