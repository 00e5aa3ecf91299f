// SPDX-License-Identifier: MIT
// Traversal alone on the device, for measurements: rays go in, and hits come out.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gl/context.h"
#include "gl/program.h"
#include "gl/scene_buffers.h"
#include "scene/local_space.h"

namespace fragtrace {

/// The hit of a ray: its leaf slot (leaf * 2 + side) or -1, and its distance.
struct TracedRay {
  int32_t slot = -1;
  float t = 0.0f;
};

class RayCaster {
 public:
  /// Uploads the scene for the variant's traversal and reads. The size is that of all sets of rays. Throws
  /// RenderError if an array is larger than the driver can read. Entries of shaders/entry have the name
  /// `entry` and what ends a ray.
  RayCaster(const Context& context, GpuScene scene, const ShaderVariant& variant, glm::ivec2 size,
            const std::filesystem::path& shaderFolder = {}, std::string entry = "rays");

  /// A set of rays on the device, width x height of them, rows from the bottom.
  class RaySet {
   public:
    explicit RaySet(std::span<const Ray> rays);

   private:
    friend class RayCaster;
    GlBuffer buffer_;
  };

  /// Traces a set, one ray per pixel, or per lane where the variant dispatches compute. anyHit: any hit ends
  /// a ray; otherwise the nearest one is found. Returns milliseconds, by the wall clock around glFinish on
  /// software, by the device's own timer elsewhere.
  double trace(const RaySet& rays, bool anyHit);

  /// The hits of the latest trace. Throws RenderError when a ray took more steps than one draw allows.
  std::vector<TracedRay> hits() const;

  /// The clock that trace() reads: "wall clock" or "gpu timer".
  const char* clockName() const { return software_ ? "wall clock" : "gpu timer"; }

 private:
  SceneBuffers buffers_;
  const GlProgram& program(bool anyHit);

  ShaderVariant variant_;
  std::filesystem::path shaderFolder_;
  std::string entry_;
  std::array<std::optional<GlProgram>, 2> programs_;  // nearest hit, any hit; built when first used
  GlBuffer frameBuffer_;
  GlBuffer hitBuffer_;
  GlVertexArray vertexArray_;
  GlFramebuffer framebuffer_;
  GlQuery timer_;
  glm::ivec2 size_;
  bool software_;
};

}  // namespace fragtrace
