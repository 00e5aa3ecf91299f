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
#include <deque>
#include <functional>
#include <glm/common.hpp>
#include <utility>

#include "view/letters/fonts.h"
#include "view/shown_text.h"
#include "view/window/glfw_window.h"
#include "view/window/input.h"
#include "view/window/widgets.h"

namespace fragtrace {

namespace {

constexpr float kFontSize = 15.0f;  // pixels at 96 dots an inch

void loadFont(float scale) {
  ImFontGlyphRangesBuilder characters;
  for (const std::string& character : shownCharacters()) characters.AddText(character.c_str());
  buildFont(*ImGui::GetIO().Fonts, std::round(kFontSize * scale), std::move(characters), {});
}

#if IMGUI_VERSION_NUM < 18700
/// A key or a character that waits for a frame of Dear ImGui, which has no queue of its own. It does not see
/// a key that goes down and up within a frame, nor how a frame's keys and characters follow each other. So a
/// key that types no character goes down in a frame of its own.
struct TypedEvent {
  bool alone = false;
  std::function<void()> pass;
};

/// There is one window, as for Dear ImGui's own callbacks.
std::deque<TypedEvent>& typedEvents() {
  static std::deque<TypedEvent> events;
  return events;
}

void queueKeys(GLFWwindow* window) {
  glfwSetKeyCallback(window, [](GLFWwindow* w, int code, int scanCode, int action, int modifiers) {
    const bool types = code < GLFW_KEY_ESCAPE && (modifiers & GLFW_MOD_CONTROL) == 0;
    typedEvents().push_back({action == GLFW_PRESS && !types, [=] {
                               ImGui_ImplGlfw_KeyCallback(w, code, scanCode, action, modifiers);
                               const int label = labelOf(code, scanCode);
                               if (label == code || action == GLFW_REPEAT) return;
                               ImGui::GetIO().KeysDown[code] = false;
                               ImGui::GetIO().KeysDown[label] = action == GLFW_PRESS;
                             }});
  });
  glfwSetCharCallback(window, [](GLFWwindow* w, unsigned character) {
    typedEvents().push_back({false, [=] { ImGui_ImplGlfw_CharCallback(w, character); }});
  });
}

void passKeys() {
  std::deque<TypedEvent>& events = typedEvents();
  bool alone = false;
  for (bool first = true; !events.empty() && !alone && (first || !events.front().alone); first = false) {
    alone = events.front().alone;
    events.front().pass();
    events.pop_front();
  }
}
#endif

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
#if IMGUI_VERSION_NUM < 18700
  queueKeys(window);
#endif
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
  if (scale == scale_ && !lacksCharacters()) return;
  const bool replaces = std::exchange(scale_, scale) > 0.0f;
  characters_ = shownCharacters().size();
  loadFont(scale);
  if (replaces) {
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
  }
  ImGuiStyle style = themeStyle();
  style.ScaleAllSizes(scale);
  ImGui::GetStyle() = style;
}

void Interface::begin() {
  ImGui_ImplOpenGL3_NewFrame();
  fit();
#if IMGUI_VERSION_NUM < 18700
  passKeys();
#endif
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

bool Interface::lacksCharacters() const { return characters_ != shownCharacters().size(); }

bool Interface::waiting() const {
  if (lacksCharacters()) return true;
#if IMGUI_VERSION_NUM >= 18700
  return ImGui::GetCurrentContext()->InputEventsQueue.Size > 0;
#else
  return !typedEvents().empty();
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
