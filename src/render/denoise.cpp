// SPDX-License-Identifier: MIT
#include "render/denoise.h"

#include "render/noisy_image.h"

namespace fragtrace {

namespace {

constexpr int kLevels = 4;  // of taps 1, 2, 4 and 8 pixels apart
constexpr glm::ivec2 kTexel{1};

}  // namespace

VarianceFilter::VarianceFilter(const ShaderSource& source)
    : summary_(passProgram(source, "denoise/summary.frag")),
      prepare_(passProgram(source, "denoise/prepare.frag")),
      noise_(passProgram(source, "denoise/noise.frag")),
      filter_(passProgram(source, "denoise/filter.frag")),
      compare_(passProgram(source, "denoise/compare.frag")),
      finish_(passProgram(source, "denoise/finish.frag")),
      sums_(source) {
  for (GlTexture& summary : summaries_) summary = makePictureTexture(GL_RGBA32F, kTexel);
}

void VarianceFilter::makeRoom(glm::ivec2 size) {
  if (!grows(room_, size)) return;
  light_ = makePictureTexture(GL_RGBA32F, room_);
  seenLight_ = makePictureTexture(GL_R32F, room_);
  guides_ = makePictureTexture(GL_RGBA32UI, room_);
  variance_ = makePictureTexture(GL_R32F, room_);
  moved_ = makePictureTexture(GL_RG32F, room_);
  for (GlTexture& turn : turns_) turn = makePictureTexture(GL_RGBA32F, room_);
}

void VarianceFilter::summarize(const NoisyTextures& noisy, glm::ivec2 size, bool observed,
                               PicturePasses& passes) {
  for (size_t step = 0; step < (observed ? 3u : 2u); ++step) {
    glProgramUniform1i(summary_.name(), 1, GLint(step));
    passes.draw(summary_, size, PictureSums::blocksOf(size),
                {&noisy.radiance, &noisy.albedo, &noisy.counts, step > 0 ? &summaries_[0] : nullptr,
                 step > 1 ? &summaries_[1] : nullptr},
                {&sums_.blocks(size)});
    sums_.into(summaries_[step], size, passes);
  }
}

const GlTexture* VarianceFilter::filtered(const NoisyTextures& noisy, glm::ivec2 size, bool observed,
                                          const std::function<bool()>& goOn, PicturePasses& passes) {
  makeRoom(size);
  summarize(noisy, size, observed, passes);
  const GlTexture& means = summaries_[0];
  const GlTexture& logarithms = summaries_[1];
  passes.draw(prepare_, size,
              {&noisy.radiance, &noisy.albedo, &noisy.normal, &noisy.counts, &means, &logarithms},
              {&light_, &seenLight_, &guides_});
  glProgramUniform1i(noise_.name(), 1, observed ? 1 : 0);
  passes.draw(noise_, size, {&light_, &seenLight_, &guides_, &summaries_[2]}, {&turns_[0], &variance_});
  for (int level = 0; level < kLevels; ++level) {
    glProgramUniform1i(filter_.name(), 1, 1 << level);
    passes.draw(filter_, size, {&turns_[size_t(level) % 2], &guides_}, {&turns_[size_t(level + 1) % 2]});
    if (!goOn) continue;
    glFinish();
    if (!goOn()) return nullptr;
  }
  const GlTexture& latest = turns_[size_t(kLevels) % 2];
  const GlTexture& denoised = turns_[size_t(kLevels + 1) % 2];
  passes.draw(compare_, size, {&light_, &latest, &variance_}, {&moved_});
  passes.draw(finish_, size, {&light_, &latest, &moved_, &guides_, &noisy.albedo, &means, &logarithms},
              {&denoised});
  return &denoised;
}

Image VarianceFilter::filtered(const Image& noisy) {
  const glm::ivec2 size(noisy.width, noisy.height);
  bool observed = false;
  const NoisyTextures textures = texturesOf(noisy, observed);
  PicturePasses passes;
  const GlTexture& denoised = *filtered(textures, size, observed, {}, passes);
  return {size.x,
          size.y,
          {"R", "G", "B"},
          readPictureTexture<float>(denoised, GL_RGB, 3, GL_FLOAT, size, "reading the denoised picture"),
          {}};
}

}  // namespace fragtrace
