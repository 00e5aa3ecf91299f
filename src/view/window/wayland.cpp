// SPDX-License-Identifier: MIT
// Looks at the compositor before GLFW does, by the functions of libwayland-client that this takes
// (Wayland, client API). The library is opened at run time, as GLFW opens it.
#include "view/window/glfw_window.h"

#include <poll.h>

#include <cstdarg>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "gl/dynamic_library.h"

namespace fragtrace {

namespace {

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
