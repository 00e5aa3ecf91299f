// SPDX-License-Identifier: MIT
#include "view/window/glfw_window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <stdexcept>
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

}  // namespace fragtrace
