// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "gltf/codecs/worker/messages.h"

namespace fragtrace {

/// Decode into `output`, which they fill. Throw std::runtime_error when the bytes are not what was asked for.
void decodeDraco(const CodecRequest& request, std::span<const uint8_t> input, std::span<uint8_t> output);
void decodeMeshopt(const CodecRequest& request, std::span<const uint8_t> input, std::span<uint8_t> output);

}  // namespace fragtrace
