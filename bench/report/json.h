// SPDX-License-Identifier: MIT
// Results as JSON, with members in the order in which they were set.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace fragtrace {

using Json = nlohmann::ordered_json;

/// On one line, which ends. Bytes that are no UTF-8 are replaced.
inline std::string jsonLine(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace fragtrace
