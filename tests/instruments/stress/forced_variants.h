// SPDX-License-Identifier: MIT
// A scene's variant with something turned on again that it was cut down by: what does leaving it out save?
#pragma once

#include <string>
#include <vector>

#include "shader/variant.h"

namespace fragtrace {

struct ForcedVariant {
  std::string name;  ///< name of the trait, or of the other feature that is turned on
  ShaderVariant variant;
  bool otherSamples = false;  ///< it chooses lights otherwise, so its noise is another
  std::string whyNot;         ///< why it cannot be drawn; empty: it can
};

/// One for every trait that the chosen variant lacks, with those it brings (a texture:
/// coordinates); then all of
/// these that can be drawn together ("all traits"), the largest stack, and paths that can be suspended. The
/// variant of the scene itself is none of them.
std::vector<ForcedVariant> forcedVariants(const RenderOptions& options, const TraitSet& present,
                                          Surroundings surroundings, uint32_t treeDepth, BufferReads reads);

}  // namespace fragtrace
