// SPDX-License-Identifier: MIT
// OSMesa is Mesa's software rasteriser without any window system. Mesa 25.1 and later have neither the
// library nor its header, so this file declares the part of the interface that it uses (Mesa 3D, OSMesa
// interface 11.2).
#include <array>

#include "gl/context.h"
#include "gl/dynamic_library.h"

namespace fragtrace {

namespace {

using OsMesaHandle = struct OsMesaContextStruct*;

/// Names and values of context attributes.
constexpr int kFormat = 0x22;
constexpr int kRgba = 0x1908;
constexpr int kDepthBits = 0x30;
constexpr int kProfile = 0x33;
constexpr int kCoreProfile = 0x34;
constexpr int kMajorVersion = 0x36;
constexpr int kMinorVersion = 0x37;
/// The type of a surface's components, GL_UNSIGNED_BYTE.
constexpr unsigned kUnsignedByte = 0x1401;

struct OsMesaFunctions {
  OsMesaHandle (*createContext)(const int* attributes, OsMesaHandle shared) = nullptr;
  void (*destroyContext)(OsMesaHandle) = nullptr;
  unsigned char (*makeCurrent)(OsMesaHandle, void* pixels, unsigned type, int width, int height) = nullptr;
  GetProcAddress getProcAddress = nullptr;

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
  HeadlessOsMesa(const OsMesaFunctions& functions, OsMesaHandle context)
      : osMesa_(functions), context_(context) {
    backend = "osmesa";
  }
  ~HeadlessOsMesa() override {
    osMesa_.makeCurrent(nullptr, nullptr, kUnsignedByte, 0, 0);
    osMesa_.destroyContext(context_);
  }
  bool makeCurrent() {
    return osMesa_.makeCurrent(context_, surface_.data(), kUnsignedByte, kSurfaceSize, kSurfaceSize) != 0;
  }

 private:
  OsMesaFunctions osMesa_;
  OsMesaHandle context_;
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
  const int wish[] = {kFormat,       kRgba, kDepthBits,    0, kProfile, kCoreProfile,
                      kMajorVersion, 4,     kMinorVersion, 5, 0};
  OsMesaHandle native = functions.createContext(wish, nullptr);
  if (!native) return fail("no OpenGL 4.5 core context");
  auto context = std::make_unique<HeadlessOsMesa>(functions, native);
  if (!context->makeCurrent()) return fail("OSMesaMakeCurrent failed");
  std::string reason;
  if (!loadFunctions(*context, functions.getProcAddress, reason)) return fail(reason);
  return context;
}

}  // namespace fragtrace
