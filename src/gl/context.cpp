// SPDX-License-Identifier: MIT
#include "gl/context.h"

#include <array>
#include <cstring>
#include <exception>
#include <map>
#include <mutex>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "advice.h"
#include "base/dynamic_library.h"
#include "base/errors.h"
#include "base/text.h"
#include "gl/driver_choice.h"
#include "gl/gl.h"

namespace fragtrace {

namespace {

/// Fills the function table and the context's facts; false with a reason when it is not OpenGL 4.5.
bool loadFunctions(Context& context, GetProcAddress getProcAddress, std::string& reason) {
  const int version = gladLoadGL(getProcAddress);
  if (version < GLAD_MAKE_VERSION(4, 5)) {
    reason = "OpenGL " + std::to_string(GLAD_VERSION_MAJOR(version)) + "." +
             std::to_string(GLAD_VERSION_MINOR(version)) + " is older than 4.5";
    return false;
  }
  const auto text = [](GLenum name) {
    const GLubyte* value = glGetString(name);
    return std::string(value ? reinterpret_cast<const char*>(value) : "");
  };
  context.renderer = text(GL_RENDERER);
  context.version = text(GL_VERSION);
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "SwiftShader", "Software"}) {
    context.software = context.software || context.renderer.find(name) != std::string::npos;
  }
  // The driver may use as many threads as it likes to compile programs that are started together.
  if (GLAD_GL_KHR_parallel_shader_compile) glMaxShaderCompilerThreadsKHR(~0u);
  return true;
}

class Adopted : public Context {
 public:
  explicit Adopted(const OutsideContext& outside) : leave_(outside.leave) {
    backend = "window";
    outside.enter();
  }
  ~Adopted() override { leave_(); }

 private:
  std::function<void()> leave_;
};

}  // namespace

std::unique_ptr<Context> makeContext(const OutsideContext& outside) {
  auto context = std::make_unique<Adopted>(outside);
  std::string reason;
  if (!loadFunctions(*context, outside.functions, reason))
    throw ContextError("the window's driver: " + reason);
  return context;
}

std::unique_ptr<Context> makeContext(const DeviceOptions& options) {
  setVectorWidth(options.vectorWidth);
  limitDriverThreads();
  std::string tried;
  std::unique_ptr<Context> context;
  if (options.backend != Backend::OsMesa) context = makeEglContext(tried, options.device);
  if (!context && options.backend != Backend::Egl && options.device.empty())
    context = makeOsMesaContext(tried);
  if (!context) {
    if (tried.ends_with("; ")) tried.resize(tried.size() - 2);
    if (!options.device.empty())
      throw UsageError("--device " + options.device + ": no device of that number or name works; seen are " +
                       tried + " (`fragtrace info --devices`)");
    throw ContextError("no OpenGL 4.5 context; tried " + tried + kDriverAdvice);
  }
  return context;
}

// Makes contexts by EGL without a display: devices by name first (hardware before software), then Mesa's
// surfaceless platform.

namespace {

struct EglFunctions : LibraryFunctions {
  using LibraryFunctions::LibraryFunctions;
  decltype(&eglGetProcAddress) getProcAddress = find("eglGetProcAddress");
  decltype(&eglInitialize) initialize = find("eglInitialize");
  decltype(&eglTerminate) terminate = find("eglTerminate");
  decltype(&eglBindAPI) bindApi = find("eglBindAPI");
  decltype(&eglChooseConfig) chooseConfig = find("eglChooseConfig");
  decltype(&eglCreateContext) createContext = find("eglCreateContext");
  decltype(&eglDestroyContext) destroyContext = find("eglDestroyContext");
  decltype(&eglMakeCurrent) makeCurrent = find("eglMakeCurrent");
  decltype(&eglQueryString) queryString = find("eglQueryString");
  decltype(&eglGetError) getError = find("eglGetError");
  PFNEGLQUERYDEVICESEXTPROC queryDevices = extension("eglQueryDevicesEXT");
  PFNEGLQUERYDEVICESTRINGEXTPROC queryDeviceString = extension("eglQueryDeviceStringEXT");
  PFNEGLGETPLATFORMDISPLAYEXTPROC getPlatformDisplay = extension("eglGetPlatformDisplayEXT");

