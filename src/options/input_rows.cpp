// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/errors.h"
#include "base/text.h"
#include "gltf/edit/factors.h"
#include "image/display/page_color.h"
#include "options/option_row.h"
#include "options/parse_render.h"
#include "options/row_makers.h"
#include "scene/camera.h"

namespace fragtrace {

namespace {

/// Sets what a picture on standard output is called, too.
OptionRow outputRow() {
  OptionRow row = memberRow(
      "--output",
      "picture to write: .png .jpg (tone-mapped, sRGB), .exr .hdr .pfm (linear radiance); of --frames and "
      "--turntable also a video, which ffmpeg encodes: .mp4 .webm .gif, or .mov (ProRes with alpha, for "
      "editing); '-' writes to standard output (--format), and nothing else goes there; required",
      FRAGTRACE_MEMBER(output.file), {.effect = Effect::Report, .kept = true, .group = OptionGroup::File});
  row.examples = {"it's-1.exr"};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    app.add_option_function<std::string>(
           "-o,--output", [&raw](const std::string& file) { raw.options.output.file = file; }, r.help)
        ->type_name("FILE");
  };
  row.words = [](const RenderOptions& o) {
    return std::vector<std::string>{o.output.toStandardOutput ? "-" : placeOf(o.output).string()};
  };
  row.copy = [](RenderOptions& to, const RenderOptions& from) {
    to.output.file = from.output.file;
    to.output.place = from.output.place;
    to.output.toStandardOutput = from.output.toStandardOutput;
  };
  return row;
}

OptionRow timeRow() {
  OptionRow row = memberRow(
      "--animation-time",
      "pose the scene at this time of its animation, in seconds; by default the scene is not animated",
      FRAGTRACE_MEMBER(selection.animationTime), {.effect = Effect::Picture, .renewal = Renewal::Pose});
  row.examples = {"0", "1.2500000000000002"};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    app.add_option(r.name, raw.options.selection.animationTime, r.help)->check(realNumberFrom(0.0));
  };
  row.words = [](const RenderOptions& o) { return std::vector{exactText(*o.selection.animationTime)}; };
  return row;
}

/// A list of texts, of which each is given by an option of its own.
template <typename Member>
OptionRow listRow(const char* name, std::string help, Member member, const char* example, const char* type,
                  Renewal renewal = Renewal::Scene) {
  OptionRow row = memberRow(name, std::move(help), member, {.effect = Effect::Picture, .renewal = renewal});
  row.examples = {example};
  row.add = [member, type](CLI::App& app, const OptionRow& r, RawRender& raw) {
    app.add_option(r.name, member(raw.options), r.help)->type_name(type)->allow_extra_args(false);
  };
  row.words = [member](const RenderOptions& o) { return member(o); };
  return row;
}

/// The place of the first equals sign without a backslash before it.
size_t firstEquals(const std::string& text) {
  size_t at = 0;
  while (at < text.size() && text[at] != '=') at += text[at] == '\\' ? 2 : 1;
  return at < text.size() ? at : std::string::npos;
}

/// The word of a mode, as the file has it; empty: it is none.
std::string modeIn(const std::string& word) {
  for (const char* mode : {"OPAQUE", "MASK", "BLEND", "true", "false", kNoValue})
    if (isSameButForCase(word, mode)) return mode;
  return "";
}

/// "POINTER=1,2", "POINTER=1, 2", "MATERIAL:NAME=1,2", "MATERIAL:NAME=red" or "MATERIAL:NAME=BLEND"
SetNumber setNumberIn(const std::string& text) {
  const bool isPlace = text.starts_with('/');
  const size_t equals = isPlace ? text.rfind('=') : firstEquals(text);
  SetNumber set{text.substr(0, equals), {}};
  const size_t colon = isPlace ? std::string::npos : set.pointer.rfind(':');
  const bool isNamed = colon != std::string::npos && colon > 0 && colon + 1 < set.pointer.size();
  if (!(isPlace || isNamed) || equals >= text.size() - 1) {
    const size_t slash = set.pointer.find('/');
    const bool isMeant = slash != std::string::npos && slash > 0 && equals < text.size() - 1;
    const size_t start = text.starts_with("#/") ? 2 : 0;
    throw UsageError(
        "--set: '" + text + "' is not of the form PLACE=NUMBERS or MATERIAL:NAME=VALUES" +
        (isMeant ? "; did you mean /" + text.substr(start) + "?" : ", such as oak:roughness=0.25"));
  }
  set.word = modeIn(text.substr(equals + 1));
  if (!set.word.empty()) return set;
  if (const std::optional<glm::vec3> color = pageColor(text.substr(equals + 1))) {
    for (int c = 0; c < 3; ++c) set.values.push_back(shortest((*color)[c]));
    return set;
  }
  for (size_t start = equals + 1; start <= text.size();) {
    const size_t end = std::min(text.find(',', start), text.size());
    const std::string word = CLI::detail::trim_copy(text.substr(start, end - start));
    const std::optional<double> number = numberOfAll<double>(word);
    if (!number || !std::isfinite(*number))
      throw UsageError("--set: " + set.pointer + ": '" + word + "' is no number and no colour" +
                       (end == text.size() && word.empty() ? "; a list with spaces stands in quotes"
                                                           : didYouMean(word, pageColorNames())));
    set.values.push_back(*number);
    start = end + 1;
  }
  return set;
}

