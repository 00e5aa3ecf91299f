// SPDX-License-Identifier: MIT
#include "render/film/checkpoint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace fragtrace {
namespace {

Checkpoint someCheckpoint() {
  Checkpoint c;
  c.job = R"({"bounces":16})";
  c.statistics = "{}";
  c.part = 3;
  c.picture = {2, 1, {"R", "G", "B", "A"}, {1, 2, 3, 4, 5, 6, 7, 8}, {}};
  FilmState film;
  film.size = {1, 2};
  film.sum = {1, 2, 3, 4, 5, 6, 7, 8};
  film.compensation = {8, 7, 6, 5, 4, 3, 2, 1};
  film.counts = {1, 2, 3, 4, 5, 6, 7, 0xffffffffu};
  film.cut = 0.1;
  film.lightPaths = {9, 0.1, 0.7};
  film.pixelsPerPath = 2;
  c.films = {film, film};
  FilmPixels look{{1, 1}, {}, 0.25};
  look.pixels.resize(1);
  look.pixels[0].sum = {0.1, 0.2, 0.3};
  look.pixels[0].samples = 9;
  c.looks = {look};
  c.adaptive = {{32}, {64}, 2, 1.5};
  return c;
}

TEST(Checkpoints, ComeBackAsTheyWere) {
  const Checkpoint c = someCheckpoint();
  const Checkpoint back = decodeCheckpoint(encodeCheckpoint(c));
  EXPECT_EQ(back.job, c.job);
  EXPECT_EQ(back.part, 3);
  EXPECT_EQ(back.picture.channels, c.picture.channels);
  EXPECT_EQ(back.picture.values, c.picture.values);
  ASSERT_EQ(back.films.size(), 2u);
  EXPECT_EQ(back.films[1].size, c.films[1].size);
  EXPECT_EQ(back.films[1].sum, c.films[1].sum);
  EXPECT_EQ(back.films[1].compensation, c.films[1].compensation);
  EXPECT_EQ(back.films[1].counts, c.films[1].counts);
  EXPECT_EQ(back.films[1].cut, 0.1);
  EXPECT_EQ(back.films[1].lightPaths.squared, 0.7);
  EXPECT_EQ(back.films[1].pixelsPerPath, 2);
  ASSERT_EQ(back.looks.size(), 1u);
  EXPECT_EQ(back.looks[0].pixels[0].sum, c.looks[0].pixels[0].sum);
  EXPECT_EQ(back.looks[0].pixels[0].samples, 9u);
  EXPECT_EQ(back.adaptive.samples, c.adaptive.samples);
  EXPECT_EQ(back.adaptive.targets, c.adaptive.targets);
  EXPECT_EQ(back.adaptive.rounds, 2);
  EXPECT_EQ(back.adaptive.seconds, 1.5);
}

TEST(Checkpoints, CutAnywhereAreRefused) {
  const std::vector<uint8_t> bytes = encodeCheckpoint(someCheckpoint());
  for (size_t length = 0; length < bytes.size(); ++length)
    EXPECT_THROW(decodeCheckpoint(std::span(bytes).first(length)), std::runtime_error) << length;
  std::vector<uint8_t> longer = bytes;
  longer.push_back(0);
  EXPECT_THROW(decodeCheckpoint(longer), std::runtime_error);
}

TEST(Checkpoints, WithAnyByteOfTheirArraysChangedAreRefused) {
  const std::vector<uint8_t> bytes = encodeCheckpoint(someCheckpoint());
  // The end of the header, or later.
  const auto end = std::find(bytes.rbegin(), bytes.rend(), uint8_t('}')).base();
  for (auto at = size_t(end - bytes.begin()); at < bytes.size(); ++at) {
    std::vector<uint8_t> changed = bytes;
    changed[at] ^= 1;
    EXPECT_THROW(decodeCheckpoint(changed), std::runtime_error) << at;
  }
}

TEST(Checkpoints, WithAnyByteChangedAreRefusedOrRead) {
  const std::vector<uint8_t> bytes = encodeCheckpoint(someCheckpoint());
  size_t refused = 0;
  for (size_t at = 0; at < bytes.size(); ++at) {
    for (const uint8_t value : {uint8_t('9'), uint8_t('-'), uint8_t(0xff)}) {
      std::vector<uint8_t> changed = bytes;
      changed[at] = value;
      try {
        decodeCheckpoint(changed);
      } catch (const std::runtime_error&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, bytes.size());
}

}  // namespace
}  // namespace fragtrace
