// SPDX-License-Identifier: MIT
#include <dlfcn.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <regex>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <OpenImageIO/color.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include "image/image.h"
#include "image/worker/library.h"

namespace fragtrace {

namespace {

// AVIF by libheif, which OpenImageIO links: it reads such pictures from files alone, and this process opens
// none. Its interface, whose headers are in a package that nothing else here needs.

struct HeifError {
  int code;
  int subcode;
  const char* message;
};
struct HeifContext;
struct HeifHandle;
struct HeifImage;
constexpr int kHeifRgb = 1;               // heif_colorspace_RGB
constexpr int kHeifInterleaved = 10;      // heif_channel_interleaved
constexpr int kHeifInterleavedRgba = 11;  // heif_chroma_interleaved_RGBA
constexpr int kHeifUnsupported = 4;       // heif_error_Unsupported_feature
constexpr int kHeifNoPlugin = 6;          // heif_error_Decoder_plugin_error: also where there is none

/// Looks a function of libheif up among what is loaded.
template <typename Function>
Function* found(const char* name) {
  auto* function = reinterpret_cast<Function*>(::dlsym(RTLD_DEFAULT, name));
  if (function == nullptr)
    throw std::runtime_error("AVIF cannot be decoded: OpenImageIO was built without libheif");
  return function;
}

template <typename Thing>
using Owned = std::unique_ptr<Thing, void (*)(Thing*)>;

template <typename Thing>
Owned<Thing> owned(Thing* thing, const char* release) {
  return {thing, found<void(Thing*)>(release)};
}

void check(const HeifError& error) {
  if (error.code == 0) return;
  const std::string text = error.message != nullptr ? error.message : "libheif gives no reason";
  if (error.code == kHeifUnsupported || error.code == kHeifNoPlugin)
    throw std::runtime_error("AVIF cannot be decoded: " + text +
                             " (on Debian 13: apt-get install libheif-plugin-dav1d)");
  throw std::runtime_error(text);
}

/// Fills `rgba`, which holds width x height texels of 8 bits. Throws std::runtime_error where the picture has
/// another size, and where there is no libheif, or none with a decoder of AV1: then the reason names the
/// package.
void decodeAvif(std::span<const uint8_t> bytes, int width, int height, std::span<uint8_t> rgba) {
  const auto context = owned(found<HeifContext*()>("heif_context_alloc")(), "heif_context_free");
  check(found<HeifError(HeifContext*, const void*, size_t, const void*)>(
      "heif_context_read_from_memory_without_copy")(context.get(), bytes.data(), bytes.size(), nullptr));
  HeifHandle* opened = nullptr;
  check(found<HeifError(HeifContext*, HeifHandle**)>("heif_context_get_primary_image_handle")(context.get(),
                                                                                              &opened));
  const auto handle = owned(opened, "heif_image_handle_release");
  const auto sizeOf = [&](const char* side) { return found<int(const HeifHandle*)>(side)(handle.get()); };
  if (sizeOf("heif_image_handle_get_width") != width || sizeOf("heif_image_handle_get_height") != height ||
      rgba.size() != size_t(width) * size_t(height) * 4)
    throw std::runtime_error("its size is not what its header says");
  HeifImage* decoded = nullptr;
  check(found<HeifError(const HeifHandle*, HeifImage**, int, int, const void*)>("heif_decode_image")(
      handle.get(), &decoded, kHeifRgb, kHeifInterleavedRgba, nullptr));
  const auto image = owned(decoded, "heif_image_release");
  int stride = 0;
  const uint8_t* plane = found<const uint8_t*(const HeifImage*, int, int*)>("heif_image_get_plane_readonly")(
      image.get(), kHeifInterleaved, &stride);
  if (plane == nullptr) throw std::runtime_error("libheif gives no pixels");
  const size_t row = size_t(width) * 4;
  for (int y = 0; y < height; ++y)
    std::copy_n(plane + ptrdiff_t(y) * stride, row, rgba.begin() + ptrdiff_t(y) * ptrdiff_t(row));
}

}  // namespace

// The only file that sees OpenImageIO; formats are chosen by name.

namespace {

const char* formatName(ImageFormat format) {
  switch (format) {
    case ImageFormat::Png:
      return "png";
    case ImageFormat::Jpeg:
      return "jpeg";
    case ImageFormat::OpenExr:
      return "openexr";
    case ImageFormat::Hdr:
      return "hdr";
    case ImageFormat::WebP:
      return "webp";
    case ImageFormat::Pfm:
    case ImageFormat::Ktx2:
    case ImageFormat::Avif:
      break;
  }
  throw std::runtime_error("the image library is not for this format");
}

std::string oneLine(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::ranges::replace(text, '\n', ' ');
  // The name by which the library opens pictures without a file.
  static const std::regex kOwnName("\"?memory\\.[a-z]+\"?");
  text = std::regex_replace(text, kOwnName, "the picture");
  return text.empty() ? "the image library gives no reason" : text;
}

// Reading

/// An encoded picture in memory, opened.
struct OpenPicture {
  OIIO::Filesystem::IOMemReader bytes;
  std::unique_ptr<OIIO::ImageInput> input;  // declared after the bytes, so that it is closed before they go
  OIIO::ImageSpec spec;

