// SPDX-License-Identifier: MIT
// fragtrace._core: what the Python package (src/python/fragtrace) is made of. Words go in, pictures come out.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <thread>

#include "base/errors.h"
#include "image/compare/difference.h"
#include "image/compare/flip.h"
#include "image/display/tone_map.h"
#include "image/image.h"
#include "options/numbers.h"
#include "options/option_text.h"
#include "options/parse_render.h"
#include "python/kept_scene.h"
#include "session/picture/joined_parts.h"
#include "session/picture/sequence.h"

namespace nb = nanobind;

namespace fragtrace {
namespace {

using Values = nb::ndarray<nb::numpy, float, nb::ndim<3>>;
using GivenValues = nb::ndarray<const float, nb::ndim<3>, nb::c_contig, nb::device::cpu>;

/// Height, width, channels; the array keeps the values alive.
Values arrayOf(Image& image) {
  auto* const values = new std::vector<float>(std::move(image.values));
  const nb::capsule owner(values, [](void* p) noexcept { delete static_cast<std::vector<float>*>(p); });
  return Values(values->data(), {size_t(image.height), size_t(image.width), image.channels.size()}, owner);
}

/// The strings and numbers of an .exr, which Python gives and gets besides the channels' names and values.
nb::tuple attributesOf(const Image& image) { return nb::make_tuple(image.attributes, image.numbers); }

/// Channels' names, values and attributes.
nb::tuple pictureTuple(Image& image) {
  Values values = arrayOf(image);
  return nb::make_tuple(image.channels, values, attributesOf(image));
}

Image imageOfArray(const GivenValues& values, std::vector<std::string> channels) {
  if (values.shape(2) != channels.size())
    throw UsageError("an array of another number of channels than names");
  constexpr size_t kMost = 1 << 20;
  if (values.size() == 0 || values.shape(0) > kMost || values.shape(1) > kMost)
    throw UsageError("an array that is no picture: height, width and channels are wanted");
  Image image{int(values.shape(1)), int(values.shape(0)), std::move(channels), {}, {}};
  image.values.assign(values.data(), values.data() + values.size());
  return image;
}

/// Waits for a job with Python's interpreter free, but reacts to Ctrl-C. `told` is called with the fraction
/// done.
void await(DrawJob& job, const nb::object& told) {
  constexpr int kLookMs = 40;
  constexpr int kLeaveMs = 120;  // a compilation that takes longer continues, and is not waited for
  double last = -1.0;
  const auto leave = [&] {
    job.interrupts = 2;
    const nb::gil_scoped_release free;
    job.wait(kLeaveMs);
  };
  while (true) {
    bool ended = false;
    {
      const nb::gil_scoped_release free;
      ended = job.wait(kLookMs);
      // Python is ending, and ends threads that ask for the interpreter now, which C++ does not survive.
      while (isDrawingStopped()) std::this_thread::sleep_for(std::chrono::seconds(1));
    }
    if (ended) break;
    if (PyErr_CheckSignals() != 0) {
      nb::python_error error;
      leave();
      throw error;
    }
    const double fraction = job.fraction;
    if (told.is_none() || fraction == last) continue;
    last = fraction;
    try {
      told(fraction);
    } catch (...) {
      leave();
      throw;
    }
  }
  if (job.error) std::rethrow_exception(job.error);
}

const char* nameOf(Renewal renewal) {
  constexpr std::array kNames = {"nothing", "program", "scene", "pose", "pose", "scene"};
  return kNames[size_t(renewal)];
}

/// The numbers of the pictures that the words ask for; of a single one [0].
std::vector<int> frameNumbers(std::vector<std::string> words) {
  const RenderOptions options = optionsOfWords(std::move(words));
  if (!isSequence(options)) return {0};
  std::vector<int> numbers;
  for (int i = 0; i < frameCount(options.output.sequence); ++i) numbers.push_back(frameOf(options, i).number);
  return numbers;
}

/// A scene that Python holds.
class SceneHandle {
 public:
  explicit SceneHandle(bool kept) : scene_(std::make_shared<KeptScene>()) { scene_->isKept = kept; }
  SceneHandle(const SceneHandle&) = delete;
  SceneHandle& operator=(const SceneHandle&) = delete;
  ~SceneHandle() {
    try {
      releaseLater(std::move(scene_));
    } catch (const std::exception&) {
      // A forked process has no drawing thread, and nothing to free.
    }
  }

  /// Channels, values, attributes, statistics (JSON), whether it is complete, what was said, what was
  /// renewed.
  nb::object draw(std::vector<std::string> words, const nb::object& told, int index) {
    const auto drawn = std::make_shared<std::optional<DrawnPicture>>();
    const auto options = std::make_shared<RenderOptions>(optionsOfWords(std::move(words)));
    const auto job = postJob([scene = scene_, drawn, options, index](DrawJob& own) {
      *drawn = drawKept(scene, *options, index, own);
    });
    await(*job, told);
    if (!*drawn) throw RenderError("interrupted, nothing is drawn");
    Values values = arrayOf((*drawn)->image);
    return nb::make_tuple((*drawn)->image.channels, values, attributesOf((*drawn)->image),
                          (*drawn)->statistics, (*drawn)->complete, job->said, nameOf((*drawn)->renewal));
  }

