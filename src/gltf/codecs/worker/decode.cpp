// SPDX-License-Identifier: MIT
#include "gltf/codecs/worker/decode.h"

#include <meshoptimizer.h>

#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include <draco/compression/decode.h>

#include "base/message.h"
#include "base/worker/module.h"

namespace fragtrace {

namespace {

void expect(bool condition, const std::string& reason) {
  if (!condition) throw std::runtime_error(reason);
}

/// Writes the values of all vertices as that type; returns the number of bytes written.
template <typename Component>
size_t writeValues(const draco::Mesh& mesh, const draco::PointAttribute& attribute, uint32_t components,
                   std::span<uint8_t> output) {
  const size_t size = components * sizeof(Component);
  std::array<Component, 4> value{};
  expect(components <= value.size() && output.size() >= size * mesh.num_points(), "has too many values");
  for (uint32_t i = 0; i < mesh.num_points(); ++i) {
    const draco::AttributeValueIndex index = attribute.mapped_index(draco::PointIndex(i));
    expect(index.value() < attribute.size() &&
               attribute.ConvertValue<Component>(index, int8_t(components), value.data()),
           "has values that do not fit the accessor's component type");
    std::memcpy(output.data() + i * size, value.data(), size);
  }
  return size * mesh.num_points();
}

size_t writeAttribute(const draco::Mesh& mesh, const CodecAttribute& wanted, std::span<uint8_t> output) {
  const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(wanted.id);
  expect(attribute != nullptr, "has no attribute " + std::to_string(wanted.id));
  expect(uint32_t(attribute->num_components()) == wanted.components,
         "has " + std::to_string(attribute->num_components()) + " components in attribute " +
             std::to_string(wanted.id) + ", not " + std::to_string(wanted.components) + " as its accessor");
  switch (wanted.componentType) {
    case 5120:
      return writeValues<int8_t>(mesh, *attribute, wanted.components, output);
    case 5121:
      return writeValues<uint8_t>(mesh, *attribute, wanted.components, output);
    case 5122:
      return writeValues<int16_t>(mesh, *attribute, wanted.components, output);
    case 5123:
      return writeValues<uint16_t>(mesh, *attribute, wanted.components, output);
    case 5125:
      return writeValues<uint32_t>(mesh, *attribute, wanted.components, output);
    default:
      return writeValues<float>(mesh, *attribute, wanted.components, output);
  }
}

std::unique_ptr<draco::Mesh> meshOf(std::span<const uint8_t> input) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(input.data()), input.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  expect(decoded.ok(), "cannot be decoded: " + decoded.status().error_msg_string());
  return std::move(decoded).value();
}

void countDraco(std::span<const uint8_t> input, std::span<uint8_t> output) {
  const std::unique_ptr<draco::Mesh> mesh = meshOf(input);
  const StreamCounts counts{mesh->num_points(), uint64_t(mesh->num_faces()) * 3};
  expect(output.size() == sizeof counts, "has no room for its counts");
  std::memcpy(output.data(), &counts, sizeof counts);
}

/// Decode into `output`, which they fill. Throw std::runtime_error if the bytes are not those of the request.
void decodeDraco(const CodecRequest& request, std::span<const uint8_t> input, std::span<uint8_t> output) {
  const std::unique_ptr<draco::Mesh> decoded = meshOf(input);
  const draco::Mesh& mesh = *decoded;
  expect(mesh.num_points() == request.count, "has " + std::to_string(mesh.num_points()) + " vertices, not " +
                                                 std::to_string(request.count) + " as its accessors");
  expect(uint64_t(mesh.num_faces()) * 3 == request.indexCount,
         "has " + std::to_string(mesh.num_faces()) + " triangles, not those of " +
             std::to_string(request.indexCount) + " indices as its accessor");
  size_t used = 0;
  for (uint32_t i = 0; i < mesh.num_faces(); ++i) {
    for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(i))) {
      const uint32_t index = corner.value();
      std::memcpy(output.data() + used, &index, sizeof index);
      used += sizeof index;
    }
  }
  for (uint32_t i = 0; i < request.attributeCount; ++i) {
    used += writeAttribute(mesh, request.attributes[i], output.subspan(used));
    used = (used + 3) / 4 * 4;
  }
}

int decode(const CodecRequest& request, std::span<const uint8_t> input, void* output) {
  switch (request.codec) {
    case Codec::MeshoptVertices:
      return meshopt_decodeVertexBuffer(output, request.count, request.stride, input.data(), input.size());
    case Codec::MeshoptTriangles:
      return meshopt_decodeIndexBuffer(output, request.count, request.stride, input.data(), input.size());
    default:
      return meshopt_decodeIndexSequence(output, request.count, request.stride, input.data(), input.size());
  }
}

std::string libraryText() {
  return "meshoptimizer " + std::to_string(MESHOPTIMIZER_VERSION / 1000) + "." +
         std::to_string(MESHOPTIMIZER_VERSION / 10 % 100);
}

/// Refuses a stream, and says its version if the library does not know it.
[[noreturn]] void refuse(const CodecRequest& request, std::span<const uint8_t> input) {
  constexpr uint8_t kVertices = 0xa0;  // the first byte of a stream; its lower half is the version
  const bool isVertices = request.codec == Codec::MeshoptVertices && !input.empty();
  const int version = isVertices && (input[0] & 0xf0) == kVertices ? input[0] & 0x0f : 0;
  if (version == 0) throw std::runtime_error("the compressed data are broken");
  throw std::runtime_error(
      "the stream has version " + std::to_string(version) + ", and " + libraryText() +
      ", the library here, could not decode it; it reads version 0, as gltfpack writes it "
      "for EXT_meshopt_compression");
}

void decodeColors(const CodecRequest& request, std::span<uint8_t> output) {
#if MESHOPTIMIZER_VERSION >= 250
  meshopt_decodeFilterColor(output.data(), request.count, request.stride);
#else
  static_cast<void>(request);
  static_cast<void>(output);
  throw std::runtime_error("the filter COLOR needs meshoptimizer 0.25, and the library here is " +
                           libraryText());
#endif
}

void decodeMeshopt(const CodecRequest& request, std::span<const uint8_t> input, std::span<uint8_t> output) {
  if (decode(request, input, output.data()) != 0) refuse(request, input);
  switch (request.filter) {
    case MeshoptFilter::None:
      return;
    case MeshoptFilter::Octahedral:
      return meshopt_decodeFilterOct(output.data(), request.count, request.stride);
    case MeshoptFilter::Quaternion:
      return meshopt_decodeFilterQuat(output.data(), request.count, request.stride);
    case MeshoptFilter::Color:
      return decodeColors(request, output);
    case MeshoptFilter::Exponential:
      return meshopt_decodeFilterExp(output.data(), request.count, request.stride);
  }
}

}  // namespace

// The worker's module for compressed geometry.

extern "C" void fragtraceWork(std::span<const uint8_t> input, WorkOutput& output) {
  if (input.empty()) return;
  const auto request = takeMessage<CodecRequest>(input);
  if (request.codec == Codec::Draco)
    decodeDraco(request, input, output.room);
  else if (request.codec == Codec::DracoCounts)
    countDraco(input, output.room);
  else
    decodeMeshopt(request, input, output.room);
  output.used = output.room.size();
}

}  // namespace fragtrace
