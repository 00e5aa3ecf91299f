// SPDX-License-Identifier: MIT
#include <meshoptimizer.h>

#include <stdexcept>

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

}  // namespace

void decodeMeshopt(const CodecRequest& request, std::span<const uint8_t> input, std::span<uint8_t> output) {
  if (decode(request, input, output.data()) != 0) throw std::runtime_error("the compressed data are broken");
  switch (request.filter) {
    case MeshoptFilter::None:
      return;
    case MeshoptFilter::Octahedral:
      return meshopt_decodeFilterOct(output.data(), request.count, request.stride);
    case MeshoptFilter::Quaternion:
      return meshopt_decodeFilterQuat(output.data(), request.count, request.stride);
    case MeshoptFilter::Exponential:
      return meshopt_decodeFilterExp(output.data(), request.count, request.stride);
  }
}

}  // namespace fragtrace
