// SPDX-License-Identifier: MIT
// The image library of the GPU bundle (bench/gpu/pack): OpenImageIO brings 350 MB of shared objects, stb
// brings one. Reads .png, .jpg and .hdr, writes .png and .jpg by stb; .exr only as it writes them itself,
// uncompressed floats.
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

#include "base/message.h"
#include "image/image.h"
#include "image/worker/library.h"

namespace fragtrace {
namespace {

using Bytes = std::span<const uint8_t>;
using Texels = std::unique_ptr<void, decltype(&stbi_image_free)>;

[[noreturn]] void refuseByStb() {
  const char* reason = stbi_failure_reason();
  throw std::runtime_error(reason != nullptr ? reason : "stb gives no reason");
}

[[noreturn]] void refuseFormat() {
  throw std::runtime_error("the image library of the GPU bundle does not know this format");
}

void appendTo(void* bytes, void* data, int size) {
  const auto* from = static_cast<const uint8_t*>(data);
  static_cast<std::vector<uint8_t>*>(bytes)->insert(static_cast<std::vector<uint8_t>*>(bytes)->end(), from,
                                                    from + size);
}

// OpenEXR ("OpenEXR File Layout"): a header of attributes, a table of places, then the scan lines, each with
// its channels one after the other, by name. This machine has the file's byte order.

constexpr uint32_t kExrStart[] = {20000630, 2};  // the signature; version 2, scan lines
constexpr uint32_t kExrFloat = 2;

class ExrWriter {
 public:
  template <typename T>
  void add(const T& value) {
    const Bytes from = asMessage(value);
    bytes.insert(bytes.end(), from.begin(), from.end());
  }
  void addText(const std::string& text) {
    bytes.insert(bytes.end(), text.begin(), text.end());
    bytes.push_back(0);
  }
  template <typename... T>
  void addAttribute(const char* name, const char* type, const T&... values) {
    addText(name);
    addText(type);
    add(uint32_t((sizeof values + ...)));
    (add(values), ...);
  }

  /// A matrix, chromaticities or one number.
  void addNumbers(const std::string& name, const std::vector<float>& numbers) {
    addText(name);
    addText(numbers.size() == 16 ? "m44f" : numbers.size() == 8 ? "chromaticities" : "float");
    add(uint32_t(numbers.size() * sizeof(float)));
    for (const float number : numbers) add(number);
  }

  std::vector<uint8_t> bytes;
};

/// The channels' indices in the order of the file.
std::vector<size_t> byName(const std::vector<std::string>& channels) {
  std::vector<size_t> order(channels.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, {}, [&](size_t i) { return channels[i]; });
  return order;
}

std::vector<uint8_t> writeExr(const Image& image, std::span<const float> values) {
  const std::vector<size_t> order = byName(image.channels);
  ExrWriter channels;
  for (const size_t c : order) {
    channels.addText(image.channels[c]);
    for (const uint32_t value : {kExrFloat, 0U, 1U, 1U})
      channels.add(value);  // linear; sampled at each pixel
  }
  channels.bytes.push_back(0);

  ExrWriter file;
  file.add(kExrStart);
  file.addText("channels");
  file.addText("chlist");
  file.add(uint32_t(channels.bytes.size()));
  file.bytes.insert(file.bytes.end(), channels.bytes.begin(), channels.bytes.end());
  file.addAttribute("compression", "compression", uint8_t(0));
  const glm::ivec2 size(image.width, image.height);
  const Placement placed = image.placement.value_or(Placement{{0, 0}, size});
  const glm::ivec2 first = placed.corner;
  const glm::ivec2 last = first + size - 1;
  file.addAttribute("dataWindow", "box2i", first.x, first.y, last.x, last.y);
  file.addAttribute("displayWindow", "box2i", 0, 0, placed.whole.x - 1, placed.whole.y - 1);
  file.addAttribute("lineOrder", "lineOrder", uint8_t(0));
  file.addAttribute("pixelAspectRatio", "float", 1.0F);
  file.addAttribute("screenWindowCenter", "v2f", 0.0F, 0.0F);
  if (!image.numbers.contains("screenWindowWidth")) file.addAttribute("screenWindowWidth", "float", 1.0F);
  for (const auto& [name, numbers] : image.numbers) file.addNumbers(name, numbers);
  file.bytes.push_back(0);

  const size_t lineBytes = size_t(image.width) * image.channelCount() * sizeof(float);
  uint64_t place = file.bytes.size() + size_t(image.height) * sizeof place;
  for (int y = 0; y < image.height; ++y, place += lineBytes + 8) file.add(place);
  for (int y = 0; y < image.height; ++y) {
    file.add(first.y + y);
    file.add(uint32_t(lineBytes));
    const float* line = values.data() + size_t(y) * size_t(image.width) * image.channelCount();
    for (const size_t c : order) {
      for (int x = 0; x < image.width; ++x) file.add(line[size_t(x) * image.channelCount() + c]);
    }
  }
  return file.bytes;
}

class ExrReader {
 public:
  explicit ExrReader(Bytes bytes) : bytes_(bytes) {}

