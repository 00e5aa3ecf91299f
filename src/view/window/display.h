// SPDX-License-Identifier: MIT
// The latest pictures on the window: exposure and tone map once a picture, at its own resolution
// (shaders/entry/display.frag), then both sides of the bar at the window's (shaders/entry/window.frag).
#pragma once

#include <array>

#include "gl/gl.h"
#include "image/display/tone_map.h"
#include "view/exchange.h"

namespace fragtrace {

/// How a side's picture is shown.
struct DisplaySide {
  double exposure = 0.0;
  ToneMap toneMap = ToneMap::Neutral;
  bool operator==(const DisplaySide&) const = default;
};

class Display {
 public:
  /// Needs a current context; throws RenderError.
  Display();

  void take(const TracedPicture& picture);
  bool shows(size_t side) const { return sides_[side].size.x > 0; }

  /// Fills a framebuffer of that size; the bar stands at this part of the width, 1: the left side alone.
  void draw(glm::ivec2 framebuffer, const std::array<DisplaySide, 2>& sides, double bar);

 private:
  struct Side {
    GlTexture traced;
    GlTexture displayed;
    GlFramebuffer framebuffer;  ///< of the latter
    glm::ivec2 size{0};
    bool asItIs = false;
    bool fresh = false;    ///< what is displayed is of the traced picture,
    DisplaySide settings;  ///< shown like this
  };
  void map(Side& side, const DisplaySide& settings);

  GlProgram mapping_;
  GlProgram window_;
  GlVertexArray vertexArray_;
  std::array<Side, 2> sides_;
};

}  // namespace fragtrace
