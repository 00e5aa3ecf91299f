// SPDX-License-Identifier: MIT
// A libEGL.so.1 in front of the real one, which makes an OpenGL call fail. The environment says how:
//   FRAGTRACE_REAL_EGL   path of the library that does the work
//   FRAGTRACE_FAIL_CALL  which call fails, counted from 1 over all that are wrapped; 0: none
//   FRAGTRACE_FAIL_KIND  memory: it does nothing and gives GL_OUT_OF_MEMORY
//                        build: it is the glCompileShader or glLinkProgram of that number that fails
//                        lost: the context is lost from then on, until another one is made
//                        blend: none fails, but no format can be blended
//                        gpu: none fails, and the driver says that it is one of a GPU
//                        small, huge: none fails, and the driver says so of its limits
//                        nan: none fails, but textures of floats that are read hold NaN
//                        stall: none fails, but fences take twelve seconds from the first look at one on
//                        second: there is one context, and no other
//   FRAGTRACE_FAIL_ONLY  calls of this function alone are counted, and logged
//   FRAGTRACE_FAIL_NAME  a function that does nothing and gives no error, as often as it is called
//   FRAGTRACE_FAIL_WHEN  a file: once it is there it is removed, and the context is lost
//   FRAGTRACE_FAIL_AGAIN after so many calls the context that took a lost one's place is lost, too; once
//   FRAGTRACE_FAIL_LOG   a file that gets the name of each call, a line each
#include <EGL/egl.h>
#include <dlfcn.h>
#include <glad/gl.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <mutex>
#include <utility>

#include "heap_log.h"

