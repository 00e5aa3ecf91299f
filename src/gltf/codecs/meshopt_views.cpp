// SPDX-License-Identifier: MIT
// EXT_meshopt_compression and its successor, KHR_meshopt_compression, which has one more filter and a second
// version of the streams of vertices.
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "gltf/codecs/compression.h"

namespace fragtrace {
namespace {

using nlohmann::json;

constexpr std::string_view kExt = "EXT_meshopt_compression";
constexpr std::string_view kKhr = "KHR_meshopt_compression";

const json* viewExtension(const json& object, std::string_view name) {
  const auto extensions = object.find("extensions");
  if (extensions == object.end() || !extensions->is_object()) return nullptr;
  const auto extension = extensions->find(std::string(name));
  return extension != extensions->end() ? &*extension : nullptr;
}

/// The members of both extensions that an object has.
struct Meshopt {
  std::string_view name = kExt;
  const json* object = nullptr;  ///< none
};

Meshopt meshoptOf(const json& object) {
  const json* khr = viewExtension(object, kKhr);
  return khr != nullptr ? Meshopt{kKhr, khr} : Meshopt{kExt, viewExtension(object, kExt)};
}

std::optional<Codec> codecNamed(const std::string& mode) {
  if (mode == "ATTRIBUTES") return Codec::MeshoptVertices;
  if (mode == "TRIANGLES") return Codec::MeshoptTriangles;
  if (mode == "INDICES") return Codec::MeshoptIndices;
  return std::nullopt;
}

std::optional<MeshoptFilter> filterNamed(const std::string& filter, bool isKhr) {
  if (filter == "NONE") return MeshoptFilter::None;
  if (filter == "OCTAHEDRAL") return MeshoptFilter::Octahedral;
  if (filter == "QUATERNION") return MeshoptFilter::Quaternion;
  if (filter == "EXPONENTIAL") return MeshoptFilter::Exponential;
  if (filter == "COLOR" && isKhr) return MeshoptFilter::Color;
  return std::nullopt;
}

/// Checks the strides and counts that the extension demands and that the library takes for granted.
void checkSizes(const CodecRequest& request, const std::string& place, const Diagnostics& diagnostics) {
  constexpr uint64_t kLargestStride = 256;
  const uint64_t stride = request.stride;
  const bool isStride = request.codec == Codec::MeshoptVertices
                            ? stride > 0 && stride <= kLargestStride && stride % 4 == 0
                            : stride == 2 || stride == 4;
  const bool fitsFilter = request.filter == MeshoptFilter::None ||
                          (request.codec == Codec::MeshoptVertices &&
                           (request.filter == MeshoptFilter::Exponential || stride == 8 ||
                            (request.filter != MeshoptFilter::Quaternion && stride == 4)));
  if (!isStride) {
    diagnostics.lose(place + "/byteStride", std::to_string(stride) + " is no stride that its mode can have");
  }
  if (!fitsFilter) diagnostics.lose(place + "/filter", "does not go with its mode or its byteStride");
  if (request.count == 0) diagnostics.lose(place + "/count", "is 0");
  if (request.codec == Codec::MeshoptTriangles && request.count % 3 != 0)
    diagnostics.lose(place + "/count", std::to_string(request.count) + " is no multiple of 3");
}

CodecRequest requestOf(const json& extension, bool isKhr, uint64_t viewBytes, const std::string& place,
                       const Diagnostics& diagnostics) {
  const auto& mode = extension["mode"].get_ref<const std::string&>();
  const std::string filter = extension.value("filter", std::string("NONE"));
  if (!codecNamed(mode)) diagnostics.lose(place + "/mode", inQuotes(mode) + " is no mode");
  if (!filterNamed(filter, isKhr)) diagnostics.lose(place + "/filter", inQuotes(filter) + " is no filter");
  CodecRequest request;
  request.codec = *codecNamed(mode);
  request.filter = *filterNamed(filter, isKhr);
  request.count = extension["count"].get<uint64_t>();
  request.stride = extension["byteStride"].get<uint64_t>();
  request.outputBytes = viewBytes;
  checkSizes(request, place, diagnostics);
  // The check divides instead of multiplying, so that no count is large enough to wrap around.
  if (viewBytes % request.stride != 0 || viewBytes / request.stride != request.count) {
    diagnostics.lose(place + "/count", "times byteStride is not the " + std::to_string(viewBytes) +
                                           " bytes of the buffer view");
  }
  return request;
}

std::span<const uint8_t> encodedBytes(const json& extension, const Buffers& buffers, const std::string& place,
                                      const Diagnostics& diagnostics) {
  const auto buffer = extension["buffer"].get<size_t>();
  diagnostics.need(pointerTo("buffers", buffer));
  const std::vector<uint8_t>& bytes = buffers[buffer];
  const uint64_t offset = extension.value("byteOffset", uint64_t(0));
  const auto length = extension["byteLength"].get<uint64_t>();
  if (offset > bytes.size() || length > bytes.size() - offset) {
    diagnostics.lose(place, std::to_string(length) + " bytes from byte " + std::to_string(offset) +
                                " reach past the " + std::to_string(bytes.size()) + " of its buffer");
  }
  return std::span(bytes).subspan(offset, length);
}

}  // namespace

bool isFallback(const json& buffer) {
  const json* extension = meshoptOf(buffer).object;
  return extension != nullptr && extension->value("fallback", false);
}

namespace {

/// Replaces a view by its decoded bytes, in a buffer of its own.
void decompressView(json& root, size_t index, Buffers& buffers, Worker& codecs, Document& document) {
  json& view = root["bufferViews"][index];
  const auto [name, extension] = meshoptOf(view);
  const std::string place = pointerTo("bufferViews", index, "extensions", name);
  Diagnostics& diagnostics = document.diagnostics;
  const CodecRequest request =
      requestOf(*extension, name == kKhr, view["byteLength"].get<uint64_t>(), place, diagnostics);
  const std::span<const uint8_t> encoded = encodedBytes(*extension, buffers, place, diagnostics);
  takeMemory(document, place, 2 * request.outputBytes);
  std::vector<uint8_t> decoded =
      diagnostics.attemptObject(place, [&] { return decodeByProcess(codecs, request, encoded); });
  view["buffer"] = buffers.size();
  view["byteOffset"] = 0;
  root["buffers"].push_back({{"byteLength", decoded.size()}});
  buffers.push_back(std::move(decoded));
}

}  // namespace

void decompressViews(json& root, Buffers& buffers, Worker& codecs, Document& document) {
  Diagnostics& diagnostics = document.diagnostics;
  for (size_t i = 0; i < root["bufferViews"].size(); ++i) {
    json& view = root["bufferViews"][i];
    const auto [name, extension] = meshoptOf(view);
    if (extension == nullptr || view["byteLength"] == 0) continue;
    const std::string place = pointerTo("bufferViews", i, "extensions", name);
    if (name == kKhr && viewExtension(view, kExt) != nullptr)
      diagnostics.warn(place, "stands beside " + std::string(kExt) + ", which is ignored");
    if (!codecs.works()) {
      if (buffers[view["buffer"].get<size_t>()].empty())
        diagnostics.refuse(place, std::string(name) + " cannot be decoded: " + codecs.whyNot());
      diagnostics.warn(place, "cannot be decoded, the uncompressed data are taken: " + codecs.whyNot());
      continue;
    }
    const auto decode = [&] {
      decompressView(root, i, buffers, codecs, document);
      return true;
    };
    if (diagnostics.keepRest("the buffer view", decode)) continue;
    diagnostics.noteLost(pointerTo("bufferViews", i));
    root["bufferViews"][i]["byteLength"] = 0;
  }
}

}  // namespace fragtrace
