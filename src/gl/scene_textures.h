// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "gl/context.h"
#include "gl/gl.h"
#include "pack/gpu_scene.h"

namespace fragtrace {

/// The room for the texels of scenes in the current context, in the reads asked for: by default words on
/// software and array textures on GPUs.
TextureRoom textureRoom(TextureReads wanted, const Context& context);

/// The pictures of a scene's textures on the device (pack/texture_plan.h).
class SceneTextures {
 public:
  /// Uploads the pictures of the scene, each of which is freed then. Without pictures it stays as it is.
  /// Throws RenderError, also where memory runs out.
  void replace(GpuScene& scene);
  void bind() const;

 private:
  void makeBuffers(const TexturePlan& plan);
  void makeArrays(const TexturePlan& plan);

  TexelReads reads_ = TexelReads::Words;
  std::vector<GlBuffer> buffers_;
  std::vector<GlTexture> textures_;  ///< views of the buffers; or numbers, colours and wide texels
};

}  // namespace fragtrace