  Bytes take(size_t count) {
    if (count > bytes_.size()) throw std::runtime_error("the file is truncated");
    const Bytes taken = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return taken;
  }
  template <typename T>
  T take() {
    return takeMessage<T>(bytes_);
  }
  std::string takeText() {
    std::string text;
    while (const char c = char(take(1)[0])) text += c;
    return text;
  }

 private:
  Bytes bytes_;
};

[[noreturn]] void refuseExr() {
  throw std::runtime_error("the GPU bundle reads only the .exr that it writes: uncompressed floats");
}

void takeChannels(ExrReader value, std::vector<std::string>& names) {
  for (std::string name = value.takeText(); !name.empty(); name = value.takeText()) {
    if (value.take<uint32_t>() != kExrFloat) refuseExr();
    value.take(12);
    names.push_back(name);
  }
}

Image readExr(Bytes bytes) {
  ExrReader file(bytes);
  for (const uint32_t word : kExrStart) {
    if (file.take<uint32_t>() != word) refuseExr();
  }
  Image image;
  std::vector<std::string> stored;
  for (std::string name = file.takeText(); !name.empty(); name = file.takeText()) {
    file.takeText();  // the type
    ExrReader value(file.take(file.take<uint32_t>()));
    if (name == "channels") takeChannels(value, stored);
    if (name == "compression" && value.take<uint8_t>() != 0) refuseExr();
    if (name == "dataWindow") {
      if (value.take<int>() != 0 || value.take<int>() != 0) refuseExr();
      image.width = value.take<int>() + 1;
      image.height = value.take<int>() + 1;
    }
  }
  checkImageSize(image.width, image.height, int64_t(stored.size()));

  // Colour channels come first, as in OpenImageIO.
  image.channels = stored;
  const auto rank = [](const std::string& name) {
    return std::min(name.size() == 1 ? std::string("RGBA").find(name) : 4, size_t(4));
  };
  std::ranges::stable_sort(image.channels, {}, rank);
  image.values.resize(size_t(image.width) * size_t(image.height) * stored.size());
  file.take(size_t(image.height) * sizeof(uint64_t));
  for (int y = 0; y < image.height; ++y) {
    file.take(8);  // the line's number and length
    for (const std::string& name : stored) {
      const auto c = std::ranges::find(image.channels, name) - image.channels.begin();
      for (int x = 0; x < image.width; ++x) image.pixel(x, y)[c] = file.take<float>();
    }
  }
  return image;
}

}  // namespace

Image decodeFloats(Bytes bytes, ImageFormat format) {
  if (format == ImageFormat::OpenExr) return readExr(bytes);
  if (format != ImageFormat::Hdr) refuseFormat();
  Image image;
  int stored = 0;
  const Texels values(
      stbi_loadf_from_memory(bytes.data(), int(bytes.size()), &image.width, &image.height, &stored, 3),
      &stbi_image_free);
  if (!values) refuseByStb();
  image.channels = {"R", "G", "B"};
  const auto* first = static_cast<const float*>(values.get());
  image.values.assign(first, first + size_t(image.width) * size_t(image.height) * 3);
  return image;
}

void decodeTexels(Bytes bytes, ImageFormat format, int width, int height, int bits, std::span<uint8_t> rgba) {
  if (format != ImageFormat::Png && format != ImageFormat::Jpeg) refuseFormat();
  int w = 0;
  int h = 0;
  int stored = 0;
  const auto load = [&](auto function) -> void* {
    return function(bytes.data(), int(bytes.size()), &w, &h, &stored, 4);
  };
  const Texels texels(bits == 16 ? load(stbi_load_16_from_memory) : load(stbi_load_from_memory),
                      &stbi_image_free);
  if (!texels) refuseByStb();
  if (w != width || h != height || rgba.size() != size_t(w) * size_t(h) * 4 * size_t(bits / 8))
    throw std::runtime_error("its size is not what its header says");
  std::copy_n(static_cast<const uint8_t*>(texels.get()), rgba.size(), rgba.data());
}

std::vector<uint8_t> encodeBytes(int width, int height, int channelCount, int bits, Bytes values,
                                 ImageFormat format) {
  if (bits != 8) throw std::runtime_error("the GPU bundle writes pictures of 8 bits alone");
  constexpr int kQuality = 95;
  std::vector<uint8_t> bytes;
  int done = 0;
  if (format == ImageFormat::Png) {
    done = stbi_write_png_to_func(appendTo, &bytes, width, height, channelCount, values.data(),
                                  width * channelCount);
  } else if (format == ImageFormat::Jpeg) {
    done = stbi_write_jpg_to_func(appendTo, &bytes, width, height, channelCount, values.data(), kQuality);
  } else {
    refuseFormat();
  }
  if (done == 0) throw std::runtime_error("stb could not encode it");
  return bytes;
}

std::vector<uint8_t> encodeFloats(const Image& image, std::span<const float> values,
                                  const std::vector<bool>& halves, ImageFormat format) {
  if (!halves.empty()) throw std::runtime_error("the GPU bundle writes .exr of 32-bit floats alone");
  if (format != ImageFormat::OpenExr) refuseFormat();
  return writeExr(image, values);
}

void showByView(Image&) { throw std::runtime_error("the GPU bundle has no OpenColorIO"); }

void openImageLibrary() {}

}  // namespace fragtrace
