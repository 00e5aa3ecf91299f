// SPDX-License-Identifier: MIT
#include "image/denoise/oidn.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "base/text.h"
#include "image/channels.h"

namespace fragtrace {

namespace {

constexpr const char* kOidnName = "libOpenImageDenoise.so.2";
constexpr const char* kOidnVariable = "FRAGTRACE_OIDN_LIBRARY";
constexpr int kOidnMajor = 2;

std::string textOfVariable(const char* name) {
  const char* text = std::getenv(name);
  return text == nullptr ? "" : text;
}

/// Folders of Python packages: those of an environment, of the programs in PATH (conda), of pyenv, of the
/// user and of the system.
std::vector<std::filesystem::path> packageFolders() {
  std::vector<std::filesystem::path> folders;
  const auto addVersions = [&](const std::filesystem::path& library, const char* packages) {
    std::error_code error;
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::directory_iterator(library, error)) {
      if (entry.path().filename().string().starts_with("python3")) found.push_back(entry.path() / packages);
    }
    std::ranges::sort(found);
    folders.insert(folders.end(), found.begin(), found.end());
  };
  const std::filesystem::path environment = textOfVariable("VIRTUAL_ENV");
  const std::filesystem::path home = textOfVariable("HOME");
  if (!environment.empty()) addVersions(environment / "lib", "site-packages");
  const std::string path = textOfVariable("PATH");
  for (const std::string_view programs : splitText(path, ':'))
    addVersions(std::filesystem::path(programs).parent_path() / "lib", "site-packages");
  if (!home.empty()) {
    std::error_code error;
    for (const auto& version : std::filesystem::directory_iterator(home / ".pyenv/versions", error))
      addVersions(version.path() / "lib", "site-packages");
    addVersions(home / ".local/lib", "site-packages");
  }
  addVersions("/usr/local/lib", "dist-packages");
  folders.emplace_back("/usr/lib/python3/dist-packages");
  return folders;
}

/// Not loaded when a file cannot be opened; `reason` says why.
DynamicLibrary openOidnFile(const std::filesystem::path& path, std::string& reason) {
  std::error_code error;
  // The loader waits for whoever writes to a pipe.
  if (!std::filesystem::is_regular_file(path, error)) {
    reason =
        path.string() + (std::filesystem::exists(path, error) ? ": is no file" : ": there is no such file");
    return DynamicLibrary(std::initializer_list<const char*>());
  }
  DynamicLibrary library({std::filesystem::absolute(path).c_str()});
  reason = library.error();
  return library;
}

/// Makes the device, which knows the version.
OidnLibrary startOidn(const DynamicLibrary& opened, const std::string& file) {
  OidnLibrary library{.call = OidnFunctions(opened), .file = file};
  if (!library.call.complete())
    throw UsageError(file + ": is no Open Image Denoise 2: it lacks " + library.call.missing());
  const auto checkStarted = [&] {
    const char* message = nullptr;
    if (library.call.getDeviceError(library.device.get(), &message) == kOidnNoError && library.device) return;
    throw UsageError(file + ": Open Image Denoise does not start: " +
                     (message == nullptr ? "it makes no device" : message));
  };
  library.device = {library.call.newDevice(kOidnCpuDevice),
                    [release = library.call.releaseDevice](OidnDeviceHandle* device) {
                      if (device != nullptr) release(device);
                    }};
  checkStarted();
  // The version is read before the device is used, because the calls below are known for version 2 only.
  const auto number = [&](const char* name) { return library.call.getDeviceInt(library.device.get(), name); };
  const int major = number("versionMajor");
  library.version = std::to_string(major) + "." + std::to_string(number("versionMinor")) + "." +
                    std::to_string(number("versionPatch"));
  if (major != kOidnMajor)
    throw UsageError(file + ": is Open Image Denoise " + library.version + ", where 2.x is needed");
  library.call.commitDevice(library.device.get());
  checkStarted();
  return library;
}

OidnLibrary openNamedOidn(const std::filesystem::path& path, const std::string& saidBy) {
  std::string reason;
  const DynamicLibrary library = openOidnFile(path, reason);
  if (!library.loaded()) throw UsageError(saidBy + ": cannot be opened as a library: " + reason);
  return startOidn(library, path.string());
}

OidnLibrary openAnyOidn() {
  if (const DynamicLibrary library({kOidnName}); library.loaded()) return startOidn(library, kOidnName);
  std::string reasons;
  for (const std::filesystem::path& folder : packageFolders()) {
    const std::filesystem::path path = folder / "pyoidn/oidn/lib" / kOidnName;
    std::error_code error;
    if (!std::filesystem::exists(path, error)) continue;
    std::string reason;
    const DynamicLibrary library = openOidnFile(path, reason);
    if (library.loaded()) return startOidn(library, path.string());
    reasons += "; " + reason;
  }
  throw UsageError(std::string("Open Image Denoise is not there: neither ") + kOidnName +
                   " nor the Python package pyoidn was found (pip install pyoidn, or name the file by "
                   "--oidn-library or " +
                   kOidnVariable + ")" + reasons);
}

using LayerNames = std::array<const char*, 3>;
constexpr LayerNames kOidnColor{"R", "G", "B"};
constexpr LayerNames kOidnAlbedo{kGuideChannels[0], kGuideChannels[1], kGuideChannels[2]};
constexpr LayerNames kOidnNormal{kGuideChannels[4], kGuideChannels[5], kGuideChannels[6]};

/// Three floats per pixel, rows from the top.
using Triples = std::vector<float>;

bool hasLayer(const Image& image, const LayerNames& names) {
  return std::ranges::all_of(names, [&](const char* name) { return findChannel(image, name).has_value(); });
}

/// Gives each pixel with a value that is not finite the mean of its neighbours that are, in rings from the
/// edge of such a region inwards; 0 where nothing is finite.
void fillFromNeighbours(Triples& pixels, int width, int height) {
  enum State : uint8_t { Known, Unknown, Next };
  std::vector<State> states(pixels.size() / 3, Known);
  const auto isFinite = [](float value) { return std::isfinite(value); };
  for (size_t i = 0; i < states.size(); ++i) {
    if (!std::all_of(&pixels[3 * i], &pixels[3 * i] + 3, isFinite)) states[i] = Unknown;
  }
  const auto forNeighbours = [&](size_t i, auto visit) {
    const int x = int(i % size_t(width)), y = int(i / size_t(width));
    for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, height - 1); ++ny) {
      for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, width - 1); ++nx)
        visit(size_t(ny) * size_t(width) + size_t(nx));
    }
  };
  std::vector<size_t> ring, next;
  const auto addUnknown = [&](size_t i) {
    if (std::exchange(states[i], states[i] == Unknown ? Next : states[i]) == Unknown) next.push_back(i);
  };
  for (size_t i = 0; i < states.size(); ++i) {
    bool isEdge = false;
    if (states[i] == Unknown) forNeighbours(i, [&](size_t n) { isEdge = isEdge || states[n] == Known; });
    if (isEdge) addUnknown(i);
  }
  while (!next.empty()) {
    ring = std::exchange(next, {});
    for (const size_t i : ring) {
      std::array<double, 3> sum{};
      int count = 0;
      forNeighbours(i, [&](size_t n) {
        if (states[n] != Known) return;
        for (size_t c = 0; c < 3; ++c) sum[c] += pixels[3 * n + c];
        ++count;
      });
      for (size_t c = 0; c < 3; ++c) pixels[3 * i + c] = float(sum[c] / count);
    }
    for (const size_t i : ring) states[i] = Known;
    for (const size_t i : ring) forNeighbours(i, addUnknown);
  }
  for (float& value : pixels) value = std::isfinite(value) ? value : 0.0f;
}

