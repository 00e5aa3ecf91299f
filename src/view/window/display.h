// SPDX-License-Identifier: MIT
// The latest pictures on the window: exposure and tone map once a picture, at its own resolution
// (shaders/entry/display.frag), then both sides of the bar at the window's (shaders/entry/window.frag).
#pragma once

#include <array>

#include "gl/gl.h"
#include "image/display/tone_map.h"
#include "view/pictures.h"
#include "view/view_state.h"

namespace fragtrace {

// Reads values of a picture on the device for display, without waiting for the device.

class ValueReader {
 public:
  ValueReader() = default;
  ValueReader(const ValueReader&) = delete;
  ValueReader& operator=(const ValueReader&) = delete;
  ~ValueReader();

  /// Keeps `values` those of an area of the picture: reads it where they are of another one, or, at most five
  /// times a second, of another picture. An area without pixels is nothing to be read. `now`: seconds.
  /// Returns when to call it again, though nothing else changes; infinity: never.
  double keep(PictureValues& values, GLuint texture, uint64_t picture, glm::ivec2 whole,
              const PixelArea& area, double now);

 private:
  void begin(GLuint texture, double now);
  void end(PictureValues& values);

  GlBuffer buffer_;
  size_t room_ = 0;  ///< bytes
  bool reading_ = false;
  void* done_ = nullptr;  ///< a fence, after which
  PictureValues asked_;   ///< is read, except for its image
  double begun_ = -1.0;
};

/// The way in which radiance is shown.
struct DisplaySettings {
  double exposure = 0.0;
  ToneMap toneMap = ToneMap::Neutral;
  std::optional<glm::vec3> page{};  ///< the colour behind the surfaces, as toDisplayOver() takes it
  bool operator==(const DisplaySettings&) const = default;
};

class Display {
 public:
  /// Needs a current context; throws RenderError.
  explicit Display(Exchange& exchange);

  void take(const TracedPicture& picture);
  /// Shows the first side in the place of this one until its next picture comes.
  void forget(size_t side);
  bool shows(size_t side) const { return sides_[side].size.x > 0; }
  /// Returns true if the tracing thread still draws a picture that was taken.
  bool waits() const;
  /// Returns true if the next draw() shows another picture than the one before.
  bool hasNewPicture() const;
  /// Keeps these values of a side's picture, and says when to be asked again, as ValueReader does.
  double keepValues(size_t side, PictureValues& values, const PixelArea& area, double now);
  /// Pixels of the picture that is shown.
  glm::ivec2 sizeOf(size_t side) const { return sides_[side].size; }

  /// Has the driver compile what the first picture would wait for. Draws into the window, whose frame has
  /// been shown.
  void prepare();

  /// Fills the picture's area of a window, and clears the rest.
  void draw(const ViewState& state, glm::ivec2 picture, glm::ivec2 window);

 private:
  struct Side {
    GlTexture copied;  ///< the picture, if textures are not shared
    glm::ivec2 copiedSize{0};
    SharedTexture shared;   ///< the texture that is shown
    SharedTexture waiting;  ///< the next texture, until it is ready
    glm::ivec2 waitingSize{0};
    bool waitingAsItIs = false;
    GLuint traced = 0;    ///< texture that is shown
    uint64_t number = 0;  ///< number of the picture
    ValueReader reader;
    GlTexture displayed;
    GlFramebuffer framebuffer;  ///< framebuffer of `displayed`
    glm::ivec2 size{0};
    bool asItIs = false;
    bool fresh = false;        ///< `displayed` holds the traced picture
    DisplaySettings settings;  ///< the settings with which it was drawn
  };
  bool allReady() const;
  void showWaiting();
  static void show(Side& side, GLuint traced, glm::ivec2 size, bool asItIs);
  void release(size_t side, SharedTexture& texture);
  void map(Side& side, const DisplaySettings& settings);
  /// Two pictures, or the same, at a place of the window from its bottom left.
  void drawCell(const ViewState& state, size_t left, size_t right, glm::ivec2 corner, glm::ivec2 size);

  Exchange& exchange_;
  GlProgram mapping_;
  GlProgram window_;
  GlVertexArray vertexArray_;
  std::array<Side, kMostSides> sides_;
};

}  // namespace fragtrace
