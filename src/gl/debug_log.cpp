// SPDX-License-Identifier: MIT
#include "gl/debug_log.h"

#include <utility>

#include "base/errors.h"
#include "gl/gl.h"

namespace fragtrace {

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
