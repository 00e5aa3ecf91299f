// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "gl/context.h"
#include "gl/gl.h"
#include "pack/gpu_scene.h"

namespace fragtrace {

/// The room for the texels of scenes in the current context, for the reads and the filter asked for: by
/// default words on software and array textures on GPUs.
TextureRoom textureRoom(const RenderOptions& options, const Context& context);

/// The pictures of a scene's textures on the device (pack/textures/texture_plan.h).
class SceneTextures {
 public:
  /// Makes room for the pictures of a plan. Returns where they are to be written, if this can be told: texels
  /// then never lie in memory twice. Throws RenderError, also where memory runs out.
  const TexelMemory& prepare(const TexturePlan& plan);
  /// Takes the pictures of the scene, into the room that was prepared, or else into room of its own. Frees
  /// them. Without pictures it stays as it is. Throws the same.
  void replace(GpuScene& scene);
  /// The mapped buffers, where levels are filled later: they stay mapped while they are read.
  const TexelMemory& memory() const { return memory_; }
  void bind() const;

 private:
  void makeBuffers(const TexturePlan& plan);
  void makeArrays(const TexturePlan& plan);

  TexelReads reads_ = TexelReads::Words;
  bool isPrepared_ = false;
  bool staysMapped_ = false;
  TexelMemory memory_;  ///< the mapped buffers
  std::vector<GlBuffer> buffers_;
  std::vector<GlTexture> textures_;  ///< views of the buffers; or numbers, colours and wide texels
};

}  // namespace fragtrace