Triples triplesOf(const Image& image, const LayerNames& names) {
  std::array<size_t, 3> index{};
  for (size_t c = 0; c < 3; ++c) {
    const auto found = findChannel(image, names[c]);
    if (!found) throw RenderError(std::string("Open Image Denoise needs the layer ") + names[c]);
    index[c] = *found;
  }
  Triples triples;
  triples.reserve(image.values.size() / image.channelCount() * 3);
  for (size_t first = 0; first < image.values.size(); first += image.channelCount()) {
    for (const size_t c : index) triples.push_back(image.values[first + c]);
  }
  fillFromNeighbours(triples, image.width, image.height);
  return triples;
}

/// The power of two next to the geometric mean of what is not black: the library loses pictures that are far
/// darker or brighter than 1 (all of 1e-40 or 1e38), and a few bright pixels do not move this mean. Nothing
/// where all is black.
std::optional<int> exponentOf(const Triples& color) {
  double sum = 0.0;
  size_t count = 0;
  for (const float value : color) {
    if (value <= 0.0f) continue;
    sum += std::log2(double(value));
    ++count;
  }
  if (count == 0) return std::nullopt;
  return int(std::lround(sum / double(count)));
}

void multiplyByPowerOfTwo(Triples& color, int exponent) {
  constexpr float kBrightest = 1e18f;  // its square is a float, too
  for (float& value : color) value = std::clamp(std::ldexp(value, exponent), -kBrightest, kBrightest);
}

