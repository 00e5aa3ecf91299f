// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <glad/gl.h>

namespace fragtrace {

// OpenGL, for the files of src/gl and src/render only.

/// Throws RenderError that names `where` and every pending OpenGL error; ContextLost if the context is lost.
void checkGl(const char* where);

/// Fences between contexts that share objects, as GLsync. Null, which drivers without fences give, counts as
/// signalled. makeFence() makes a fence after all commands of this context so far, and flushes them.
void* makeFence();
/// Commands of this context that follow wait for the fence, which is released.
void awaitFence(void* fence);
bool isSignalled(void* fence);
/// Waits for the fence and releases it. Without a fence it waits for all commands of this context. The thread
/// sleeps for half of the expected time (0: not known), and between looks at the fence, because NVIDIA's
/// driver keeps a processor busy while it waits. It reports if the fence takes more than ten seconds.
void finishFence(void* fence, double expectedMs = 0.0);
void releaseFence(void* fence);

/// Waits until all commands of this context are done, as finishFence() does.
void waitForDevice(double expectedMs = 0.0);

/// The number of bytes that this thread has moved between host and device. Code that moves bytes adds to it.
uint64_t& movedBytes();

/// A limit of the driver, such as GL_MAX_TEXTURE_SIZE, at most 2^40, so that 16 times it is a number of
/// bytes. Throws as checkGl(): a lost context says 0.
int64_t driverLimit(GLenum name);
/// Returns the same as a number of OpenGL's.
GLsizei driverCount(GLenum name);

/// An OpenGL object's name, released by its owner; move-only.
template <void (*Release)(GLuint)>
class GlHandle {
 public:
  GlHandle() = default;
  explicit GlHandle(GLuint name) : name_(name) {}
  GlHandle(GlHandle&& other) noexcept : name_(std::exchange(other.name_, 0u)) {}
  GlHandle& operator=(GlHandle&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~GlHandle() {
    if (name_ != 0) Release(name_);
  }
  GLuint name() const { return name_; }

 private:
  GLuint name_ = 0;
};

inline void releaseBuffer(GLuint name) { glDeleteBuffers(1, &name); }
inline void releaseTexture(GLuint name) { glDeleteTextures(1, &name); }
inline void releaseFramebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }
inline void releaseVertexArray(GLuint name) { glDeleteVertexArrays(1, &name); }
inline void releaseShader(GLuint name) { glDeleteShader(name); }
inline void releaseQuery(GLuint name) { glDeleteQueries(1, &name); }
inline void releaseProgram(GLuint name) { glDeleteProgram(name); }

using GlBuffer = GlHandle<releaseBuffer>;
using GlTexture = GlHandle<releaseTexture>;
using GlFramebuffer = GlHandle<releaseFramebuffer>;
using GlVertexArray = GlHandle<releaseVertexArray>;
using GlQuery = GlHandle<releaseQuery>;
using GlShader = GlHandle<releaseShader>;
using GlProgram = GlHandle<releaseProgram>;

GlBuffer makeBuffer();
GlTexture makeTexture(GLenum target);
GlVertexArray makeVertexArray();
GlFramebuffer makeFramebuffer();
/// GL_TIME_ELAPSED: the time that draws take; GL_TIMESTAMP: the device's clock.
GlQuery makeQuery(GLenum target);

/// Collects the driver's messages through KHR_debug while it lives (errors always; in debug builds everything
/// above notifications). Call take() where the messages can be shown.
class DebugLog {
 public:
  DebugLog();
  DebugLog(const DebugLog&) = delete;
  DebugLog& operator=(const DebugLog&) = delete;
  ~DebugLog();
  std::vector<std::string> take();

 private:
  std::vector<std::string> messages_;
};

/// Does the same as checkGl(), with the driver's message about the error.
void checkGl(const char* where, DebugLog& log);

}  // namespace fragtrace
