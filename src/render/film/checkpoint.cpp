// SPDX-License-Identifier: MIT
// A checkpoint begins with a line that says what the file is, then a line with the length of the header, the
// header in JSON, and the arrays one after the other.
#include "render/film/checkpoint.h"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "base/words.h"

namespace fragtrace {

namespace {

constexpr std::string_view kMagic = "fragtrace checkpoint 4\n";

template <typename Value>
std::span<const uint8_t> bytesOf(const std::vector<Value>& values) {
  return {reinterpret_cast<const uint8_t*>(values.data()), values.size() * sizeof(Value)};
}

/// The rest of a file.
class Reader {
 public:
  explicit Reader(std::span<const uint8_t> bytes) : left_(bytes) {}

  std::span<const uint8_t> take(uint64_t count) {
    if (count > left_.size()) throw std::runtime_error("the file is truncated");
    const auto taken = left_.first(count);
    left_ = left_.subspan(count);
    return taken;
  }

  template <typename Value>
  std::vector<Value> takeValues(uint64_t count) {
    if (count > left_.size() / sizeof(Value)) throw std::runtime_error("the file is truncated");
    std::vector<Value> values(count);
    const auto bytes = take(count * sizeof(Value));
    if (count > 0) std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }

  /// A number, up to the end of its line.
  uint64_t takeNumberLine() {
    uint64_t number = 0;
    for (char c = char(take(1)[0]); c != '\n'; c = char(take(1)[0])) {
      if (c < '0' || c > '9' || number > left_.size()) throw std::runtime_error("its header has no length");
      number = 10 * number + uint64_t(c - '0');
    }
    return number;
  }

  std::span<const uint8_t> rest() const { return left_; }
  bool atEnd() const { return left_.empty(); }

