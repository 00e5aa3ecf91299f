// SPDX-License-Identifier: MIT
#include "render/denoise.h"

#include <span>

#include "base/errors.h"
#include "base/thread_name.h"
#include "base/timeline.h"
#include "gl/context.h"
#include "image/channels.h"
#include "render/noisy_image.h"

namespace fragtrace {

namespace {

/// Pixels from tap to tap.
constexpr std::array kStrides{1, 2, 4, 8};
/// The same for few samples, whose noise is rough. Strides that are all even would leave a woven pattern,
/// since odd and even pixels never meet.
constexpr std::array kStridesOfFew{1, 2, 4, 8, 1};
constexpr glm::ivec2 kTexel{1};

/// A black picture with all layers, large enough for each of the filter's programs to be drawn.
Image blackPicture() {
  constexpr int kSide = 20;  // more than a block of PicturePasses::sum()
  Image picture{kSide, kSide, {"R", "G", "B", "variance.Y", "samples.Y"}, {}, {}};
  picture.channels.insert(picture.channels.end(), kGuideChannels.begin(), kGuideChannels.end());
  picture.channels.emplace_back(kObservedChannel);
  picture.values.assign(size_t(kSide) * kSide * picture.channelCount(), 0.0f);
  return picture;
}

}  // namespace

VarianceFilter::VarianceFilter(const ShaderSource& source) {
  makePasses(source, {{&summary_, "denoise/summary.frag"},
                      {&prepare_, "denoise/prepare.frag"},
                      {&noise_, "denoise/noise.frag"},
                      {&filter_, "denoise/filter.frag"},
                      {&compare_, "denoise/compare.frag"},
                      {&finish_, "denoise/finish.frag"}});
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
    passes.sum(summary_, size,
               {&noisy.radiance, &noisy.albedo, &noisy.counts, step > 0 ? &summaries_[0] : nullptr,
                step > 1 ? &summaries_[1] : nullptr},
               summaries_[step]);
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
  const std::span<const int> strides =
      observed ? std::span<const int>(kStrides) : std::span<const int>(kStridesOfFew);
  size_t turn = 0;
  for (const int stride : strides) {
    glProgramUniform1i(filter_.name(), 1, stride);
    passes.draw(filter_, size, {&turns_[turn], &guides_}, {&turns_[1 - turn]});
    turn = 1 - turn;
    if (!goOn) continue;
    waitForDevice();
    if (!goOn()) return nullptr;
  }
  const GlTexture& latest = turns_[turn];
  const GlTexture& denoised = turns_[1 - turn];
  passes.draw(compare_, size, {&light_, &latest, &variance_}, {&moved_});
  passes.draw(finish_, size, {&light_, &latest, &moved_, &guides_, &noisy.albedo, &means, &logarithms},
              {&denoised});
  return &denoised;
}

Image VarianceFilter::filtered(const Image& noisy, PicturePasses& passes) {
  const glm::ivec2 size(noisy.width, noisy.height);
  bool observed = false;
  const NoisyTextures textures = texturesOf(noisy, observed);
  const GlTexture& denoised = *filtered(textures, size, observed, {}, passes);
  return {size.x,
          size.y,
          {"R", "G", "B"},
          readPictureTexture<float>(denoised, GL_RGB, 3, GL_FLOAT, size, "reading the denoised picture"),
          {}};
}

FilterThread::FilterThread(const ShaderSource& source, const std::string& backend)
    : thread_([this, source, backend] { run(source, backend); }) {}

FilterThread::~FilterThread() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

Image FilterThread::filtered(const Image& noisy) {
  Task task([&](VarianceFilter& filter, PicturePasses& passes, DebugLog& log) {
    Image result = filter.filtered(noisy, passes);
    messages_ = log.take();
    return result;
  });
  std::future<Image> result = task.get_future();
  {
    const std::lock_guard lock(mutex_);
    task_ = std::move(task);
  }
  changed_.notify_one();
  return result.get();
}

void FilterThread::run(const ShaderSource& source, const std::string& backend) {
  nameThread("filter");
  try {
    std::optional<TimelineSpan> span(std::in_place, "prepare the filter");
    const double start = steadyMilliseconds();
    std::string tried;
    const auto context = backend == "osmesa" ? makeOsMesaContext(tried) : makeEglContext(tried);
    if (!context) throw RenderError("no second context: " + tried);
    DebugLog log;
    VarianceFilter filter(source);
    PicturePasses passes(source);
    // Drivers finish programs when they are drawn.
    filter.filtered(blackPicture(), passes);
    span.reset();
    made_.set_value(steadyMilliseconds() - start);
    for (std::unique_lock lock(mutex_);;) {
      changed_.wait(lock, [&] { return ends_ || task_; });
      if (ends_) return;
      Task task = std::move(*std::exchange(task_, std::nullopt));
      lock.unlock();
      task(filter, passes, log);
      lock.lock();
    }
  } catch (...) {
    made_.set_exception(std::current_exception());
  }
}

}  // namespace fragtrace