/// The library's filters, one after the other, as parts of one piece of work.
class OidnRuns {
 public:
  OidnRuns(const OidnLibrary& library, int width, int height, uint64_t memoryBytes, int runs,
           const OidnProgress& progress)
      : library_(library), width_(size_t(width)), height_(size_t(height)), runs_(runs), progress_(progress) {
    constexpr uint64_t kMost = 2000;  // pictures that need more are filtered in tiles
    memoryMb_ = int(std::clamp<uint64_t>(memoryBytes / 1'000'000, 1, kMost));
  }

  struct Input {
    const char* name;
    Triples& pixels;
  };

  /// False when it was stopped. `cleanGuides`: albedo and normal are filtered already.
  bool run(std::initializer_list<Input> inputs, Triples& output, bool hdr, bool cleanGuides) {
    const OidnFunctions& call = library_.call;
    const std::unique_ptr<OidnFilterHandle, void (*)(OidnFilterHandle*)> filter(
        call.newFilter(library_.device.get(), "RT"), call.releaseFilter);
    if (!filter) throw RenderError(reason("it makes no filter"));
    const auto set = [&](const char* name, Triples& pixels) {
      call.setSharedFilterImage(filter.get(), name, pixels.data(), kOidnFloat3, width_, height_, 0, 0, 0);
    };
    for (const Input& input : inputs) set(input.name, input.pixels);
    set("output", output);
    if (hdr) call.setFilterBool(filter.get(), "hdr", true);
    if (cleanGuides) call.setFilterBool(filter.get(), "cleanAux", true);
    call.setFilterInt(filter.get(), "quality", kOidnHighQuality);
    call.setFilterInt(filter.get(), "maxMemoryMB", memoryMb_);
    call.setProgressMonitor(
        filter.get(),
        [](void* runs, double fraction) { return static_cast<OidnRuns*>(runs)->goesOn(fraction); }, this);
    call.commitFilter(filter.get());
    if (check()) call.executeFilter(filter.get());
    const bool complete = check() && !stopped_;
    ++done_;
    return complete;
  }

 private:
  bool goesOn(double fraction) {
    if (progress_ && !progress_((done_ + std::clamp(fraction, 0.0, 1.0)) / runs_)) stopped_ = true;
    return !stopped_;
  }

  std::string reason(const char* otherwise) {
    const char* message = nullptr;
    library_.call.getDeviceError(library_.device.get(), &message);
    return "Open Image Denoise " + library_.version + " failed: " + (message ? message : otherwise);
  }

  /// False when it was stopped.
  bool check() {
    const char* message = nullptr;
    const int error = library_.call.getDeviceError(library_.device.get(), &message);
    if (error == kOidnNoError) return true;
    if (error == kOidnCancelledError && stopped_) return false;
    throw RenderError("Open Image Denoise " + library_.version +
                      " failed: " + (message ? message : "error " + std::to_string(error)));
  }

  const OidnLibrary& library_;
  size_t width_;
  size_t height_;
  int memoryMb_;
  int runs_;
  int done_ = 0;
  bool stopped_ = false;
  const OidnProgress& progress_;
};

/// The library takes what is outside of a thin picture for black: its last rows and columns are repeated.
constexpr int kThinnest = 64;

Image atLeastAsLarge(const Image& image) {
  Image larger{std::max(image.width, kThinnest), std::max(image.height, kThinnest), image.channels, {}, {}};
  const size_t channels = image.channelCount();
  larger.values.reserve(size_t(larger.width) * size_t(larger.height) * channels);
  for (int y = 0; y < larger.height; ++y) {
    for (int x = 0; x < larger.width; ++x) {
      const size_t from =
          size_t(std::min(y, image.height - 1)) * size_t(image.width) + size_t(std::min(x, image.width - 1));
      const float* pixel = &image.values[from * channels];
      larger.values.insert(larger.values.end(), pixel, pixel + channels);
    }
  }
  return larger;
}

