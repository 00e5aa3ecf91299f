// SPDX-License-Identifier: MIT
#include "gl/scene_buffers.h"

#include <algorithm>

#include "base/errors.h"

namespace fragtrace {

namespace {

constexpr size_t kNumbers = 0;
constexpr size_t kColors = 1;
constexpr size_t kWide = 2;

/// The size of an array texture; one texel, where there is no layer.
struct ArraySize {
  GLsizei side = 1;
  GLsizei layers = 1;
  GLsizei levels = 1;

  ArraySize(const TexturePlan& plan, int64_t filled) {
    if (filled == 0) return;
    side = plan.layerSide;
    layers = GLsizei(filled);
    if (plan.levels != MipLevels::None) levels = levelsOf({side, side});
  }
};

GlTexture makeArray(GLenum format, const ArraySize& size) {
  GlTexture texture = makeTexture(GL_TEXTURE_2D_ARRAY);
  glTextureStorage3D(texture.name(), size.levels, format, size.side, size.side, size.layers);
  return texture;
}

/// The same texels as colours in sRGB.
GlTexture colorView(const GlTexture& numbers, const ArraySize& size) {
  GLuint name = 0;
  glGenTextures(1, &name);  // a view needs a name without a texture
  glTextureView(name, GL_TEXTURE_2D_ARRAY, numbers.name(), GL_SRGB8_ALPHA8, 0, GLuint(size.levels), 0,
                GLuint(size.layers));
  return GlTexture(name);
}

/// Uploads a picture, with its levels, to its place in an array.
void upload(const GlTexture& array, const TexturePlan& plan, const PackedPicture& picture) {
  const TexturePlace& place = plan.places[picture.image];
  const glm::ivec2 corner(place.first & 0xffffu, place.first >> 16);
  for (int level = 0; level < (plan.levels == MipLevels::None ? 1 : levelsOf(place.size)); ++level) {
    const glm::ivec2 at = corner >> level, size = place.size >> level;
    const uint32_t* words = picture.own.data() + texelsBefore(place.size, level) * (place.wide ? 2 : 1);
    glTextureSubImage3D(array.name(), level, at.x, at.y, GLint(place.number), size.x, size.y, 1, GL_RGBA,
                        place.wide ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE, words);
  }
}

}  // namespace

TextureRoom textureRoom(const RenderOptions& options, const Context& context) {
  const TextureReads wanted = options.device.textureReads;
  const bool arrays = wanted == TextureReads::Auto ? !context.software : wanted == TextureReads::Arrays;
  TextureRoom room;
  if (options.sampling.textureFilter == TextureFilter::Cones) room.levels = MipLevels::Made;
  if (arrays) {
    room.reads = TexelReads::Arrays;
    room.side = int(driverLimit(GL_MAX_TEXTURE_SIZE));
    room.layers = uint32_t(driverLimit(GL_MAX_ARRAY_TEXTURE_LAYERS));
  } else {
    room.words = driverLimit(GL_MAX_TEXTURE_BUFFER_SIZE);
    const int64_t images =
        std::min({driverLimit(GL_MAX_IMAGE_UNITS), driverLimit(GL_MAX_FRAGMENT_IMAGE_UNIFORMS),
                  driverLimit(GL_MAX_COMPUTE_IMAGE_UNIFORMS)});
    room.buffers =
        uint32_t(std::clamp<int64_t>(images - layout::kTexelImageBase, 1, layout::kMostTexelBuffers));
  }
  checkGl("asking for the driver's limits of textures");
  return room;
}

void SceneTextures::makeBuffers(const TexturePlan& plan) {
  staysMapped_ = plan.levels == MipLevels::Later;
  const GLbitfield access =
      GL_MAP_READ_BIT | GL_MAP_WRITE_BIT | (staysMapped_ ? GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT : 0u);
  for (const int64_t words : plan.sizes) {
    const auto bytes = GLsizeiptr(std::max<int64_t>(words, 1) * int64_t(sizeof(uint32_t)));
    GlBuffer& buffer = buffers_.emplace_back(makeBuffer());
    glNamedBufferStorage(buffer.name(), bytes, nullptr, access);
    const GlTexture& view = textures_.emplace_back(makeTexture(GL_TEXTURE_BUFFER));
    glTextureBuffer(view.name(), GL_R32UI, buffer.name());
    memory_.push_back(static_cast<uint32_t*>(glMapNamedBufferRange(buffer.name(), 0, bytes, access)));
  }
}

void SceneTextures::makeArrays(const TexturePlan& plan) {
  const ArraySize narrow(plan, plan.sizes[0]), wide(plan, plan.sizes[1]);
  textures_.push_back(makeArray(GL_RGBA8, narrow));
  textures_.push_back(colorView(textures_[kNumbers], narrow));
  textures_.push_back(makeArray(GL_RGBA16, wide));
}

const TexelMemory& SceneTextures::prepare(const TexturePlan& plan) {
  reads_ = plan.reads;
  memory_.clear();
  buffers_.clear();
  textures_.clear();
  if (reads_ == TexelReads::Words)
    makeBuffers(plan);
  else
    makeArrays(plan);
  checkGl("making room for textures");
  if (std::ranges::find(memory_, nullptr) != memory_.end()) throw RenderError("textures cannot be mapped");
  isPrepared_ = true;
  return memory_;
}

void SceneTextures::replace(GpuScene& scene) {
  if (scene.pictures.empty() && !isPrepared_) return;
  const TexturePlan& plan = scene.textures;
  if (!isPrepared_) prepare(plan);
  for (PackedPicture& picture : scene.pictures) {
    const TexturePlace& place = plan.places[picture.image];
    if (reads_ == TexelReads::Arrays)
      upload(textures_[place.wide ? kWide : kNumbers], plan, picture);
    else
      std::ranges::copy(picture.own, memory_[place.number] + place.first);
    picture = {};
  }
  isPrepared_ = false;
  if (!staysMapped_) {
    for (const GlBuffer& buffer : buffers_) glUnmapNamedBuffer(buffer.name());
    memory_.clear();
  }
  checkGl("uploading textures");
}

void SceneTextures::bind() const {
  for (size_t i = 0; i < textures_.size(); ++i) {
    if (reads_ == TexelReads::Words)
      glBindImageTexture(layout::kTexelImageBase + GLuint(i), textures_[i].name(), 0, GL_FALSE, 0,
                         GL_READ_ONLY, GL_R32UI);
    else
      glBindTextureUnit(layout::kTexelTextures + GLuint(i), textures_[i].name());
  }
}

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
