// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
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

/// The packed scene on the device, bound as storage buffers, image buffers or texel buffers.
class SceneBuffers {
 public:
  /// Frees each array of the scene as soon as the driver has it. Throws RenderError if an array is larger
  /// than this driver can read in that way, or if memory runs out.
  SceneBuffers(GpuScene& scene, BufferReads reads);
  /// Does the same for the next scene, and leaves out unchanged arrays. Throws the same, and then holds
  /// neither scene.
  void replace(GpuScene& scene);
  void bind() const;

  /// Overwrites the last rows of an array that was made with kLightsBinding.
  void writeLastLights(const Words& rows);

 private:
  struct Entry {
    GlBuffer buffer;
    GlTexture view;  ///< image and texel reads
    GLenum format = GL_RGBA32UI;
    GLintptr bytes = 0;
  };
  std::array<Entry, layout::kSceneBufferCount> entries_;
  BufferReads reads_;
};

/// The largest arrays that a driver reads in each way.
struct ReadLimits {
  int64_t texels = 0;  ///< texels in image and texel buffers
  int64_t storageBytes = 0;
  int64_t imageUnits = 0;
};
/// The limits of the current context.
ReadLimits readLimits();

struct ReadChoice {
  BufferReads reads = BufferReads::Ssbo;
  std::string fallback;  ///< why it is not the read that is fastest on this driver; empty when it is
};

/// Returns the read asked for; throws RenderError where the driver cannot read the scene so. For Auto it is
/// the fastest on this driver (image buffers on software, storage buffers on GPUs), or the other one if only
/// that reads arrays of this size.
ReadChoice chooseReads(BufferReads wanted, bool software, const GpuScene& scene, const ReadLimits& limits);

}  // namespace fragtrace
