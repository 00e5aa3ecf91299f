// SPDX-License-Identifier: MIT
#include "session/picture/provenance.h"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "base/errors.h"
#include "base/split.h"
#include "base/text.h"
#include "options/option_row.h"
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

namespace {

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

std::vector<SampleRange> rangesOf(const Provenance& provenance) {
  if (!provenance.ranges.empty()) return provenance.ranges;
  return {{provenance.seed, provenance.sampleOffset, provenance.samples}};
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

}  // namespace fragtrace