  OpenPicture(std::span<const uint8_t> encoded, ImageFormat format)
      : bytes(const_cast<uint8_t*>(encoded.data()), encoded.size()),
        input(OIIO::ImageInput::create(formatName(format))) {
    if (!input) throw std::runtime_error(oneLine(OIIO::geterror()));
    OIIO::ImageSpec configuration;
    configuration.attribute("oiio:UnassociatedAlpha", 1);  // else the colour is multiplied by alpha
    if (!input->supports("ioproxy") || !input->set_ioproxy(&bytes))
      throw std::runtime_error(std::string(formatName(format)) + " cannot be read from memory");
    if (!input->open(std::string("memory.") + formatName(format), spec, configuration))
      throw std::runtime_error(oneLine(input->geterror()));
    checkImageSize(spec.width, spec.height, spec.nchannels);
  }

  /// Goes to a part of an .exr.
  void select(int part) {
    if (!input->seek_subimage(part, 0)) throw std::runtime_error(oneLine(input->geterror()));
    spec = input->spec();
    checkImageSize(spec.width, spec.height, spec.nchannels);
  }

  void read(const OIIO::TypeDesc& type, void* values, OIIO::stride_t pixelStride, OIIO::stride_t rowStride) {
    if (!input->read_image(input->current_subimage(), 0, 0, spec.nchannels, type, values, pixelStride,
                           rowStride))
      throw std::runtime_error(oneLine(input->geterror()));
    // libjpeg's warnings are errors here, except for extraneous bytes, which leave the picture whole.
    if (!input->has_error()) return;
    const std::string warning = input->geterror();
    if (warning.find("extraneous bytes") == std::string::npos) throw std::runtime_error(oneLine(warning));
  }
};

/// String attributes of a file, without those that say how the file is stored.
std::map<std::string, std::string> stringAttributes(const OIIO::ImageSpec& spec) {
  std::map<std::string, std::string> attributes;
  for (const OIIO::ParamValue& value : spec.extra_attribs) {
    const std::string name = value.name().string();
    const bool storage = name.starts_with("oiio:") || name.starts_with("openexr:") || name == "compression";
    if (value.type() == OIIO::TypeString && !storage) attributes[name] = value.get_string();
  }
  return attributes;
}

/// The image library's name of a standard attribute of OpenEXR.
std::string libraryName(const std::string& name) {
  if (name == "worldToCamera") return "worldtocamera";
  if (name == "worldToNDC") return "worldtoNDC";
  return name;
}

OIIO::TypeDesc typeOfNumbers(size_t count) {
  if (count == 1) return OIIO::TypeFloat;
  if (count == 16) return OIIO::TypeMatrix44;
  return {OIIO::TypeDesc::FLOAT, int(count)};
}

/// Returns those attributes of kNumberAttributes that the file has.
std::map<std::string, std::vector<float>> numberAttributes(const OIIO::ImageSpec& spec) {
  std::map<std::string, std::vector<float>> attributes;
  for (const NumberAttribute& row : kNumberAttributes) {
    // Written under the library's name, they are read under their own.
    const OIIO::ParamValue* value = spec.find_attribute(row.name, typeOfNumbers(row.count), true);
    if (value == nullptr) continue;
    const auto* numbers = static_cast<const float*>(value->data());
    attributes[row.name].assign(numbers, numbers + row.count);
  }
  return attributes;
}

/// OpenImageIO 2.4 multiplies WebP's colour by its alpha, whatever it is asked. Divides it again, as well as
/// the 8 bits left allow; colour under alpha 0 is lost. `half` is what rounds a value of this type.
template <typename Value>
void unassociate(std::span<Value> values, double one, double half) {
  for (size_t first = 0; first < values.size(); first += 4) {
    const double alpha = values[first + 3] / one;
    for (size_t c = first; c < first + 3 && alpha > 0; ++c)
      values[c] = Value(std::min(values[c] / alpha + half, one));
  }
}

/// The place of a part of an .exr in the picture, its display window.
Region placeOf(const OIIO::ImageSpec& spec) {
  return {{spec.x - spec.full_x, spec.y - spec.full_y}, {spec.width, spec.height}};
}

/// The part of a rectangle that lies in the picture.
Region cut(const Region& region, const glm::ivec2& whole) {
  const glm::ivec2 corner = glm::clamp(region.corner, glm::ivec2(0), whole);
  return {corner, glm::max(glm::min(region.corner + region.size, whole) - corner, glm::ivec2(0))};
}

Region around(const Region& a, const Region& b) {
  const glm::ivec2 corner = glm::min(a.corner, b.corner);
  return {corner, glm::max(a.corner + a.size, b.corner + b.size) - corner};
}

/// Reads all parts of an .exr as one picture, whose channels have the names PART\nCHANNEL where there are
/// several (image/files/picture_files.cpp). Pixels outside of the display window are left out.
Image readParts(OpenPicture& picture) {
  std::vector<OIIO::ImageSpec> specs;
  for (int i = 0; picture.input->seek_subimage(i, 0); ++i) specs.push_back(picture.input->spec());
  picture.input->geterror();  // that there are no more parts
  const glm::ivec2 whole(std::max(specs[0].full_width, 1), std::max(specs[0].full_height, 1));
  Region data = placeOf(specs[0]);
  for (const OIIO::ImageSpec& spec : specs) data = around(data, placeOf(spec));
  data = cut(data, whole);

  Image image;
  image.width = data.size.x;
  image.height = data.size.y;
  if (data.size != whole) image.placement = {data.corner, whole};
  for (const OIIO::ImageSpec& spec : specs) {
    const std::string part = std::string(spec.get_string_attribute("oiio:subimagename")) + "\n";
    for (const std::string& name : spec.channelnames)
      image.channels.push_back(specs.size() > 1 ? part + name : name);
  }
  checkImageSize(whole.x, whole.y, int(image.channelCount()));
  image.values.resize(size_t(image.width) * size_t(image.height) * image.channelCount());
  size_t channel = 0;
  for (size_t part = 0; part < specs.size(); ++part) {
    const OIIO::ImageSpec& spec = specs[part];
    image.attributes.merge(stringAttributes(spec));
    image.numbers.merge(numberAttributes(spec));
    picture.select(int(part));
    const size_t count = size_t(spec.nchannels);
    std::vector<float> values(size_t(spec.width) * size_t(spec.height) * count);
    picture.read(OIIO::TypeFloat, values.data(), OIIO::AutoStride, OIIO::AutoStride);
    const Region place = placeOf(spec), seen = cut(place, whole);
    for (int y = 0; y < seen.size.y; ++y) {
      for (int x = 0; x < seen.size.x; ++x) {
        const glm::ivec2 from = seen.corner - place.corner + glm::ivec2(x, y);
        const glm::ivec2 to = seen.corner - data.corner + glm::ivec2(x, y);
        std::copy_n(&values[(size_t(from.y) * size_t(spec.width) + size_t(from.x)) * count], count,
                    image.pixel(to.x, to.y) + channel);
      }
    }
    channel += count;
  }
  return image;
}

template <typename Value>
void readTexels(OpenPicture& picture, std::span<Value> rgba) {
  constexpr Value kOne = std::numeric_limits<Value>::max();
  const int stored = picture.spec.nchannels;
  const OIIO::stride_t pixelStride = 4 * sizeof(Value);
  picture.read(OIIO::BaseTypeFromC<Value>::value, rgba.data(), pixelStride, pixelStride * picture.spec.width);
  if (picture.input->format_name() == std::string_view("webp") && stored == 4)
    unassociate<Value>(rgba, kOne, 0.5);

  // Spread what is stored at the front of each texel: Y, YA or RGB.
  for (size_t first = 0; first < rgba.size() && stored < 4; first += 4) {
    Value* texel = rgba.data() + first;
    texel[3] = stored == 2 ? texel[1] : kOne;
    if (stored <= 2) texel[1] = texel[2] = texel[0];
  }
}

}  // namespace

Image decodeFloats(std::span<const uint8_t> bytes, ImageFormat format) {
  OpenPicture picture(bytes, format);
  if (format == ImageFormat::OpenExr) return readParts(picture);
  const OIIO::ImageSpec& spec = picture.spec;
  Image image;
  image.width = spec.width;
  image.height = spec.height;
  image.channels = spec.channelnames;
  image.values.resize(size_t(image.width) * size_t(image.height) * image.channelCount());
  picture.read(OIIO::TypeFloat, image.values.data(), OIIO::AutoStride, OIIO::AutoStride);
  if (format == ImageFormat::WebP && spec.nchannels == 4) unassociate<float>(image.values, 1, 0);
  return image;
}

void decodeTexels(std::span<const uint8_t> bytes, ImageFormat format, int width, int height, int bits,
                  std::span<uint8_t> rgba) {
  if (rgba.size() != size_t(width) * size_t(height) * 4 * size_t(bits / 8))
    throw std::runtime_error("the worker process got a broken request");
  if (format == ImageFormat::Avif) return decodeAvif(bytes, width, height, rgba);
  OpenPicture picture(bytes, format);
  const int stored = picture.spec.nchannels;
  if (stored > 4) throw std::runtime_error("it has more than four channels");
  if (picture.spec.width != width || picture.spec.height != height)
    throw std::runtime_error("its size is not what its header says");
  if (bits == 8)
    readTexels(picture, rgba);
  else
    readTexels(picture, std::span(reinterpret_cast<uint16_t*>(rgba.data()), rgba.size() / sizeof(uint16_t)));
}

// Writing

namespace {

std::vector<uint8_t> encode(const OIIO::ImageSpec& spec, ImageFormat format, const void* values) {
  const auto output = OIIO::ImageOutput::create(formatName(format));
  if (!output) throw std::runtime_error(oneLine(OIIO::geterror()));
  std::vector<uint8_t> bytes;
  OIIO::Filesystem::IOVecOutput sink(bytes);
  if (!output->supports("ioproxy") || !output->set_ioproxy(&sink))
    throw std::runtime_error(std::string(formatName(format)) + " cannot be written to memory");
  if (!output->open(std::string("memory.") + formatName(format), spec) ||
      !output->write_image(spec.format, values) || !output->close())
    throw std::runtime_error(oneLine(output->geterror()));
  return bytes;
}

}  // namespace

std::vector<uint8_t> encodeBytes(int width, int height, int channelCount, int bits,
                                 std::span<const uint8_t> values, ImageFormat format) {
  OIIO::ImageSpec spec(width, height, channelCount, bits == 16 ? OIIO::TypeUInt16 : OIIO::TypeUInt8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("oiio:UnassociatedAlpha", 1);  // else the colour is divided by alpha
  spec.attribute("Compression", "jpeg:95");
  spec.attribute("jpeg:subsampling", "4:4:4");
  return encode(spec, format, values.data());
}

std::vector<uint8_t> encodeFloats(const Image& image, std::span<const float> values,
                                  const std::vector<bool>& halves, ImageFormat format) {
  OIIO::ImageSpec spec(image.width, image.height, int(image.channelCount()), OIIO::TypeFloat);
  spec.channelnames = image.channels;
  for (const bool half : halves) spec.channelformats.push_back(half ? OIIO::TypeHalf : OIIO::TypeFloat);
  const auto alpha = std::ranges::find(image.channels, "A");
  spec.alpha_channel = alpha == image.channels.end() ? -1 : int(alpha - image.channels.begin());
  for (const auto& [name, text] : image.attributes) spec.attribute(name, text);
  for (const auto& [name, numbers] : image.numbers)
    spec.attribute(libraryName(name), typeOfNumbers(numbers.size()), numbers.data());
  if (image.placement) {
    spec.x = image.placement->corner.x;
    spec.y = image.placement->corner.y;
    spec.full_width = image.placement->whole.x;
    spec.full_height = image.placement->whole.y;
  }
  spec.attribute("oiio:ColorSpace", "Linear");
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "");  // else the time of writing, and the same picture gave different files
  return encode(spec, format, values.data());
}

// OpenColorIO

namespace {

using Names = std::vector<std::string>;
using Attributes = std::map<std::string, std::string>;

/// The names of linear Rec. 709 in configurations: those of ACES and of Blender, and older ones.
constexpr const char* kLinearNames[] = {"lin_rec709",
                                        "lin_rec709_scene",
                                        "lin_srgb",
                                        "Linear Rec.709 (sRGB)",
                                        "Linear Rec.709",
                                        "Utility - Linear - sRGB",
                                        "Utility - Linear - Rec.709"};

/// Throws std::runtime_error that lists the names there are.
void require(const std::string& kind, const std::string& name, const Names& known) {
  if (std::ranges::find(known, name) != known.end()) return;
  std::string text = "the configuration has no " + kind + " '" + name + "'; it has: ";
  for (const std::string& other : known) text += (&other == known.data() ? "" : ", ") + other;
  throw std::runtime_error(text);
}

/// Requires each of "a, +b, -c".
void requireLooks(const std::string& looks, const Names& known) {
  for (size_t at = 0; at < looks.size();) {
    const size_t end = std::min(looks.find_first_of(",:", at), looks.size());
    const size_t first = looks.find_first_not_of(" +-", at);
    const size_t last = looks.find_last_not_of(' ', end - 1);
    if (first < end) require("look", looks.substr(first, last - first + 1), known);
    at = end + 1;
  }
}

/// Pictures go through these in turn: the look, if one is asked for, and the view.
using Processors = std::vector<OIIO::ColorProcessorHandle>;

/// Empty: an error of the configuration says why.
Processors processorsOf(const OIIO::ColorConfig& config, const std::string& display, const Attributes& view,
                        const std::string& input) {
  const OIIO::ustring space(input), look(view.at("look")), none;
  Processors all;
  if (!look.empty()) all.push_back(config.createLookTransform(look, space, space, false, none, none));
#if OIIO_VERSION >= 20500
  all.push_back(config.createDisplayTransform(OIIO::ustring(display), OIIO::ustring(view.at("view")), space,
                                              none, false, none, none));
#else
  all.push_back(config.createDisplayTransform(OIIO::ustring(display), OIIO::ustring(view.at("view")), space));
#endif
  return std::ranges::all_of(all, [](const auto& one) { return one != nullptr; }) ? all : Processors();
}

/// Reads the configuration and the files that the view needs.
Processors openView(const Attributes& view) {
  OIIO::ColorConfig config(view.at("config"));
  if (config.has_error()) throw std::runtime_error(oneLine(config.geterror()));
  std::string display = view.at("display");
  if (display.empty()) display = config.getDefaultDisplayName();
  require("display", display, config.getDisplayNames());
  require("view of the display '" + display + "' called", view.at("view"), config.getViewNames(display));
  requireLooks(view.at("look"), config.getLookNames());
  Names inputs(std::begin(kLinearNames), std::end(kLinearNames));
  if (!view.at("input").empty()) inputs = {view.at("input")};
  const auto input = std::ranges::find_if(inputs, [&](const std::string& name) {
    return config.getColorSpaceFamilyByName(name) != nullptr;  // else there is none of that name
  });
  if (input == inputs.end() && !view.at("input").empty())
    require("colour space", view.at("input"), config.getColorSpaceNames());
  if (input == inputs.end())
    throw std::runtime_error(
        "the configuration has none of the usual names of linear Rec. 709 (--ocio-input)");
  Processors all = processorsOf(config, display, view, *input);
  if (all.empty()) throw std::runtime_error(oneLine(config.geterror()));
  return all;
}

}  // namespace

void showByView(Image& image) {
  static Attributes shown;
  static Processors processors;
  if (processors.empty() || shown != image.attributes) processors = openView(image.attributes);
  shown = image.attributes;
  const OIIO::ImageSpec spec(image.width, image.height, int(image.channelCount()), OIIO::TypeFloat);
  OIIO::ImageBuf pixels(spec, image.values.data());
  for (const OIIO::ColorProcessorHandle& processor : processors) {
    if (!OIIO::ImageBufAlgo::colorconvert(pixels, pixels, processor.get(), false))
      throw std::runtime_error(oneLine(pixels.geterror()));
  }
}

void openImageLibrary() {
  OIIO::attribute("threads", 1);
  OIIO::ImageInput::create("png");  // fills the catalogue of formats
}

}  // namespace fragtrace
