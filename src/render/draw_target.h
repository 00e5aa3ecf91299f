// SPDX-License-Identifier: MIT
#pragma once

#include "gl/gl.h"

namespace fragtrace {

/// The objects that no two contexts share. They are made for a pass, so that a pass may draw in any context
/// that shares the other objects.
struct DrawTarget {
  GlFramebuffer framebuffer = makeFramebuffer();
  GlVertexArray vertexArray = makeVertexArray();
  void bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glBindVertexArray(vertexArray.name());
  }
};

}  // namespace fragtrace