 private:
  Symbol extension(const char* name) const {
    return {getProcAddress ? reinterpret_cast<void*>(getProcAddress(name)) : nullptr};
  }
};

/// The contexts of each display. EGL ends a display for all of them at once.
struct Displays {
  std::mutex mutex;
  std::map<EGLDisplay, int> contexts;

  bool begin(const EglFunctions& egl, EGLDisplay display) {
    const std::lock_guard lock(mutex);
    if (!egl.initialize(display, nullptr, nullptr)) return false;
    ++contexts[display];
    return true;
  }

  void end(const EglFunctions& egl, EGLDisplay display) {
    const std::lock_guard lock(mutex);
    if (--contexts[display] == 0) egl.terminate(display);
  }
};

Displays& displays() {
  static Displays all;
  return all;
}

class EglContext : public Context {
 public:
  EglContext(const EglFunctions& functions, EGLDisplay display, EGLContext context)
      : egl_(functions), display_(display), context_(context) {
    backend = "egl";
  }
  ~EglContext() override {
    egl_.makeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    egl_.destroyContext(display_, context_);
    // Without its last display the driver is unloaded. After an error its end may wait for ever for a lock:
    // Mesa keeps one where it could not start a thread.
    if (std::uncaught_exceptions() == 0) displays().end(egl_, display_);
  }

