// SPDX-License-Identifier: MIT
#include "gltf/build/read_document.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <map>
#include <string_view>
#include <utility>

#include "gltf/build/animation.h"
#include "gltf/build/numbers.h"
#include "gltf/check/extensions.h"
#include "gltf/check/repairs.h"
#include "gltf/check/schema.h"
#include "gltf/codecs/compression.h"
#include "gltf/read/accessor.h"
#include "gltf/read/container.h"
#include "gltf/read/json.h"
#include "scene/parts.h"

namespace fragtrace {
namespace {

using nlohmann::json;

/// The array of that name; an empty one is made where there is none.
json& arrayIn(json& root, const char* name) {
  json& array = root[name];
  if (array.is_null()) array = json::array();
  return array;
}

void checkExtensions(json& root, const std::vector<std::string>& ignored, Diagnostics& diagnostics) {
  const json& required = arrayIn(root, "extensionsRequired");
  for (size_t i = 0; i < required.size(); ++i) {
    const auto& name = required[i].get_ref<const std::string&>();
    if (!isApplied(name) && std::ranges::find(ignored, name) == ignored.end()) {
      diagnostics.refuse(pointerTo("extensionsRequired", i),
                         "the extension " + inQuotes(name) +
                             " is required and not supported (--ignore-required draws the scene without it)");
    }
  }
  const json& used = arrayIn(root, "extensionsUsed");
  for (size_t i = 0; i < used.size(); ++i) {
    const auto& name = used[i].get_ref<const std::string&>();
    if (!isApplied(name)) {
      diagnostics.warn(pointerTo("extensionsUsed", i), "the extension " + inQuotes(name) + " is ignored");
    }
  }
}

/// Tells how far files have been read, as a part of the load from one to another.
ReadProgress tellReading(const GltfProgress& progress, const std::string& what, double from, double to) {
  if (!progress) return {};
  return [progress, what, from, to](uint64_t read, uint64_t size) {
    constexpr uint64_t kMegabyte = 1'000'000;
    constexpr uint64_t kWorthCounting = 32 * kMegabyte;
    std::string text = what;
    if (std::max(read, size) >= kWorthCounting) {
      text += ", " + std::to_string(read / kMegabyte);
      if (size > 0) text += " of " + std::to_string(size / kMegabyte);
      text += " MB";
    }
    progress(text, from + (to - from) * (size > 0 ? std::min(double(read) / double(size), 1.0) : 0.0));
  };
}

// Parts of a load, whose second half is the tree's (session/setup.cpp).
constexpr double kContainerPart = 0.2;
constexpr double kBuffersPart = 0.4;

/// The bytes of a buffer's URI.
std::vector<uint8_t> readBuffer(const std::string& uri, size_t index, size_t count, Document& document) {
  const std::string place = pointerTo("buffers", index, "uri");
  document.refersToFiles = document.refersToFiles || !isDataUri(uri);
  if (!isDataUri(uri)) document.made.buffers.push_back(pathOfUri(document.access, uri));
  const double step = (kBuffersPart - kContainerPart) / double(count);
  const double from = kContainerPart + double(index) * step;
  document.access.progress = tellReading(
      document.progress, "reading buffer " + std::to_string(index + 1) + " of " + std::to_string(count), from,
      from + step);
  std::vector<uint8_t> bytes =
      document.diagnostics.attempt(place, [&] { return readUri(document.access, uri, document.memory); });
  if (const std::string odd = oddityOf(document.access, uri); !odd.empty())
    document.diagnostics.warn(place, odd);
  takeMemory(document, place, bytes.size());
  return bytes;
}

/// The URIs of all buffers and pictures.
std::vector<std::string> urisOf(json& root) {
  std::vector<std::string> uris;
  for (const char* array : {"buffers", "images"}) {
    for (const json& one : arrayIn(root, array)) uris.push_back(one.value("uri", std::string()));
  }
  std::erase(uris, "");
  return uris;
}

/// Brings every buffer into memory, at most as long as the document says; one without URI stays empty, and so
/// does one that is lost.
Buffers readBuffers(json& root, Container& container, Worker& codecs, const IsUsed& isUsed,
                    Document& document) {
  Diagnostics& diagnostics = document.diagnostics;
  Buffers buffers;
  json& described = arrayIn(root, "buffers");
  for (size_t i = 0; i < described.size(); ++i) {
    json& buffer = described[i];
    const auto length = buffer["byteLength"].get<uint64_t>();
    std::vector<uint8_t>& bytes = buffers.emplace_back();
    if (length == 0 || (isFallback(buffer) && codecs.works())) continue;
    const std::string place = pointerTo("buffers", i);
    if (buffer.contains("uri")) {
      const auto& uri = buffer["uri"].get_ref<const std::string&>();
      try {
        bytes = readBuffer(uri, i, described.size(), document);
      } catch (const InputError& error) {
        if (isUsed(place)) throw InputError(error.what() + alsoMissing(document.access, urisOf(root), uri));
        diagnostics.warn(place + "/uri", "cannot be read, and nothing uses it");
        diagnostics.noteLost(place);
        continue;
      }
    } else if (i == 0 && container.hasBinary) {
      bytes = std::move(container.binary);
    } else {
      continue;  // an extension may bring it; bytesOf() loses what uses it
    }
    if (bytes.empty()) {
      const std::string than =
          length < kToTheEnd ? ", fewer than its byteLength of " + buffer["byteLength"].dump() : "";
      diagnostics.warnLoss(place, "holds 0 bytes" + than, "the buffer", isUsed(place));
      diagnostics.noteLost(place);
    }
    if (length == kToTheEnd) buffer["byteLength"] = bytes.size();
    bytes.resize(std::min<uint64_t>(bytes.size(), length));
  }
  return buffers;
}

/// Takes buffers with less data than the document says as they are.
void takeShortBuffers(json& root, const Buffers& data, const std::map<size_t, bool>& losesUsedView,
                      Diagnostics& diagnostics) {
  for (size_t i = 0; i < data.size(); ++i) {
    json& length = root["buffers"][i]["byteLength"];
    if (data[i].empty() || data[i].size() == length) continue;
    const std::string reason =
        "holds " + std::to_string(data[i].size()) + " bytes, fewer than its byteLength of " + length.dump();
    const auto loses = losesUsedView.find(i);
    if (loses == losesUsedView.end())
      diagnostics.warn(pointerTo("buffers", i), reason + "; what lies within them is read");
    else
      diagnostics.warnLoss(pointerTo("buffers", i), reason, "what lies past them", loses->second);
    length = data[i].size();
  }
}

/// Buffer views that reach past their buffer are lost. Takes out strides, of which tinygltf refuses some.
void checkBufferViews(json& root, const Buffers& data, const IsUsed& isUsed, Document& document) {
  Diagnostics& diagnostics = document.diagnostics;
  json& views = arrayIn(root, "bufferViews");
  const json& buffers = arrayIn(root, "buffers");
  std::map<size_t, bool> losesUsedView;  // by short buffer
  for (size_t i = 0; i < views.size(); ++i) {
    json& view = views[i];
    document.strides.push_back(view.value("byteStride", size_t(0)));
    view.erase("byteStride");
    const std::string place = pointerTo("bufferViews", i);
    const uint64_t offset = view.value("byteOffset", uint64_t(0));
    const auto buffer = view["buffer"].get<size_t>();
    const auto size = buffer < buffers.size() ? buffers[buffer]["byteLength"].get<uint64_t>() : 0;
    const uint64_t there = buffer < data.size() && !data[buffer].empty() ? data[buffer].size() : size;
    if (view["byteLength"] == kToTheEnd) view["byteLength"] = there - std::min(offset, there);
    const auto length = view["byteLength"].get<uint64_t>();
    const auto reachesPast = [&](uint64_t end) { return offset > end || length > end - offset; };
    const bool isTold = diagnostics.isLost(place) || diagnostics.isLost(pointerTo("buffers", buffer));
    if (!isTold && !reachesPast(there)) continue;
    if (!isTold && reachesPast(size))
      diagnostics.warnLoss(place,
                           std::to_string(length) + " bytes from byte " + std::to_string(offset) +
                               " reach past the " + std::to_string(size) + " of its buffer",
                           "the buffer view", isUsed(place));
    else if (!isTold)
      losesUsedView[buffer] = losesUsedView[buffer] || isUsed(place);
    diagnostics.noteLost(place);
    view["byteLength"] = 0;
    view["byteOffset"] = 0;
  }
  takeShortBuffers(root, data, losesUsedView, diagnostics);
}

/// Notes who made the file, and the names that the user may choose from.
void noteNames(json& root, Document& document) {
  const auto said = [&](const char* member) {
    const json& asset = root["asset"];
    return asset.contains(member) && asset[member].is_string() ? asset[member].get<std::string>() : "";
  };
  document.made.generator = said("generator");
  document.made.copyright = said("copyright");
  const json::json_pointer variants("/extensions/KHR_materials_variants/variants");
  document.sceneNames = namesOf(arrayIn(root, "scenes"));
  document.animationNames = namesOf(arrayIn(root, "animations"));
  for (const json& animation : arrayIn(root, "animations"))
    document.animationSeconds.push_back(durationOf(animation, arrayIn(root, "accessors")));
  if (root.contains(variants)) document.materialVariants = namesOf(root[variants]);
}

/// Notes where the pictures are, and gives tinygltf a name that leads nowhere, which it takes without
/// complaint.
std::vector<ImageSource> takeImages(json& root) {
  std::vector<ImageSource> sources;
  for (json& image : arrayIn(root, "images")) {
    sources.push_back({image.value("uri", std::string()), image.value("bufferView", -1),
                       image.value("mimeType", std::string())});
    image = {{"uri", "image"}};
  }
  return sources;
}

/// Gives tinygltf a number as the name of each buffer, behind which it finds our memory.
void nameBuffers(json& root, Buffers& memory) {
  json& buffers = arrayIn(root, "buffers");
  for (size_t i = 0; i < buffers.size(); ++i) {
    buffers[i]["uri"] = std::to_string(i);
    if (!memory[i].empty()) continue;
    memory[i].push_back(0);  // tinygltf refuses empty buffers
    buffers[i]["byteLength"] = 1;
  }
}

bool fileExists(const std::string& name, void*) {
  return name.find_first_not_of("0123456789") == std::string::npos;
}

std::string keepPath(const std::string& name, void*) { return name; }

bool takeBuffer(std::vector<unsigned char>* bytes, std::string*, const std::string& name, void* user) {
  size_t index = 0;
  std::from_chars(name.data(), name.data() + name.size(), index);
  *bytes = std::move(static_cast<Buffers*>(user)->at(index));
  return true;
}

/// Callbacks that read our memory, not files. tinygltf 2.9 has one member more than 2.8, and uses none of
/// them if one is null.
template <typename Callbacks = tinygltf::FsCallbacks>
Callbacks readFromMemory(Buffers& buffers) {
  Callbacks callbacks{};
  callbacks.FileExists = fileExists;
  callbacks.ExpandFilePath = keepPath;
  callbacks.ReadWholeFile = takeBuffer;
  callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
  };
  if constexpr (requires { callbacks.GetFileSizeInBytes; }) {
    callbacks.GetFileSizeInBytes = [](size_t* size, std::string*, const std::string&, void*) {
      *size = 0;  // tinygltf compares the size with a limit of its own; ours are checked already
      return true;
    };
  }
  callbacks.user_data = &buffers;
  return callbacks;
}

bool leaveImage(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int,
                void*) {
  return true;
}

/// tinygltf wants a buffer view for indices, which glTF does not (they are all 0, or sparse): each accessor
/// without one points past the others until it has been parsed.
class CoveredAccessors {
 public:
  explicit CoveredAccessors(json& root) : root_(root), noView_(arrayIn(root, "bufferViews").size()) {
    root["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 1}});
    for (json& accessor : arrayIn(root, "accessors")) accessor.emplace("bufferView", noView_);
  }

  void uncover(tinygltf::Model& model) {
    model.bufferViews.pop_back();
    for (tinygltf::Accessor& accessor : model.accessors) {
      if (size_t(accessor.bufferView) == noView_) accessor.bufferView = -1;
    }
    root_["bufferViews"].erase(noView_);
    for (json& accessor : root_["accessors"]) {
      if (accessor["bufferView"] == noView_) accessor.erase("bufferView");
    }
  }

 private:
  json& root_;
  size_t noView_;
};

tinygltf::Model parseModel(json& root, Buffers& buffers, const Diagnostics& diagnostics) {
  CoveredAccessors covered(root);
  const std::string text = root.dump();
  if (text.size() > std::numeric_limits<int32_t>::max()) diagnostics.refuse("", "the JSON is too large");
  tinygltf::TinyGLTF parser;
  parser.SetFsCallbacks(readFromMemory(buffers));
  parser.SetImageLoader(leaveImage, nullptr);
  tinygltf::Model model;
  std::string error;
  std::string warning;
  if (!parser.LoadASCIIFromString(&model, &error, &warning, text.data(), unsigned(text.size()), "")) {
    while (!error.empty() && error.back() == '\n') error.pop_back();
    std::replace(error.begin(), error.end(), '\n', ' ');
    diagnostics.refuse("", error.empty() ? "tinygltf cannot parse it" : error);
  }
  covered.uncover(model);
  return model;
}

/// The animations that the options play; says what is not played.
std::vector<const Animation*> playedAnimations(const KeptDocument& read, const SceneSelection& selection,
                                               Document& document) {
  if (!selection.animationTime && selection.animation.empty()) return {};
  std::vector<const Animation*> played;
  for (const size_t index : chosenAnimations(selection.animation, document.animationNames))
    played.push_back(&read.animations[index]);
  if (played.empty()) document.diagnostics.remark("", "has no animation that a time could be of");
  if (!played.empty() && selection.animation.empty() && read.animations.size() > 1)
    document.diagnostics.remark("/animations",
                                "not played: " + std::to_string(read.animations.size() - 1) + " of " +
                                    std::to_string(read.animations.size()) +
                                    " (--animation all plays all at once, --animation NAME another one)");
  return played;
}

/// Parses the JSON again, which has changed, so that readers of the model need not know of that.
void parseAgain(json& root, Document& document) {
  Buffers buffers;
  for (tinygltf::Buffer& buffer : document.model.buffers) buffers.push_back(std::move(buffer.data));
  document.model = parseModel(root, buffers, document.diagnostics);
}

/// A copy for a pose, which takes buffers and pictures with it.
Document lend(KeptDocument& kept) {
  std::vector<tinygltf::Buffer> buffers = std::move(kept.document.model.buffers);
  std::vector<ImageSource> images = std::move(kept.document.images);
  Document lent = kept.document;
  lent.model.buffers = std::move(buffers);
  lent.images = std::move(images);
  lent.keepsPictures = true;
  return lent;
}

}  // namespace

KeptDocument readDocument(const std::filesystem::path& path, const GltfOptions& options) {
  Document document(path.string(), options.limits);
  document.access = {path.parent_path(), options.limits.allowExternalFiles};
  document.progress = options.progress;
  Diagnostics& diagnostics = document.diagnostics;
  Container container =
      readContainer(path, options.limits.memoryBytes, diagnostics,
                    tellReading(options.progress, "reading the scene", 0.0, kContainerPart));
  takeMemory(document, "", container.binary.size());
  json root = parseJson(container.json, document.memory, diagnostics);
  container.json = std::string();
  checkMembers(root, diagnostics);
  checkVersions(root, diagnostics);
  supplyMembers(root, diagnostics);
  addLights(root, options.selection.lights, options.selection.up);
  const IsUsed isUsed = applySchema(root, options.selection, diagnostics);
  mendValues(root, isUsed, diagnostics);
  checkExtensions(root, options.limits.ignoredExtensions, diagnostics);
  noteNames(root, document);
  applySelection(root, options.selection, diagnostics);
  Worker codecs(kGeometryCodecs);
  Buffers buffers = readBuffers(root, container, codecs, isUsed, document);
  checkBufferViews(root, buffers, isUsed, document);
  document.access.progress = tellReading(options.progress, "reading textures", kBuffersPart, kBuffersPart);
  if (options.progress) options.progress("unpacking", kBuffersPart);
  decompressViews(root, buffers, codecs, document);
  decompressPrimitives(root, buffers, codecs, document);
  document.skins = takeSkins(root);
  std::vector<Animation> animations = takeAnimations(root);
  document.images = takeImages(root);
  nameBuffers(root, buffers);
  document.model = parseModel(root, buffers, diagnostics);
  return {std::move(document), std::move(root), std::move(animations)};
}

Document posed(KeptDocument& read, bool isKept, const GltfOptions& options) {
  Document document = isKept ? lend(read) : std::move(read.document);
  const SceneSelection& selection = options.selection;
  const std::vector<const Animation*> played = playedAnimations(read, selection, document);
  const bool changesText =
      !selection.set.empty() || std::ranges::any_of(played, [&](const Animation* animation) {
        return !drivesNodesAlone(*animation, read.root);
      });
  json changed;
  if (changesText) changed = isKept ? read.root : std::move(read.root);
  writeNumbers(changed, selection.set, document.diagnostics);
  // Where an animation is named without a time, the time is 0.
  const double seconds = selection.animationTime.value_or(0.0);
  for (const Animation* animation : played)
    applyAnimation(document, *animation, seconds, options.shutter, read.root,
                   changesText ? &changed : nullptr);
  if (changesText) parseAgain(changed, document);
  if (!isKept) read.root = {};
  return document;
}

void takeBack(Document& lent, KeptDocument& kept) {
  kept.document.model.buffers = std::move(lent.model.buffers);
  kept.document.images = std::move(lent.images);
}

}  // namespace fragtrace
