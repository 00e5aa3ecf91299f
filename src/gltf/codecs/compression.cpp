// SPDX-License-Identifier: MIT
#include "gltf/codecs/compression.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "advice.h"
#include "base/message.h"
#include "gltf/read/accessor.h"
#include "scene/scene.h"

namespace fragtrace {

const WorkerKind kGeometryCodecs{"libfragtrace_geometry.so", "the library that decodes it", kCodecAdvice, ""};

std::vector<uint8_t> decodeByProcess(Worker& codecs, const CodecRequest& request,
                                     std::span<const uint8_t> encoded) {
  // Draco's tables of corners take some hundred bytes for a triangle whose output is 24 bytes.
  constexpr uint64_t kLibraries = uint64_t(256) << 20;
  constexpr uint64_t kOfAByte = 64;
  constexpr uint64_t kBytesASecond = 5'000'000;
  const uint64_t bytes = encoded.size() + request.outputBytes;
  const WorkResult result = codecs.perform(
      {asMessage(request), encoded}, request.outputBytes,
      {.memoryBytes = kLibraries + kOfAByte * bytes, .cpuSeconds = unsigned(2 + bytes / kBytesASecond)});
  return {result.output.begin(), result.output.end()};
}

// KHR_draco_mesh_compression.

namespace {

using nlohmann::json;

constexpr const char* kExtension = "KHR_draco_mesh_compression";

uint64_t paddedTo4(uint64_t bytes) { return (bytes + 3) / 4 * 4; }

/// One primitive: the request to the library, and the accessors that its answer replaces.
class PrimitiveDecoder {
 public:
  PrimitiveDecoder(json& root, json& primitive, std::string place, Document& document)
      : root_(root),
        primitive_(primitive),
        extension_(primitive["extensions"][kExtension]),
        place_(std::move(place)),
        document_(document) {}

  /// Returns true if the file also holds all of it uncompressed.
  bool hasFallback() const {
    for (const auto& attribute : compressed().items()) {
      const auto accessor = primitive_["attributes"].find(attribute.key());
      if (accessor == primitive_["attributes"].end() || !hasView(*accessor)) return false;
    }
    return primitive_.contains("indices") && hasView(primitive_["indices"]);
  }

  /// The extension's schema requires at least one attribute; some files have none, but accessors with data.
  bool isEmpty() const { return compressed().empty(); }

  void takeOwnData() {
    bool isWhole = !primitive_.contains("indices") || hasData(primitive_["indices"]);
    for (const auto& attribute : primitive_["attributes"].items())
      isWhole = isWhole && hasData(attribute.value());
    if (!isWhole) lose("/attributes", "is empty, and not all of the primitive's own accessors have data");
    document_.diagnostics.warn(place_ + "/attributes", "is empty; the primitive's own data are taken");
  }

  void decode(Buffers& buffers, Worker& codecs) {
    makeRequest();
    const std::span<const uint8_t> encoded = encodedBytes(buffers);
    const auto attempt = [&] {
      takeMemory(document_, place_, 2 * request_.outputBytes);
      return decodeByProcess(codecs, request_, encoded);
    };
    std::vector<uint8_t> decoded = document_.diagnostics.attemptObject(place_, [&] {
      try {
        return attempt();
      } catch (const InputError&) {
        throw;
      } catch (const std::runtime_error&) {
        if (!takeCounts(codecs, encoded)) throw;
        return attempt();
      }
    });
    putDecoded(buffers.size());
    root_["buffers"].push_back({{"byteLength", decoded.size()}});
    buffers.push_back(std::move(decoded));
  }

 private:
  [[noreturn]] void lose(const std::string& part, const std::string& reason) const {
    document_.diagnostics.lose(place_ + part, reason);
  }

  /// The attributes that the stream holds, by their ids.
  const json& compressed() const {
    static const json kNone = json::object();
    return extension_.contains("attributes") ? extension_["attributes"] : kNone;
  }

  bool hasData(const json& index) const { return hasView(index) || accessorOf(index).contains("sparse"); }