OptionRow setRow() {
  OptionRow row = memberRow(
      "--set",
      "value to draw instead of the file's: of the materials with that name, as \"MATERIAL:NAME=VALUES\", "
      "such as "
      "\"Wood*:roughness=0.25\" or \"seat:color=navy\", also of what the file's material lacks (clearcoat, "
      "sheen, "
      "transmission, index, alphaMode, ...); color is the colour itself, without the material's texture, and "
      "baseColor multiplies the texture; NAMETexture=none leaves a texture out; or a number by JSON pointer, "
      "such "
      "as /materials/0/alphaCutoff=0.25; several with commas where the file has an array; can be given "
      "several "
      "times",
      FRAGTRACE_MEMBER(selection.set), {.effect = Effect::Picture, .renewal = Renewal::Surfaces});
  row.examples = {"/materials/0/pbrMetallicRoughness/roughnessFactor=0.25", "Wood*:roughness=0.25",
                  "b:c:alphaMode=BLEND", "b:baseColorTexture=none"};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    const auto take = [&raw](const std::vector<std::string>& texts) {
      raw.options.selection.set.clear();
      for (const std::string& text : texts) raw.options.selection.set.push_back(setNumberIn(text));
    };
    app.add_option_function<std::vector<std::string>>(r.name, take, r.help)
        ->type_name("ASSIGNMENT")
        ->allow_extra_args(false);
  };
  row.words = [](const RenderOptions& o) {
    std::vector<std::string> words;
    for (const SetNumber& set : o.selection.set) {
      words.push_back(set.pointer);
      const char* separator = "=";
      if (!set.word.empty()) words.back() += separator + set.word;
      for (const double value : set.values) words.back() += std::exchange(separator, ",") + exactText(value);
    }
    return words;
  };
  return row;
}

OptionRow addLightRow() {
  OptionRow row =
      memberRow("--add-light",
                "light the scene with a lamp of your own, too: \"sun from=AZIMUTH,ELEVATION strength=3 "
                "color=1,1,1\", or "
                "\"area at=X,Y,Z to=X,Y,Z size=W,H power=30 color=1,1,1\", a rectangle that is seen; angles "
                "are those of "
                "--camera-orbit, strength is in W/m^2 and power in W; can be given several times",
                FRAGTRACE_MEMBER(selection.lights), {.effect = Effect::Picture, .renewal = Renewal::Scene});
  row.examples = {"sun", "sun from=-20,10.5 strength=0.1 color=1,0.5,0", "area at=0,2,1",
                  "area at=-1,2,0.30000001192092896 to=0,0,0 size=2,0.5 power=7"};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    const auto take = [&raw](const std::vector<std::string>& texts) {
      raw.options.selection.lights.clear();
      for (const std::string& text : texts) raw.options.selection.lights.push_back(addedLightIn(text));
    };
    app.add_option_function<std::vector<std::string>>(r.name, take, r.help)
        ->type_name("LIGHT")
        ->allow_extra_args(false);
  };
  row.words = [](const RenderOptions& o) {
    std::vector<std::string> words;
    for (const AddedLight& light : o.selection.lights) words.push_back(textOf(light));
    return words;
  };
  return row;
}

/// Throws UsageError.
glm::dvec3 upOf(const char* option, const std::string& word) {
  for (size_t i = 0; i < kUpAxes.size(); ++i) {
    if (isSameButForCase(word, kUpAxisNames[i])) return kUpAxes[i];
  }
  std::vector<double> values;
  for (const std::string& part : CLI::detail::split(word, ',')) {
    const std::optional<double> value = numberIn(part);
    if (value && std::isfinite(*value)) values.push_back(*value);
  }
  if (values.size() != 3 || std::ranges::count(word, ',') != 2)
    throw UsageError(std::string(option) + ": " + whyNoneOf(word, kUpAxisNames) + ", and no direction X,Y,Z");
  const glm::dvec3 up(values[0], values[1], values[2]);
  if (up == glm::dvec3(0.0)) throw UsageError(std::string(option) + ": is zero");
  return up;
}

