// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <initializer_list>
#include <stdexcept>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "gl/gl.h"
#include "render/film.h"
#include "shader/assemble.h"

namespace fragtrace {

// Textures of one texel per pixel: writing them, and reading them back from the device.

inline GlTexture makePictureTexture(GLenum format, glm::ivec2 size) {
  GlTexture texture = makeTexture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), 1, format, size.x, size.y);
  // A texture of integers that would be interpolated is incomplete: all its texels are 0.
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

/// Returns true if a picture of that size has no room, which then grows. The content must then be made again.
inline bool grows(glm::ivec2& room, glm::ivec2 size) {
  if (glm::all(glm::lessThanEqual(size, room))) return false;
  room = glm::max(size, room);
  return true;
}

/// Reads all texels of a format with `channels` channels of type `type`, row by row in the order of the
/// device. `where` names the step in errors, as for checkGl().
template <typename Value>
std::vector<Value> readPictureTexture(const GlTexture& texture, GLenum format, int channels, GLenum type,
                                      glm::ivec2 size, const char* where) {
  const size_t row = size_t(size.x) * size_t(channels);
  std::vector<Value> values(row * size_t(size.y));
  movedBytes() += values.size() * sizeof(Value);
  // The copy's size is an int in OpenGL, so large pictures are read in bands.
  const int rowsAtOnce = std::max(1, int((size_t(1) << 28) / (row * sizeof(Value))));
  for (int y = 0; y < size.y; y += rowsAtOnce) {
    const int rows = std::min(rowsAtOnce, size.y - y);
    glGetTextureSubImage(texture.name(), 0, 0, y, 0, size.x, rows, 1, format, type,
                         GLsizei(size_t(rows) * row * sizeof(Value)), values.data() + size_t(y) * row);
  }
  checkGl(where);
  return values;
}

/// Writes as many values as readPictureTexture() returns.
template <typename Value>
void writePictureTexture(const GlTexture& texture, GLenum format, int channels, GLenum type, glm::ivec2 size,
                         const std::vector<Value>& values, const char* where) {
  const size_t row = size_t(size.x) * size_t(channels);
  if (values.size() != row * size_t(size.y)) throw std::invalid_argument("values do not fill the texture");
  movedBytes() += values.size() * sizeof(Value);
  glTextureSubImage2D(texture.name(), 0, 0, 0, size.x, size.y, format, type, values.data());
  checkGl(where);
}

/// A noisy picture on the device with its guides: means of its samples, a texel per pixel, in textures that
/// may be larger.
struct NoisyTextures {
  GlTexture radiance;  ///< linear R, G, B; variance of the mean's luminance (Layers::variance)
  GlTexture counts;    ///< samples; one observation of that variance (observedVariance()), negative: none
  GlTexture albedo;    ///< albedo and coverage: the first four of kGuideChannels
  GlTexture normal;    ///< normal and depth: the other four
  glm::ivec2 room{0};  ///< pixels that they hold
};

/// Makes textures for that many pixels if these are smaller.
inline void makeRoom(NoisyTextures& noisy, glm::ivec2 size) {
  glm::ivec2 room = noisy.room;
  if (!grows(room, size)) return;
  noisy = {makePictureTexture(GL_RGBA32F, room), makePictureTexture(GL_RG32F, room),
           makePictureTexture(GL_RGBA32F, room), makePictureTexture(GL_RGBA32F, room), room};
}

// Programs over all pixels of a picture, from textures into textures (shaders/picture/picture.glsl).

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

// A film as a picture on the device: its means, joined with the picture that a moving camera saw before, and
// in the form that a window shows.

/// A picture and its camera.
struct SeenPicture {
  NoisyTextures noisy;
  glm::ivec2 size{0};  ///< size of the picture; 0: there is none
  Camera camera;       ///< world space
};

/// Behind its surfaces a picture has a background, which makes it opaque; nothing; or nothing and a shadow in
/// alpha alone, so that it was filtered as laid over white.
enum class Behind { Background, Nothing, White };

/// The programs, which belong to one context. Rows of films and of pictures made of them go up; those of
/// shown pictures go down.
class SeenPasses {
 public:
  /// Throws RenderError, as all other members do.
  explicit SeenPasses(const ShaderSource& source);

  /// Writes the film's linear R, G, B and alpha into `raw`, and all else that a filter needs: radiance and
  /// counts into `fresh`, albedo and normal of a film of guides into `surfaces`.
  void read(const Film& film, const Film& guides, const GlTexture& raw, const NoisyTextures& fresh,
            const NoisyTextures& surfaces, PicturePasses& passes);

  /// Writes into `now` radiance and counts of the fresh picture with the samples of `past` added. A pixel's
  /// first hit takes them if the past picture shows that point, at the same depth, with a similar normal and
  /// albedo. Past light is divided by the past albedo and multiplied by the present one, so that textures
  /// stay sharp. A pixel's past counts as the samples that it had, but at most `most`, since its reflections
  /// were seen from elsewhere. Means, counts and variances are joined as if all samples had been seen (Chan,
  /// Golub and LeVeque, 1979). The background takes nothing from the past.
  void join(const NoisyTextures& fresh, const SeenPicture& now, const SeenPicture& past, double most,
            PicturePasses& passes);

  /// Mixes `share` of the filtered picture with the rest of the raw one, into `shown`.
  void show(const GlTexture& raw, const GlTexture& filtered, double share, Behind behind, glm::ivec2 size,
            const GlTexture& shown, PicturePasses& passes);
  /// Shows the film as it is.
  void show(const Film& film, bool background, const GlTexture& shown, PicturePasses& passes);

  /// Counts into one texel: samples, rays, and pixels in which the driver ended a loop.
  void count(const Film& film, const GlTexture& texel, PicturePasses& passes);

 private:
  GlProgram film_;
  GlProgram reproject_;
  GlProgram join_;
  GlProgram show_;
  GlProgram showFilm_;
  GlProgram totals_;
  glm::ivec2 room_{0};
  GlTexture past_;  ///< scratch of one call
  GlTexture apart_;
};

}  // namespace fragtrace
