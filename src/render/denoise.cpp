// SPDX-License-Identifier: MIT
#include "render/denoise.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <glm/glm.hpp>
#include <initializer_list>

#include "errors.h"
#include "gl/gl.h"
#include "gl/program.h"
#include "image/channels.h"
#include "render/picture_texture.h"

namespace fragtrace {

namespace {

constexpr int kLevels = 5;  // of taps 1, 2, 4, 8 and 16 pixels apart

double millisecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

size_t channelOf(const Image& image, const char* name) {
  const auto index = findChannel(image, name);
  if (!index) throw RenderError(std::string("denoising by variance needs the layer ") + name);
  return *index;
}

float finite(float value) { return std::isfinite(value) ? value : 0.0f; }

/// Texels of four channels, in the order of the image's pixels.
std::vector<glm::vec4> texelsOf(const Image& image, const std::array<const char*, 4>& names) {
  std::array<size_t, 4> index{};
  for (int c = 0; c < 4; ++c) index[c] = channelOf(image, names[c]);
  std::vector<glm::vec4> texels;
  texels.reserve(size_t(image.width) * size_t(image.height));
  for (size_t first = 0; first < image.values.size(); first += image.channelCount()) {
    glm::vec4& texel = texels.emplace_back();
    for (int c = 0; c < 4; ++c) texel[c] = finite(image.values[first + index[c]]);
  }
  return texels;
}

/// 1 / mean luminance; 1 where all is black.
double scaleOf(const std::vector<glm::vec4>& radiance) {
  double sum = 0.0;
  for (const glm::vec4& texel : radiance)
    sum += glm::dot(glm::dvec3(texel), glm::dvec3(0.2126, 0.7152, 0.0722));
  return sum > 0.0 ? double(radiance.size()) / sum : 1.0;
}

/// Brings radiance and its variance into units of the mean luminance, so that squares neither overflow nor
/// vanish; a variance that is not known becomes -1.
void scaleNoisy(std::vector<glm::vec4>& texels, const Image& image, double scale) {
  constexpr double kBrightest = 1e12;
  const size_t samples = channelOf(image, "samples.Y");
  for (size_t i = 0; i < texels.size(); ++i) {
    const bool known = image.values[i * image.channelCount() + samples] > 1.0f;
    for (int c = 0; c < 3; ++c) texels[i][c] = float(std::clamp(texels[i][c] * scale, 0.0, kBrightest));
    texels[i].w = known ? float(std::min(texels[i].w * scale * scale, kBrightest * kBrightest)) : -1.0f;
  }
}

GlTexture upload(const std::vector<glm::vec4>& texels, glm::ivec2 size) {
  GlTexture texture = makePictureTexture(GL_RGBA32F, size);
  glTextureSubImage2D(texture.name(), 0, 0, 0, size.x, size.y, GL_RGBA, GL_FLOAT, texels.data());
  return texture;
}

/// Draws passes, each over all pixels, from textures into textures.
class Passes {
 public:
  explicit Passes(glm::ivec2 size) : size_(size), vertexArray_(makeVertexArray()) {}

  void draw(const GlProgram& program, std::initializer_list<const GlTexture*> from,
            std::initializer_list<const GlTexture*> into, int stride = 0) {
    const GlFramebuffer framebuffer = makeFramebuffer();
    std::vector<GLenum> buffers;
    for (const GlTexture* target : into) {
      buffers.push_back(GLenum(GL_COLOR_ATTACHMENT0 + buffers.size()));
      glNamedFramebufferTexture(framebuffer.name(), buffers.back(), target->name(), 0);
    }
    glNamedFramebufferDrawBuffers(framebuffer.name(), GLsizei(buffers.size()), buffers.data());
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glBindVertexArray(vertexArray_.name());
    glViewport(0, 0, size_.x, size_.y);
    glUseProgram(program.name());
    glUniform2i(0, size_.x, size_.y);
    if (stride > 0) glUniform1i(1, stride);
    GLuint unit = 0;
    for (const GlTexture* source : from) glBindTextureUnit(unit++, source->name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    checkGl("denoising");
  }

 private:
  glm::ivec2 size_;
  GlVertexArray vertexArray_;
};

}  // namespace

Image denoisedByVariance(const Image& noisy, const ShaderSource& source, DenoiseTimes& times) {
  const auto build = [&](const char* entry) {
    return buildProgram(assembleShader(source, "fullscreen.vert", {}), assembleShader(source, entry, {}));
  };
  auto start = std::chrono::steady_clock::now();
  const GlProgram prepare = build("denoise_prepare.frag");
  const GlProgram filter = build("denoise_filter.frag");
  const GlProgram finish = build("denoise_finish.frag");
  checkGl("building the programs that denoise");
  times.compileMs = millisecondsSince(start);

  start = std::chrono::steady_clock::now();
  const glm::ivec2 size(noisy.width, noisy.height);
  std::vector<glm::vec4> texels = texelsOf(noisy, {"R", "G", "B", "variance.Y"});
  const double scale = scaleOf(texels);
  scaleNoisy(texels, noisy, scale);
  const GlTexture radiance = upload(texels, size);
  const GlTexture albedos = upload(texelsOf(noisy, {"albedo.R", "albedo.G", "albedo.B", "A"}), size);
  const GlTexture normals = upload(texelsOf(noisy, {"normal.X", "normal.Y", "normal.Z", "depth.Z"}), size);
  const GlTexture light = makePictureTexture(GL_RGBA32F, size);
  const GlTexture surfaces = makePictureTexture(GL_RGBA32F, size);
  const GlTexture shapes = makePictureTexture(GL_RGBA32F, size);
  const GlTexture slopes = makePictureTexture(GL_RG32F, size);
  const std::array<GlTexture, 2> turns{makePictureTexture(GL_RGBA32F, size),
                                       makePictureTexture(GL_RGBA32F, size)};

  Passes passes(size);
  passes.draw(prepare, {&radiance, &albedos, &normals}, {&light, &surfaces, &shapes, &slopes});
  const GlTexture* latest = &light;
  for (int level = 0; level < kLevels; ++level) {
    const GlTexture* next = &turns[size_t(level) % 2];
    passes.draw(filter, {latest, &surfaces, &shapes, &slopes}, {next}, 1 << level);
    latest = next;
  }
  const GlTexture* denoised = &turns[size_t(kLevels) % 2];
  passes.draw(finish, {&light, latest, &albedos}, {denoised});
  std::vector<float> colors =
      readPictureTexture<float>(*denoised, GL_RGB, 3, GL_FLOAT, size, "reading the denoised picture");
  for (float& value : colors) value = float(value / scale);
  times.filterMs = millisecondsSince(start);
  return {size.x, size.y, {"R", "G", "B"}, std::move(colors), {}};
}

}  // namespace fragtrace
