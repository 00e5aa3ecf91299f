// SPDX-License-Identifier: MIT
// Refusals and warnings of the loader: one line each, with the file, the place as a JSON pointer, and the
// reason.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <set>
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

/// The reason why an object of the file cannot be read. It costs that object alone: keepRest() catches it.
struct Loss : InputError {
  Loss(const std::string& line, std::string_view lostPlace, std::string_view lostReason)
      : InputError(line), place(lostPlace), reason(lostReason) {}

  std::string place, reason;
  bool isTold = false;  ///< what it follows from has been told
};

/// Names the file in every message, and collects the warnings. Control characters become question marks.
/// The rule of what costs what: what has one obvious reading is read so, with a warn(). What has none costs
/// its own object: lose(), inside a keepRest(). The file is refused where a reference is broken in something
/// that is used, or where memory or another folder is at stake, and at the end if losses leave nothing to
/// draw. What nothing uses is never a reason.
class Diagnostics {
 public:
  explicit Diagnostics(std::string file) : file_(std::move(file)) {}

  /// From now on, errors at this place, or at a place that holds it, are reported as errors of --set.
  void noteSet(std::string place) { set_.push_back(std::move(place)); }

  /// Throws InputError "FILE: PLACE: REASON"; an empty place is left out. Throws UsageError "--set: PLACE:
  /// REASON" where the user has set a number there.
  [[noreturn]] void refuse(std::string_view place, std::string_view reason) const;

  /// Throws a Loss, or UsageError as refuse() does.
  [[noreturn]] void lose(std::string_view place, std::string_view reason) const;

  /// Runs an action for an object, such as "the primitive". Returns nothing, with a warning, if it is lost.
  template <typename Action>
  auto keepRest(const char* object, const Action& action) -> std::optional<decltype(action())> {
    try {
      return action();
    } catch (const Loss& loss) {
      if (!loss.isTold) warnLoss(loss.place, loss.reason, object);
      return std::nullopt;
    }
  }

  /// Warns that an object is left out for that reason. firstLoss() does not count one that nothing uses.
  void warnLoss(std::string_view place, std::string_view reason, const std::string& object,
                bool isUsed = true);

  /// Notes that the object at a place is lost, so that what needs it is lost without a further warning.
  void noteLost(std::string place) { lost_.insert(std::move(place)); }
  bool hasLost() const { return !lost_.empty(); }
  bool isLost(std::string_view place) const { return lost_.contains(place); }

  /// Throws a Loss that keepRest() does not tell if that object is lost.
  void need(std::string_view place) const;

  /// The message of the first object that was lost, which refuses a file of which nothing is left.
  const std::optional<std::string>& firstLoss() const { return firstLoss_; }

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

  /// Runs an action as attempt() does; the reason loses that place instead, unless it is AtStake.
  template <typename Action>
  auto attemptObject(std::string_view place, const Action& action) const {
    try {
      return action();
    } catch (const InputError&) {
      throw;
    } catch (const AtStake& error) {
      refuse(place, error.what());
    } catch (const std::runtime_error& error) {
      lose(place, error.what());
    }
  }

  /// Notes something that is skipped or repaired. The same reason at several places, but for its numbers and
  /// quoted names, makes one line with a count and the first places.
  void warn(std::string_view place, std::string_view reason, size_t count = 1);

  /// Notes something that follows from the user's options, and is no fault of the file.
  void remark(std::string_view place, std::string_view reason);

  /// One line for each reason, in the order of their first appearance; remarks, too, unless only faults are
  /// asked for.
  std::vector<std::string> warnings(bool onlyFaults = false) const;

  const std::string& file() const { return file_; }

 private:
  struct Warning {
    std::string reason;
    std::vector<std::string> places;  ///< the first few
    size_t placeCount = 0;
    size_t count = 0;
    bool isRemark = false;
  };
  std::string line(std::string_view place, std::string_view reason) const;
  void throwIfSet(std::string_view place, std::string_view reason) const;

  std::string file_;
  std::vector<std::string> set_;  ///< places of the user's numbers
  std::vector<Warning> warnings_;
  std::unordered_map<std::string, size_t> warningOf_;  ///< index of a warning by its kind
  std::optional<std::string> firstLoss_;
  std::set<std::string, std::less<>> lost_;  ///< places of objects
};

}  // namespace fragtrace
