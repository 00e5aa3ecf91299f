// SPDX-License-Identifier: MIT
#include "gl/gl.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>

#include "base/errors.h"
#include "base/report.h"

namespace fragtrace {

namespace {

constexpr GLint64 kMostLimit = GLint64(1) << 40;

const char* errorName(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "invalid enum";
    case GL_INVALID_VALUE:
      return "invalid value";
    case GL_INVALID_OPERATION:
      return "invalid operation";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "invalid framebuffer operation";
    case GL_OUT_OF_MEMORY:
      return "out of memory";
    case GL_CONTEXT_LOST:
      return "context lost";
    default:
      return "unknown error";
  }
}

}  // namespace

void checkGl(const char* where) {
  std::string errors;
  bool lost = false;
  // A lost context reports its error without end.
  for (int i = 0; i < 8; ++i) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR || lost) break;
    lost = error == GL_CONTEXT_LOST;
    errors += (errors.empty() ? "" : ", ") + std::string(errorName(error));
  }
  if (errors.empty()) return;
  const std::string message = "OpenGL: " + errors + " while " + where;
  if (lost) throw ContextLost(message);
  throw RenderError(message);
}

void* makeFence() {
  void* fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  glFlush();
  return fence;
}

void awaitFence(void* fence) {
  if (fence == nullptr) return;
  glWaitSync(static_cast<GLsync>(fence), 0, GL_TIMEOUT_IGNORED);
  releaseFence(fence);
}

bool isSignalled(void* fence) {
  return fence == nullptr || glClientWaitSync(static_cast<GLsync>(fence), 0, 0) != GL_TIMEOUT_EXPIRED;
}

void finishFence(void* fence, double expectedMs) {
  if (fence == nullptr) return glFinish();
  using Milliseconds = std::chrono::duration<double, std::milli>;
  constexpr GLuint64 kShort = 200'000;  // ns; short draws are not made longer
  constexpr double kShortMs = 1e-6 * kShort;
  constexpr double kSurelyBusy = 0.5;  // part of the expected time: many samples at once take less each
  constexpr Milliseconds kStall(10'000.0);
  const auto sync = static_cast<GLsync>(fence);
  const bool sleeps = expectedMs > kShortMs;
  const Milliseconds asleep(sleeps ? kSurelyBusy * expectedMs : 0.0);
  if (sleeps) std::this_thread::sleep_for(asleep);
  GLenum state = glClientWaitSync(sync, GL_SYNC_FLUSH_COMMANDS_BIT, sleeps ? 0 : kShort);
  // A look at the fence takes 15 us of a processor. The pauses are a twentieth of the time that has gone by.
  Milliseconds waited(0.0);
  for (Milliseconds pause = std::max(Milliseconds(0.1), asleep / 20.0); state == GL_TIMEOUT_EXPIRED;
       pause = std::min(pause * 1.05, kStall / 20.0)) {
    std::this_thread::sleep_for(pause);
    if (waited < kStall && waited + pause >= kStall) {
      // A user who asked for quiet may have to end the program, too.
      reportMessage("warning: the driver has not finished a draw for 10 s; it may be busy or stuck");
    }
    waited += pause;
    state = glClientWaitSync(sync, 0, 0);
  }
  if (state != GL_ALREADY_SIGNALED && state != GL_CONDITION_SATISFIED) glFinish();
  releaseFence(fence);
}

void releaseFence(void* fence) { glDeleteSync(static_cast<GLsync>(fence)); }

void waitForDevice(double expectedMs) { finishFence(makeFence(), expectedMs); }

uint64_t& movedBytes() {
  static thread_local uint64_t bytes = 0;
  return bytes;
}

int64_t driverLimit(GLenum name) {
  GLint64 value = 0;
  glGetInteger64v(name, &value);
  checkGl("asking for a limit of the driver");
  return std::clamp(value, GLint64(0), kMostLimit);
}

GLsizei driverCount(GLenum name) {
  return GLsizei(std::min<int64_t>(driverLimit(name), std::numeric_limits<GLsizei>::max()));
}

GlBuffer makeBuffer() {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  return GlBuffer(name);
}

GlTexture makeTexture(GLenum target) {
  GLuint name = 0;
  glCreateTextures(target, 1, &name);
  return GlTexture(name);
}

GlQuery makeQuery(GLenum target) {
  GLuint name = 0;
  glCreateQueries(target, 1, &name);
  return GlQuery(name);
}

GlVertexArray makeVertexArray() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  return GlVertexArray(name);
}

GlFramebuffer makeFramebuffer() {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  return GlFramebuffer(name);
}

namespace {

void GLAD_API_PTR receive(GLenum, GLenum type, GLuint, GLenum severity, GLsizei length, const GLchar* text,
                          const void* user) {
  if (severity == GL_DEBUG_SEVERITY_NOTIFICATION) return;
#ifdef NDEBUG
  if (type != GL_DEBUG_TYPE_ERROR) return;
#else
  (void)type;
#endif
  auto& messages = *static_cast<std::vector<std::string>*>(const_cast<void*>(user));
  messages.emplace_back(text, size_t(length));
}

}  // namespace

DebugLog::DebugLog() {
  if (!GLAD_GL_KHR_debug) return;
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(receive, &messages_);
}

DebugLog::~DebugLog() {
  if (GLAD_GL_KHR_debug) glDebugMessageCallback(nullptr, nullptr);
}

std::vector<std::string> DebugLog::take() { return std::exchange(messages_, {}); }

void checkGl(const char* where, DebugLog& log) {
  try {
    checkGl(where);
  } catch (const ContextLost&) {
    throw;
  } catch (const RenderError& error) {
    std::string text = error.what();
    for (const std::string& message : log.take()) text += "; driver: " + message;
    throw RenderError(text);
  }
}

}  // namespace fragtrace