 private:
  std::shared_ptr<KeptScene> scene_;
};

Metric metricNamed(const std::string& name) { return choose<Metric>("metric", name, metricNames()); }

double differenceOfArrays(const GivenValues& picture, const GivenValues& reference,
                          const std::vector<std::string>& channels, const std::string& metric) {
  const Image a = imageOfArray(picture, channels);
  const Image b = imageOfArray(reference, channels);
  const Metric chosen = metricNamed(metric);
  if (chosen == Metric::Bias) throw UsageError("metric: bias compares files: fragtrace diff A.exr B.exr");
  const nb::gil_scoped_release free;
  if (chosen == Metric::Flip) return flipError(toDefaultDisplay(a), toDefaultDisplay(b)).mean;
  return metricValue(compare(a, b), chosen);
}

/// The colour of R, G, B and A with the page behind it.
Image laidOver(const glm::vec3& page, Image picture) {
  constexpr size_t kAlpha = 3;
  for (size_t first = 0; first < picture.values.size(); first += kAlpha + 1) {
    float* const pixel = picture.values.data() + first;
    for (size_t c = 0; c < kAlpha; ++c) pixel[c] += (1.0f - pixel[kAlpha]) * page[int(c)];
  }
  return picture;
}

/// sRGB-encoded display values, 0..1, of R, G, B and perhaps A; with the noise for 8 bits (dither()) if
/// wanted. A picture with A lies over a page, if one is named.
nb::tuple displayed(const GivenValues& values, const std::vector<std::string>& channels, double exposure,
                    const std::string& curve, bool dithers, const std::string& page) {
  const std::optional<ToneMap> toneMap = parseToneMap(curve);
  if (!std::isfinite(exposure)) throw UsageError("exposure: is not a finite number");
  if (!toneMap) throw UsageError("tone_map: '" + curve + "' is none of " + joined(toneMapNames()));
  Image linear = imageOfArray(values, channels);
  const bool isOverPage = !page.empty() && channels == std::vector<std::string>{"R", "G", "B", "A"};
  const glm::vec3 color = isOverPage ? colorIn("background_color", page, 1.0) : glm::vec3(0.0f);
  Image display = isOverPage ? toDisplayOver(color, laidOver(color, std::move(linear)), exposure, *toneMap)
                             : toDisplay(linear, exposure, *toneMap);
  if (dithers) dither(display, {0, 0});
  return pictureTuple(display);
}

/// Returns how many values --half has clamped.
size_t save(const std::string& path, const GivenValues& values, std::vector<std::string> channels,
            std::map<std::string, std::string> attributes, std::map<std::string, std::vector<float>> numbers,
            bool half, int pngDepth) {
  Image image = imageOfArray(values, std::move(channels));
  image.attributes = std::move(attributes);
  image.numbers = std::move(numbers);
  const Encoding encoding{half, pngDepth};
  if (pngDepth != 8 && pngDepth != 16) throw UsageError("png_depth: is neither 8 nor 16");
  checkEncoding(encoding, path);
  const nb::gil_scoped_release free;
  return writeImage(path, image, encoding);
}

nb::tuple readFile(const std::string& path) {
  Image image;
  {
    const nb::gil_scoped_release free;
    image = readStoredImage(path);
  }
  return pictureTuple(image);
}

/// Returns the same as readFile(), and the parts of which the picture consists.
nb::tuple merge(const std::vector<std::string>& paths) {
  if (paths.empty()) throw UsageError("merge: no parts");
  Part joined;
  {
    const nb::gil_scoped_release free;
    std::vector<Part> parts;
    for (const std::string& path : paths) parts.push_back(readPart(path));
    joined = joinedParts(std::move(parts));
  }
  const std::string words = describeParts(paths.size(), joined);
  const nb::tuple attributes = attributesOf(joined.image);
  return nb::make_tuple(joined.image.channels, arrayOf(joined.image), attributes, words);
}

}  // namespace
}  // namespace fragtrace

NB_MODULE(_core, module) {
  using namespace fragtrace;
  nb::set_leak_warnings(false);
  nb::exception<RenderError>(module, "RenderError", PyExc_RuntimeError);
  nb::exception<UsageError>(module, "UsageError", PyExc_ValueError);
  nb::exception<InputError>(module, "InputError", PyExc_ValueError);
  nb::exception<ContextError>(module, "ContextError", PyExc_RuntimeError);
  nb::class_<SceneHandle>(module, "Scene")
      .def(nb::init<bool>())
      .def("draw", &SceneHandle::draw, nb::arg("words"), nb::arg("told").none(), nb::arg("index") = 0);
  module.attr("__version__") = FRAGTRACE_VERSION;
  module.def("option_names", &optionNames);
  module.def("option_like", &optionLike);
  module.def("frame_numbers", &frameNumbers);
  module.def("read", &readFile);
  module.def("save", &save);
  module.def("merge", &merge);
  module.def("difference", &differenceOfArrays);
  module.def("display", &displayed);
  module.def("is_display_format", [](const std::string& path) { return isDisplayFormat(path); });
  module.def("stop", [] {
    const nb::gil_scoped_release free;
    stopDrawing();
  });
}
