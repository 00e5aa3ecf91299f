// SPDX-License-Identifier: MIT
// Programs over all pixels of a picture, from textures into textures (shaders/picture/picture.glsl).
#pragma once

#include <glm/glm.hpp>
#include <initializer_list>

#include "gl/gl.h"
#include "shader/assemble.h"

namespace fragtrace {

/// Makes a program of a fragment shader alone. Throws RenderError.
GlProgram passProgram(const ShaderSource& source, const char* entry);

/// A framebuffer and its draws. Changes framebuffer, viewport, program and texture units of the context.
class PicturePasses {
 public:
  PicturePasses() : vertexArray_(makeVertexArray()), framebuffer_(makeFramebuffer()) {}

  /// Draws over the first `drawn` pixels of `into.front()`. `size` is the size that the program sees. Throws
  /// RenderError.
  void draw(const GlProgram& program, glm::ivec2 size, glm::ivec2 drawn,
            std::initializer_list<const GlTexture*> from, std::initializer_list<const GlTexture*> into);
  void draw(const GlProgram& program, glm::ivec2 size, std::initializer_list<const GlTexture*> from,
            std::initializer_list<const GlTexture*> into) {
    draw(program, size, size, from, into);
  }

 private:
  GlVertexArray vertexArray_;
  GlFramebuffer framebuffer_;
  size_t attached_ = 0;
};

/// Sums a picture over blocks, and these sums again, down to one texel.
class PictureSums {
 public:
  PictureSums(const ShaderSource& source) : sums_(passProgram(source, "picture/sums.frag")) {}

  /// The size after one sum.
  static glm::ivec2 blocksOf(glm::ivec2 size);
  /// The texture into which a program writes its sums over blocks of a picture of that size.
  const GlTexture& blocks(glm::ivec2 size);
  /// Sums the blocks into one texel of RGBA32F.
  void into(const GlTexture& texel, glm::ivec2 size, PicturePasses& passes);

 private:
  GlProgram sums_;
  glm::ivec2 room_{0};
  GlTexture blocks_;  ///< of pixels
  GlTexture wider_;   ///< of these
};

}  // namespace fragtrace
