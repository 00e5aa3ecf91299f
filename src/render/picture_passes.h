// SPDX-License-Identifier: MIT
// Programs over all pixels of a picture, from textures into textures (shaders/picture/picture.glsl).
#pragma once

#include <glm/glm.hpp>
#include <initializer_list>
#include <utility>

#include "gl/gl.h"
#include "shader/assemble.h"

namespace fragtrace {

/// Makes programs of a fragment shader each, by the names of its file. All are started before one is waited
/// for. Throws RenderError.
void makePasses(const ShaderSource& source,
                std::initializer_list<std::pair<GlProgram*, const char*>> programs);

/// A framebuffer and its draws. Changes framebuffer, viewport, program and texture units of the context.
class PicturePasses {
 public:
  /// Throws RenderError, as all others do.
  explicit PicturePasses(const ShaderSource& source);

  /// Draws over the first `drawn` pixels of `into.front()`. `size` is the size that the program sees.
  void draw(const GlProgram& program, glm::ivec2 size, glm::ivec2 drawn,
            std::initializer_list<const GlTexture*> from, std::initializer_list<const GlTexture*> into);
  void draw(const GlProgram& program, glm::ivec2 size, std::initializer_list<const GlTexture*> from,
            std::initializer_list<const GlTexture*> into) {
    draw(program, size, size, from, into);
  }

  /// Draws a program that sums over blocks of 16 x 16 pixels of a picture of that size, and sums these blocks
  /// into `texel`, one of RGBA32F.
  void sum(const GlProgram& program, glm::ivec2 size, std::initializer_list<const GlTexture*> from,
           const GlTexture& texel);

 private:
  GlVertexArray vertexArray_;
  GlFramebuffer framebuffer_;
  size_t attached_ = 0;
  GlProgram sums_;
  glm::ivec2 room_{0};
  GlTexture blocks_;  ///< sums over blocks of pixels
  GlTexture wider_;   ///< sums over blocks of blocks
};

}  // namespace fragtrace
