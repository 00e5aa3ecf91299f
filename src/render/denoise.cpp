// SPDX-License-Identifier: MIT
#include "render/denoise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <initializer_list>

#include "errors.h"
#include "gl/program.h"
#include "image/channels.h"
#include "math/luminance.h"
#include "render/picture_texture.h"
#include "shader/layout.h"

namespace fragtrace {

namespace {

constexpr int kLevels = 4;  // of taps 1, 2, 4 and 8 pixels apart
constexpr float kUnknown = -1.0f;

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

/// Four of kGuideChannels.
std::array<const char*, 4> guideChannels(size_t from) {
  return {kGuideChannels[from], kGuideChannels[from + 1], kGuideChannels[from + 2], kGuideChannels[from + 3]};
}

/// Pixels whose colour is not finite get the mean of those around them that are, from the rim of a hole to
/// its middle.
void fillHoles(std::vector<glm::vec4>& texels, const Image& image) {
  std::vector<size_t> holes;
  std::vector<char> whole(texels.size(), 1);
  for (size_t i = 0; i < texels.size(); ++i) {
    const float* pixel = &image.values[i * image.channelCount()];
    if (std::isfinite(pixel[0]) && std::isfinite(pixel[1]) && std::isfinite(pixel[2])) continue;
    whole[i] = 0;
    holes.push_back(i);
  }
  while (!holes.empty() && holes.size() < texels.size()) {
    std::vector<size_t> filled;
    std::vector<size_t> left;
    for (const size_t i : holes) {
      const int x = int(i % size_t(image.width));
      const int y = int(i / size_t(image.width));
      glm::vec4 sum(0.0f);
      float count = 0.0f;
      for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, image.height - 1); ++ny) {
        for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, image.width - 1); ++nx) {
          const size_t other = size_t(ny) * size_t(image.width) + size_t(nx);
          if (!whole[other]) continue;
          sum += texels[other];
          count += 1.0f;
        }
      }
      if (count > 0.0f) texels[i] = sum / count;
      (count > 0.0f ? filled : left).push_back(i);
    }
    for (const size_t i : filled) whole[i] = 1;
    holes = std::move(left);
  }
}

double luminanceOf(const glm::vec4& color) { return luminance(glm::dvec3(color)); }

/// 1 / typical luminance of what has an albedo, divided by it as the shader does; 1 where all is black. The
/// geometric mean, in which a lamp that is a thousand times as bright as all else hardly counts, of no pixel
/// less than a thousandth of the arithmetic one.
double scaleOf(const std::vector<glm::vec4>& radiance, const std::vector<glm::vec4>& albedos) {
  constexpr double kLeast = 1e-3;
  std::vector<double> lights;
  lights.reserve(radiance.size());
  double sum = 0.0;
  for (size_t i = 0; i < radiance.size(); ++i) {
    if (!(albedos[i].a > 0.0f)) continue;
    const glm::vec4 divisor = glm::mix(glm::max(albedos[i], 0.0f), glm::vec4(1.0f), layout::kAlbedoFloor);
    const double light = luminanceOf(radiance[i] / divisor);
    if (!std::isfinite(light)) continue;
    lights.push_back(std::max(light, 0.0));
    sum += lights.back();
  }
  if (!(sum > 0.0)) return 1.0;
  const double least = kLeast * sum / double(lights.size());
  double logarithms = 0.0;
  for (const double light : lights) logarithms += std::log(std::max(light, least));
  return std::exp(-logarithms / double(lights.size()));
}

/// Brings radiance and its variance into units of the mean, so that squares neither overflow nor vanish; a
/// variance that is not known becomes -1.
void scaleNoisy(std::vector<glm::vec4>& texels, const Image& image, double scale) {
  constexpr double kBrightest = 1e12;
  const size_t samples = channelOf(image, "samples.Y");
  for (size_t i = 0; i < texels.size(); ++i) {
    const bool known = image.values[i * image.channelCount() + samples] > 1.0f;
    for (int c = 0; c < 3; ++c) texels[i][c] = float(std::clamp(texels[i][c] * scale, 0.0, kBrightest));
    texels[i].w =
        known ? float(std::clamp(texels[i].w * scale * scale, 0.0, kBrightest * kBrightest)) : kUnknown;
  }
}

/// How many times the noise the filter may move a window's light. Distances scatter about their noise, and a
/// share below 1 gives noise back; with many samples that matters less than what the filter takes for noise.
float trustAt(const Image& image) {
  constexpr double kFew = 16.0;
  double samples = 0.0;
  for (size_t i = channelOf(image, "samples.Y"); i < image.values.size(); i += image.channelCount())
    samples += std::max(finite(image.values[i]), 0.0f);
  const double each = samples * double(image.channelCount()) / double(image.values.size());
  return float(1.0 + 0.5 * std::min(1.0, kFew / std::max(each, 1.0)));
}

/// What was observed of the variance, in the same units; empty where nothing was.
std::vector<float> observedOf(const Image& image, double scale) {
  std::vector<float> observed;
  const auto channel = findChannel(image, kObservedChannel);
  if (!channel) return observed;
  observed.reserve(size_t(image.width) * size_t(image.height));
  for (size_t i = *channel; i < image.values.size(); i += image.channelCount())
    observed.push_back(float(std::clamp(finite(image.values[i]) * scale * scale, 0.0, 1e24)));
  return observed;
}