OptionRow upRow() {
  OptionRow row =
      memberRow("--up",
                "direction that points up in the scene's own space: " + joined(kUpAxisNames) +
                    " or X,Y,Z; the scene is turned the shortest way so that it becomes +Y, from -y about Z; "
                    "with z, -Y "
                    "becomes the front, as in Blender",
                FRAGTRACE_MEMBER(selection.up), {.effect = Effect::Picture, .renewal = Renewal::Scene});
  row.choices.assign(kUpAxisNames.begin(), kUpAxisNames.end());
  row.open = true;
  row.examples = {"x", "-z", "0.1,-0.9,0.30000001192092896"};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    addWord(app, r, raw, [name = r.name](RenderOptions& o, const std::string& word) {
      o.selection.up = upOf(name, word);
    });
    app.get_option(r.name)->default_str("y");
  };
  row.words = [](const RenderOptions& o) {
    const glm::dvec3& up = o.selection.up;
    const auto axis = std::ranges::find(kUpAxes, up);
    if (axis == kUpAxes.end()) return std::vector{numbersText(up.x, up.y, up.z)};
    return std::vector{std::string(kUpAxisNames[size_t(axis - kUpAxes.begin())])};
  };
  return row;
}

OptionRow memoryRow() {
  OptionRow row =
      memberRow("--memory-limit",
                "memory limit, counted separately for files and for the picture, such as 500MB or 2GiB, at "
                "least 1MB; by default the smallest of 8 GiB, half of the machine's memory and ulimit -v",
                FRAGTRACE_MEMBER(limits.memoryBytes), {.effect = Effect::Report, .renewal = Renewal::Scene});
  row.examples = {"12345678", "2GiB"};
  row.add = [](CLI::App& app, const OptionRow& r, RawRender& raw) {
    app.add_option(r.name, raw.options.limits.memoryBytes, r.help)
        ->transform(memorySize(kLeastMemoryBytes))
        ->type_name("SIZE");
  };
  row.words = [](const RenderOptions& o) { return std::vector{std::to_string(o.limits.memoryBytes)}; };
  return row;
}

OptionRow missingRow() {
  constexpr std::array<const char*, 2> kNames{"refuse", "magenta"};
  return choice(
      "--missing-textures",
      "what to do if the image of a texture that is drawn cannot be read: {}; magenta prints a warning, "
      "replaces a missing base colour with magenta, and omits the effects of other missing textures; refuse "
      "ends the program",
      FRAGTRACE_MEMBER(limits.drawMissingTextures), kNames,
      {.effect = Effect::Picture, .renewal = Renewal::Scene});
}

}  // namespace

std::vector<OptionRow> fileRows() {
  return {
      // Commands declare the scene as an argument.
      word("file", "scene: a .gltf or .glb file", FRAGTRACE_MEMBER(scene),
           {.effect = Effect::Picture, .renewal = Renewal::Scene, .group = OptionGroup::File}, "FILE"),
      outputRow(),
  };
}

std::vector<OptionRow> inputRows() {
  constexpr OptionTraits kScene{.effect = Effect::Picture, .renewal = Renewal::Scene};
  constexpr OptionTraits kPose{.effect = Effect::Picture, .renewal = Renewal::Pose};
  return {
      word("--scene", "name or index of the scene; by default the one that the file chooses",
           FRAGTRACE_MEMBER(selection.scene), kScene),
      timeRow(),
      word("--animation",
           "name or index of the animation, at --animation-time or at its first moment; by default the "
           "first; 'all' "
           "plays all at once",
           FRAGTRACE_MEMBER(selection.animation), kPose),
      word(
          "--material-variant",
          "name or index of the material variant; `fragtrace info` lists the variants; `render` draws all of "
          "them by 'all', each to --output with its name instead of #",
          FRAGTRACE_MEMBER(selection.materialVariant), kScene),
      listRow("--hide",
              "name or index of a node to hide, together with everything below it; can be given several "
              "times; `fragtrace info --nodes` lists the nodes",
              FRAGTRACE_MEMBER(selection.hiddenNodes), "/nodes/3", "NODE", Renewal::Pose),
      listRow(
          "--double-sided",
          "name or index of a material whose back is drawn, and shines, as its front does, or 'all'; can be "
          "given several times; for surfaces that face the wrong way",
          FRAGTRACE_MEMBER(selection.doubleSided), "all", "MATERIAL"),
      setRow(),
      addLightRow(),
      upRow(),
      memoryRow(),
      limit<int>("--texture-limit",
                 "maximum width and height of textures in pixels; larger ones are scaled down",
                 FRAGTRACE_MEMBER(limits.textureSide), {1, kLargestTextureSide}, kScene),
      missingRow(),
      flag("--strict", "refuse a scene of whose file a warning would be printed",
           FRAGTRACE_MEMBER(limits.strict), {.effect = Effect::Report, .renewal = Renewal::Scene}),
      flag("--allow-external-files", "let the scene refer to files outside its folder",
           FRAGTRACE_MEMBER(limits.allowExternalFiles),
           {.effect = Effect::Report, .renewal = Renewal::Scene}),
      listRow(
          "--ignore-required",
          "draw a scene although this extension, which it requires, is not supported; can be given several "
          "times",
          FRAGTRACE_MEMBER(limits.ignoredExtensions), "CESIUM_RTC", "EXTENSION"),
  };
}

}  // namespace fragtrace
