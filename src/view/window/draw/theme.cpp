// SPDX-License-Identifier: MIT
#include "view/window/draw/theme.h"

namespace fragtrace {

namespace {

ImVec4 grey(float level, float opacity = 1.0f) { return {level, level, level, opacity}; }

const ImVec4 kAccentLit{0.27f, 0.48f, 0.74f, 1.0f};

}  // namespace

ImGuiStyle themeStyle() {
  ImGuiStyle style;
  style.WindowRounding = 4.0f;
  style.WindowBorderSize = 0.0f;
  style.PopupBorderSize = 1.0f;
  style.FrameRounding = 3.0f;
  style.GrabRounding = 2.0f;
  style.GrabMinSize = 6.0f;
  style.ScrollbarSize = 12.0f;
  style.ItemSpacing = {7.0f, 5.0f};
  style.FramePadding = {6.0f, 3.0f};
  style.DisabledAlpha = 0.5f;
  ImGui::StyleColorsDark(&style);
  const auto set = [&](ImGuiCol color, const ImVec4& value) { style.Colors[color] = value; };
  set(ImGuiCol_Text, grey(0.94f));
  set(ImGuiCol_TextDisabled, grey(0.66f));
  set(ImGuiCol_WindowBg, grey(0.15f));
  set(ImGuiCol_PopupBg, grey(0.11f));
  set(ImGuiCol_Border, grey(0.30f));
  set(ImGuiCol_FrameBg, grey(0.23f));
  set(ImGuiCol_FrameBgHovered, grey(0.28f));
  set(ImGuiCol_FrameBgActive, grey(0.31f));
  set(ImGuiCol_TitleBg, grey(0.11f));
  set(ImGuiCol_TitleBgActive, grey(0.11f));
  set(ImGuiCol_CheckMark, grey(0.94f));
  // Text is read across the grab.
  set(ImGuiCol_SliderGrab, kAccent);
  set(ImGuiCol_SliderGrabActive, kAccentLit);
  set(ImGuiCol_Button, grey(0.28f));
  set(ImGuiCol_ButtonHovered, grey(0.33f));
  set(ImGuiCol_ButtonActive, kAccent);
  set(ImGuiCol_Header, grey(0.20f));
  set(ImGuiCol_HeaderHovered, grey(0.26f));
  set(ImGuiCol_HeaderActive, kAccent);
  set(ImGuiCol_Separator, grey(0.30f));
  set(ImGuiCol_ScrollbarBg, grey(0.12f));
  set(ImGuiCol_ScrollbarGrab, grey(0.32f));
  set(ImGuiCol_ScrollbarGrabHovered, grey(0.40f));
  set(ImGuiCol_ScrollbarGrabActive, grey(0.46f));
  set(ImGuiCol_PlotHistogram, kAccent);
  set(ImGuiCol_TextSelectedBg, kAccent);
  set(ImGuiCol_TableRowBgAlt, grey(1.0f, 0.04f));
  set(ImGuiCol_ModalWindowDimBg, grey(0.0f, 0.45f));
  return style;
}

}  // namespace fragtrace