  /// Takes the stream's counts where the accessors have others. Returns false where they have not.
  bool takeCounts(Worker& codecs, std::span<const uint8_t> encoded) {
    CodecRequest question;
    question.codec = Codec::DracoCounts;
    question.outputBytes = sizeof(StreamCounts);
    const std::vector<uint8_t> answer = decodeByProcess(codecs, question, encoded);
    StreamCounts counts;
    std::memcpy(&counts, answer.data(), std::min(answer.size(), sizeof counts));
    if (std::max(counts.vertices, counts.indices) >= kMissIndex ||
        (counts.vertices == request_.count && counts.indices == request_.indexCount))
      return false;
    request_.count = counts.vertices;
    request_.indexCount = counts.indices;
    request_.outputBytes = counts.indices * sizeof(uint32_t);
    for (size_t i = 0; i < request_.attributeCount; ++i) request_.outputBytes += paddedTo4(bytesOf(i));
    document_.diagnostics.warn(place_, "has other counts than its accessors; those of the stream are taken");
    return true;
  }

  /// The decoded bytes of an attribute.
  uint64_t bytesOf(size_t attribute) const {
    const CodecAttribute& one = request_.attributes[attribute];
    return request_.count * one.components * componentSize(one.componentType);
  }

  bool hasView(const json& index) const { return accessorOf(index).contains("bufferView"); }

  const json& accessorOf(const json& index) const { return root_["accessors"][index.get<size_t>()]; }

  uint64_t countOf(const json& index) const {
    document_.diagnostics.need(pointerTo("accessors", index.get<size_t>()));
    const auto count = accessorOf(index)["count"].get<uint64_t>();
    if (count >= kMissIndex) lose("", "has an accessor with too many elements");
    return count;
  }

  void makeRequest() {
    constexpr int kTriangles = 4;
    if (primitive_.value("mode", kTriangles) < kTriangles)
      lose("", "compresses triangles, which the primitive's mode has none of");
    request_.codec = Codec::Draco;
    request_.indexCount = primitive_.contains("indices") ? countOf(primitive_["indices"]) : 0;
    request_.outputBytes = request_.indexCount * sizeof(uint32_t);
    for (const auto& attribute : compressed().items())
      addAttribute(attribute.key(), attribute.value().get<uint32_t>());
    if (names_.empty()) lose("/attributes", "has no attribute of the primitive");
  }

  void addAttribute(const std::string& name, uint32_t id) {
    const std::string part = pointerTo("attributes", name);
    if (!primitive_["attributes"].contains(name))
      return document_.diagnostics.warn(place_ + part, "is no attribute of the primitive, and ignored");
    if (request_.attributeCount == kMostCodecAttributes) lose("/attributes", "has too many attributes");
    const json& index = primitive_["attributes"][name];
    const auto& type = accessorOf(index)["type"].get_ref<const std::string&>();
    const uint32_t components = type == "SCALAR"          ? 1
                                : type.starts_with("VEC") ? uint32_t(type.back() - '0')
                                                          : 0;
    if (components == 0) lose(part, "has an accessor that is neither of scalars nor of vectors");
    if (names_.empty()) request_.count = countOf(index);
    const auto component = accessorOf(index)["componentType"].get<uint32_t>();
    request_.attributes[request_.attributeCount++] = {id, component, components};
    request_.outputBytes += paddedTo4(bytesOf(request_.attributeCount - 1));
    names_.push_back(name);
  }

  std::span<const uint8_t> encodedBytes(const Buffers& buffers) const {
    if (!extension_.contains("bufferView")) lose("", "\"bufferView\" is missing");
    const auto index = extension_["bufferView"].get<size_t>();
    document_.diagnostics.need(pointerTo("bufferViews", index));
    const json& view = root_["bufferViews"][index];
    const auto buffer = view["buffer"].get<size_t>();
    if (buffer >= buffers.size() || buffers[buffer].empty())
      lose("/bufferView", "is of a buffer without data");
    return std::span(buffers[buffer])
        .subspan(view.value("byteOffset", uint64_t(0)), view["byteLength"].get<uint64_t>());
  }

  /// Adds an accessor like the given one, at those bytes of the buffer; returns its index.
  size_t addAccessor(json accessor, uint64_t count, size_t buffer, uint64_t offset, uint64_t length) {
    root_["bufferViews"].push_back({{"buffer", buffer}, {"byteOffset", offset}, {"byteLength", length}});
    accessor["bufferView"] = root_["bufferViews"].size() - 1;
    accessor["count"] = count;
    accessor.erase("byteOffset");
    accessor.erase("sparse");
    root_["accessors"].push_back(std::move(accessor));
    return root_["accessors"].size() - 1;
  }