 private:
  EglFunctions egl_;
  EGLDisplay display_;
  EGLContext context_;
};

/// A place to look for a context: a device, or the surfaceless platform.
struct Candidate {
  EGLenum platform;
  void* native;
  std::string name;
};

bool contains(const char* extensions, const char* name) {
  return extensions && std::strstr(extensions, name);
}

std::vector<Candidate> candidates(const EglFunctions& egl) {
  std::vector<Candidate> hardware;
  std::vector<Candidate> software;
  std::array<EGLDeviceEXT, 32> devices{};
  EGLint count = 0;
  if (egl.queryDevices && egl.queryDeviceString &&
      egl.queryDevices(EGLint(devices.size()), devices.data(), &count)) {
    for (EGLint i = 0; i < count; ++i) {
      const char* extensions = egl.queryDeviceString(devices[size_t(i)], EGL_EXTENSIONS);
      const bool isSoftware = contains(extensions, "EGL_MESA_device_software");
      const std::string name = isSoftware ? "EGL software device" : "EGL device " + std::to_string(i);
      (isSoftware ? software : hardware).push_back({EGL_PLATFORM_DEVICE_EXT, devices[size_t(i)], name});
    }
  }
  hardware.insert(hardware.end(), software.begin(), software.end());
  if (contains(egl.queryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_MESA_platform_surfaceless")) {
    hardware.push_back({EGL_PLATFORM_SURFACELESS_MESA, nullptr, "EGL surfaceless"});
  }
  return hardware;
}

/// Makes a context of OpenGL 4.5 that reports when it is lost, where the driver can tell.
EGLContext createContext(const EglFunctions& egl, EGLDisplay display, EGLConfig config) {
  std::vector<EGLint> wishes{EGL_CONTEXT_MAJOR_VERSION,       4,
                             EGL_CONTEXT_MINOR_VERSION,       5,
                             EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
#ifndef NDEBUG
  wishes.insert(wishes.end(), {EGL_CONTEXT_OPENGL_DEBUG, EGL_TRUE});
#endif
  std::vector<EGLint> telling = wishes;
  telling.insert(telling.end(),
                 {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_LOSE_CONTEXT_ON_RESET, EGL_NONE});
  wishes.push_back(EGL_NONE);
  const EGLContext context = egl.createContext(display, config, EGL_NO_CONTEXT, telling.data());
  return context != EGL_NO_CONTEXT ? context
                                   : egl.createContext(display, config, EGL_NO_CONTEXT, wishes.data());
}

std::unique_ptr<Context> tryCandidate(const EglFunctions& egl, const Candidate& candidate,
                                      std::string& reason) {
  const auto fail = [&](const char* step) {
    reason = formatted("%s failed (0x%04x)", step, unsigned(egl.getError()));
    return nullptr;
  };
  EGLDisplay display = egl.getPlatformDisplay(candidate.platform, candidate.native, nullptr);
  if (display == EGL_NO_DISPLAY) return fail("eglGetPlatformDisplay");
  if (!displays().begin(egl, display)) return fail("eglInitialize");
  EGLConfig config = EGL_NO_CONFIG_KHR;
  const char* extensions = egl.queryString(display, EGL_EXTENSIONS);
  if (!contains(extensions, "EGL_KHR_no_config_context")) {
    const EGLint wish[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_NONE};
    EGLint found = 0;
    if (!egl.chooseConfig(display, wish, &config, 1, &found) || found == 0) return fail("eglChooseConfig");
  }
  EGLContext context = EGL_NO_CONTEXT;
  if (egl.bindApi(EGL_OPENGL_API)) context = createContext(egl, display, config);
  if (context == EGL_NO_CONTEXT) {
    fail("eglCreateContext");
    displays().end(egl, display);
    return nullptr;
  }
  auto result = std::make_unique<EglContext>(egl, display, context);
  if (!egl.makeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) return fail("eglMakeCurrent");
  if (!loadFunctions(*result, egl.getProcAddress, reason)) return nullptr;
  return result;
}

/// The functions of EGL; none: `reason` says why.
const EglFunctions* eglFunctions(std::string& reason) {
  static const DynamicLibrary library({"libEGL.so.1", "libEGL.so"});
  static const EglFunctions egl(library);
  if (egl.complete() && egl.getPlatformDisplay) return &egl;
  reason = library.loaded() ? "the library lacks functions of EGL 1.5" : library.error();
  return nullptr;
}

bool isNumber(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789") == text.npos;
}

}  // namespace

std::unique_ptr<Context> makeEglContext(std::string& tried, const std::string& device) {
  std::string reason;
  const EglFunctions* const egl = eglFunctions(reason);
  if (egl == nullptr) {
    tried += "EGL (" + reason + "); ";
    return nullptr;
  }
  const std::vector<Candidate> places = candidates(*egl);
  if (places.empty()) tried += "EGL (no device); ";
  for (size_t i = 0; i < places.size(); ++i) {
    const bool isAnother = isNumber(device) && (places[i].native == nullptr || std::to_string(i) != device);
    auto context = isAnother ? nullptr : tryCandidate(*egl, places[i], reason);
    const bool isNamed = context && (device.empty() || isNumber(device) ||
                                     lowered(context->renderer).find(lowered(device)) != std::string::npos);
    if (isNamed) return context;
    if (context) reason = context->renderer;
    tried += places[i].name + (isAnother ? "; " : " (" + reason + "); ");
  }
  return nullptr;
}

std::vector<ListedDevice> listDevices() {
  std::vector<ListedDevice> devices;
  std::string reason;
  const EglFunctions* const egl = eglFunctions(reason);
  if (egl == nullptr) return devices;
  for (const Candidate& candidate : candidates(*egl)) {
    if (candidate.native == nullptr) continue;
    reason.clear();
    const auto context = tryCandidate(*egl, candidate, reason);
    devices.push_back({candidate.name, context ? context->renderer : "", reason});
  }
  return devices;
}

// OSMesa is Mesa's software rasteriser without any window system. Mesa 25.1 and later have neither the
// library nor its header, so this file declares the part of the interface that it uses (Mesa 3D, OSMesa
// interface 11.2).

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

struct OsMesaFunctions : LibraryFunctions {
  using LibraryFunctions::LibraryFunctions;
  OsMesaHandle (*createContext)(const int* attributes,
                                OsMesaHandle shared) = find("OSMesaCreateContextAttribs");
  void (*destroyContext)(OsMesaHandle) = find("OSMesaDestroyContext");
  unsigned char (*makeCurrent)(OsMesaHandle, void* pixels, unsigned type, int width,
                               int height) = find("OSMesaMakeCurrent");
  GetProcAddress getProcAddress = find("OSMesaGetProcAddress");
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
  const OsMesaFunctions functions(library);
  if (!functions.complete()) return fail("the library lacks OSMesaCreateContextAttribs");
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
