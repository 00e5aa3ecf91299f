// SPDX-License-Identifier: MIT
// The libraries of compressed geometry in a process of their own, fragtrace_codecs: what hostile data make
// them do is limited in memory and time, and a run that needs none of them does not load them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gltf/codecs/worker/messages.h"
#include "process/child.h"
#include "process/shared_memory.h"

namespace fragtrace {

class CodecProcess {
 public:
  /// Whether there is one that works; the first call starts it. It is looked for in the folder
  /// FRAGTRACE_LIBRARY_PATH, then beside the executable.
  bool available();
  const std::string& whyNot() const { return whyNot_; }

  /// The decoded bytes, request.outputBytes of them. Throws std::runtime_error with the bare reason.
  std::vector<uint8_t> decode(const CodecRequest& request, std::span<const uint8_t> encoded);

 private:
  /// The memory that was shared, whose end is the output. Throws std::runtime_error where no reply comes.
  std::unique_ptr<SharedMemory> exchange(CodecRequest request, std::span<const uint8_t> encoded,
                                         CodecReply& reply);

  std::unique_ptr<Child> child_;
  std::string whyNot_;
};

}  // namespace fragtrace
