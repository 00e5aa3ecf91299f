// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>

#include "gl/gl.h"
#include "pack/gpu_scene.h"

namespace fragtrace {

/// The packed scene on the device, bound as storage buffers, image buffers or texel buffers.
class SceneBuffers {
 public:
  /// Frees each array of the scene as soon as the driver has it. Throws RenderError when one is larger than
  /// this driver reads that way, or memory runs out.
  SceneBuffers(GpuScene& scene, BufferReads reads);
  void bind() const;

 private:
  struct Entry {
    GlBuffer buffer;
    GlTexture view;  ///< image and texel reads
    GLenum format = GL_RGBA32UI;
  };
  std::array<Entry, layout::kSceneBufferCount> entries_;
  BufferReads reads_;
};

/// What a driver says of how much it reads each way.
struct ReadLimits {
  int64_t texels = 0;        ///< of one texel or image buffer
  int64_t storageBytes = 0;  ///< of one storage buffer
  int64_t imageUnits = 0;
};
/// Of the current context.
ReadLimits readLimits();

/// Why this scene cannot be read that way: which array is too large, or that image units lack; empty when it
/// can.
std::string whyNotRead(const GpuScene& scene, BufferReads reads, const ReadLimits& limits);

}  // namespace fragtrace
