// SPDX-License-Identifier: MIT
#include "base/errors.h"
#include "options/option_row.h"
#include "options/row_makers.h"

namespace fragtrace {

namespace {

constexpr OptionTraits kOfMap{.effect = Effect::Picture, .renewal = Renewal::Scene};

OptionTraits named(const char* attribute) {
  OptionTraits traits = kOfMap;
  traits.attribute = attribute;
  return traits;
}

OptionRow timeRow() {
  OptionRow row =
      word("--sun-time",
           "put the sun of --sky where it stands at this time, seen from --sun-place: ISO 8601 with "
           "its offset, as 2026-06-21T14:30+02:00",
           FRAGTRACE_MEMBER(light.sky.time), named("sun_time"), "TIME");
  row.examples = {"2026-06-21T14:30:00+02:00"};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    const auto take = [](RenderOptions& o, const std::string& text) {
      if (daysOf(text + "Z"))
        throw UsageError("--sun-time: '" + text + "' has no offset from universal time, as " + text +
                         "+02:00 or " + text + "Z has");
      if (!daysOf(text))
        throw UsageError(
            "--sun-time: '" + text +
            "' is no time with its offset as ISO 8601 writes it, such as 2026-06-21T14:30+02:00");
      o.light.sky.time = text;
    };
    addWord(app, r, raw, take, "TIME");
  };
  row.words = [](const RenderOptions& o) { return std::vector<std::string>{o.light.sky.time}; };
  row.value = [](const RenderOptions& o) { return AttributeValue(o.light.sky.time); };
  return row;
}

glm::dvec2 placeOf(const std::vector<double>& values) {
  if (std::abs(values[0]) > 90.0) throw UsageError("--sun-place: the latitude is not within -90 and 90");
  if (std::abs(values[1]) > 180.0) throw UsageError("--sun-place: the longitude is not within -180 and 180");
  return {values[0], values[1]};
}

}  // namespace

std::vector<OptionRow> skyRows() {
  return {
      flag("--sky",
           "light the scene with a clear sky and its sun; north is -Z, and --hdri-rotation turns both",
           FRAGTRACE_MEMBER(light.sky.on), named("sky")),
      number<double>("--sun-elevation",
                     "height of the sun of --sky above the horizon, in degrees; negative after sunset",
                     FRAGTRACE_MEMBER(light.sky.sun.elevation), {-90.0, 90.0}, named("sun_elevation")),
      number<double>("--sun-azimuth",
                     "direction to the sun of --sky, in degrees clockwise from north: 90 is east (+X)",
                     FRAGTRACE_MEMBER(light.sky.sun.azimuth), {-360.0, 360.0},
                     {.effect = Effect::Picture, .attribute = "sun_azimuth"}),
      timeRow(),
      numbers<double>(
          "--sun-place", "LAT,LON of --sun-time: latitude and longitude in degrees, north and east positive",
          FRAGTRACE_MEMBER(light.sky.place), 2, placeOf,
          [](const glm::dvec2& p) { return numbersText(p.x, p.y); }, {"52.52,13.405"}, kOfMap),
      number<double>("--sky-turbidity", "haze in the air of --sky: 1 has none, 3 is a clear day, 10 is hazy",
                     FRAGTRACE_MEMBER(light.sky.turbidity), {1.0, 10.0}, named("sky_turbidity")),
      number<double>("--ground-albedo",
                     "part of the light that the ground below the sky of --sky reflects, which is seen below "
                     "the horizon",
                     FRAGTRACE_MEMBER(light.sky.groundAlbedo), {0.0, 1.0}, named("ground_albedo")),
  };
}

}  // namespace fragtrace
