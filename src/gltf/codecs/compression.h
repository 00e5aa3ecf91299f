// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/worker.h"
#include "gltf/codecs/worker/decode.h"
#include "gltf/read/document.h"

namespace fragtrace {

// Replaces compressed geometry in the document by its decoded form, before anything reads it.

/// Returns true if a buffer only stands in for readers that cannot decode EXT_ or KHR_meshopt_compression.
bool isFallback(const nlohmann::json& buffer);

/// Decode all buffer views with EXT_ or KHR_meshopt_compression, and all primitives with
/// KHR_draco_mesh_compression. The document gets more buffers, buffer views and accessors. If the libraries
/// are missing and the file also holds the data uncompressed, these are used, with a warning. Throw
/// InputError.
void decompressViews(nlohmann::json& root, Buffers& buffers, Worker& codecs, Document& document);
void decompressPrimitives(nlohmann::json& root, Buffers& buffers, Worker& codecs, Document& document);

/// The libraries run in a worker process.
extern const WorkerKind kGeometryCodecs;

/// The decoded bytes, request.outputBytes of them. Throws std::runtime_error with the bare reason.
std::vector<uint8_t> decodeByProcess(Worker& codecs, const CodecRequest& request,
                                     std::span<const uint8_t> encoded);

}  // namespace fragtrace