/// The first rows and columns.
Image cutTo(const Image& image, int width, int height) {
  Image part{width, height, image.channels, {}, {}};
  for (int y = 0; y < height; ++y) {
    const auto row =
        image.values.begin() + std::ptrdiff_t(size_t(y) * size_t(image.width) * image.channelCount());
    part.values.insert(part.values.end(), row, row + std::ptrdiff_t(size_t(width) * image.channelCount()));
  }
  return part;
}

/// Restores the pixels that show no surface, where the picture says which these are: they have no noise.
void keepBackground(Triples& output, const Triples& color, const Image& noisy) {
  const std::optional<size_t> coverage = findChannel(noisy, kGuideChannels[3]);
  if (!coverage) return;
  for (size_t i = 0, pixel = *coverage; i < output.size(); i += 3, pixel += noisy.channelCount()) {
    if (!(noisy.values[pixel] > 0.0f)) std::copy_n(&color[i], 3, &output[i]);
  }
}

/// Indices of a layer's three channels, and what stands before the layer's name: "ViewLayer.".
struct FoundLayer {
  std::array<size_t, 3> channels{};
  std::string prefix;
};

/// The channels of `stem`, such as "albedo" or "" for R, G and B themselves, with one of the two endings.
std::optional<std::array<size_t, 3>> channelsOf(const Image& file, const std::string& stem) {
  for (const std::string_view endings : {"RGB", "XYZ"}) {
    std::array<size_t, 3> indices{};
    bool complete = true;
    for (size_t c = 0; c < 3; ++c) {
      const auto index = findChannel(file, stem + (stem.empty() ? "" : ".") + endings[c]);
      complete = complete && index;
      indices[c] = index.value_or(0);
    }
    if (complete) return indices;
  }
  return std::nullopt;
}

/// The first layer, in the names' order, that is called so, after any prefix that ends in a dot.
std::optional<FoundLayer> findLayer(const Image& file, std::initializer_list<const char*> names) {
  for (const std::string_view name : names) {
    for (const std::string& channel : file.channels) {
      const std::string stem = channel.substr(0, channel.rfind('.'));
      if (stem.size() == channel.size() || !stem.ends_with(name)) continue;
      const std::string prefix = stem.substr(0, stem.size() - name.size());
      if (!prefix.empty() && !prefix.ends_with('.')) continue;
      if (const auto channels = channelsOf(file, stem)) return FoundLayer{*channels, prefix};
    }
  }
  return std::nullopt;
}

/// Does the same, but only after that prefix, or after any if the colours have none: they may be of one part
/// of an .exr, and the guides of others.
std::optional<FoundLayer> findGuide(const Image& file, const std::string& prefix,
                                    std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (const auto channels = channelsOf(file, prefix + name)) return FoundLayer{*channels, prefix};
  }
  return prefix.empty() ? findLayer(file, names) : std::nullopt;
}

std::optional<FoundLayer> findColor(const Image& file) {
  if (const auto own = findColorChannels(file)) return FoundLayer{*own, ""};
  return findLayer(file, {"Noisy Image", "Combined"});
}

/// The layers that are taken from a file, in the order of the result.
struct Taken {
  std::vector<std::string> from;  ///< channels of the file
  std::vector<std::string> names;

  void take(const std::string& channel, const std::string& name) {
    from.push_back(channel);
    names.push_back(name);
  }
  void takeLayer(const Image& file, const FoundLayer& layer, const std::array<const char*, 3>& as) {
    for (size_t c = 0; c < as.size(); ++c) take(file.channels[layer.channels[c]], as[c]);
  }
  bool has(const char* name) const { return std::ranges::find(names, name) != names.end(); }
};

/// 1 where a pixel shows a surface, also where it shows one only in part. That changes the light of a
/// filtered pixel by at most 0.3 % on average (docs/measurements/denoising.md).
Image coverageOf(const Image& file, size_t depth) {
  Image coverage{file.width, file.height, {"A"}, {}, {}};
  for (size_t first = 0; first < file.values.size(); first += file.channelCount())
    coverage.values.push_back(file.values[first + depth] > 0.0f ? 1.0f : 0.0f);
  return coverage;
}

}  // namespace

bool namesOidn(const std::filesystem::path& chosen) {
  return !chosen.empty() || !textOfVariable(kOidnVariable).empty();
}

OidnLibrary openOidn(const std::filesystem::path& chosen) {
  const auto start = std::chrono::steady_clock::now();
  const std::string byVariable = textOfVariable(kOidnVariable);
  OidnLibrary library = !chosen.empty()       ? openNamedOidn(chosen, "--oidn-library")
                        : !byVariable.empty() ? openNamedOidn(byVariable, kOidnVariable)
                                              : openAnyOidn();
  library.loadMs =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return library;
}

