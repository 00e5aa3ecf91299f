// SPDX-License-Identifier: MIT
#include "render/denoise.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/errors.h"
#include "base/parallel.h"
#include "base/timeline.h"
#include "gl/context.h"
#include "image/channels.h"

namespace fragtrace {

namespace {

size_t channelOf(const Image& image, const char* name) {
  const auto index = findChannel(image, name);
  if (!index) throw RenderError(std::string("denoising by variance needs the layer ") + name);
  return *index;
}

float finite(float value) { return std::isfinite(value) ? value : 0.0f; }

/// Texels of four channels, in the order of the image's pixels.
std::vector<float> texelsOf(const Image& image, const std::array<const char*, 4>& names) {
  std::array<size_t, 4> index{};
  for (size_t c = 0; c < 4; ++c) index[c] = channelOf(image, names[c]);
  std::vector<float> texels;
  texels.reserve(size_t(image.width) * size_t(image.height) * 4);
  for (size_t first = 0; first < image.values.size(); first += image.channelCount()) {
    for (const size_t c : index) texels.push_back(finite(image.values[first + c]));
  }
  return texels;
}

/// Four of kGuideChannels.
std::array<const char*, 4> guideChannels(size_t from) {
  return {kGuideChannels[from], kGuideChannels[from + 1], kGuideChannels[from + 2], kGuideChannels[from + 3]};
}

/// Pixels whose colour is not finite get the mean of their finite neighbours, from the rim of a hole to its
/// middle.
void fillHoles(std::vector<float>& texels, const Image& image) {
  std::vector<size_t> holes;
  const size_t pixels = texels.size() / 4;
  std::vector<char> whole(pixels, 1);
  for (size_t i = 0; i < pixels; ++i) {
    const float* pixel = &image.values[i * image.channelCount()];
    if (std::isfinite(pixel[0]) && std::isfinite(pixel[1]) && std::isfinite(pixel[2])) continue;
    whole[i] = 0;
    holes.push_back(i);
  }
  while (!holes.empty() && holes.size() < pixels) {
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
          for (int c = 0; c < 4; ++c) sum[c] += texels[other * 4 + size_t(c)];
          count += 1.0f;
        }
      }
      for (int c = 0; c < 4 && count > 0.0f; ++c) texels[i * 4 + size_t(c)] = sum[c] / count;
      (count > 0.0f ? filled : left).push_back(i);
    }
    for (const size_t i : filled) whole[i] = 1;
    holes = std::move(left);
  }
}

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

NoisyTextures texturesOf(const Image& noisy, bool& observed) {
  constexpr const char* kUploading = "uploading a picture to be denoised";
  const glm::ivec2 size(noisy.width, noisy.height);
  const int64_t most = driverLimit(GL_MAX_TEXTURE_SIZE);
  if (size.x > most || size.y > most) {
    throw RenderError("the picture is " + std::to_string(size.x) + " x " + std::to_string(size.y) +
                      " pixels, this driver filters at most " + std::to_string(most) + " a side");
  }
  std::vector<float> radiance = texelsOf(noisy, {"R", "G", "B", "variance.Y"});
  fillHoles(radiance, noisy);
  const size_t samples = channelOf(noisy, "samples.Y");
  const auto observation = findChannel(noisy, kObservedChannel);
  observed = observation.has_value();
  std::vector<float> counts;
  counts.reserve(radiance.size() / 2);
  for (size_t first = 0; first < noisy.values.size(); first += noisy.channelCount()) {
    counts.push_back(finite(noisy.values[first + samples]));
    counts.push_back(observed ? finite(noisy.values[first + *observation]) : -1.0f);
  }
  NoisyTextures textures;
  makeRoom(textures, size);
  const auto upload = [&](const GlTexture& texture, GLenum format, int channels,
                          const std::vector<float>& values) {
    writePictureTexture(texture, format, channels, GL_FLOAT, size, values, kUploading);
  };
  upload(textures.radiance, GL_RGBA, 4, radiance);
  upload(textures.counts, GL_RG, 2, counts);
  upload(textures.albedo, GL_RGBA, 4, texelsOf(noisy, guideChannels(0)));
  upload(textures.normal, GL_RGBA, 4, texelsOf(noisy, guideChannels(4)));
  return textures;
}

Image imageOf(const NoisyTextures& noisy, glm::ivec2 size) {
  constexpr const char* kReading = "reading a noisy picture";
  const auto read = [&](const GlTexture& texture, GLenum format, int channels) {
    return readPictureTexture<float>(texture, format, channels, GL_FLOAT, size, kReading);
  };
  const std::vector<float> radiance = read(noisy.radiance, GL_RGBA, 4);
  const std::vector<float> samples = read(noisy.counts, GL_RED, 1);
  const std::vector<float> albedo = read(noisy.albedo, GL_RGBA, 4);
  const std::vector<float> normal = read(noisy.normal, GL_RGBA, 4);
  Image image{size.x, size.y, {"R", "G", "B", "variance.Y", "samples.Y"}, {}, {}};
  image.channels.insert(image.channels.end(), kGuideChannels.begin(), kGuideChannels.end());
  image.values.reserve(samples.size() * image.channelCount());
  for (int y = size.y - 1; y >= 0; --y) {
    for (int x = 0; x < size.x; ++x) {
      const size_t p = size_t(y) * size_t(size.x) + size_t(x);
      const auto add = [&](const std::vector<float>& texels) {
        image.values.insert(image.values.end(), texels.begin() + ptrdiff_t(p * 4),
                            texels.begin() + ptrdiff_t(p * 4 + 4));
      };
      add(radiance);
      image.values.push_back(samples[p]);
      add(albedo);
      add(normal);
    }
  }
  return image;
}

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

FilterThread::FilterThread(const ShaderSource& source, const std::string& backend, const std::string& device)
    : thread_([this, source, backend, device] { run(source, backend, device); }) {}

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

void FilterThread::run(const ShaderSource& source, const std::string& backend, const std::string& device) {
  nameThread("filter");
  try {
    std::optional<TimelineSpan> span(std::in_place, "prepare the filter");
    std::string tried;
    const auto context = backend == "osmesa" ? makeOsMesaContext(tried) : makeEglContext(tried, device);
    if (!context) throw RenderError("no second context: " + tried);
    DebugLog log;
    VarianceFilter filter(source);
    PicturePasses passes(source);
    // Drivers finish programs when they are drawn.
    filter.filtered(blackPicture(), passes);
    span.reset();
    made_.set_value();
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
