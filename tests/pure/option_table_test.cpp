// SPDX-License-Identifier: MIT
// Each row of the option table goes round: parsed, written, parsed again; on the command line, in an option
// file and in the command that the viewer copies.
#include "options/option_row.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <map>

#include "options/command_text.h"
#include "options/help_rows.h"
#include "options/option_text.h"
#include "options/parse_render.h"

namespace fragtrace {
namespace {

using Words = std::vector<std::string>;

/// Parses words as a command that has all options does, with those of the file, if there is one.
RenderOptions parsed(Words words, const std::filesystem::path& config = {}) {
  CLI::App app("", "render");
  app.set_help_flag();
  RawRender raw;
  raw.anyOutput = true;
  for (const OptionRow& row : optionRows()) {
    if (row.traits.group != OptionGroup::None) row.add(app, row, raw);
  }
  parseWords(app, std::move(words));
  return finishConfigured(raw, config, app);
}

bool isOption(const OptionRow& row) { return row.name[0] == '-' && row.traits.group != OptionGroup::None; }

/// Options without which that one is refused.
Words companionsOf(const std::string& name) {
  static const std::map<std::string, Words> needed{{"--focus-distance", {"--f-stop=2.8"}},
                                                   {"--shutter", {"--animation-time=1"}},
                                                   {"--aperture-blades", {"--f-stop=2.8"}},
                                                   {"--fog-color", {"--fog-density=0.5"}},
                                                   {"--fog-anisotropy", {"--fog-density=0.5"}},
                                                   {"--fog-height", {"--fog-density=0.5"}},
                                                   {"--fog-distance", {"--fog-density=0.5"}},
                                                   {"--sun-time", {"--sun-place=-33.9,18.4"}},
                                                   {"--sun-place", {"--sun-time=2026-06-21T12:00Z"}},
                                                   {"--volume-position", {"--volume=cloud.nvdb"}},
                                                   {"--volume-scale", {"--volume=cloud.nvdb"}},
                                                   {"--volume-density", {"--volume=cloud.nvdb"}},
                                                   {"--volume-color", {"--volume=cloud.nvdb"}},
                                                   {"--volume-anisotropy", {"--volume=cloud.nvdb"}},
                                                   {"--volume-emission", {"--volume=cloud.nvdb"}},
                                                   {"--ocio-config", {"--ocio-view=AgX"}},
                                                   {"--ocio-display", {"--ocio-view=AgX"}},
                                                   {"--ocio-look", {"--ocio-view=AgX"}},
                                                   {"--ocio-input", {"--ocio-view=AgX"}},
                                                   {"--format", {"--output=-"}},
                                                   {"--sample-offset", {"--spp=1"}}};
  const auto found = needed.find(name);
  return found == needed.end() ? Words{"a.gltf"} : Words{"a.gltf", found->second.front()};
}

/// The option with each of its examples: a word each.
std::vector<std::string> uses(const OptionRow& row) {
  if (row.examples.empty()) return {row.name};
  std::vector<std::string> words;
  for (const std::string& example : row.examples) words.push_back(std::string(row.name) + "=" + example);
  return words;
}

/// All rows, those that the viewer's command leaves out, too.
std::string wholeText(const RenderOptions& options) {
  std::string text = quoted(options.scene.string());
  for (const OptionRow& row : optionRows()) {
    if (isOption(row)) appendRow(text, row, options);
  }
  return text;
}

/// Calls law(row, options, use) for each row and each of its examples.
template <typename Law>
void forEachUse(const Law& law) {
  for (const OptionRow& row : optionRows()) {
    if (!isOption(row)) continue;
    for (const std::string& use : uses(row)) {
      SCOPED_TRACE(use);
      Words words = companionsOf(row.name);
      words.push_back(use);
      law(row, parsed(words), use);
    }
  }
}

/// The options next to it. A format is refused without standard output, and the reverse; so are a time and
/// its place.
RenderOptions withoutOption(const std::string_view name) {
  const bool pair = name == "--format" || name == "--sun-time" || name == "--sun-place";
  return parsed(pair ? Words{"a.gltf"} : companionsOf(std::string(name)));
}

TEST(OptionTable, EachRowOfHelpIsOfAnOption) {
  for (const std::string_view name : namesOfHelpRows()) EXPECT_EQ(rowOf(name).name, name);
}

TEST(OptionTable, HasEachNameOnce) {
  std::map<std::string, int> count;
  for (const OptionRow& row : optionRows()) EXPECT_EQ(++count[row.name], 1) << row.name;
}

TEST(OptionTable, NoNameIsSaidToBeOfAnotherProgram) {
  Words names;
  for (const OptionRow& row : optionRows()) names.push_back(row.name);
  for (const std::string& name : names)
    EXPECT_EQ(suggestedOption(name, names).substr(0, name.size()), name) << "suggestion.cpp";
}

TEST(OptionTable, HasNoRowThatChangesNothing) {
  std::map<std::string, bool> changes;
  forEachUse([&](const OptionRow& row, const RenderOptions& options, const std::string&) {
    changes[row.name] = changes[row.name] || options != withoutOption(row.name);
  });
  for (const auto& [name, does] : changes) EXPECT_TRUE(does) << name;
}

TEST(OptionTable, EachRowRenewsWhatItSays) {
  forEachUse([](const OptionRow& row, const RenderOptions& options, const std::string&) {
    const RenderOptions others = withoutOption(row.name);
    EXPECT_EQ(renewalBetween(options, options), Renewal::None);
    EXPECT_EQ(renewalBetween(others, options), renewalBetween(options, others));
    if (!row.isDefault(options) && row.isDefault(others)) {
      EXPECT_GE(renewalBetween(others, options), row.traits.renewal);
    }
    const bool alone = std::ranges::all_of(optionRows(), [&](const OptionRow& other) {
      return other.traits.renewal != Renewal::Scene || other.isDefault(options) == other.isDefault(others);
    });
    const Renewal renewal = row.traits.renewal;
    if (renewal < Renewal::Surroundings || renewal == Renewal::Scene || !alone) return;
    EXPECT_EQ(renewalBetween(others, options), renewal);
    EXPECT_TRUE(differIn(renewal, others, options));
    EXPECT_EQ(sameBesidePose(others, options), renewal == Renewal::Surfaces || renewal == Renewal::Pose);
  });
}

TEST(OptionTable, EachRowIsWrittenAsItIsRead) {
  forEachUse([](const OptionRow&, const RenderOptions& options, const std::string&) {
    const std::string text = wholeText(options);
    EXPECT_EQ(parsed(splitWords(text)), options) << text;
  });
}

TEST(OptionTable, EachRowMeansTheSameInAnOptionFile) {
  const auto file = std::filesystem::path(testing::TempDir()) / "option_table_test.json";
  forEachUse([&](const OptionRow& row, const RenderOptions& options, const std::string& use) {
    const std::string name = std::string(row.name).substr(2);
    const std::string value = row.examples.empty() ? "true" : "\"" + use.substr(name.size() + 3) + "\"";
    std::ofstream(file) << "{\"" + name + "\": " + value + "}";
    EXPECT_EQ(parsed(companionsOf(row.name), file), options);
  });
  std::filesystem::remove(file);
}

TEST(OptionTable, RowsTogetherHaveAllMembers) {
  forEachUse([](const OptionRow&, const RenderOptions& options, const std::string&) {
    RenderOptions copy;
    for (const OptionRow& row : optionRows()) row.copy(copy, options);
    copy.stages = options.stages;
    EXPECT_EQ(copy, options);
  });
}

TEST(OptionTable, TheViewersCommandSaysWhatMakesThePicture) {
  for (const OptionRow& row : optionRows()) {
    const bool isOfTheRun = row.traits.effect == Effect::Report || row.traits.effect == Effect::Count ||
                            row.traits.group == OptionGroup::Output ||
                            row.traits.group == OptionGroup::Sequence;
    EXPECT_TRUE(!isOption(row) || row.traits.copied || isOfTheRun) << row.name;
  }
}

TEST(OptionTable, TheViewersCommandSaysEachRowThatItIsToSay) {
  forEachUse([](const OptionRow& row, const RenderOptions& options, const std::string&) {
    const std::string text = commandText(options);
    const bool isSaid = text.find(std::string(" ") + row.name) != std::string::npos;
    EXPECT_EQ(isSaid, row.traits.copied && !row.isDefault(options)) << text;
    if (!row.traits.copied) return;
    RenderOptions current;
    for (const OptionRow& other : optionRows()) {
      if (other.traits.kept) other.copy(current, options);
    }
    EXPECT_EQ(withCommandText(current, text), options) << text;
  });
}

TEST(OptionTable, GoesRoundAsAWhole) {
  // Other rows exclude these.
  const Words left{"--camera",     "--focal-length",    "--camera-orbit",   "--camera-view-angle",
                   "--frames",     "--hdri-file",       "--format",         "--resume",
                   "--checkpoint", "--noise",           "--time",           "--quality",
                   "--caustics",   "--camera-type",     "--shadow-catcher", "--light-reuse",
                   "--stage",      "--disable",         "--sample-offset",  "--no-default-light",
                   "--tree-level", "--background-blur", "--studio",         "--studio-look",
                   "--turn",       "--sun-elevation",   "--sun-azimuth"};
  Words words{"a.gltf"};
  for (const OptionRow& row : optionRows()) {
    if (isOption(row) && std::ranges::find(left, row.name) == left.end()) words.push_back(uses(row).back());
  }
  const RenderOptions options = parsed(words);
  const std::string text = wholeText(options);
  EXPECT_EQ(parsed(splitWords(text)), options) << text;
}

}  // namespace
}  // namespace fragtrace
