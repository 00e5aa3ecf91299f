// SPDX-License-Identifier: MIT
#include "view/window/display.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/errors.h"
#include "gl/program.h"

namespace fragtrace {

namespace {

constexpr double kInterval = 0.2;  // seconds between reads of an area
constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr size_t kChannels = 4;

// Locations of the uniforms of shaders/entry/display.frag and shaders/entry/window.frag.
constexpr GLint kFactor = 0;
constexpr GLint kToneMap = 1;
constexpr GLint kDithers = 2;
constexpr GLint kPage = 3;
constexpr GLint kPictureSize = 0;
constexpr GLint kBar = 1;
constexpr GLint kCorner = 2;
constexpr GLint kPart = 3;
constexpr GLint kDifference = 4;

}  // namespace

ValueReader::~ValueReader() { releaseFence(done_); }

void ValueReader::begin(GLuint texture, double now) {
  const PixelArea& area = asked_.area;
  const size_t bytes = size_t(area.size.x) * size_t(area.size.y) * kChannels * sizeof(float);
  if (bytes > room_) {
    buffer_ = makeBuffer();
    glNamedBufferStorage(buffer_.name(), GLsizeiptr(bytes), nullptr, GL_MAP_READ_BIT);
    room_ = bytes;
  }
  glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer_.name());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glGetTextureSubImage(texture, 0, area.corner.x, area.corner.y, 0, area.size.x, area.size.y, 1, GL_RGBA,
                       GL_FLOAT, GLsizei(bytes), nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  done_ = makeFence();
  reading_ = true;
  begun_ = now;
  checkGl("reading pixels");
}

void ValueReader::end(PictureValues& values) {
  releaseFence(std::exchange(done_, nullptr));
  reading_ = false;
  values = asked_;
  const glm::ivec2 size = values.area.size;
  values.image = {size.x, size.y, {"R", "G", "B", "A"}, {}, {}};
  values.image.values.resize(size_t(size.x) * size_t(size.y) * kChannels);
  glGetNamedBufferSubData(buffer_.name(), 0, GLsizeiptr(values.image.values.size() * sizeof(float)),
                          values.image.values.data());
  checkGl("reading pixels");
}

double ValueReader::keep(PictureValues& values, GLuint texture, uint64_t picture, glm::ivec2 whole,
                         const PixelArea& area, double now) {
  if (reading_ && isSignalled(done_)) end(values);
  if (reading_) return now;
  const bool known = values.area == area && values.whole == whole;
  if (area.size.x <= 0 || (known && values.picture == picture)) return kNever;
  if (known && now < begun_ + kInterval) return begun_ + kInterval;
  asked_ = {picture, whole, area, {}};
  begin(texture, now);
  return now;
}

Display::Display(Exchange& exchange) : exchange_(exchange), vertexArray_(makeVertexArray()) {
  const ShaderSource source = shaderSource({});
  const std::string vertex = assembleShader(source, "entry/fullscreen.vert", {});
  StartedProgram mapping = startProgram(vertex, assembleShader(source, "entry/display.frag", {}));
  window_ = buildProgram(vertex, assembleShader(source, "entry/window.frag", {}));
  mapping_ = finished(std::move(mapping));
  checkGl("building the display's programs");
}

bool Display::waits() const {
  return std::ranges::any_of(sides_, [](const Side& side) { return side.waiting.slot >= 0; });
}

void Display::release(size_t side, SharedTexture& texture) {
  if (texture.slot >= 0) exchange_.release(side, texture, makeFence());
  texture = {};
}

void Display::show(Side& side, GLuint traced, glm::ivec2 size, bool asItIs) {
  if (side.size != size) {
    side.displayed = makeTexture(GL_TEXTURE_2D);
    glTextureStorage2D(side.displayed.name(), 1, GL_RGBA8, size.x, size.y);
    glTextureParameteri(side.displayed.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(side.displayed.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    side.framebuffer = makeFramebuffer();
    glNamedFramebufferTexture(side.framebuffer.name(), GL_COLOR_ATTACHMENT0, side.displayed.name(), 0);
    side.size = size;
  }
  side.traced = traced;
  ++side.number;
  side.asItIs = asItIs;
  side.fresh = false;
}

double Display::keepValues(size_t number, PictureValues& values, const PixelArea& area, double now) {
  Side& side = sides_[number];
  return side.reader.keep(values, side.traced, side.number, side.size, area, now);
}

bool Display::allReady() const {
  return std::ranges::all_of(
      sides_, [](const Side& side) { return side.waiting.slot < 0 || isSignalled(side.waiting.ready); });
}

bool Display::hasNewPicture() const {
  return (waits() && allReady()) ||
         std::ranges::any_of(sides_, [](const Side& side) { return side.size.x > 0 && !side.fresh; });
}

/// Shows the pictures that wait, if all are ready: those of two sides show the same moment.
void Display::showWaiting() {
  if (!allReady()) return;
  for (size_t number = 0; number < kMostSides; ++number) {
    Side& side = sides_[number];
    if (side.waiting.slot < 0) continue;
    release(number, side.shared);
    side.shared = std::exchange(side.waiting, {});
    show(side, side.shared.texture, side.waitingSize, side.waitingAsItIs);
  }
}

void Display::take(const TracedPicture& picture) {
  Side& side = sides_.at(picture.side);
  release(picture.side, side.waiting);
  if (picture.shared.slot >= 0) {
    side.waiting = picture.shared;
    side.waitingSize = picture.size;
    side.waitingAsItIs = picture.asItIs;
    return;
  }
  const Image& image = picture.image;
  const glm::ivec2 size(image.width, image.height);
  const bool alpha = image.channelCount() == 4;
  if (!alpha && image.channelCount() != 3) throw RenderError("a traced picture is neither RGB nor RGBA");
  if (side.copiedSize != size) {
    side.copied = makeTexture(GL_TEXTURE_2D);
    glTextureStorage2D(side.copied.name(), 1, GL_RGBA32F, size.x, size.y);
    side.copiedSize = size;
  }
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTextureSubImage2D(side.copied.name(), 0, 0, 0, size.x, size.y, alpha ? GL_RGBA : GL_RGB, GL_FLOAT,
                      image.values.data());
  release(picture.side, side.shared);
  show(side, side.copied.name(), size, picture.asItIs);
  checkGl("uploading a picture");
}

void Display::forget(size_t side) {
  release(side, sides_.at(side).waiting);
  sides_[side].size = glm::ivec2(0);
  sides_[side].traced = 0;
}

void Display::map(Side& side, const DisplaySettings& settings) {
  if (side.fresh && side.settings == settings) return;
  glBindFramebuffer(GL_FRAMEBUFFER, side.framebuffer.name());
  glViewport(0, 0, side.size.x, side.size.y);
  glBindTextureUnit(0, side.traced);
  glUseProgram(mapping_.name());
  glUniform1f(kFactor, side.asItIs ? 1.0f : float(std::exp2(settings.exposure)));
  glUniform1i(kToneMap, side.asItIs ? GLint(ToneMap::Linear) : GLint(settings.toneMap));
  glUniform1i(kDithers, side.asItIs ? 0 : 1);
  const bool hasPage = settings.page && !side.asItIs;
  const glm::vec3 page = hasPage ? *settings.page : glm::vec3(0.0f);
  glUniform4f(kPage, page.r, page.g, page.b, hasPage ? 1.0f : 0.0f);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  side.settings = settings;
  side.fresh = true;
}

void Display::prepare() {
  if (shows(0) || waits()) return;
  constexpr glm::ivec2 kSize{7};  // no power of two, for which llvmpipe compiles again
  const GlTexture nothing = makeTexture(GL_TEXTURE_2D);
  glTextureStorage2D(nothing.name(), 1, GL_RGBA32F, kSize.x, kSize.y);
  show(sides_[0], nothing.name(), kSize, false);
  draw({}, {8, 8}, {8, 8});
  sides_[0].size = glm::ivec2(0);
  sides_[0].traced = 0;
  checkGl("preparing the display");
}

void Display::draw(const ViewState& state, glm::ivec2 picture, glm::ivec2 window) {
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_DEPTH_TEST);
  glBindSampler(0, 0);
  glBindSampler(1, 0);
  glBindVertexArray(vertexArray_.name());
  showWaiting();
  const RenderOptions& o = state.edit.shared;
  const DisplaySettings settings{o.output.exposure.value_or(0.0), o.output.toneMap,
                                 o.light.background ? o.light.backgroundColor : std::nullopt};
  for (size_t i = 0; i < kMostSides; ++i) {
    if (shows(i) && (i < 2 || state.overview)) map(sides_[i], settings);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, window.x, window.y);
  glClearColor(0.08f, 0.08f, 0.08f, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
  const glm::ivec2 size = state.overview ? picture / kCells : picture;
  for (int i = 0; i < (state.overview ? int(kMostSides) : 1); ++i) {
    const glm::ivec2 corner(i % kCells * size.x, window.y - (i / kCells + 1) * size.y);
    const size_t left = size_t(i), right = state.overview ? left : shows(1) ? 1 : 0;
    if (shows(left)) drawCell(state, left, right, corner, size);
  }
  glBindVertexArray(0);
  glUseProgram(0);
}

void Display::drawCell(const ViewState& state, size_t left, size_t right, glm::ivec2 corner,
                       glm::ivec2 size) {
  const bool difference = state.showsDifference() && left != right;
  // Radiance cannot be compared with colours of a display.
  const bool asShown = sides_[left].asItIs != sides_[right].asItIs;
  for (const size_t unit : {0u, 1u}) {
    const Side& side = sides_[unit == 0 ? left : right];
    const GLuint shown = difference && !asShown ? side.traced : side.displayed.name();
    // Pixels of a picture that fits, or is enlarged, are shown as they are.
    const GLint filter = side.size == size || state.magnifier.steps > 0 ? GL_NEAREST : GL_LINEAR;
    glTextureParameteri(shown, GL_TEXTURE_MIN_FILTER, filter);
    glTextureParameteri(shown, GL_TEXTURE_MAG_FILTER, filter);
    glBindTextureUnit(GLuint(unit), shown);
  }
  glViewport(corner.x, corner.y, size.x, size.y);
  glUseProgram(window_.name());
  glUniform2f(kPictureSize, float(size.x), float(size.y));
  glUniform1f(kBar, float(std::round(state.shownBar() * size.x)));
  glUniform2f(kCorner, float(corner.x), float(corner.y));
  const glm::dvec2 center = state.magnifier.center;
  glUniform3f(kPart, float(center.x), float(center.y), float(std::exp2(-state.magnifier.steps)));
  glUniform1f(kDifference, difference ? float(std::exp2(state.differenceStops)) : 0.0f);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace fragtrace
