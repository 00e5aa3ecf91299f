// SPDX-License-Identifier: MIT
// Refusals and warnings of the loader: one line each, with the file, the place as a JSON pointer, and the
// reason.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "scene/parts.h"

namespace fragtrace {

/// A name as a part of a JSON pointer: ~ and / are escaped (RFC 6901).
std::string escapedForPointer(std::string_view name);

/// Joins names and indices to a JSON pointer: pointerTo("meshes", 0, "primitives") is "/meshes/0/primitives".
template <typename... Parts>
std::string pointerTo(const Parts&... parts) {
  std::string pointer;
  const auto append = [&pointer](const auto& part) {
    pointer += '/';
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(part)>>) {
      pointer += std::to_string(part);
    } else {
      pointer += escapedForPointer(part);
    }
  };
  (append(parts), ...);
  return pointer;
}

/// Names the file in every message, and collects the warnings. Control characters become question marks.
class Diagnostics {
 public:
  explicit Diagnostics(std::string file) : file_(std::move(file)) {}

  /// From now on, errors at this place, or at a place that holds it, are reported as errors of --set.
  void noteSet(std::string place) { set_.push_back(std::move(place)); }

  /// Throws InputError "FILE: PLACE: REASON"; an empty place is left out. Throws UsageError "--set: PLACE:
  /// REASON" where the user has set a number there.
  [[noreturn]] void refuse(std::string_view place, std::string_view reason) const;

  /// Runs an action; a std::runtime_error of it is the reason to refuse that place.
  template <typename Action>
  auto attempt(std::string_view place, const Action& action) const {
    try {
      return action();
    } catch (const InputError&) {
      throw;
    } catch (const std::runtime_error& error) {
      refuse(place, error.what());
    }
  }

  /// Notes something that is skipped or repaired. The same reason at several places makes one line with a
  /// count and the first place.
  void warn(std::string_view place, std::string_view reason, size_t count = 1);

  /// One line for each reason, in the order of their first appearance.
  std::vector<std::string> warnings() const;

  const std::string& file() const { return file_; }

 private:
  struct Warning {
    std::string reason;
    std::vector<std::string> places;  ///< the first few
    size_t placeCount = 0;
    size_t count = 0;
  };
  std::string line(std::string_view place, std::string_view reason) const;

  std::string file_;
  std::vector<std::string> set_;  ///< places of the user's numbers
  std::vector<Warning> warnings_;
  std::unordered_map<std::string, size_t> warningOf_;  ///< index of a warning by its reason
};

}  // namespace fragtrace
