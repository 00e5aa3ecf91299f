// SPDX-License-Identifier: MIT
// OSMesa: Mesa's software rasteriser without any window system.
#include <GL/osmesa.h>

#include <array>

#include "gl/context.h"
#include "gl/dynamic_library.h"

namespace fragtrace {

namespace {

struct OsMesaFunctions {
  decltype(&OSMesaCreateContextAttribs) createContext = nullptr;
  decltype(&OSMesaDestroyContext) destroyContext = nullptr;
  decltype(&OSMesaMakeCurrent) makeCurrent = nullptr;
  decltype(&OSMesaGetProcAddress) getProcAddress = nullptr;

  bool load(const DynamicLibrary& library) {
    return library.find("OSMesaCreateContextAttribs", createContext) &&
           library.find("OSMesaDestroyContext", destroyContext) &&
           library.find("OSMesaMakeCurrent", makeCurrent) &&
           library.find("OSMesaGetProcAddress", getProcAddress);
  }
};

constexpr int kSurfaceSize = 4;  // pixels; the tracer writes to images, never to this surface

class HeadlessOsMesa : public Context {
 public:
  HeadlessOsMesa(const OsMesaFunctions& functions, OSMesaContext context)
      : osMesa_(functions), context_(context) {
    backend = "osmesa";
  }
  ~HeadlessOsMesa() override {
    osMesa_.makeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0);
    osMesa_.destroyContext(context_);
  }
  bool makeCurrent() {
    return osMesa_.makeCurrent(context_, surface_.data(), GL_UNSIGNED_BYTE, kSurfaceSize, kSurfaceSize) != 0;
  }

 private:
  OsMesaFunctions osMesa_;
  OSMesaContext context_;
  std::array<unsigned char, size_t(kSurfaceSize) * kSurfaceSize * 4> surface_{};
};

}  // namespace

std::unique_ptr<Context> makeOsMesaContext(std::string& tried) {
  static const DynamicLibrary library({"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"});
  const auto fail = [&](const std::string& reason) {
    tried += "OSMesa (" + reason + ")";
    return nullptr;
  };
  if (!library.loaded()) return fail(library.error());
  OsMesaFunctions functions;
  if (!functions.load(library)) return fail("the library lacks OSMesaCreateContextAttribs");
  const int wish[] = {OSMESA_FORMAT,
                      OSMESA_RGBA,
                      OSMESA_DEPTH_BITS,
                      0,
                      OSMESA_PROFILE,
                      OSMESA_CORE_PROFILE,
                      OSMESA_CONTEXT_MAJOR_VERSION,
                      4,
                      OSMESA_CONTEXT_MINOR_VERSION,
                      5,
                      0};
  OSMesaContext native = functions.createContext(wish, nullptr);
  if (!native) return fail("no OpenGL 4.5 core context");
  auto context = std::make_unique<HeadlessOsMesa>(functions, native);
  if (!context->makeCurrent()) return fail("OSMesaMakeCurrent failed");
  std::string reason;
  if (!loadFunctions(*context, functions.getProcAddress, reason)) return fail(reason);
  return context;
}

}  // namespace fragtrace