 private:
  std::span<const uint8_t> left_;
};

nlohmann::json sizeJson(glm::ivec2 size) { return {size.x, size.y}; }

/// Reads the size of a film. Throws std::runtime_error for one that no film can have.
glm::ivec2 sizeOf(const nlohmann::json& json) {
  const glm::ivec2 size(json.at(0).get<int>(), json.at(1).get<int>());
  checkImageSize(size.x, size.y, 4);
  return size;
}

uint64_t pixelsOf(glm::ivec2 size) { return uint64_t(size.x) * uint64_t(size.y); }

nlohmann::json headerOf(const Checkpoint& c, uint64_t sum) {
  nlohmann::json json;
  json["layout"] = sizeof(FilmPixel);
  json["sum"] = sum;
  json["job"] = c.job;
  json["statistics"] = c.statistics;
  json["part"] = c.part;
  json["films"] = nlohmann::json::array();
  for (const FilmState& film : c.films)
    json["films"].push_back(
        {{"size", sizeJson(film.size)},
         {"cut", film.cut},
         {"splats", !film.splats.empty()},
         {"light_paths", {film.lightPaths.count, film.lightPaths.weight, film.lightPaths.squared}},
         {"pixels_per_path", film.pixelsPerPath}});
  json["looks"] = nlohmann::json::array();
  for (const FilmPixels& look : c.looks)
    json["looks"].push_back({{"size", sizeJson(look.size)}, {"cut", look.cut}});
  json["picture"] = {{"size", {c.picture.width, c.picture.height}}, {"channels", c.picture.channels}};
  json["blocks"] = c.adaptive.samples.size();
  json["rounds"] = c.adaptive.rounds;
  json["seconds"] = c.adaptive.seconds;
  return json;
}

Checkpoint decode(Reader reader) {
  const auto magic = reader.take(kMagic.size());
  if (std::memcmp(magic.data(), kMagic.data(), kMagic.size()) != 0)
    throw std::runtime_error("it is no checkpoint of this version");
  const auto text = reader.take(reader.takeNumberLine());
  const nlohmann::json json = nlohmann::json::parse(text.begin(), text.end());
  if (json.at("layout") != sizeof(FilmPixel)) throw std::runtime_error("it was written by another program");
  if (json.at("sum") != hashOf(reader.rest())) throw std::runtime_error("its data are damaged or incomplete");
  Checkpoint c;
  c.job = json.at("job");
  c.statistics = json.at("statistics");
  c.part = json.at("part");
  for (const nlohmann::json& film : json.at("films")) {
    FilmState state;
    state.size = sizeOf(film.at("size"));
    state.cut = film.at("cut");
    const uint64_t count = 4 * pixelsOf(state.size);
    state.sum = reader.takeValues<float>(count);
    state.compensation = reader.takeValues<float>(count);
    state.counts = reader.takeValues<uint32_t>(count);
    if (film.at("splats")) state.splats = reader.takeValues<float>(count);
    const nlohmann::json& paths = film.at("light_paths");
    state.lightPaths = {paths.at(0), paths.at(1), paths.at(2)};
    state.pixelsPerPath = std::max(film.at("pixels_per_path").get<int>(), 0);
    if (state.pixelsPerPath > kMostPixelsPerPath) state.pixelsPerPath = kNoLightPaths;
    c.films.push_back(std::move(state));
  }
  for (const nlohmann::json& look : json.at("looks")) {
    FilmPixels pixels{sizeOf(look.at("size")), {}, look.at("cut")};
    pixels.pixels = reader.takeValues<FilmPixel>(pixelsOf(pixels.size));
    c.looks.push_back(std::move(pixels));
  }
  c.picture.channels = json.at("picture").at("channels").get<std::vector<std::string>>();
  if (!c.picture.channels.empty()) {
    const glm::ivec2 size = sizeOf(json.at("picture").at("size"));
    c.picture.width = size.x;
    c.picture.height = size.y;
    checkImageSize(size.x, size.y, int64_t(c.picture.channelCount()));
    c.picture.values = reader.takeValues<float>(pixelsOf(size) * c.picture.channelCount());
  }
  const uint64_t blocks = json.at("blocks");
  c.adaptive.samples = reader.takeValues<int32_t>(blocks);
  c.adaptive.targets = reader.takeValues<int32_t>(blocks);
  c.adaptive.rounds = json.at("rounds");
  c.adaptive.seconds = json.at("seconds");
  if (!reader.atEnd()) throw std::runtime_error("there are bytes behind its end");
  return c;
}

}  // namespace

std::vector<uint8_t> encodeCheckpoint(const Checkpoint& c) {
  std::vector<std::span<const uint8_t>> arrays;
  for (const FilmState& film : c.films) {
    arrays.push_back(bytesOf(film.sum));
    arrays.push_back(bytesOf(film.compensation));
    arrays.push_back(bytesOf(film.counts));
    arrays.push_back(bytesOf(film.splats));
  }
  for (const FilmPixels& look : c.looks) arrays.push_back(bytesOf(look.pixels));
  arrays.push_back(bytesOf(c.picture.values));
  arrays.push_back(bytesOf(c.adaptive.samples));
  arrays.push_back(bytesOf(c.adaptive.targets));

  uint64_t sum = kHashStart;
  for (const auto& array : arrays) sum = hashOf(array, sum);
  const std::string header = headerOf(c, sum).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  const std::string start = std::string(kMagic) + std::to_string(header.size()) + "\n" + header;
  size_t size = start.size();
  for (const auto& array : arrays) size += array.size();
  std::vector<uint8_t> bytes;
  bytes.reserve(size);
  bytes.insert(bytes.end(), start.begin(), start.end());
  for (const auto& array : arrays) bytes.insert(bytes.end(), array.begin(), array.end());
  return bytes;
}

Checkpoint decodeCheckpoint(std::span<const uint8_t> bytes) {
  try {
    return decode(Reader(bytes));
  } catch (const nlohmann::json::exception&) {
    throw std::runtime_error("its header is broken");
  }
}

}  // namespace fragtrace