namespace {

const char* setting(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

bool isKind(const char* kind) { return std::strcmp(setting("FRAGTRACE_FAIL_KIND"), kind) == 0; }

struct Faults {
  long failing = std::atol(setting("FRAGTRACE_FAIL_CALL"));
  bool lostKind = isKind("lost");
  bool buildKind = isKind("build");
  const char* when = setting("FRAGTRACE_FAIL_WHEN");
  const char* only = setting("FRAGTRACE_FAIL_ONLY");
  const char* never = setting("FRAGTRACE_FAIL_NAME");
  long again = std::atol(setting("FRAGTRACE_FAIL_AGAIN"));
  long untilLost = 0;  // calls; 0: never
  FILE* log = *setting("FRAGTRACE_FAIL_LOG") ? std::fopen(setting("FRAGTRACE_FAIL_LOG"), "w") : nullptr;
  void* real = dlopen(setting("FRAGTRACE_REAL_EGL"), RTLD_NOW | RTLD_LOCAL);
  long calls = 0;
  GLenum error = GL_NO_ERROR;
  bool lost = false;
  bool notBuilt = false;
  std::mutex mutex;
};

Faults& faults() {
  static Faults all;
  return all;
}

/// Counts a call; false: it must do nothing.
bool allowed(const char* name) {
  Faults& f = faults();
  const std::lock_guard lock(f.mutex);
  logHeap();
  if (*f.when && std::remove(f.when) == 0) f.lost = true;
  if (f.untilLost > 0 && --f.untilLost == 0) f.lost = true;
  if (f.lost || std::strcmp(name, f.never) == 0) return false;
  const bool builds = std::strcmp(name, "glCompileShader") == 0 || std::strcmp(name, "glLinkProgram") == 0;
  if (f.buildKind && !builds) return true;
  if (*f.only && std::strcmp(name, f.only) != 0) return true;
  ++f.calls;
  if (f.log) {
    std::fprintf(f.log, "%s\n", name);
    std::fflush(f.log);
  }
  if (f.calls != f.failing) return true;
  if (f.buildKind) {
    f.notBuilt = true;
    return false;
  }
  f.lost = f.lostKind;
  f.error = GL_OUT_OF_MEMORY;
  return false;
}

/// Returns glFoo for glad_glFoo.
const char* openGlName(const char* gladName) { return gladName + std::strlen("glad_"); }

/// One OpenGL function; Name tells those of the same type apart.
template <const char* Name, typename Function>
struct Wrapped;

template <const char* Name, typename Result, typename... Arguments>
struct Wrapped<Name, Result (*)(Arguments...)> {
  static inline Result (*real)(Arguments...) = nullptr;
  static Result call(Arguments... arguments) {
    if (allowed(openGlName(Name))) return real(arguments...);
    return Result();
  }
};

GLenum failingGetError() {
  using Real = GLenum (*)();
  static const Real real = [] {
    const auto find = reinterpret_cast<void* (*)(const char*)>(dlsym(faults().real, "eglGetProcAddress"));
    return reinterpret_cast<Real>(find("glGetError"));
  }();
  Faults& f = faults();
  const std::lock_guard lock(f.mutex);
  if (f.lost) return GL_CONTEXT_LOST;
  const GLenum error = f.error;
  f.error = GL_NO_ERROR;
  return error != GL_NO_ERROR ? error : real();
}

/// An object that was not built reports that.
template <const char* Name, typename Function>
void failingStatus(GLuint object, GLenum what, GLint* value) {
  Wrapped<Name, Function>::call(object, what, value);
  const Faults& f = faults();
  if (f.notBuilt && (what == GL_COMPILE_STATUS || what == GL_LINK_STATUS)) *value = GL_FALSE;
}

/// The answer of a driver that cannot blend.
template <const char* Name, typename Function>
void failingFormat(GLenum target, GLenum format, GLenum what, GLsizei size, GLint* value) {
  Wrapped<Name, Function>::call(target, format, what, size, value);
  if (isKind("blend") && what == GL_FRAMEBUFFER_BLEND) *value = GL_NONE;
}

/// The driver's word for itself.
template <const char* Name, typename Function>
const GLubyte* renamed(GLenum what) {
  if (isKind("gpu") && what == GL_RENDERER)
    return reinterpret_cast<const GLubyte*>("a GPU that is not there");
  return Wrapped<Name, Function>::call(what);
}

/// Limits that are not true.
template <const char* Name, typename Function>
void failingLimit(GLenum what, GLint64* value) {
  Wrapped<Name, Function>::call(what, value);
  if (isKind("small")) *value = 1;
  if (isKind("huge")) *value = std::numeric_limits<GLint64>::max();
}

/// Bytes 0xff are NaN, as floats of 16 and of 32 bits.
template <const char* Name, typename Function>
void failingRead(GLuint texture, GLint level, GLint x, GLint y, GLint z, GLsizei width, GLsizei height,
                 GLsizei depth, GLenum format, GLenum type, GLsizei size, void* pixels) {
  Wrapped<Name, Function>::call(texture, level, x, y, z, width, height, depth, format, type, size, pixels);
  if (isKind("nan") && (type == GL_FLOAT || type == GL_HALF_FLOAT)) std::memset(pixels, 0xff, size_t(size));
}

/// A driver that is stuck for a while.
template <const char* Name, typename Function>
GLenum failingWait(GLsync fence, GLbitfield flags, GLuint64 nanoseconds) {
  using Clock = std::chrono::steady_clock;
  static const Clock::time_point first = Clock::now();
  if (isKind("stall") && Clock::now() - first < std::chrono::seconds(12)) return GL_TIMEOUT_EXPIRED;
  return Wrapped<Name, Function>::call(fence, flags, nanoseconds);
}

template <typename Function>
Function realEgl(const char* name) {
  return reinterpret_cast<Function>(dlsym(faults().real, name));
}

}  // namespace

// glad's names are macros: `function` arrives as glad_glFoo.
#define WRAP_BY(function, ...)                                                                \
  if (static constexpr char kName[] = #function; std::strcmp(name, openGlName(kName)) == 0) { \
    using Function = decltype(function);                                                      \
    Wrapped<kName, Function>::real = reinterpret_cast<Function>(real);                        \
    return reinterpret_cast<Pointer>(&__VA_ARGS__);                                           \
  }
#define WRAP(function) WRAP_BY(function, Wrapped<kName, Function>::call)
#define WRAP_STATUS(function) WRAP_BY(function, failingStatus<kName, Function>)
#define WRAP_FORMAT(function) WRAP_BY(function, failingFormat<kName, Function>)
#define WRAP_NAME(function) WRAP_BY(function, renamed<kName, Function>)
#define WRAP_LIMIT(function) WRAP_BY(function, failingLimit<kName, Function>)
#define WRAP_READ(function) WRAP_BY(function, failingRead<kName, Function>)
#define WRAP_WAIT(function) WRAP_BY(function, failingWait<kName, Function>)

extern "C" {

// NOLINTNEXTLINE(readability-function-size): a table
__eglMustCastToProperFunctionPointerType eglGetProcAddress(const char* name) {
  using Pointer = __eglMustCastToProperFunctionPointerType;
  const Pointer real = realEgl<Pointer (*)(const char*)>("eglGetProcAddress")(name);
  if (std::strcmp(name, "glGetError") == 0) return reinterpret_cast<Pointer>(&failingGetError);
  WRAP_STATUS(glGetShaderiv)
  WRAP_STATUS(glGetProgramiv)
  WRAP_FORMAT(glGetInternalformativ)
  WRAP(glAttachShader)
  WRAP(glBeginQuery)
  WRAP(glBindBufferBase)
  WRAP(glBindFramebuffer)
  WRAP(glBindImageTexture)
  WRAP(glBindTextureUnit)
  WRAP(glBindVertexArray)
  WRAP(glBlendFunc)
  WRAP(glClearNamedBufferData)
  WRAP(glClearNamedFramebufferfv)
  WRAP(glClearNamedFramebufferuiv)
  WRAP(glClearTexImage)
  WRAP_WAIT(glClientWaitSync)
  WRAP(glCompileShader)
  WRAP(glCopyNamedBufferSubData)
  WRAP(glCreateBuffers)
  WRAP(glCreateFramebuffers)
  WRAP(glCreateProgram)
  WRAP(glCreateQueries)
  WRAP(glCreateShader)
  WRAP(glCreateTextures)
  WRAP(glCreateVertexArrays)
  WRAP(glDebugMessageCallback)
  WRAP(glDeleteBuffers)
  WRAP(glDeleteFramebuffers)
  WRAP(glDeleteProgram)
  WRAP(glDeleteQueries)
  WRAP(glDeleteShader)
  WRAP(glDeleteSync)
  WRAP(glDeleteTextures)
  WRAP(glDeleteVertexArrays)
  WRAP(glDisable)
  WRAP(glDispatchCompute)
  WRAP(glDrawArrays)
  WRAP(glEnable)
  WRAP(glEndQuery)
  WRAP(glFenceSync)
  WRAP(glFinish)
  WRAP(glFlush)
  WRAP(glGenTextures)
  WRAP(glGetFloatv)
  WRAP_LIMIT(glGetInteger64v)
  WRAP(glGetNamedBufferSubData)
  WRAP(glGetProgramInfoLog)
  WRAP(glGetQueryObjectui64v)
  WRAP(glGetShaderInfoLog)
  WRAP_NAME(glGetString)
  WRAP_READ(glGetTextureSubImage)
  WRAP(glLinkProgram)
  WRAP(glMapNamedBufferRange)
  WRAP(glMaxShaderCompilerThreadsKHR)
  WRAP(glMemoryBarrier)
  WRAP(glNamedBufferStorage)
  WRAP(glNamedBufferSubData)
  WRAP(glNamedFramebufferDrawBuffers)
  WRAP(glNamedFramebufferParameteri)
  WRAP(glNamedFramebufferTexture)
  WRAP(glProgramUniform1f)
  WRAP(glProgramUniform1i)
  WRAP(glProgramUniform2f)
  WRAP(glProgramUniform2i)
  WRAP(glProgramUniform4fv)
  WRAP(glShaderSource)
  WRAP(glTextureBuffer)
  WRAP(glTextureParameteri)
  WRAP(glTextureStorage2D)
  WRAP(glTextureStorage3D)
  WRAP(glTextureSubImage2D)
  WRAP(glTextureSubImage3D)
  WRAP(glTextureView)
  WRAP(glUnmapNamedBuffer)
  WRAP(glUseProgram)
  WRAP(glViewport)
  WRAP(glWaitSync)
  return real;
}

EGLContext eglCreateContext(EGLDisplay display, EGLConfig config, EGLContext shared, const EGLint* wishes) {
  Faults& f = faults();
  {
    const std::lock_guard lock(f.mutex);
    if (f.lost) f.untilLost = std::exchange(f.again, 0);
    f.lost = false;
  }
  static std::atomic<bool> isSecond = false;
  if (isSecond && isKind("second")) return EGL_NO_CONTEXT;
  const EGLContext made =
      realEgl<decltype(&eglCreateContext)>("eglCreateContext")(display, config, shared, wishes);
  isSecond = isSecond || made != EGL_NO_CONTEXT;
  return made;
}

EGLBoolean eglInitialize(EGLDisplay display, EGLint* major, EGLint* minor) {
  return realEgl<decltype(&eglInitialize)>("eglInitialize")(display, major, minor);
}
EGLBoolean eglTerminate(EGLDisplay display) {
  return realEgl<decltype(&eglTerminate)>("eglTerminate")(display);
}
EGLBoolean eglBindAPI(EGLenum api) { return realEgl<decltype(&eglBindAPI)>("eglBindAPI")(api); }
EGLBoolean eglChooseConfig(EGLDisplay display, const EGLint* wishes, EGLConfig* configs, EGLint size,
                           EGLint* count) {
  return realEgl<decltype(&eglChooseConfig)>("eglChooseConfig")(display, wishes, configs, size, count);
}
EGLBoolean eglDestroyContext(EGLDisplay display, EGLContext context) {
  return realEgl<decltype(&eglDestroyContext)>("eglDestroyContext")(display, context);
}
EGLBoolean eglMakeCurrent(EGLDisplay display, EGLSurface draw, EGLSurface read, EGLContext context) {
  return realEgl<decltype(&eglMakeCurrent)>("eglMakeCurrent")(display, draw, read, context);
}
const char* eglQueryString(EGLDisplay display, EGLint name) {
  return realEgl<decltype(&eglQueryString)>("eglQueryString")(display, name);
}
EGLint eglGetError() { return realEgl<decltype(&eglGetError)>("eglGetError")(); }

}  // extern "C"
