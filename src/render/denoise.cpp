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

/// Radiance in units of its mean luminance, so that squares neither overflow nor vanish, and its variance;
/// -1: not known.
std::vector<glm::vec4> noisyTexels(const Image& image, double scale) {
  std::vector<glm::vec4> texels = texelsOf(image, {"R", "G", "B", "variance.Y"});
  const size_t samples = channelOf(image, "samples.Y");
  for (size_t i = 0; i < texels.size(); ++i) {
    const bool known = image.values[i * image.channelCount() + samples] > 1.0f;
    constexpr double kBrightest = 1e12;
    for (int c = 0; c < 3; ++c) texels[i][c] = float(std::clamp(texels[i][c] * scale, 0.0, kBrightest));
    texels[i].w = known ? float(std::min(texels[i].w * scale * scale, kBrightest * kBrightest)) : -1.0f;
  }
  return texels;
}

/// 1 / mean luminance; 1 where all is black.
double scaleOf(const Image& image) {
  double sum = 0.0;
  size_t count = 0;
  const std::array<size_t, 3> rgb{channelOf(image, "R"), channelOf(image, "G"), channelOf(image, "B")};
  for (size_t first = 0; first < image.values.size(); first += image.channelCount(), ++count) {
    constexpr std::array<double, 3> kLuminance{0.2126, 0.7152, 0.0722};
    for (int c = 0; c < 3; ++c) sum += kLuminance[c] * finite(image.values[first + rgb[c]]);
  }
  return sum > 0.0 ? double(count) / sum : 1.0;
}

GlTexture makeLayer(glm::ivec2 size, GLenum format = GL_RGBA32F) {
  GlTexture texture = makeTexture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), 1, format, size.x, size.y);
  return texture;
}

GlTexture upload(const std::vector<glm::vec4>& texels, glm::ivec2 size) {
  GlTexture texture = makeLayer(size);
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

Image readBack(const GlTexture& texture, glm::ivec2 size, double scale) {
  std::vector<float> texels(size_t(size.x) * size_t(size.y) * 3);
  // In bands, since the copy's size is an int.
  const int rowsAtOnce = std::max(1, int((size_t(1) << 28) / (size_t(size.x) * 3 * sizeof(float))));
  for (int y = 0; y < size.y; y += rowsAtOnce) {
    const int rows = std::min(rowsAtOnce, size.y - y);
    glGetTextureSubImage(texture.name(), 0, 0, y, 0, size.x, rows, 1, GL_RGB, GL_FLOAT,
                         GLsizei(size_t(rows) * size_t(size.x) * 3 * sizeof(float)),
                         texels.data() + size_t(y) * size_t(size.x) * 3);
  }
  checkGl("reading the denoised picture");
  for (float& value : texels) value = float(value / scale);
  return {size.x, size.y, {"R", "G", "B"}, std::move(texels), {}};
}

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
  const double scale = scaleOf(noisy);
  const GlTexture radiance = upload(noisyTexels(noisy, scale), size);
  const GlTexture albedos = upload(texelsOf(noisy, {"albedo.R", "albedo.G", "albedo.B", "A"}), size);
  const GlTexture normals = upload(texelsOf(noisy, {"normal.X", "normal.Y", "normal.Z", "depth.Z"}), size);
  const GlTexture light = makeLayer(size);
  const GlTexture surfaces = makeLayer(size);
  const GlTexture shapes = makeLayer(size);
  const GlTexture slopes = makeLayer(size, GL_RG32F);
  const std::array<GlTexture, 2> turns{makeLayer(size), makeLayer(size)};

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
  Image result = readBack(*denoised, size, scale);
  times.filterMs = millisecondsSince(start);
  return result;
}

}  // namespace fragtrace
