// SPDX-License-Identifier: MIT
#pragma once

#include "render/picture_texture.h"

namespace fragtrace {

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

}  // namespace fragtrace
