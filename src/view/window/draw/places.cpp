// SPDX-License-Identifier: MIT
#include "view/window/draw/places.h"

#include <imgui.h>

namespace fragtrace {

namespace {

void add(Places& places, const std::string& name, ImVec2 place, ImVec2 size) {
  places[name] = {place.x, place.y, size.x, size.y};
}

}  // namespace

void addWindowPlace(Places& places, const std::string& name) {
  add(places, name, ImGui::GetWindowPos(), ImGui::GetWindowSize());
}

bool placed(Places& places, const std::string& name, bool result) {
  add(places, name, ImGui::GetItemRectMin(), ImGui::GetItemRectSize());
  return result;
}

}  // namespace fragtrace
