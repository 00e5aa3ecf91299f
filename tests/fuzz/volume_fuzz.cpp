// SPDX-License-Identifier: MIT
// A grid of a NanoVDB file, behind its header: what the worker makes of it, and what the program makes of
// that.
#include <cstring>
#include <stdexcept>
#include <vector>

#include "scene/volume/decode.h"
#include "scene/volume/read_grid.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace fragtrace;
  std::vector<uint64_t> grid((size + 7) / 8);
  if (size > 0) std::memcpy(grid.data(), data, size);
  std::vector<uint8_t> room(1 << 16);
  WorkOutput output{room};
  try {
    decodeGrid({reinterpret_cast<uint8_t*>(grid.data()), size}, output);
    gridOfAnswer(std::span(room).first(output.used));
  } catch (const std::runtime_error&) {  // NOLINT: what a broken grid is to bring
  }
  try {
    gridOfAnswer({data, size});
  } catch (const std::runtime_error&) {  // NOLINT
  }
  return 0;
}
