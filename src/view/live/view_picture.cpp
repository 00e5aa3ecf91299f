// SPDX-License-Identifier: MIT
#include "view/live/view_picture.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <utility>

#include "gl/program.h"
#include "session/picture/draw_samples.h"

namespace fragtrace {

namespace {

double threadCpuMs() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * double(time.tv_sec) + 1e-6 * double(time.tv_nsec);
}

constexpr double kAllUpTo = 64.0;  // samples
constexpr double kNoneFrom = 256.0;
constexpr int kGuideStep = 4;              // samples from one set of guides to the next
constexpr double kMostPastSamples = 16.0;  // the past counts as at most this many samples
constexpr double kQuickMs = 25.0;          // a filter that takes less is not interrupted

void fit(ShownTexture& shown, glm::ivec2 size) {
  if (shown.size == size) return;
  shown.texture = makePictureTexture(GL_RGBA32F, size);
  shown.size = size;
}

/// Returns the same pixels with the rows in the other order.
Image turnedOver(const Image& image) {
  Image turned = image;
  const size_t row = size_t(image.width) * image.channelCount();
  for (size_t y = 0; y < size_t(image.height); ++y)
    std::copy_n(image.values.begin() + ptrdiff_t(y * row), row,
                turned.values.end() - ptrdiff_t((y + 1) * row));
  return turned;
}

}  // namespace

void PassClock::forgetDevice() {
  stamps_.clear();
  asksDevice_ = false;
}

void PassClock::stamp(std::optional<Pass> pass) {
  if (!asksDevice_) return;
  stamps_.push_back({makeQuery(GL_TIMESTAMP), pass});
  glQueryCounter(stamps_.back().time.name(), GL_TIMESTAMP);
}

void PassClock::readStamps() {
  while (!stamps_.empty()) {
    const GLuint name = stamps_.front().time.name();
    GLint there = 0;
    glGetQueryObjectiv(name, GL_QUERY_RESULT_AVAILABLE, &there);
    if (!there) return;
    GLuint64 at = 0;
    glGetQueryObjectui64v(name, GL_QUERY_RESULT, &at);
    const auto pass = stamps_.front().pass;
    if (pass && at > stampedAt_) times_.wall[size_t(*pass)] += 1e-6 * double(at - stampedAt_);
    stampedAt_ = at;
    stamps_.pop_front();
  }
}

void PassClock::restart() {
  stamp({});
  wall_ = std::chrono::steady_clock::now();
  cpuMs_ = threadCpuMs();
}

void PassClock::end(Pass pass) {
  if (waits_) waitForDevice();
  stamp(pass);
  const auto now = std::chrono::steady_clock::now();
  const double cpuMs = threadCpuMs();
  if (!asksDevice_)
    times_.wall[size_t(pass)] += std::chrono::duration<double, std::milli>(now - wall_).count();
  times_.cpu[size_t(pass)] += cpuMs - cpuMs_;
  wall_ = now;
  cpuMs_ = cpuMs;
}

PassTimes PassClock::take() {
  readStamps();
  return std::exchange(times_, {});
}

double filteredShare(double samples) {
  return std::clamp(std::log2(kNoneFrom / std::max(samples, 1.0)) / std::log2(kNoneFrom / kAllUpTo), 0.0,
                    1.0);
}

void SideMemory::turn() {
  if (present.size.x > 0) std::swap(past, present);
  present.size = glm::ivec2(0);
  guideSamples = 0;
}

void SideMemory::forget() {
  present.size = past.size = glm::ivec2(0);
  guideSamples = 0;
}

Image imageOf(const ShownTexture& shown) {
  return {shown.size.x,
          shown.size.y,
          {"R", "G", "B", "A"},
          readPictureTexture<float>(shown.texture, GL_RGBA, 4, GL_FLOAT, shown.size, "reading what is shown"),
          {}};
}

PictureMaker::PictureMaker(const std::filesystem::path& shaderFolder, const std::optional<OidnLibrary>& oidn,
                           PassClock& clock)
    : source_(shaderSource(shaderFolder)),
      oidn_(oidn),
      clock_(clock),
      passes_(source_),
      seen_(source_),
      counted_(makePictureTexture(GL_RGBA32F, {1, 1})) {
  // llvmpipe compiles at the first draw: now, while a scene is loaded.
  const Film film(kCompiledFor);
  ShownTexture into;
  fit(into, film.size());
  seen_.show(film, true, into.texture, passes_);
  count(film);
}

void PictureMaker::prepareFilter() {
  if (filter_) return;
  filter_ = std::make_unique<VarianceFilter>(source_);
  SeenPicture nothing;
  makeRoom(nothing.noisy, kCompiledFor);
  ShownTexture into;
  fit(into, kCompiledFor);
  GlTexture raw = makePictureTexture(GL_RGBA32F, kCompiledFor);
  const Film film(kCompiledFor);
  seen_.read(film, film, raw, nothing.noisy, nothing.noisy, passes_);
  const GlTexture* filter = filter_->filtered(
      nothing.noisy, kCompiledFor, false, [] { return true; }, passes_);
  seen_.show(raw, *filter, 1.0, Behind::Background, kCompiledFor, into.texture, passes_);
}

