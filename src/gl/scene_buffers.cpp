// SPDX-License-Identifier: MIT
#include "gl/scene_buffers.h"

#include "errors.h"

namespace fragtrace {

namespace {

bool hasTwoWords(uint32_t binding) {
  return binding == layout::kTexelsBinding || binding == layout::kEnvironmentAliasBinding;
}

int64_t texelBytes(uint32_t binding) { return hasTwoWords(binding) ? 8 : 16; }

GLint64 limit(GLenum name) {
  GLint64 value = 0;
  glGetInteger64v(name, &value);
  return value;
}

}  // namespace

ReadLimits readLimits() {
  return {limit(GL_MAX_TEXTURE_BUFFER_SIZE), limit(GL_MAX_SHADER_STORAGE_BLOCK_SIZE),
          limit(GL_MAX_IMAGE_UNITS)};
}

std::string whyNotRead(const GpuScene& scene, BufferReads reads, const ReadLimits& limits) {
  constexpr int64_t kUnits = layout::kSceneImageBase + layout::kSceneBufferCount;
  if (reads == BufferReads::Image && limits.imageUnits < kUnits) {
    return "--buffer-reads image needs " + std::to_string(kUnits) + " image units, this driver has " +
           std::to_string(limits.imageUnits);
  }
  for (uint32_t binding = 0; binding < layout::kSceneBufferCount; ++binding) {
    const int64_t bytes = int64_t(scene.buffers[binding].size() * sizeof(uint32_t));
    const int64_t most =
        reads == BufferReads::Ssbo ? limits.storageBytes : limits.texels * texelBytes(binding);
    if (bytes <= most) continue;
    return "scene buffer " + std::to_string(binding) + " takes " + std::to_string(bytes) +
           " bytes, this driver reads at most " + std::to_string(most) + " by --buffer-reads " +
           std::string(kBufferReadsNames[size_t(reads)]);
  }
  return {};
}

SceneBuffers::SceneBuffers(GpuScene& scene, BufferReads reads) : reads_(reads) {
  const std::string reason = whyNotRead(scene, reads, readLimits());
  if (!reason.empty()) throw RenderError(reason);
  for (uint32_t binding = 0; binding < layout::kSceneBufferCount; ++binding) {
    static constexpr std::array<uint32_t, 4> kNothing{};
    Words& words = scene.buffers[binding];
    Entry& entry = entries_[binding];
    entry.format = hasTwoWords(binding) ? GL_RG32UI : GL_RGBA32UI;
    const size_t bytes = words.empty() ? sizeof kNothing : words.size() * sizeof(uint32_t);
    const void* data = words.empty() ? kNothing.data() : words.data();
    entry.buffer = makeBuffer();
    glNamedBufferStorage(entry.buffer.name(), GLsizeiptr(bytes), data, 0);
    words = Words();
    if (reads != BufferReads::Ssbo) {
      entry.view = makeTexture(GL_TEXTURE_BUFFER);
      glTextureBuffer(entry.view.name(), entry.format, entry.buffer.name());
    }
  }
  checkGl("uploading the scene");
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
