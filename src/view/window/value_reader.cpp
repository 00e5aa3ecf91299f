// SPDX-License-Identifier: MIT
#include "view/window/value_reader.h"

#include <limits>
#include <utility>

namespace fragtrace {

namespace {

constexpr double kInterval = 0.2;  // seconds between reads of an area
constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr size_t kChannels = 4;

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

}  // namespace fragtrace