bool hasOidnGuides(const Image& picture) {
  return hasLayer(picture, kOidnAlbedo) && hasLayer(picture, kOidnNormal);
}

std::optional<Image> denoisedByOidn(const Image& noisy, const OidnLibrary& library, uint64_t memoryBytes,
                                    const OidnProgress& progress) {
  if (noisy.width < kThinnest || noisy.height < kThinnest) {
    const std::optional<Image> larger = denoisedByOidn(atLeastAsLarge(noisy), library, memoryBytes, progress);
    return larger ? std::optional(cutTo(*larger, noisy.width, noisy.height)) : std::nullopt;
  }
  const bool guided = hasOidnGuides(noisy);
  Triples color = triplesOf(noisy, kOidnColor);
  const std::optional<int> exponent = exponentOf(color);
  // The library would make light of it.
  if (!exponent) return Image{noisy.width, noisy.height, {"R", "G", "B"}, std::move(color), {}};
  Triples scaled = color;
  multiplyByPowerOfTwo(scaled, -*exponent);
  Triples output(color.size());
  OidnRuns runs(library, noisy.width, noisy.height, memoryBytes, guided ? 3 : 1, progress);
  if (guided) {
    // Guides that have noise of their own, as at edges, blur the picture unless they are filtered first.
    Triples albedo = triplesOf(noisy, kOidnAlbedo);
    Triples normal = triplesOf(noisy, kOidnNormal);
    if (!runs.run({{"albedo", albedo}}, albedo, false, false) ||
        !runs.run({{"normal", normal}}, normal, false, false) ||
        !runs.run({{"color", scaled}, {"albedo", albedo}, {"normal", normal}}, output, true, true))
      return std::nullopt;
  } else if (!runs.run({{"color", scaled}}, output, true, false)) {
    return std::nullopt;
  }
  for (size_t i = 0; i < output.size(); ++i) {
    output[i] = std::ldexp(output[i], *exponent);
    if (!std::isfinite(output[i])) output[i] = color[i];
  }
  keepBackground(output, color, noisy);
  return Image{noisy.width, noisy.height, {"R", "G", "B"}, std::move(output), {}};
}

Image layersForFilter(const Image& file) {
  const auto color = findColor(file);
  if (!color) return {file.width, file.height, {}, {}, file.attributes};
  Taken taken;
  taken.takeLayer(file, *color, {"R", "G", "B"});
  auto alpha = findChannel(file, "A");
  if (!alpha) alpha = findChannel(file, color->prefix + "Combined.A");
  if (alpha) taken.take(file.channels[*alpha], "A");
  for (const char* name : {"samples.Y", "variance.Y", kObservedChannel}) {
    if (findChannel(file, name)) taken.take(name, name);
  }
  for (const char* name : kGuideChannels) {
    if (findChannel(file, name)) taken.take(name, name);
  }
  const auto albedo = findGuide(file, color->prefix, {"Denoising Albedo", "albedo", "Albedo", "alb"});
  if (albedo && !taken.has(kGuideChannels[0]))
    taken.takeLayer(file, *albedo, {kGuideChannels[0], kGuideChannels[1], kGuideChannels[2]});
  const auto normal = findGuide(
      file, color->prefix,
      {"Denoising Normal", "normal", "sh_normal", "nn", "sn", "normals", "Ns", "N", "Normal", "geo_normal"});
  if (normal && !taken.has(kGuideChannels[4]))
    taken.takeLayer(file, *normal, {kGuideChannels[4], kGuideChannels[5], kGuideChannels[6]});
  if (findChannel(file, "depth.Z") && !taken.has(kGuideChannels[7])) taken.take("depth.Z", kGuideChannels[7]);
  const bool lacksCoverage = taken.has(kGuideChannels[7]) && !taken.has(kGuideChannels[3]);
  if (lacksCoverage && alpha) taken.take(file.channels[*alpha], kGuideChannels[3]);
  Image result = onlyChannels(file, taken.from);
  result.channels = taken.names;
  if (const auto depth = findChannel(result, kGuideChannels[7]); lacksCoverage && !alpha)
    appendChannels(result, coverageOf(result, *depth), {kGuideChannels[3]});
  return result;
}

}  // namespace fragtrace
