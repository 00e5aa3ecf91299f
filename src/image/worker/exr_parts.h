// SPDX-License-Identifier: MIT
// A multipart .exr as one picture.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace fragtrace {

struct ExrPart {
  std::string name;
  std::vector<std::string> channels;
};

/// The indices of the parts, that of the picture's colour first: the first part that is called by its layer a
/// beauty pass, else the first that has R, G and B, else the first.
std::vector<size_t> orderOfParts(const std::vector<ExrPart>& parts);

/// The names of all channels, part by part in that order. Those of the first part stay. A name without a
/// layer gets that of its part in front of it elsewhere, and so does a name that is there already, which
/// makes each name one of its own: "depth.Z".
std::vector<std::string> channelsOfParts(const std::vector<ExrPart>& parts, const std::vector<size_t>& order);

}  // namespace fragtrace