bool PictureMaker::drawGuides(const Showing& showing, glm::ivec2 size, Tracer& tracer, const View& view,
                              SideMemory& memory, const std::function<bool()>& goOn) {
  const int wanted = std::min(showing.samples, kFewLayerSamples);
  if (memory.guideSamples >= kFewLayerSamples ||
      (memory.guideSamples > 0 && wanted < kGuideStep * memory.guideSamples))
    return true;
  const ShaderVariant& variant = showing.cones ? tracer.cones[1] : tracer.aovs.front();
  if (!memory.guides)
    memory.guides.emplace(size);
  else if (memory.guideSamples == 0)
    memory.guides->restart(size);
  if (tracer.renderer->knows(variant))
    tracer.renderer->use(variant);
  else
    tracer.renderer->compile(variant, *memory.guides, view);
  RenderTimes times;
  const bool complete = tracer.renderer->addSamples(*memory.guides, view, memory.guideSamples, wanted, times,
                                                    [&](double) { return goOn(); });
  tracer.renderer->use(tracer.variant);
  if (complete) memory.guideSamples = wanted;
  return complete;
}

const GlTexture* PictureMaker::filtered(const Showing& showing, const RenderOptions& options,
                                        const SeenPicture& present, const std::function<bool()>& goOn) {
  if (!showing.byOidn) {
    if (!filter_) filter_ = std::make_unique<VarianceFilter>(source_);
    const bool quick = showing.expectedMs > 0.0 && showing.expectedMs < kQuickMs;
    return filter_->filtered(present.noisy, present.size, false, quick ? nullptr : goOn, passes_);
  }
  const std::optional<Image> denoised =
      denoisedByOidn(imageOf(present.noisy, present.size), *oidn_, options.limits.memoryBytes,
                     [&](double) { return goOn(); });
  if (!denoised) return nullptr;
  denoised_ = makePictureTexture(GL_RGBA32F, present.size);
  writePictureTexture(denoised_, GL_RGB, 3, GL_FLOAT, present.size, turnedOver(*denoised).values,
                      "uploading a denoised picture");
  return &denoised_;
}

bool PictureMaker::show(const Film& film, const Showing& showing, const RenderOptions& options,
                        Tracer& tracer, const View& view, SideMemory& memory, ShownTexture& into,
                        const std::function<bool()>& goOn) {
  const glm::ivec2 size = film.size();
  const bool page = options.light.background && options.light.backgroundColor;
  const bool background = options.light.background && !page;
  clock_.restart();
  const double share = showing.filtered ? filteredShare(showing.samples) : 0.0;
  if (share <= 0.0) {
    if (showing.filtered) memory.forget();
    fit(into, size);
    seen_.show(film, background, into.texture, passes_);
    clock_.end(Pass::Show);
    return true;
  }
  if (grows(room_, size)) raw_ = makePictureTexture(GL_RGBA32F, room_);
  if (!drawGuides(showing, size, tracer, view, memory, goOn)) return false;
  clock_.end(Pass::Guides);
  SeenPicture& present = memory.present;
  makeRoom(present.noisy, size);
  present.size = size;
  present.camera = view.camera;
  // The past fades out as the filter does: what it has seen from elsewhere is not what is seen here.
  const double left = std::max(0.0, 1.0 - double(showing.samples) / kNoPastFrom);
  const double past = kMostPastSamples * left * left;
  const bool joins = showing.past && memory.past.size.x > 0 && past > 0.0;
  if (joins) makeRoom(fresh_, size);
  seen_.read(film, *memory.guides, raw_, joins ? fresh_ : present.noisy, present.noisy, passes_);
  clock_.end(Pass::Film);
  if (joins) seen_.join(fresh_, present, memory.past, past, passes_);
  clock_.end(Pass::Past);
  const GlTexture* filter = filtered(showing, options, present, goOn);
  if (!filter) return false;
  clock_.end(Pass::Filter);
  fit(into, size);
  const Behind behind = background                              ? Behind::Background
                        : tracer.variant.shadowCatcher && !page ? Behind::White
                                                                : Behind::Nothing;
  seen_.show(raw_, *filter, share, behind, size, into.texture, passes_);
  clock_.end(Pass::Show);
  return true;
}

void PictureMaker::show(const Image& image, ShownTexture& into) const {
  const glm::ivec2 size(image.width, image.height);
  fit(into, size);
  const bool alpha = image.channelCount() > 3;
  // Three channels leave the fourth at 1.
  writePictureTexture(into.texture, alpha ? GL_RGBA : GL_RGB, alpha ? 4 : 3, GL_FLOAT, size, image.values,
                      "uploading a picture");
}

glm::vec3 PictureMaker::count(const Film& film) {
  seen_.count(film, counted_, passes_);
  const auto sums = readPictureTexture<float>(counted_, GL_RGBA, 4, GL_FLOAT, {1, 1}, "reading sums");
  return {sums[0], sums[1], sums[2]};
}

}  // namespace fragtrace
