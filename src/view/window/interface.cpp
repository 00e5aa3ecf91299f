// SPDX-License-Identifier: MIT
#include "view/window/interface.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <filesystem>
#include <glm/common.hpp>

#include "view/key_queue.h"
#include "view/letters/fonts.h"
#include "view/window/draw/theme.h"
#include "view/window/glfw_window.h"

namespace fragtrace {

namespace {

constexpr float kFontSize = 15.0f;  // pixels at 96 dots an inch

void loadFont(float scale) {
  ImGuiIO& io = ImGui::GetIO();
  io.Fonts->Clear();
  for (const char* path : kFonts) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) continue;
    if (io.Fonts->AddFontFromFileTTF(path, std::round(kFontSize * scale))) return;
  }
  ImFontConfig config;
  config.SizePixels = kBuiltInFontSize * std::max(1.0f, std::floor(scale));
  io.Fonts->AddFontDefault(&config);
}

/// There is one window, as for Dear ImGui's own callbacks.
KeyQueue& keyQueue() {
  static KeyQueue queue;
  return queue;
}

/// Takes keys and characters in the place of Dear ImGui's callbacks, which get them frame by frame.
void queueKeys(GLFWwindow* window) {
  if (IMGUI_VERSION_NUM >= 18700) return;
  glfwSetKeyCallback(window, [](GLFWwindow*, int code, int scanCode, int action, int modifiers) {
    keyQueue().push_back({.code = code, .scanCode = scanCode, .action = action, .modifiers = modifiers});
  });
  glfwSetCharCallback(window, [](GLFWwindow*, unsigned character) {
    keyQueue().push_back({.isText = true, .character = character});
  });
}

void passKeys(GLFWwindow* window) {
  for (const TypedEvent& event : takeFrame(keyQueue())) {
    if (event.isText)
      ImGui_ImplGlfw_CharCallback(window, event.character);
    else
      ImGui_ImplGlfw_KeyCallback(window, event.code, event.scanCode, event.action, event.modifiers);
  }
}

/// Pixels for one of GLFW's units, in which it gives the cursor: more than one on Wayland.
glm::dvec2 pixelsOfUnit(GLFWwindow* window) {
  glm::ivec2 units(1);
  glm::ivec2 pixels(1);
  glfwGetWindowSize(window, &units.x, &units.y);
  glfwGetFramebufferSize(window, &pixels.x, &pixels.y);
  return glm::dvec2(pixels) / glm::dvec2(glm::max(units, 1));
}

/// Gives the cursor in pixels to Dear ImGui's callback, and to ours, which that one calls.
void scaleCursor(GLFWwindow* window) {
  static GLFWcursorposfun next = nullptr;
  next = glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
    const glm::dvec2 cursor = pixelsOfUnit(w) * glm::dvec2(x, y);
    next(w, cursor.x, cursor.y);
  });
}

/// Puts the frame that GLFW's backend has begun into pixels.
void scaleFrame(GLFWwindow* window) {
  const glm::vec2 unit(pixelsOfUnit(window));
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {io.DisplaySize.x * unit.x, io.DisplaySize.y * unit.y};
  io.DisplayFramebufferScale = {1.0f, 1.0f};
#if IMGUI_VERSION_NUM >= 18700
  // The backend asks for the cursor outside of the window, too. On Wayland, it is then where it left it, in
  // units.
  if (onWayland() && glfwGetWindowAttrib(window, GLFW_HOVERED) == 0) io.AddMousePosEvent(-FLT_MAX, -FLT_MAX);
#else
  if (ImGui::IsMousePosValid(&io.MousePos)) io.MousePos = {io.MousePos.x * unit.x, io.MousePos.y * unit.y};
#endif
}

}  // namespace

float displayScale(const glm::vec2& contentScale) {
  return std::clamp(std::max(contentScale.x, contentScale.y), 0.5f, 8.0f);
}

Interface::Interface(GLFWwindow* window) : window_(window) {
  ImGui::CreateContext();
  // Nothing is remembered behind the user's back.
  ImGui::GetIO().IniFilename = nullptr;
  ImGui_ImplGlfw_InitForOpenGL(window, true);
  queueKeys(window);
  scaleCursor(window);
  ImGui_ImplOpenGL3_Init("#version 450 core");
  fit();
}

Interface::~Interface() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void Interface::fit() {
  glm::vec2 content(1.0f);
  glfwGetWindowContentScale(window_, &content.x, &content.y);
  const float scale = displayScale(content);
  if (scale == scale_) return;
  scale_ = scale;
  loadFont(scale);
  // The next frame makes them again; it makes the texture of the fonts only together with all else.
  ImGui_ImplOpenGL3_DestroyDeviceObjects();
  ImGuiStyle style = themeStyle();
  style.ScaleAllSizes(scale);
  ImGui::GetStyle() = style;
}

void Interface::begin() {
  fit();
  passKeys(window_);
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  scaleFrame(window_);
  ImGui::NewFrame();
}

void Interface::end() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Interface::discard() { ImGui::EndFrame(); }

bool Interface::holding() { return ImGui::IsAnyItemActive(); }

bool Interface::waiting() { return !keyQueue().empty() || isBehind(); }

bool Interface::isBehind() {
#if IMGUI_VERSION_NUM >= 18700
  return ImGui::GetCurrentContext()->InputEventsQueue.Size > 0;
#else
  return false;
#endif
}

const char* Interface::focus() {
  if (ImGui::GetIO().WantTextInput) return "text";
  return hasPopup() ? "popup" : "picture";
}

std::optional<glm::vec2> Interface::mouse() {
  const ImVec2 at = ImGui::GetIO().MousePos;
  return ImGui::IsMousePosValid(&at) ? std::optional(glm::vec2(at.x, at.y)) : std::nullopt;
}

bool Interface::hasPopup() { return ImGui::GetCurrentContext()->OpenPopupStack.Size > 0; }

void Interface::closePopup() {
  // Dear ImGui does so itself only where it takes the keys that we have.
  ImGui::ClosePopupToLevel(ImGui::GetCurrentContext()->OpenPopupStack.Size - 1, true);
}

}  // namespace fragtrace
