// SPDX-License-Identifier: MIT
// The name that was most likely meant by one that does not exist.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fragtrace {

/// The most similar name; empty if more than a third of the letters differ.
std::string nearestName(std::string_view unknown, const std::vector<std::string>& known);

/// The indices of the names: first those that hold the unknown one, then by how similar they are, whatever
/// the case of letters is.
std::vector<size_t> nearestFirst(std::string_view unknown, const std::vector<std::string>& known);

/// "; did you mean NAME?" for the end of a message; empty if no name is near.
std::string didYouMean(std::string_view unknown, const std::vector<std::string>& known);

}  // namespace fragtrace
