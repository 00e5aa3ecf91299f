// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "gl/gl.h"
#include "pack/gpu_scene.h"

namespace fragtrace {

/// The packed scene on the device, bound as storage buffers, image buffers or texel buffers.
class SceneBuffers {
 public:
  /// Throws RenderError when an array is larger than this driver reads that way, or memory runs out.
  SceneBuffers(const GpuScene& scene, BufferReads reads);
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

}  // namespace fragtrace