  /// Primitives that are not compressed may share accessors with it, so the primitive gets its own.
  void putDecoded(size_t buffer) {
    constexpr int kTriangles = 4;
    json indices = {{"componentType", kUnsignedInt}, {"type", "SCALAR"}, {"count", request_.indexCount}};
    uint64_t offset = request_.indexCount * sizeof(uint32_t);
    primitive_["indices"] = addAccessor(std::move(indices), request_.indexCount, buffer, 0, offset);
    primitive_["mode"] = kTriangles;
    for (size_t i = 0; i < names_.size(); ++i) {
      const uint64_t length = bytesOf(i);
      json& index = primitive_["attributes"][names_[i]];
      index = addAccessor(accessorOf(index), request_.count, buffer, offset, length);
      offset += paddedTo4(length);
    }
  }

  json& root_;
  json& primitive_;
  const json& extension_;
  std::string place_;
  Document& document_;
  CodecRequest request_;
  std::vector<std::string> names_;
};

}  // namespace

namespace {

void decompressPrimitive(json& root, json& primitive, const std::string& place, Buffers& buffers,
                         Worker& codecs, Document& document) {
  PrimitiveDecoder decoder(root, primitive, place, document);
  if (decoder.isEmpty()) {
    decoder.takeOwnData();
  } else if (codecs.works()) {
    decoder.decode(buffers, codecs);
  } else if (decoder.hasFallback()) {
    document.diagnostics.warn(place,
                              "cannot be decoded, the uncompressed data are taken: " + codecs.whyNot());
  } else {
    document.diagnostics.refuse(place, std::string(kExtension) + " cannot be decoded: " + codecs.whyNot());
  }
}

}  // namespace

void decompressPrimitives(json& root, Buffers& buffers, Worker& codecs, Document& document) {
  if (!root.contains("meshes")) return;
  for (size_t m = 0; m < root["meshes"].size(); ++m) {
    json& primitives = root["meshes"][m]["primitives"];
    for (size_t i = 0; i < primitives.size(); ++i) {
      const json::json_pointer extension(pointerTo("extensions", kExtension));
      if (!primitives[i].contains(extension)) continue;
      const std::string place = pointerTo("meshes", m, "primitives", i, "extensions", kExtension);
      const auto decode = [&] {
        decompressPrimitive(root, primitives[i], place, buffers, codecs, document);
        return true;
      };
      if (document.diagnostics.keepRest("the primitive", decode)) continue;
      document.diagnostics.noteLost(pointerTo("meshes", m, "primitives", i));
      primitives[i] = {{"attributes", json::object()}};
    }
  }
}

// EXT_meshopt_compression and its successor, KHR_meshopt_compression, which has one more filter and a second
// version of the streams of vertices.

namespace {

constexpr std::string_view kExt = "EXT_meshopt_compression";
constexpr std::string_view kKhr = "KHR_meshopt_compression";

/// The members of both extensions that an object has.
struct Meshopt {
  std::string_view name;
  const json& object;  ///< null: none
};

Meshopt meshoptOf(const json& object) {
  const json& khr = extensionOf(object, kKhr);
  return khr.is_object() ? Meshopt{kKhr, khr} : Meshopt{kExt, extensionOf(object, kExt)};
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

bool isFallback(const json& buffer) { return memberOf(meshoptOf(buffer).object, "fallback") == true; }

namespace {

/// Replaces a view by its decoded bytes, in a buffer of its own.
void decompressView(json& root, size_t index, Buffers& buffers, Worker& codecs, Document& document) {
  json& view = root["bufferViews"][index];
  const auto [name, extension] = meshoptOf(view);
  const std::string place = pointerTo("bufferViews", index, "extensions", name);
  Diagnostics& diagnostics = document.diagnostics;
  const CodecRequest request =
      requestOf(extension, name == kKhr, view["byteLength"].get<uint64_t>(), place, diagnostics);
  const std::span<const uint8_t> encoded = encodedBytes(extension, buffers, place, diagnostics);
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
    if (!extension.is_object() || view["byteLength"] == 0) continue;
    const std::string place = pointerTo("bufferViews", i, "extensions", name);
    if (name == kKhr && extensionOf(view, kExt).is_object())
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
