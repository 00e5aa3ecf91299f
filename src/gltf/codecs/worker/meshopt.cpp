// SPDX-License-Identifier: MIT
#include <meshoptimizer.h>

#include <stdexcept>
#include <string>

#include "gltf/codecs/worker/decode.h"

namespace fragtrace {
namespace {

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

}  // namespace

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

}  // namespace fragtrace
