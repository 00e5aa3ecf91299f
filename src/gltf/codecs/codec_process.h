// SPDX-License-Identifier: MIT
// Runs the libraries of compressed geometry in a worker process.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/worker.h"
#include "gltf/codecs/worker/decode.h"

namespace fragtrace {

extern const WorkerKind kGeometryCodecs;

/// The decoded bytes, request.outputBytes of them. Throws std::runtime_error with the bare reason.
std::vector<uint8_t> decodeByProcess(Worker& codecs, const CodecRequest& request,
                                     std::span<const uint8_t> encoded);

}  // namespace fragtrace
