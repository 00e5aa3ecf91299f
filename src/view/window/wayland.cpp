// SPDX-License-Identifier: MIT
// Looks at the compositor before GLFW does, by the functions of libwayland-client that this takes
// (Wayland, client API). The library is opened at run time, as GLFW opens it.
#include "view/window/wayland.h"

#include <array>
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
  Proxy (*construct)(Proxy parent, uint32_t request, const void* interface, ...) = nullptr;
  void (*destroy)(Proxy proxy) = nullptr;
  int (*listen)(Proxy proxy, const RegistryEvents* events, void* seen) = nullptr;
  void (*handleLog)(void (*handler)(const char* format, va_list)) = nullptr;
  const void* registry = nullptr;  ///< wl_registry_interface

  bool load(const DynamicLibrary& library) {
    return library.find("wl_display_connect", connect) && library.find("wl_display_disconnect", disconnect) &&
           library.find("wl_display_roundtrip", roundtrip) &&
           library.find("wl_proxy_marshal_constructor", construct) &&
           library.find("wl_proxy_destroy", destroy) && library.find("wl_proxy_add_listener", listen) &&
           library.find("wl_log_set_handler_client", handleLog) &&
           library.find("wl_registry_interface", registry);
  }
};

bool hasSeat(const WaylandLibrary& wayland, Proxy display) {
  static constexpr RegistryEvents kEvents{[](void* seen, Proxy, uint32_t, const char* interface, uint32_t) {
                                            if (std::string_view(interface) == "wl_seat")
                                              *static_cast<bool*>(seen) = true;
                                          },
                                          [](void*, Proxy, uint32_t) {}};
  bool seen = false;
  Proxy registry = wayland.construct(display, kGetRegistry, wayland.registry, nullptr);
  if (registry == nullptr) return false;
  const bool told = wayland.listen(registry, &kEvents, &seen) == 0 && wayland.roundtrip(display) >= 0;
  wayland.destroy(registry);
  return told && seen;
}

}  // namespace

std::string whyNoWayland() {
  if (std::getenv("WAYLAND_DISPLAY") == nullptr) return "WAYLAND_DISPLAY is not set";
  if (std::getenv("WAYLAND_SOCKET") != nullptr) return "";  // a connection that can be made only once
  static const DynamicLibrary library({"libwayland-client.so.0"});
  if (!library.loaded()) return library.error();
  WaylandLibrary wayland;
  if (!wayland.load(library)) return "libwayland-client lacks a function";
  wayland.handleLog([](const char*, va_list) {});  // what it would print is returned here
  Proxy display = wayland.connect(nullptr);
  if (display == nullptr) return "the compositor that WAYLAND_DISPLAY names does not answer";
  const bool seat = hasSeat(wayland, display);
  wayland.disconnect(display);
  return seat ? "" : "the compositor has no seat: neither keyboard nor pointer";
}

}  // namespace fragtrace
