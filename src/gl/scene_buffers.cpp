// SPDX-License-Identifier: MIT
#include "gl/scene_buffers.h"

#include <algorithm>

#include "base/errors.h"

namespace fragtrace {

namespace {

bool hasTwoWords(uint32_t binding) { return binding == layout::kBricksBinding; }

int64_t texelBytes(uint32_t binding) { return hasTwoWords(binding) ? 8 : 16; }

int64_t mostBytes(BufferReads reads, uint32_t binding, const ReadLimits& limits) {
  return reads == BufferReads::Ssbo ? limits.storageBytes : limits.texels * texelBytes(binding);
}

/// Says which limit of the driver is too low to read the scene in that way; empty if none is.
std::string whatIsTooLarge(const GpuScene& scene, BufferReads reads, const ReadLimits& limits) {
  constexpr int64_t kUnits = layout::kSceneImageBase + layout::kSceneBufferCount;
  if (reads == BufferReads::Image && limits.imageUnits < kUnits)
    return "image buffers take " + std::to_string(kUnits) + " image units, this driver has " +
           std::to_string(limits.imageUnits);
  for (uint32_t binding = 0; binding < layout::kSceneBufferCount; ++binding) {
    const int64_t bytes = int64_t(scene.buffers[binding].size() * sizeof(uint32_t));
    const int64_t most = mostBytes(reads, binding, limits);
    if (bytes <= most) continue;
    return "scene buffer " + std::to_string(binding) + " takes " + std::to_string(bytes) +
           " bytes, this driver reads at most " + std::to_string(most) + " as " +
           (reads == BufferReads::Ssbo    ? "storage buffer"
            : reads == BufferReads::Image ? "image buffer"
                                          : "texel buffer");
  }
  return {};
}

void checkSize(const GpuScene& scene, BufferReads reads, const ReadLimits& limits) {
  const std::string tooLarge = whatIsTooLarge(scene, reads, limits);
  if (!tooLarge.empty()) throw RenderError(tooLarge + " (--buffer-reads)");
}

}  // namespace

ReadLimits readLimits() {
  const ReadLimits limits{driverLimit(GL_MAX_TEXTURE_BUFFER_SIZE),
                          driverLimit(GL_MAX_SHADER_STORAGE_BLOCK_SIZE), driverLimit(GL_MAX_IMAGE_UNITS)};
  checkGl("asking for the driver's limits");
  return limits;
}

ReadChoice chooseReads(BufferReads wanted, bool software, const GpuScene& scene, const ReadLimits& limits) {
  if (wanted != BufferReads::Auto) {
    // A program that reads more than the driver has room for does not compile.
    checkSize(scene, wanted, limits);
    return {wanted, {}};
  }
  const BufferReads first = software ? BufferReads::Image : BufferReads::Ssbo;
  const BufferReads other = software ? BufferReads::Ssbo : BufferReads::Texel;
  const std::string reason = whatIsTooLarge(scene, first, limits);
  if (reason.empty() || !whatIsTooLarge(scene, other, limits).empty()) return {first, {}};
  return {other, reason};
}

SceneBuffers::SceneBuffers(GpuScene& scene, BufferReads reads) : reads_(reads) { replace(scene); }

void SceneBuffers::replace(GpuScene& scene) {
  checkSize(scene, reads_, readLimits());
  for (uint32_t binding = 0; binding < layout::kSceneBufferCount; ++binding) {
    static constexpr std::array<uint32_t, 4> kNothing{};
    if (scene.unchanged[binding]) continue;
    Words& words = scene.buffers[binding];
    Entry& entry = entries_[binding];
    entry.format = hasTwoWords(binding) ? GL_RG32UI : GL_RGBA32UI;
    const size_t bytes = words.empty() ? sizeof kNothing : words.size() * sizeof(uint32_t);
    const void* data = words.empty() ? kNothing.data() : words.data();
    entry.buffer = makeBuffer();
    glNamedBufferStorage(entry.buffer.name(), GLsizeiptr(bytes), data,
                         binding == layout::kLightsBinding ? GL_DYNAMIC_STORAGE_BIT : 0);
    entry.bytes = GLintptr(bytes);
    words = Words();
    if (reads_ != BufferReads::Ssbo) {
      entry.view = makeTexture(GL_TEXTURE_BUFFER);
      glTextureBuffer(entry.view.name(), entry.format, entry.buffer.name());
    }
  }
  checkGl("uploading the scene");
}

void SceneBuffers::writeLastLights(const Words& rows) {
  const Entry& lights = entries_[layout::kLightsBinding];
  const auto bytes = GLsizeiptr(rows.size() * sizeof(uint32_t));
  movedBytes() += size_t(bytes);
  glNamedBufferSubData(lights.buffer.name(), lights.bytes - bytes, bytes, rows.data());
  checkGl("uploading the guiding of caustics");
}

void SceneBuffers::bind() const {
  for (uint32_t binding = 0; binding < layout::kSceneBufferCount; ++binding) {
    const Entry& entry = entries_[binding];
    switch (reads_) {
      case BufferReads::Image:
        glBindImageTexture(layout::kSceneImageBase + binding, entry.view.name(), 0, GL_FALSE, 0, GL_READ_ONLY,
                           entry.format);
        break;
      case BufferReads::Texel:
        glBindTextureUnit(binding, entry.view.name());
        break;
      default:
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, entry.buffer.name());
    }
  }
}

}  // namespace fragtrace
