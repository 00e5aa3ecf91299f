// SPDX-License-Identifier: MIT
#include "options/light_words.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "base/errors.h"
#include "base/near_name.h"
#include "base/text.h"
#include "options/numbers.h"
#include "options/row_makers.h"

namespace fragtrace {

namespace {

constexpr double kMostMetres = 1e9;
constexpr double kMostStrength = 1e9;
const std::vector<std::string> kOfSun{"from", "strength", "color"};
const std::vector<std::string> kOfArea{"at", "to", "size", "power", "color"};

[[noreturn]] void refuse(const std::string& what) { throw UsageError("--add-light: " + what); }

/// The numbers of NAME=VALUES: `least` to `most` of them, each within the bound.
std::vector<double> valuesOf(const std::string& name, const std::string& text, size_t least, size_t most,
                             double bound) {
  std::vector<double> values;
  for (const std::string& part : CLI::detail::split(text, ',')) {
    const std::optional<double> value = numberIn(part);
    if (!value || !(std::abs(*value) <= bound))
      refuse(name + ": '" + part + "' is no number from " + shortText(-bound) + " to " + shortText(bound));
    values.push_back(*value);
  }
  if (values.size() < least || values.size() > most)
    refuse(name + " takes " + countText(most, "number") + ", not " + std::to_string(values.size()));
  return values;
}

double positive(const std::string& name, double value) {
  if (!(value > 0.0)) refuse(name + ": is not above 0");
  return value;
}

void take(const std::string& name, const std::string& text, AddedLight& light) {
  const auto values = [&](size_t count, double bound) { return valuesOf(name, text, count, count, bound); };
  const auto vector = [&](double bound) {
    const std::vector<double> v = values(3, bound);
    return glm::dvec3(v[0], v[1], v[2]);
  };
  if (name == "from") {
    const std::vector<double> v = values(2, 360.0);
    if (std::abs(v[1]) > 90.0) refuse("from: the elevation is not between -90 and 90 degrees");
    light.from = {v[0], v[1]};
  } else if (name == "at") {
    light.at = vector(kMostMetres);
  } else if (name == "to") {
    light.target = vector(kMostMetres);
  } else if (name == "size") {
    const std::vector<double> v = valuesOf(name, text, 1, 2, kMostMetres);
    light.size = {positive(name, v.front()), positive(name, v.back())};
  } else if (name == "color") {
    light.color = colorIn("--add-light: color", text, kMostStrength);
    if (light.color == glm::dvec3(0.0)) refuse("color: is black");
  } else {
    light.strength = positive(name, values(1, kMostStrength)[0]);
  }
}

}  // namespace

AddedLight addedLightIn(const std::string& text) {
  std::istringstream words(text);
  std::string kind;
  words >> kind;
  if (kind != "sun" && kind != "area") refuse("'" + kind + "' is none of area, sun");
  AddedLight light{.isSun = kind == "sun"};
  if (!light.isSun) light.strength = kAreaPower;
  const std::vector<std::string>& known = light.isSun ? kOfSun : kOfArea;
  std::vector<std::string> given;
  for (std::string word; words >> word;) {
    const size_t equals = std::min(word.find('='), word.size());
    const std::string name = word.substr(0, equals);
    if (std::ranges::find(known, name) == known.end())
      refuse("'" + name + "' is none of " + joined(known) + " of " + kind + didYouMean(name, known));
    if (equals + 1 >= word.size()) refuse(name + ": its value is missing, as in " + name + "=1");
    take(name, word.substr(equals + 1), light);
    given.push_back(name);
  }
  if (!light.isSun && std::ranges::find(given, "at") == given.end())
    refuse("area: its place is missing, as in \"area at=0,2,1\"");
  if (!light.isSun && light.target == light.at) refuse("to: is the place of the light itself");
  return light;
}

std::string textOf(const AddedLight& light) {
  const auto vector = [](const glm::dvec3& v) { return numbersText(v.x, v.y, v.z); };
  std::string text = light.isSun ? "sun from=" + numbersText(light.from.x, light.from.y) +
                                       " strength=" + exactText(light.strength)
                                 : "area at=" + vector(light.at);
  if (light.target) text += " to=" + vector(*light.target);
  if (!light.isSun)
    text += " size=" + numbersText(light.size.x, light.size.y) + " power=" + exactText(light.strength);
  if (light.color != glm::dvec3(1.0)) text += " color=" + vector(light.color);
  return text;
}

}  // namespace fragtrace