/// Observed / independent variance, relative to each pixel's light; kUnknown where nothing was observed.
float shareOf(const std::vector<glm::vec4>& texels, const std::vector<float>& observed) {
  constexpr double kDarkSquared = 0.01;
  double seen = 0.0;
  double independent = 0.0;
  for (size_t i = 0; i < observed.size(); ++i) {
    if (texels[i].w < 0.0f) continue;
    const double luminance = luminanceOf(texels[i]);
    const double weight = 1.0 / (luminance * luminance + kDarkSquared);
    seen += weight * observed[i];
    independent += weight * texels[i].w;
  }
  return independent > 0.0 ? float(std::min(seen / independent, 1.0)) : kUnknown;
}

/// Draws passes, each over all pixels, from textures into textures.
class Passes {
 public:
  explicit Passes(glm::ivec2 size) : size_(size), vertexArray_(makeVertexArray()) {}

  GlTexture texture(GLenum format) const { return makePictureTexture(format, size_); }

  template <typename Texel>
  GlTexture upload(const std::vector<Texel>& texels, GLenum format, GLenum channels) const {
    GlTexture uploaded = texture(format);
    glTextureSubImage2D(uploaded.name(), 0, 0, 0, size_.x, size_.y, channels, GL_FLOAT, texels.data());
    return uploaded;
  }

  void draw(const GlProgram& program, std::initializer_list<const GlTexture*> from,
            std::initializer_list<const GlTexture*> into) {
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
    glProgramUniform2i(program.name(), 0, size_.x, size_.y);
    GLuint unit = 0;
    for (const GlTexture* source : from) glBindTextureUnit(unit++, source->name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    checkGl("denoising");
  }

 private:
  glm::ivec2 size_;
  GlVertexArray vertexArray_;
};

GlProgram denoisingProgram(const ShaderSource& source, const char* entry) {
  GlProgram program =
      buildProgram(assembleShader(source, "entry/fullscreen.vert", {}), assembleShader(source, entry, {}));
  checkGl("building the programs that denoise");
  return program;
}

}  // namespace

VarianceFilter::VarianceFilter(const ShaderSource& source)
    : prepare_(denoisingProgram(source, "denoise/prepare.frag")),
      noise_(denoisingProgram(source, "denoise/noise.frag")),
      filter_(denoisingProgram(source, "denoise/filter.frag")),
      compare_(denoisingProgram(source, "denoise/compare.frag")),
      finish_(denoisingProgram(source, "denoise/finish.frag")) {}

std::optional<Image> VarianceFilter::filtered(const Image& noisy, const std::function<bool()>& goOn) const {
  const glm::ivec2 size(noisy.width, noisy.height);
  const int64_t most = driverLimit(GL_MAX_TEXTURE_SIZE);
  if (size.x > most || size.y > most) {
    throw RenderError("the picture is " + std::to_string(size.x) + " x " + std::to_string(size.y) +
                      " pixels, this driver filters at most " + std::to_string(most) + " a side");
  }
  std::vector<glm::vec4> texels = texelsOf(noisy, {"R", "G", "B", "variance.Y"});
  fillHoles(texels, noisy);
  const std::vector<glm::vec4> albedo = texelsOf(noisy, guideChannels(0));
  const double scale = scaleOf(texels, albedo);
  scaleNoisy(texels, noisy, scale);
  std::vector<float> observed = observedOf(noisy, scale);
  const float share = shareOf(texels, observed);
  observed.resize(texels.size());

  Passes passes(size);
  const GlTexture radiance = passes.upload(texels, GL_RGBA32F, GL_RGBA);
  const GlTexture albedos = passes.upload(albedo, GL_RGBA32F, GL_RGBA);
  const GlTexture normals = passes.upload(texelsOf(noisy, guideChannels(4)), GL_RGBA32F, GL_RGBA);
  const GlTexture seen = passes.upload(observed, GL_R32F, GL_RED);
  const GlTexture light = passes.texture(GL_RGBA32F);
  const GlTexture seenLight = passes.texture(GL_R32F);
  const GlTexture guides = passes.texture(GL_RGBA32UI);
  const GlTexture variance = passes.texture(GL_R32F);
  const GlTexture moved = passes.texture(GL_RG32F);
  const std::array<GlTexture, 2> turns{passes.texture(GL_RGBA32F), passes.texture(GL_RGBA32F)};

  passes.draw(prepare_, {&radiance, &albedos, &normals, &seen}, {&light, &seenLight, &guides});
  glProgramUniform1f(noise_.name(), 1, share);
  passes.draw(noise_, {&light, &seenLight, &guides}, {&turns[0], &variance});
  for (int level = 0; level < kLevels; ++level) {
    glProgramUniform1i(filter_.name(), 1, 1 << level);
    passes.draw(filter_, {&turns[size_t(level) % 2], &guides}, {&turns[size_t(level + 1) % 2]});
    glFinish();
    if (!goOn()) return std::nullopt;
  }
  const GlTexture& latest = turns[size_t(kLevels) % 2];
  const GlTexture& denoised = turns[size_t(kLevels + 1) % 2];
  passes.draw(compare_, {&light, &latest, &variance}, {&moved});
  glProgramUniform1f(finish_.name(), 1, trustAt(noisy));
  passes.draw(finish_, {&light, &latest, &moved, &guides, &albedos}, {&denoised});
  std::vector<float> colors =
      readPictureTexture<float>(denoised, GL_RGB, 3, GL_FLOAT, size, "reading the denoised picture");
  for (float& value : colors) value = float(value / scale);
  return Image{size.x, size.y, {"R", "G", "B"}, std::move(colors), {}};
}

}  // namespace fragtrace
