// SPDX-License-Identifier: MIT
#include "gl/scene_textures.h"

#include <algorithm>

#include "base/errors.h"

namespace fragtrace {

namespace {

constexpr size_t kNumbers = 0;
constexpr size_t kColors = 1;
constexpr size_t kWide = 2;

/// An array texture of one level; one layer, where there are none.
GlTexture makeArray(GLenum format, int side, int64_t layers) {
  GlTexture texture = makeTexture(GL_TEXTURE_2D_ARRAY);
  const GLsizei edge = layers > 0 ? side : 1;
  glTextureStorage3D(texture.name(), 1, format, edge, edge, GLsizei(std::max<int64_t>(layers, 1)));
  return texture;
}

/// The same texels as colours in sRGB.
GlTexture colorView(const GlTexture& numbers, int64_t layers) {
  GLuint name = 0;
  glGenTextures(1, &name);  // a view needs a name without a texture
  glTextureView(name, GL_TEXTURE_2D_ARRAY, numbers.name(), GL_SRGB8_ALPHA8, 0, 1, 0,
                GLuint(std::max<int64_t>(layers, 1)));
  return GlTexture(name);
}

}  // namespace

TextureRoom textureRoom(TextureReads wanted, const Context& context) {
  const bool arrays = wanted == TextureReads::Auto ? !context.software : wanted == TextureReads::Arrays;
  TextureRoom room;
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

TexelMemory SceneTextures::makeBuffers(const TexturePlan& plan) {
  constexpr GLbitfield kAccess = GL_MAP_READ_BIT | GL_MAP_WRITE_BIT;
  TexelMemory memory;
  for (const int64_t words : plan.sizes) {
    const auto bytes = GLsizeiptr(std::max<int64_t>(words, 1) * int64_t(sizeof(uint32_t)));
    GlBuffer& buffer = buffers_.emplace_back(makeBuffer());
    glNamedBufferStorage(buffer.name(), bytes, nullptr, kAccess);
    const GlTexture& view = textures_.emplace_back(makeTexture(GL_TEXTURE_BUFFER));
    glTextureBuffer(view.name(), GL_R32UI, buffer.name());
    memory.push_back(static_cast<uint32_t*>(glMapNamedBufferRange(buffer.name(), 0, bytes, kAccess)));
  }
  return memory;
}

void SceneTextures::makeArrays(const TexturePlan& plan) {
  textures_.push_back(makeArray(GL_RGBA8, plan.layerSide, plan.sizes[0]));
  textures_.push_back(colorView(textures_[kNumbers], plan.sizes[0]));
  textures_.push_back(makeArray(GL_RGBA16, plan.layerSide, plan.sizes[1]));
}

TexelMemory SceneTextures::prepare(const TexturePlan& plan) {
  reads_ = plan.reads;
  buffers_.clear();
  textures_.clear();
  TexelMemory memory;
  if (reads_ == TexelReads::Words)
    memory = makeBuffers(plan);
  else
    makeArrays(plan);
  checkGl("making room for textures");
  if (std::ranges::find(memory, nullptr) != memory.end()) throw RenderError("textures cannot be mapped");
  isPrepared_ = true;
  return memory;
}

void SceneTextures::replace(GpuScene& scene) {
  const TexturePlan& plan = scene.textures;
  if (scene.pictures.empty() && !isPrepared_) return;
  if (!isPrepared_) {
    const TexelMemory memory = prepare(plan);
    for (const PackedPicture& picture : scene.pictures) {
      const TexturePlace& place = plan.places[picture.image];
      if (reads_ == TexelReads::Words) std::ranges::copy(picture.words, memory[place.number] + place.first);
    }
  }
  for (PackedPicture& picture : scene.pictures) {
    const TexturePlace& place = plan.places[picture.image];
    if (reads_ == TexelReads::Arrays) {
      const GlTexture& array = textures_[place.wide ? kWide : kNumbers];
      glTextureSubImage3D(array.name(), 0, GLint(place.first & 0xffffu), GLint(place.first >> 16),
                          GLint(place.number), place.size.x, place.size.y, 1, GL_RGBA,
                          place.wide ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE, picture.words.data());
    }
    picture = {};
  }
  for (const GlBuffer& buffer : buffers_) glUnmapNamedBuffer(buffer.name());
  isPrepared_ = false;
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

}  // namespace fragtrace
