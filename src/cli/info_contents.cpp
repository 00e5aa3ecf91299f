// SPDX-License-Identifier: MIT
#include "cli/info_contents.h"

#include <algorithm>
#include <array>
#include <set>
#include <system_error>

#include "base/errors.h"
#include "base/text.h"
#include "session/file_light.h"

namespace fragtrace {

namespace {

constexpr std::array kLampTypes{"point", "spot", "directional"};

/// "2 lamps", "1 material that shines"; empty for none.
std::string counted(size_t count, const char* one, const char* more) {
  return count == 0 ? "" : std::to_string(count) + " " + (count == 1 ? one : more);
}

/// Returns true if the picture is a file of its own.
bool isFile(const EncodedImage& image) { return image.name != image.place && !image.place.empty(); }

}  // namespace

std::vector<const Material*> materialsOf(const Scene& scene) {
  std::vector<const Material*> once;
  std::set<decltype(Material::number)> numbers;
  for (const Material& material : scene.materials)
    if (numbers.insert(material.number).second) once.push_back(&material);
  return once;
}

std::vector<TextureContents> texturesOf(const Scene& scene, const Material& material) {
  std::vector<TextureContents> found;
  for (const TextureRefRow& row : kTextureRefs) {
    const TextureRef& reference = material.*row.ref;
    if (!reference.present()) continue;
    const uint32_t index = scene.textures[reference.texture].image;
    if (index == kMissIndex) continue;
    const EncodedImage& image = scene.images[index];
    const std::string file = std::filesystem::path(image.name).filename().string();
    found.push_back({row.name, isFile(image) ? file : image.name, image.width, image.height});
  }
  return found;
}

std::vector<LampContents> lampsOf(const Scene& scene) {
  std::vector<LampContents> lamps;
  for (const Light& light : scene.lights) {
    const double intensity = scene.lightSources[light.source].intensity;
    lamps.push_back({light.node, kLampTypes[size_t(light.type)], intensity,
                     light.type == LightType::Directional ? "lx" : "cd"});
  }
  return lamps;
}

std::vector<FileContents> filesOf(const std::filesystem::path& path, const Scene& scene) {
  std::vector<std::filesystem::path> paths{path};
  paths.insert(paths.end(), scene.made.buffers.begin(), scene.made.buffers.end());
  for (const EncodedImage& image : scene.images) {
    if (isFile(image)) paths.emplace_back(image.name);
  }
  std::vector<FileContents> files;
  for (const std::filesystem::path& file : paths) {
    std::error_code error;
    const uint64_t bytes = std::filesystem::file_size(file, error);
    const bool isNew = std::ranges::find(files, file.string(), &FileContents::name) == files.end();
    if (!error && isNew) files.push_back({file.string(), bytes});
  }
  return files;
}

WhoLights whoLights(const RenderOptions& options, const Scene& scene) {
  FileLight file;
  try {
    file = fileLightOf(options, scene, nullptr, nullptr);
  } catch (const InputError&) {  // a texture that shines and is broken
    return {"unknown", "not known, since a texture that shines cannot be decoded"};
  }
  const OwnLight light = countedLight(options, file);
  if (light == OwnLight::Enough) {
    const auto shining =
        std::ranges::count_if(materialsOf(scene), [](const Material* m) { return m->emissive(); });
    std::vector<std::string> own{counted(scene.lights.size(), "lamp", "lamps"),
                                 counted(size_t(shining), "material that shines", "materials that shine")};
    std::erase(own, "");
    return {"own", "its own: " + joined(own, " and ")};
  }
  const bool studio = options.light.defaultLight == DefaultLight::Studio;
  return {std::string(kDefaultLightNames[size_t(options.light.defaultLight)]),
          defaultLightReason(options, file) + ": `render` adds " +
              (studio ? "the studio" : "a white environment") + " (--default-light)"};
}

std::string bytesText(uint64_t bytes) {
  if (bytes < 1000) return countText(size_t(bytes), "byte");
  return bytes < 1'000'000 ? formatted("%.0f kB", double(bytes) / 1e3)
                           : formatted("%.1f MB", double(bytes) / 1e6);
}

}  // namespace fragtrace
