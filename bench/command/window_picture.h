// SPDX-License-Identifier: MIT
// A displayed picture as the viewer's window shows it, enlarged where it is coarser.
#pragma once

#include "gl/gl.h"
#include "image/image.h"

namespace fragtrace {

/// Draws by shaders/entry/window.frag, as src/view/window/display.cpp does. Needs a current context, as its
/// call does; both throw RenderError.
class WindowPicture {
 public:
  WindowPicture();

  /// R, G and B in 0..1 of a picture that has these first, as wide and high as `size` pixels.
  Image of(const Image& display, glm::ivec2 size) const;

 private:
  GlProgram program_;
};

}  // namespace fragtrace
