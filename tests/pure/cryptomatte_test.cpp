// SPDX-License-Identifier: MIT
#include "image/channels.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

namespace fragtrace {
namespace {

TEST(Cryptomatte, HashesAsMurmurHash3) {
  // Published values of MurmurHash3_x86_32 with the seed 0, for each number of bytes behind the blocks.
  EXPECT_EQ(murmurHash3(""), 0u);
  EXPECT_EQ(murmurHash3("hello"), 0x248bfa47u);
  EXPECT_EQ(murmurHash3("hello, world"), 0x149bbb7fu);
  EXPECT_EQ(murmurHash3("19 Jan 2038 at 3:14:07 AM"), 0xe31e8a70u);
  EXPECT_EQ(murmurHash3("The quick brown fox jumps over the lazy dog."), 0xd5c48bfcu);
}

TEST(Cryptomatte, NumbersNamesAsTheSpecification) {
  // The examples of the specification, of its sample images, and of the tests of its plug-in for Nuke.
  EXPECT_EQ(matteId("bunny"), 0x13851a76u);
  EXPECT_EQ(matteId("default"), 0x42c9679fu);
  EXPECT_EQ(matteId("bunny_porcelain_mat"), 0xb24b26d4u);
  EXPECT_EQ(matteId("flowerA.flowerA_petal1.:1065"), 0x7f0e5296u);
  EXPECT_EQ(std::bit_cast<float>(matteId("hello")), 6.0705627102400005616e-17f);
  EXPECT_EQ(std::bit_cast<float>(matteId("m\xc3\xa4"
                                         "dchen")),
            6.2361298211599995797e+25f);
}

TEST(Cryptomatte, NumbersAreOrdinaryFloats) {
  bool low = false;
  bool high = false;
  for (int i = 0; i < 4000; ++i) {
    const std::string name = "node " + std::to_string(i);
    const uint32_t exponent = murmurHash3(name) >> 23 & 0xffu;
    low = low || exponent == 0;
    high = high || exponent == 255;
    EXPECT_TRUE(std::isnormal(std::bit_cast<float>(matteId(name)))) << name;
    const bool ordinary = exponent > 0 && exponent < 255;
    EXPECT_EQ(matteId(name) == murmurHash3(name), ordinary) << name;
  }
  EXPECT_TRUE(low && high);
}

TEST(Cryptomatte, RanksByShare) {
  std::vector<float> values;
  const std::array<MatteShare, 8> shares{
      {{11, 1}, {12, 5}, {13, 2}, {14, 8}, {15, 3}, {16, 4}, {17, 2}, {18, 7}}};
  appendRanks(shares, 64, values);
  ASSERT_EQ(values.size(), 12u);
  const std::array<MatteShare, 6> expected{{{14, 8}, {18, 7}, {12, 5}, {16, 4}, {15, 3}, {13, 2}}};
  for (size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(std::bit_cast<uint32_t>(values[2 * i]), expected[i].id);
    EXPECT_EQ(values[2 * i + 1], float(expected[i].samples) / 64.0f);
  }
  values.clear();
  appendRanks(std::array{MatteShare{21, 4}}, 4, values);
  EXPECT_EQ(values[1], 1.0f);
  for (size_t i = 2; i < values.size(); ++i) EXPECT_EQ(values[i], 0.0f);
}

TEST(Cryptomatte, AttributesAreThoseOfTheSpecification) {
  Image image;
  EXPECT_FALSE(holdsMattes(image));
  setManifest(
      image, "CryptoObject",
      std::array<std::string, 4>{"bunny", "a \"quoted\" name", "bunny", "flowerA.flowerA_petal1.:1065"});
  EXPECT_TRUE(holdsMattes(image));
  EXPECT_EQ(image.attributes.at("cryptomatte/3ae39a5/name"), "CryptoObject");
  EXPECT_EQ(image.attributes.at("cryptomatte/3ae39a5/hash"), "MurmurHash3_32");
  EXPECT_EQ(image.attributes.at("cryptomatte/3ae39a5/conversion"), "uint32_to_float32");
  const auto manifest = nlohmann::json::parse(image.attributes.at("cryptomatte/3ae39a5/manifest"));
  EXPECT_EQ(manifest.size(), 3u);
  EXPECT_EQ(manifest.at("bunny"), "13851a76");
  EXPECT_EQ(manifest.at("flowerA.flowerA_petal1.:1065"), "7f0e5296");  // the hash is no ordinary float
  EXPECT_TRUE(manifest.contains("a \"quoted\" name"));
  setManifest(image, "CryptoMaterial", {});
  EXPECT_EQ(image.attributes.at("cryptomatte/be359d6/manifest"), "{}");
  EXPECT_EQ(matteChannels("CryptoObject").front(), "CryptoObject00.R");
  EXPECT_EQ(matteChannels("CryptoObject").back(), "CryptoObject02.A");
}

}  // namespace
}  // namespace fragtrace
