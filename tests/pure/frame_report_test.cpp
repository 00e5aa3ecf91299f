// SPDX-License-Identifier: MIT
#include "bench/report/frame_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "base/errors.h"
#include "bench/report/baseline.h"

namespace fragtrace {
namespace {

BenchMachine machineOf(const std::string& renderer = "llvmpipe") {
  return {"a processor", 2, renderer, "4.5", "egl", "fragtrace 0", "2026-01-02T03:04:05Z"};
}

FrameSetting settingOf(const std::string& scene, const std::string& name, std::vector<double> ms) {
  FrameSetting s;
  s.scene = scene;
  s.configuration = name;
  s.options = name == "default" ? "" : "--" + name;
  s.clock = "wall clock";
  s.width = 100;
  s.height = 50;
  s.frames = 8;
  s.wallFrameMs = ms;
  s.frameMs = std::move(ms);
  s.raysPerPath = 3.0;
  s.picture.against = "'default' by bvh";
  return s;
}

std::vector<nlohmann::json> linesOf(const std::string& text) {
  std::vector<nlohmann::json> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(nlohmann::json::parse(line));
  return lines;
}

TEST(FrameReport, RatiosAreTakenRoundByRound) {
  // The machine gets slower from round to round, and the ratio stays.
  const auto ratio = ratioOf({2, 4, 8, 17}, {1, 2, 4, 8});
  ASSERT_TRUE(ratio);
  EXPECT_DOUBLE_EQ(ratio->summary.median, 2.0);
  EXPECT_DOUBLE_EQ(ratio->summary.min, 2.0);
  EXPECT_DOUBLE_EQ(ratio->most, 17.0 / 8.0);
  // If one list has more rounds, only as many as the other one has are compared.
  EXPECT_DOUBLE_EQ(ratioOf({3, 3, 3}, {1})->most, 3.0);
  EXPECT_FALSE(ratioOf({}, {1}));
  EXPECT_FALSE(ratioOf({1}, {0}));
  EXPECT_EQ(ratioText(ratioOf({2, 3}, {1, 2})), "1.5 (1.5 to 2)");
  EXPECT_EQ(ratioText(std::nullopt), "-");
}

TEST(FrameReport, JsonHoldsOneLineASettingWithAllFigures) {
  std::vector<FrameSetting> settings = {settingOf("a.glb", "default", {10, 12, 11}),
                                        settingOf("a.glb", "b", {20, 25, 23}),
                                        settingOf("c.glb", "default", {5})};
  settings[1].picture.wrong = "\"too\xff dark\"";
  settings[1].budgetHits = 3;
  const auto lines = linesOf(frameJson(machineOf(), settings));
  ASSERT_EQ(lines.size(), 3u);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(lines[i].at("schema"), 1);
    EXPECT_EQ(lines[i].at("command"), "frame");
    EXPECT_EQ(lines[i].at("scene"), settings[i].scene);
    EXPECT_EQ(lines[i].at("configuration"), settings[i].configuration);
    EXPECT_EQ(lines[i].at("clock"), "wall clock");
    EXPECT_EQ(lines[i].at("machine").at("processor"), "a processor");
    EXPECT_EQ(lines[i].at("date"), "2026-01-02T03:04:05Z");
    EXPECT_EQ(lines[i].at("round_frame_ms"), nlohmann::json(settings[i].frameMs));
  }
  EXPECT_EQ(lines[0].at("frame_ms").at("median"), 11);
  EXPECT_EQ(lines[0].at("frame_ms").at("mean"), 11);
  EXPECT_EQ(lines[0].at("frame_ms").at("stddev"), 1);
  EXPECT_EQ(lines[0].at("frame_ms").at("p95"), 12);
  // 5000 paths in 11 ms, three rays each.
  EXPECT_NEAR(lines[0].at("mpaths_per_s").get<double>(), 5000.0 / 11e-3 * 1e-6, 1e-12);
  EXPECT_NEAR(lines[0].at("mrays_per_s").get<double>(), 15000.0 / 11e-3 * 1e-6, 1e-12);
  EXPECT_FALSE(lines[0].contains("ratio"));
  EXPECT_EQ(lines[1].at("ratio").at("to"), "default");
  EXPECT_NEAR(lines[1].at("ratio").at("median").get<double>(), 25.0 / 12.0, 1e-12);
  EXPECT_FALSE(lines[2].contains("ratio"));  // the first of its scene
  EXPECT_EQ(lines[0].at("picture").at("right"), true);
  EXPECT_EQ(lines[1].at("picture").at("right"), false);
  EXPECT_EQ(lines[1].at("budget_hits"), 3);
}

TEST(FrameReport, TableNamesTheClockAndWhatIsWrong) {
  std::vector<FrameSetting> settings = {settingOf("a.glb", "default", {10}), settingOf("a.glb", "b", {25}),
                                        settingOf("c.glb", "default", {5})};
  settings[1].picture.wrong = "too dark";
  const std::string table = frameTable(machineOf(), settings);
  EXPECT_NE(table.find("a.glb, 100 x 50, 0 triangles: milliseconds per frame by wall clock, llvmpipe"),
            std::string::npos);
  EXPECT_NE(table.find("WRONG: too dark"), std::string::npos);
  EXPECT_NE(table.find("2.5 (2.5 to 2.5)"), std::string::npos);
  EXPECT_NE(table.find("c.glb"), std::string::npos);
}

// ---- baseline ----

TEST(Baseline, WhatIsWrittenIsReadAgain) {
  std::vector<FrameSetting> settings = {settingOf("a.glb", "default", {10, 12, 11}),
                                        settingOf("a.glb", "b", {20})};
  settings[1].samplesPerDraw = 1;
  const auto entries = parseBaseline(frameJson(machineOf(), settings), "old.json");
  ASSERT_EQ(entries.size(), 2u);
  EXPECT_EQ(entries[0].medianMs, 11);
  EXPECT_EQ(entries[1].options, "--b");
  EXPECT_EQ(entries[1].samplesPerDraw, 1);
  for (const BaselineChange& c : compareWithBaseline(entries, machineOf(), settings, 0.0)) {
    EXPECT_EQ(c.ratio, 1.0) << c.name;
    EXPECT_FALSE(c.slower);
  }
}

TEST(Baseline, SlowerIsWhatTakesLongerThanTheTolerance) {
  const auto then = parseBaseline(frameJson(machineOf(), {settingOf("a.glb", "default", {100})}), "old");
  for (const auto& [ms, slower] : {std::pair(50.0, false), {109.0, false}, {111.0, true}, {300.0, true}}) {
    const auto changes = compareWithBaseline(then, machineOf(), {settingOf("a.glb", "default", {ms})}, 0.1);
    ASSERT_EQ(changes.size(), 1u);
    EXPECT_NEAR(changes[0].ratio, ms / 100.0, 1e-12);
    EXPECT_EQ(changes[0].slower, slower) << ms;
    EXPECT_EQ(baselineTable(changes, 0.1).find("SLOWER") != std::string::npos, slower);
  }
}

TEST(Baseline, WhatDoesNotMatchIsSaid) {
  const FrameSetting setting = settingOf("a.glb", "default", {100});
  const auto then = parseBaseline(frameJson(machineOf(), {setting}), "old");
  FrameSetting size = setting;
  size.width = 99;
  FrameSetting clock = setting;
  clock.clock = "gpu timer";
  FrameSetting draws = setting;
  draws.samplesPerDraw = 1;
  for (const FrameSetting& other :
       {size, clock, draws, settingOf("b.glb", "default", {1}), settingOf("a.glb", "b", {1})}) {
    const auto changes = compareWithBaseline(then, machineOf(), {other}, 0.1);
    ASSERT_EQ(changes.size(), 2u);
    EXPECT_EQ(changes[0].note, "not in the baseline");
    EXPECT_EQ(changes[1].note, "only in the baseline");
    EXPECT_FALSE(changes[0].slower || changes[1].slower);
    EXPECT_NE(baselineTable(changes, 0.1).find("only in the baseline"), std::string::npos);
  }
  EXPECT_EQ(compareWithBaseline(then, machineOf("another GPU"), {setting}, 0.1).size(), 2u);
}

TEST(Baseline, OfEntriesThatMatchTheLastCounts) {
  const auto then = parseBaseline(
      frameJson(machineOf(), {settingOf("a.glb", "default", {100}), settingOf("a.glb", "default", {50})}),
      "old");
  const auto changes = compareWithBaseline(then, machineOf(), {settingOf("a.glb", "default", {100})}, 0.1);
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_EQ(changes[0].ratio, 2.0);
}

TEST(Baseline, WhatIsNoSettingIsRefusedWithItsLine) {
  const std::string good = frameJson(machineOf(), {settingOf("a.glb", "default", {100})});
  std::string other = good;
  other.replace(other.find("\"schema\":1"), 10, "\"schema\":2");
  for (const std::string& bad : {std::string("nonsense\n"), std::string("{\"schema\":1}\n"), other}) {
    std::string text = good;
    text += "\n";
    text += bad;
    try {
      parseBaseline(text, "old.json");
      ADD_FAILURE() << bad;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find("old.json: line 3 "), 0u) << error.what();
    }
  }
  EXPECT_THROW(parseBaseline("", "old.json"), InputError);
  EXPECT_THROW(parseBaseline(frameJson(machineOf(), {settingOf("a.glb", "default", {0})}), "old"),
               InputError);
}

}  // namespace
}  // namespace fragtrace
