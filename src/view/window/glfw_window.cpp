// SPDX-License-Identifier: MIT
#include "view/window/glfw_window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <poll.h>
#include <unistd.h>

#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "advice.h"
#include "base/report.h"
#include "base/text.h"
#include "gl/dynamic_library.h"
#include "gl/gl.h"
#include "view/window/status.h"

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

struct WaylandLibrary {
  Proxy (*connect)(const char* name) = nullptr;
  void (*disconnect)(Proxy display) = nullptr;
  int (*roundtrip)(Proxy display) = nullptr;
  int (*flush)(Proxy display) = nullptr;
  int (*descriptor)(Proxy display) = nullptr;
  Proxy (*construct)(Proxy parent, uint32_t request, const void* interface, ...) = nullptr;
  void (*destroy)(Proxy proxy) = nullptr;
  int (*listen)(Proxy proxy, const RegistryEvents* events, void* seen) = nullptr;
  void (*handleLog)(void (*handler)(const char* format, va_list)) = nullptr;
  const void* registry = nullptr;  ///< wl_registry_interface

  bool load(const DynamicLibrary& library) {
    return library.find("wl_display_connect", connect) && library.find("wl_display_disconnect", disconnect) &&
           library.find("wl_display_roundtrip", roundtrip) && library.find("wl_display_flush", flush) &&
           library.find("wl_display_get_fd", descriptor) &&
           library.find("wl_proxy_marshal_constructor", construct) &&
           library.find("wl_proxy_destroy", destroy) && library.find("wl_proxy_add_listener", listen) &&
           library.find("wl_log_set_handler_client", handleLog) &&
           library.find("wl_registry_interface", registry);
  }
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
  WaylandLibrary wayland;
  if (!wayland.load(library)) return "libwayland-client lacks a function";
  wayland.handleLog([](const char*, va_list) {});  // the return value reports errors instead
  Proxy display = wayland.connect(nullptr);
  if (display == nullptr) return "there is no compositor '" + name + "' (WAYLAND_DISPLAY)";
  const Seat seat = lookForSeat(wayland, display);
  wayland.disconnect(display);
  if (seat == Seat::NoAnswer) return "the compositor '" + name + "' (WAYLAND_DISPLAY) does not answer";
  return seat == Seat::There ? "" : "the compositor '" + name + "' has no seat: neither keyboard nor pointer";
}

}  // namespace fragtrace
