// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "shader/render_options.h"

namespace fragtrace {

/// A headless OpenGL 4.5 core context, current in the thread that made it until it is destroyed. Its
/// libraries are loaded at run time.
class Context {
 public:
  Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  virtual ~Context() = default;

  std::string backend;    ///< "egl" or "osmesa"
  std::string renderer;   ///< GL_RENDERER
  std::string version;    ///< GL_VERSION
  bool software = false;  ///< a rasteriser on the processor
};

/// Makes a context: a GPU through EGL, else software EGL, else OSMesa; or only what the options name. Their
/// vector width holds for the process (setVectorWidth). Throws ContextError, which says what was tried and
/// why each attempt failed, and UsageError where no device is the one that they name.
std::unique_ptr<Context> makeContext(const DeviceOptions& options);

/// The two ways. Each returns null on failure and appends the reasons to `tried`. `device` is the number of a
/// device in listDevices(), or a part of its renderer in any case; empty: the first that works.
std::unique_ptr<Context> makeEglContext(std::string& tried, const std::string& device = {});
std::unique_ptr<Context> makeOsMesaContext(std::string& tried);

/// A device of EGL, and what its driver calls it, or why it does not work.
struct ListedDevice {
  std::string name;      ///< "EGL device 0"
  std::string renderer;  ///< GL_RENDERER; empty: it does not work
  std::string reason;    ///< why not
};

/// The devices, GPUs first, in the order in which makeEglContext() tries them. Opens each of them.
std::vector<ListedDevice> listDevices();

using GetProcAddress = void (*(*)(const char*))();

/// A context that other code has made, for one thread.
struct OutsideContext {
  std::function<void()> enter;  ///< makes it current in the calling thread
  std::function<void()> leave;  ///< leaves no context current
  GetProcAddress functions = nullptr;
};

/// Two contexts that share their objects with the window's, each for one thread at a time.
struct SharedContexts {
  std::optional<OutsideContext> draws;
  std::optional<OutsideContext> compiles;  ///< none: programs are compiled where they draw
};

/// Enters that context, which is current until the result is destroyed. Throws ContextError.
std::unique_ptr<Context> makeContext(const OutsideContext& outside);

}  // namespace fragtrace
