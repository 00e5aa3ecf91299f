// SPDX-License-Identifier: MIT
#include "session/picture/joined_parts.h"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <type_traits>

#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/text.h"
#include "base/vectors.h"
#include "image/channels.h"
#include "options/option_row.h"
#include "session/picture/denoising.h"
#include "session/shutter.h"

namespace fragtrace {

namespace {

constexpr const char* kSeed = "fragtrace:seed";
constexpr const char* kSampleOffset = "fragtrace:sampleOffset";
constexpr const char* kSamples = "fragtrace:samples";
constexpr const char* kUniform = "fragtrace:uniform";
constexpr const char* kRanges = "fragtrace:ranges";

std::string textOf(const Image& image, const char* name, const std::filesystem::path& path) {
  const auto found = image.attributes.find(name);
  if (found == image.attributes.end())
    throw InputError(path.string() + ": has no attribute " + name + "; only .exr files of `render` have");
  return found->second;
}

int64_t numberOf(const Image& image, const char* name, const std::filesystem::path& path) {
  const std::string text = textOf(image, name, path);
  const auto value = numberOfAll<int64_t>(text);
  if (!value || *value < 0)
    throw InputError(path.string() + ": attribute " + name + " is '" + text + "', no number from 0 on");
  return *value;
}

std::vector<SampleRange> rangesIn(const std::string& text, const std::filesystem::path& path) {
  std::vector<SampleRange> ranges;
  try {
    for (const nlohmann::json& range : nlohmann::json::parse(text)) {
      const auto [seed, first, count] = range.get<std::tuple<int64_t, int64_t, int64_t>>();
      if (seed < 0 || seed > UINT32_MAX || first < 0 || count < 1 || count > INT64_MAX - first)
        throw std::invalid_argument("a number is out of range");
      ranges.push_back({uint32_t(seed), first, count});
    }
    return joinedRanges(std::move(ranges));
  } catch (const std::exception& error) {
    throw InputError(path.string() + ": attribute " + kRanges + " is '" + text + "': " + error.what());
  }
}

nlohmann::ordered_json numbers(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

/// The features in a variant's name that another variant lacks.
std::string featuresOfOneAlone(const std::string& variant, const std::string& other) {
  const std::string all = "+" + other + "+";
  std::string text;
  for (const std::string_view part : splitText(variant, '+')) {
    const std::string feature(part);
    if (all.find("+" + feature + "+") == std::string::npos) text += (text.empty() ? "" : "+") + feature;
  }
  return text.empty() ? "none" : text;
}

/// The two values of one setting; for shader variants, the features that they do not share.
std::string bothValues(const std::string& key, const nlohmann::json& a, const nlohmann::json& b) {
  if (key != "variant" || !a.is_string() || !b.is_string()) return a.dump() + " and " + b.dump();
  return featuresOfOneAlone(a, b) + " and " + featuresOfOneAlone(b, a);
}

}  // namespace

std::string settingsText(const RenderOptions& options, const LoadedScene& loaded, const Tracer& tracer) {
  const Camera& camera = loaded.camera;
  nlohmann::ordered_json json;
  json["scene"] = options.scene.filename().string();
  json["scene_hash"] = formatted("%016" PRIx64, tracer.sceneHash);
  json["width"] = loaded.size.x;
  json["height"] = loaded.size.y;
  if (options.camera.region)
    json["region"] = {options.camera.region->corner.x, options.camera.region->corner.y,
                      options.camera.region->size.x, options.camera.region->size.y};
  // The traversal depends on the number of samples and changes only rounding. The kind of buffer reads and
  // the stage of the pipeline change nothing.
  ShaderVariant variant = tracer.variant;
  variant.traversal = ShaderVariant().traversal;
  variant.stackSize = ShaderVariant().stackSize;
  variant.literals.clear();
  variant.reads = BufferReads::Ssbo;
  variant.dispatch = Dispatch::Fragment;
  variant.wavefront = false;
  json["variant"] = variantName(variant);
  RenderOptions named = options;
  named.light.studio = isInStudio(options, loaded);
  for (const OptionRow& row : optionRows()) {
    if (row.traits.attribute != nullptr)
      std::visit([&](const auto& value) { json[row.traits.attribute] = value; }, row.value(named));
  }
  if (loaded.light.lampScale != 1.0) json["lamp_units"] = kLampUnitsNames[size_t(LampUnits::Radiometric)];
  json["background_color"] = nullptr;
  if (!loaded.view.showEnvironment)
    json["background_color"] = numbers(glm::dvec3(options.light.backgroundColor.value_or(glm::vec3(0.0f))));
  if (named.light.studio && options.light.studioLook != StudioLook::Soft)
    json["studio_look"] = kStudioLookNames[size_t(options.light.studioLook)];
  if (options.light.ground) json["ground"] = rowOf("--ground").words(options).front();
  if (options.light.shadowCatcher) json["shadow_catcher_height"] = loaded.view.catcherHeight;
  if (options.camera.lens.fStop) {
    json["lens_radius"] = loaded.view.lens.radius;
    json["focus_distance"] = loaded.view.lens.focusDistance;
    json["aperture_blades"] = options.camera.lens.blades;
  }
  json["camera_position"] = numbers(camera.position);
  json["camera_forward"] = numbers(camera.forward);
  json["camera_up"] = numbers(camera.up);
  json["camera_view"] = camera.type == CameraType::Orthographic ? -camera.halfHeight : camera.fovY;
  if (options.camera.shutter > 0.0) json["shutter_seconds"] = shutterSeconds(options);
  for (const auto& [middle, motion] : loaded.motion) {
    nlohmann::ordered_json& list = json["camera_motion"];
    for (const glm::dvec3& v :
         {middle.position, middle.forward, middle.up, motion.axis * motion.angle, motion.slide})
      list.push_back(numbers(v));
  }
  if (!isRectilinear(camera.type)) json["camera_type"] = kCameraTypeNames[size_t(camera.type)];
  if (camera.shift != glm::dvec2(0.0)) json["lens_shift"] = {camera.shift.x, camera.shift.y};
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string differenceOf(const std::string& settings, const std::string& others) {
  const auto a = nlohmann::json::parse(settings, nullptr, false);
  const auto b = nlohmann::json::parse(others, nullptr, false);
  if (!a.is_object() || !b.is_object()) return "they are not written as this version writes them";
  const auto differs = [&](const char* key) {
    return a.contains(key) && b.contains(key) && a[key] != b[key];
  };
  // A picture that noise or time ends has a number of samples that nobody has given.
  const bool endsElse = differs("noise") || differs("time");
  std::vector<std::string> differences;
  const auto add = [&](std::string key, const std::string& values) {
    if (key == "spp" && endsElse) return;
    std::ranges::replace(key, '_', ' ');
    differences.push_back(key + " " + values);
  };
  for (const auto& [key, value] : a.items()) {
    const auto other = b.find(key);
    if (other == b.end())
      add(key, value.dump() + " and none");
    else if (*other != value)
      add(key, bothValues(key, value, *other));
  }
  for (const auto& [key, value] : b.items()) {
    if (!a.contains(key)) add(key, "none and " + value.dump());
  }
  // Other settings mean nothing if the scene differs.
  if (differs("scene"))
    return "scene " + a["scene"].dump() + " and " + b["scene"].dump() +
           (differences.size() > 1 ? ", and " + countText(differences.size() - 1, "more setting") : "");
  return differences.empty() ? "of another version" : joined(differences);
}

std::optional<double> exposureOf(const Image& image) {
  const auto found = image.attributes.find(kExposureAttribute);
  const std::optional<double> stops =
      found == image.attributes.end() ? std::nullopt : numberOfAll<double>(found->second);
  return stops && std::isfinite(*stops) ? stops : std::nullopt;
}

namespace {

/// The ranges, or, if they are empty, those that follow from the other members.
std::vector<SampleRange> rangesOf(const Provenance& provenance) {
  if (!provenance.ranges.empty()) return provenance.ranges;
  return {{provenance.seed, provenance.sampleOffset, provenance.samples}};
}

constexpr const char* kSamplesChannel = "samples.Y";

/// The channels that only one picture has, separated by commas. The channel of numbers of samples is left
/// out.
std::string channelsOfOneAlone(const Image& a, const Image& b) {
  std::string names;
  for (const auto& [from, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    for (const std::string& channel : from->channels) {
      if (channel != kSamplesChannel && !findChannel(*other, channel))
        names += (names.empty() ? "" : ", ") + channel;
    }
  }
  return names;
}

/// Throws unless both belong to one picture and hold different samples.
void checkPair(const Part& first, const Part& second) {
  const std::string both = first.path.string() + " and " + second.path.string();
  if (first.image.width != second.image.width || first.image.height != second.image.height)
    throw InputError(both + ": differ in size");
  const std::string lone = channelsOfOneAlone(first.image, second.image);
  if (!lone.empty()) throw InputError(both + ": differ in layers, only one of them has " + lone);
  if (first.made.settings != second.made.settings)
    throw InputError(both + ": were made with different settings (of the first and of the second): " +
                     differenceOf(first.made.settings, second.made.settings));
  std::vector<SampleRange> ranges = rangesOf(first.made);
  const std::vector<SampleRange> others = rangesOf(second.made);
  ranges.insert(ranges.end(), others.begin(), others.end());
  try {
    joinedRanges(std::move(ranges));
  } catch (const std::invalid_argument& error) {
    throw InputError(both + ": overlap, they hold " + error.what());
  }
}

/// FilmPixel::luminance(), up to a constant. `alpha`: the channel, if the picture will be laid over white.
double luminanceOf(const float* pixel, std::optional<size_t> alpha) {
  return luminance({pixel[0], pixel[1], pixel[2]}) - (alpha ? double(pixel[*alpha]) : 0.0);
}

/// The parts' values at a place, and the number of samples that they represent.
struct Sources {
  std::vector<const float*> values;
  std::vector<double> samples;
  double total = 0.0;
};

/// The indices of channels in another picture.
std::vector<size_t> placesOf(const std::vector<std::string>& channels, const Image& image) {
  std::vector<size_t> places;
  places.reserve(channels.size());
  for (const std::string& channel : channels) places.push_back(findChannel(image, channel).value_or(0));
  return places;
}

double joinedVariance(const Sources& sources, const std::vector<double>& variances, double mean,
                      std::optional<size_t> alpha) {
  double m2 = 0.0;
  for (size_t i = 0; i < sources.values.size(); ++i) {
    const double n = sources.samples[i];
    const double apart = luminanceOf(sources.values[i], alpha) - mean;
    m2 += variances[i] * n * std::max(0.0, n - 1.0) + n * apart * apart;
  }
  return m2 / (sources.total * std::max(1.0, sources.total - 1.0));
}

double joinedObservation(const Sources& sources, const std::vector<double>& variances) {
  double squares = 0.0;
  for (size_t i = 0; i < variances.size(); ++i) {
    const double weight = sources.samples[i] / sources.total;
    squares += weight * weight * variances[i];
  }
  return squares;
}

/// The colour channels are the first three of every part.
Image joinedPicture(const std::vector<Part>& parts, bool withSamples) {
  Image result = parts.front().image;
  if (withSamples && !findChannel(result, kSamplesChannel)) {
    const Image counts{result.width,
                       result.height,
                       {"Y"},
                       std::vector<float>(size_t(result.width) * size_t(result.height)),
                       {}};
    appendChannels(result, counts, {kSamplesChannel});
  }
  const size_t channels = result.channelCount();
  const auto counts = findChannel(result, kSamplesChannel);
  const auto variance = findChannel(result, "variance.Y");
  const auto alpha = isOverWhite(result) ? findChannel(result, "A") : std::nullopt;
  const auto observed = findChannel(result, kObservedChannel);
  std::vector<std::vector<size_t>> places;
  std::vector<std::optional<size_t>> ownCounts;
  for (const Part& part : parts) {
    places.push_back(placesOf(result.channels, part.image));
    ownCounts.push_back(findChannel(part.image, kSamplesChannel));
  }
  Sources sources{std::vector<const float*>(parts.size()), std::vector<double>(parts.size()), 0.0};
  std::vector<double> own(parts.size());
  const size_t pixels = size_t(result.width) * size_t(result.height);
  for (size_t pixel = 0; pixel < pixels; ++pixel) {
    float* joined = &result.values[pixel * channels];
    sources.total = 0.0;
    for (size_t i = 0; i < parts.size(); ++i) {
      sources.values[i] = &parts[i].image.values[pixel * parts[i].image.channelCount()];
      sources.samples[i] = ownCounts[i] ? sources.values[i][*ownCounts[i]] : double(parts[i].made.samples);
      sources.total += sources.samples[i];
    }
    if (counts) joined[*counts] = float(sources.total);
    for (size_t c = 0; c < channels; ++c) {
      if (c == counts) continue;
      double sum = 0.0;
      for (size_t i = 0; i < parts.size(); ++i) {
        own[i] = sources.values[i][places[i][c]];
        sum += own[i] * sources.samples[i];
      }
      if (sources.total == 0.0)
        joined[c] = 0.0f;
      else if (c == observed)
        joined[c] = float(joinedObservation(sources, own));
      else if (c == variance)
        joined[c] =
            float(joinedVariance(sources, own, luminanceOf(joined, alpha), alpha));  // colours come first
      else
        joined[c] = float(sum / sources.total);
    }
  }
  return result;
}

/// Fewest, most and mean samples of a pixel.
struct Spread {
  double fewest = 0.0;
  double most = 0.0;
  double mean = 0.0;
};

Spread spreadOf(const Part& part) {
  const auto counts = findChannel(part.image, kSamplesChannel);
  const double all = double(part.made.samples);
  if (!counts) return {all, all, all};
  Spread spread{part.image.values[*counts], part.image.values[*counts], 0.0};
  double sum = 0.0;
  const size_t channels = part.image.channelCount();
  for (size_t i = *counts; i < part.image.values.size(); i += channels) {
    const double n = part.image.values[i];
    spread.fewest = std::min(spread.fewest, n);
    spread.most = std::max(spread.most, n);
    sum += n;
  }
  spread.mean = sum / (double(part.image.width) * part.image.height);
  return spread;
}

}  // namespace

void setProvenance(Image& image, const Provenance& provenance) {
  image.attributes[kSettingsAttribute] = provenance.settings;
  image.attributes[kSeed] = std::to_string(provenance.seed);
  image.attributes[kSampleOffset] = std::to_string(provenance.sampleOffset);
  image.attributes[kSamples] = std::to_string(provenance.samples);
  image.attributes[kUniform] = std::to_string(int(provenance.uniform));
  image.attributes.erase(kRanges);
  Provenance plain = provenance;
  plain.ranges.clear();
  if (provenance.ranges.empty() || provenance.ranges == rangesOf(plain)) return;
  auto json = nlohmann::json::array();
  for (const SampleRange& range : provenance.ranges) json.push_back({range.seed, range.first, range.count});
  image.attributes[kRanges] = json.dump();
}

std::vector<SampleRange> joinedRanges(std::vector<SampleRange> ranges) {
  std::sort(ranges.begin(), ranges.end());
  std::vector<SampleRange> joined;
  for (const SampleRange& range : ranges) {
    if (joined.empty() || joined.back().seed != range.seed ||
        joined.back().first + joined.back().count < range.first) {
      joined.push_back(range);
      continue;
    }
    if (joined.back().first + joined.back().count > range.first)
      throw std::invalid_argument("sample " + std::to_string(range.first) + " of seed " +
                                  std::to_string(range.seed) + " twice");
    joined.back().count += range.count;
  }
  return joined;
}

Provenance provenanceOf(const Image& image, const std::filesystem::path& path) {
  Provenance p;
  p.settings = textOf(image, kSettingsAttribute, path);
  p.seed = uint32_t(numberOf(image, kSeed, path));
  p.sampleOffset = numberOf(image, kSampleOffset, path);
  p.samples = numberOf(image, kSamples, path);
  p.uniform = numberOf(image, kUniform, path) != 0;
  if (image.attributes.contains(kRanges)) p.ranges = rangesIn(textOf(image, kRanges, path), path);
  return p;
}

Part readPart(const std::filesystem::path& path) {
  Part part{path, asDrawn(readStoredImage(path)), {}};
  if (holdsMattes(part.image))
    throw InputError(path.string() +
                     ": holds a Cryptomatte, whose numbers have no mean; render it to a file of its own "
                     "(--aov crypto-object, crypto-material)");
  part.made = provenanceOf(part.image, path);
  const bool counted = findChannel(part.image, kSamplesChannel).has_value();
  if (!part.made.uniform && !counted) {
    throw InputError(
        path.string() +
        ": its pixels differ in samples (adaptive or interrupted), and it has no layer samples.Y "
        "that says how many each has");
  }
  const Spread spread = spreadOf(part);
  if (!(spread.fewest >= 0.0 && spread.most <= double(INT32_MAX)))
    throw InputError(path.string() + ": its layer samples.Y holds no numbers of samples");
  if (part.made.samples < 1 && spread.most < 1.0) throw InputError(path.string() + ": holds no sample");
  if (!part.made.uniform && part.made.ranges.empty())
    part.made.ranges = {{part.made.seed, part.made.sampleOffset, int64_t(spread.most)}};
  return part;
}

Part joinedParts(std::vector<Part> parts) {
  std::sort(parts.begin(), parts.end(),
            [](const Part& a, const Part& b) { return rangesOf(a.made) < rangesOf(b.made); });
  for (size_t i = 0; i < parts.size(); ++i) {
    for (size_t j = 0; j < i; ++j) checkPair(parts[j], parts[i]);
  }
  const bool uniform = std::ranges::all_of(parts, [](const Part& part) { return part.made.uniform; });
  const bool counted = std::ranges::any_of(
      parts, [](const Part& part) { return findChannel(part.image, kSamplesChannel).has_value(); });
  Part joined{parts.front().path, joinedPicture(parts, counted), parts.front().made};
  std::vector<SampleRange> ranges;
  for (const Part& part : parts) {
    const std::vector<SampleRange> own = rangesOf(part.made);
    ranges.insert(ranges.end(), own.begin(), own.end());
  }
  joined.made.ranges = joinedRanges(std::move(ranges));
  joined.made.uniform = uniform;
  if (uniform) {
    joined.made.samples = 0;
    for (const Part& part : parts) joined.made.samples += part.made.samples;
  } else {
    joined.made.samples = std::llround(spreadOf(joined).mean);
  }
  setProvenance(joined.image, joined.made);
  joined.image.attributes.erase(kInterruptedAttribute);
  return joined;
}

std::string describeParts(size_t count, const Part& joined) {
  const Spread spread = spreadOf(joined);
  std::string all = countText(count, "part") + ", ";
  all += spread.fewest == spread.most ? countText(size_t(spread.most), "sample") + " per pixel"
                                      : formatted("%.0f to %.0f samples per pixel, %.1f on average",
                                                  spread.fewest, spread.most, spread.mean);
  const std::vector<SampleRange> ranges = rangesOf(joined.made);
  std::set<uint32_t> seeds;
  for (const SampleRange& range : ranges) seeds.insert(range.seed);
  if (seeds.size() > 1) all += ", of " + std::to_string(seeds.size()) + " sequences (seeds)";
  std::string missing;
  for (size_t i = 1; i < ranges.size(); ++i) {
    if (ranges[i].seed != ranges[i - 1].seed) continue;
    missing += (missing.empty() ? "" : ", ") + std::to_string(ranges[i - 1].first + ranges[i - 1].count) +
               " to " + std::to_string(ranges[i].first - 1);
    if (seeds.size() > 1) missing += " of seed " + std::to_string(ranges[i].seed);
  }
  return all + (missing.empty() ? "" : "; missing: samples " + missing);
}

}  // namespace fragtrace
