// SPDX-License-Identifier: MIT
#pragma once

#include <bitset>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace fragtrace {

/// A set of members of an enumeration that ends with Count. Sets have an order, so that they can stand in a
/// key whose comparison is defaulted.
template <typename Member>
struct SetOf : std::bitset<size_t(Member::Count)> {
  using Bits = std::bitset<size_t(Member::Count)>;

  using Bits::Bits;
  SetOf(const Bits& bits) : Bits(bits) {}  // NOLINT(google-explicit-constructor): what its operators return

  std::strong_ordering operator<=>(const SetOf& other) const {
    return this->to_string() <=> other.to_string();
  }
};

// The stages and switches: one table row each, which the parser, the statistics, the shader prelude and the
// documents iterate over.

/// The kind of change that a change of an option or a stage makes.
enum class Effect : uint8_t {
  Report,   ///< messages, files next to the picture, or whether a picture is allowed
  Method,   ///< the way in which the same samples are drawn: their time and rounding
  Layers,   ///< content of a file next to the picture
  Count,    ///< number of samples
  Display,  ///< processing of finished samples
  Noise,    ///< choice of samples; their mean stays
  View,     ///< the point of view
  Picture   ///< the limit to which samples converge
};

enum class Trait : uint8_t;  // shader/traits.h

/// A stage (in the order of --stage) or a switch of its own.
enum class Stage : uint8_t {
  Flat,
  Phong,
  Shadows,
  Reflections,
  Refraction,
  NormalMaps,
  Gi,
  Schlick,
  EnergyCompensation,
  Sobol,
  LightSampling,
  Watertight,
  Count
};
using StageSet = SetOf<Stage>;

struct StageRow {
  Stage stage;
  const char* name;              ///< on the command line
  const char* label;             ///< the name in the viewer
  const char* sentence;          ///< the sentence in the help
  bool cumulative;               ///< --stage NAME turns on this and all cumulative rows before it
  bool standard;                 ///< a switch that is on unless turned off
  const char* constant;          ///< constant in the shader; null: always on
  std::optional<Trait> needs{};  ///< the stage changes nothing without this trait
  Effect effect = Effect::Picture;
};
std::span<const StageRow> stageRows();

/// The stage that the command line calls by this name.
std::optional<Stage> parseStage(std::string_view name);

/// The stages and switches that --stage NAME turns on: the stages up to it, and the switches that are on by
/// default.
StageSet stagesUpTo(Stage stage);

/// The set with the stages up to that one, and its switches as they are.
StageSet withStagesUpTo(StageSet set, Stage stage);

template <typename Set, typename Member>
bool has(const Set& set, Member member) {
  return set.test(size_t(member));
}

}  // namespace fragtrace
