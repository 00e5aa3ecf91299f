// SPDX-License-Identifier: MIT
#pragma once

#include "gl/gl.h"

namespace fragtrace {

/// The objects that no two contexts share. They are made for a pass, so that what draws it may do so in any
/// context that shares the rest.
struct DrawTarget {
  GlFramebuffer framebuffer = makeFramebuffer();
  GlVertexArray vertexArray = makeVertexArray();
  void bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glBindVertexArray(vertexArray.name());
  }
};

}  // namespace fragtrace
