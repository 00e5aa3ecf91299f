// SPDX-License-Identifier: MIT
#include "view/window/glfw_window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <poll.h>
#include <unistd.h>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <functional>
#include <glm/common.hpp>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "advice.h"
#include "base/dynamic_library.h"
#include "base/report.h"
#include "base/text.h"
#include "gl/gl.h"
#include "view/letters/fonts.h"
#include "view/window/input.h"
#include "view/window/overlay.h"
#include "view/window/widgets.h"

namespace fragtrace {

namespace {

constexpr int kContextStatus = 4;  // the status of ContextError (cli/program.cpp)

struct GlfwErrors {
  std::mutex mutex;
  std::string text;
};

GlfwErrors& glfwErrors() {
  static GlfwErrors errors;
  return errors;
}

using Proxy = struct WaylandProxy*;
/// The events of wl_registry: a global object appears, and goes.
struct RegistryEvents {
  void (*global)(void* seen, Proxy registry, uint32_t name, const char* interface, uint32_t version);
  void (*remove)(void* seen, Proxy registry, uint32_t name);
};
constexpr uint32_t kGetRegistry = 1;  // the request of wl_display

struct WaylandLibrary : LibraryFunctions {
  using LibraryFunctions::LibraryFunctions;
  Proxy (*connect)(const char* name) = find("wl_display_connect");
  void (*disconnect)(Proxy display) = find("wl_display_disconnect");
  int (*roundtrip)(Proxy display) = find("wl_display_roundtrip");
  int (*flush)(Proxy display) = find("wl_display_flush");
  int (*descriptor)(Proxy display) = find("wl_display_get_fd");
  Proxy (*construct)(Proxy parent, uint32_t request, const void* interface,
                     ...) = find("wl_proxy_marshal_constructor");
  void (*destroy)(Proxy proxy) = find("wl_proxy_destroy");
  int (*listen)(Proxy proxy, const RegistryEvents* events, void* seen) = find("wl_proxy_add_listener");
  void (*handleLog)(void (*handler)(const char* format, va_list)) = find("wl_log_set_handler_client");
  const void* registry = find("wl_registry_interface");
};

/// Waits a few seconds for the compositor to send something.
bool answers(const WaylandLibrary& wayland, Proxy display) {
  constexpr int kPatienceMs = 3000;
  pollfd waited{wayland.descriptor(display), POLLIN, 0};
  return wayland.flush(display) >= 0 && poll(&waited, 1, kPatienceMs) > 0;
}

enum class Seat : uint8_t { There, Missing, NoAnswer };

Seat lookForSeat(const WaylandLibrary& wayland, Proxy display) {
  static constexpr RegistryEvents kEvents{[](void* seen, Proxy, uint32_t, const char* interface, uint32_t) {
                                            if (std::string_view(interface) == "wl_seat")
                                              *static_cast<bool*>(seen) = true;
                                          },
                                          [](void*, Proxy, uint32_t) {}};
  bool seen = false;
  Proxy registry = wayland.construct(display, kGetRegistry, wayland.registry, nullptr);
  if (registry == nullptr) return Seat::NoAnswer;
  const bool told = wayland.listen(registry, &kEvents, &seen) == 0 && answers(wayland, display) &&
                    wayland.roundtrip(display) >= 0;
  wayland.destroy(registry);
  return !told ? Seat::NoAnswer : seen ? Seat::There : Seat::Missing;
}

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

}  // namespace

Glfw::Glfw() {
  glfwSetErrorCallback([](int, const char* text) {
    GlfwErrors& errors = glfwErrors();
    const std::lock_guard lock(errors.mutex);
    errors.text += (errors.text.empty() ? "" : "; ") + std::string(text);
  });
  // Dear ImGui's loader prints a line and crashes without it, even where the window has OpenGL by another
  // library.
  const DynamicLibrary openGl({"libGL.so.1"});
  if (!openGl.loaded()) throw std::runtime_error(openGl.error() + "; " + kWindowAdvice);
  std::string noWayland;
#ifdef GLFW_PLATFORM  // from GLFW 3.4 on, which tries Wayland first
  noWayland = whyNoWayland();
  if (!noWayland.empty()) glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
  if (glfwInit()) return;
  const bool told = std::getenv("WAYLAND_DISPLAY") != nullptr && !noWayland.empty();
  const char* display = std::getenv("DISPLAY");
  const bool named = display != nullptr && *display != '\0';
  throw std::runtime_error((named ? takeGlfwErrors() : "X11: there is no display (DISPLAY is not set)") +
                           (told ? "; Wayland: " + noWayland : ""));
}

Glfw::~Glfw() { glfwTerminate(); }

bool onWayland() {
#ifdef GLFW_PLATFORM
  return glfwGetPlatform() == GLFW_PLATFORM_WAYLAND;
#else
  return false;
#endif
}

bool displayIsGone() { return onWayland() && !whyNoWayland().empty(); }

void endWithDisplay(const std::filesystem::path& statusFile) {
  static std::filesystem::path file;
  file = statusFile;
  using Handler = int (*)(void*);
  Handler (*setHandler)(Handler) = nullptr;
  static const DynamicLibrary library({"libX11.so.6"});
  if (!library.loaded() || !library.find("XSetIOErrorHandler", setHandler)) return;
  setHandler([](void*) {
    try {
      writeStatusFile(file, failureText(kDisplayIsGone));
    } catch (const std::exception&) {
      // There is nobody left to tell.
    }
    reportError(kDisplayIsGone);
    _exit(kContextStatus);
    return 0;
  });
}

void CloseWindow::operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }

WindowHandle openWindow(glm::ivec2 size, const std::string& title) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
#ifndef NDEBUG
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
#endif
  // Full screen, it stays when another window gets the keyboard, as on a second screen.
  glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);
  // Desktops find the icon and the menu entry by these: fragtrace.desktop.
  glfwWindowHintString(GLFW_X11_CLASS_NAME, "fragtrace");
  glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "fragtrace");
#ifdef GLFW_WAYLAND_APP_ID
  glfwWindowHintString(GLFW_WAYLAND_APP_ID, "fragtrace");
#endif
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  WindowHandle window(glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr));
  if (!window) throw std::runtime_error(takeGlfwErrors() + kDriverAdvice);
  glfwMakeContextCurrent(window.get());
  if (gladLoadGL(glfwGetProcAddress) < GLAD_MAKE_VERSION(4, 5))
    throw std::runtime_error("the display's OpenGL is older than 4.5");
  glfwSwapInterval(1);
  return window;
}

WindowHandle openSharing(GLFWwindow* window) {
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  WindowHandle sharing(glfwCreateWindow(1, 1, "", nullptr, window));
  glfwWindowHint(GLFW_VISIBLE, GLFW_TRUE);
  if (!sharing) throw std::runtime_error(takeGlfwErrors());
  return sharing;
}

OutsideContext outsideContext(GLFWwindow* sharing) {
  return {[sharing] { glfwMakeContextCurrent(sharing); }, [] { glfwMakeContextCurrent(nullptr); },
          glfwGetProcAddress};
}

std::string portalName(GLFWwindow* window) {
#ifdef GLFW_PLATFORM
  if (glfwGetPlatform() != GLFW_PLATFORM_X11) return "";
#endif
  // A GLFW for Wayland alone has no such function.
  unsigned long (*numberOf)(GLFWwindow*) = nullptr;
  static const DynamicLibrary library({"libglfw.so.3"});
  if (!library.loaded() || !library.find("glfwGetX11Window", numberOf)) return "";
  return formatted("x11:%lx", numberOf(window));
}

std::string takeGlfwErrors() {
  GlfwErrors& errors = glfwErrors();
  const std::lock_guard lock(errors.mutex);
  return std::exchange(errors.text, {});
}

// Looks at the compositor before GLFW does, by the functions of libwayland-client that this takes
// (Wayland, client API). The library is opened at run time, as GLFW opens it.

std::string whyNoWayland() {
  const std::string name = environment("WAYLAND_DISPLAY");
  if (name.empty()) return "WAYLAND_DISPLAY is not set";
  if (!environment("WAYLAND_SOCKET").empty()) return "";  // a connection that can be made only once
  if (!name.starts_with('/') && environment("XDG_RUNTIME_DIR").empty()) return "XDG_RUNTIME_DIR is not set";
  static const DynamicLibrary library({"libwayland-client.so.0"});
  if (!library.loaded()) return library.error();
  const WaylandLibrary wayland(library);
  if (!wayland.complete()) return "libwayland-client lacks a function";
  wayland.handleLog([](const char*, va_list) {});  // the return value reports errors instead
  Proxy display = wayland.connect(nullptr);
  if (display == nullptr) return "there is no compositor '" + name + "' (WAYLAND_DISPLAY)";
  const Seat seat = lookForSeat(wayland, display);
  wayland.disconnect(display);
  if (seat == Seat::NoAnswer) return "the compositor '" + name + "' (WAYLAND_DISPLAY) does not answer";
  return seat == Seat::There ? "" : "the compositor '" + name + "' has no seat: neither keyboard nor pointer";
}

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

bool Interface::hasPopup() { return ImGui::GetCurrentContext()->OpenPopupStack.Size > 0; }

void Interface::closePopup() {
  // Dear ImGui does so itself only where it takes the keys that we have.
  ImGui::ClosePopupToLevel(ImGui::GetCurrentContext()->OpenPopupStack.Size - 1, true);
}

}  // namespace fragtrace
