// SPDX-License-Identifier: MIT
// KTX2 textures: files of two encoders against what a second decoder makes of them and against the pictures
// that they were made from (tests/ktx2), headers that glTF does not allow, and files that are broken.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "base/errors.h"
#include "gltf_builder.h"
#include "image/files/header.h"
#include "image/files/process.h"
#include "image/files/whole_file.h"
#include "image/image.h"

namespace fragtrace::gltf_test {
namespace {

using Bytes = std::vector<uint8_t>;

struct Sample {
  const char* name;
  int width, height;
  const char* channels;  ///< channels of the picture from which it was made
  double error;          ///< root of the mean square in steps of 255, as the encoder leaves it
};

constexpr Sample kSamples[] = {
    {"basisu_etc1s", 64, 64, "rgb", 7.0},
    {"basisu_etc1s_alpha", 24, 20, "rgba", 11.0},
    {"basisu_etc1s_odd", 13, 7, "rgb", 24.0},
    {"basisu_etc1s_mips", 32, 32, "rgb", 12.0},
    {"basisu_uastc", 16, 16, "rgb", 1.0},
    {"basisu_uastc_zstd_alpha", 30, 18, "rgba", 3.0},
    {"libktx_etc1s_odd", 21, 35, "rgb", 8.0},
    {"libktx_etc1s_rg", 16, 16, "rg", 3.0},
    {"libktx_uastc_alpha", 10, 10, "rgba", 6.0},
    {"libktx_uastc_zstd_mips", 32, 16, "rgb", 1.0},
    {"libktx_uastc_zstd_linear", 22, 13, "rgb", 1.0},
};

Bytes fileOf(const std::string& name) {
  return readWholeFile(std::filesystem::path(FRAGTRACE_DOCS) / "../tests/ktx2" / name);
}

/// The channel of a picture that samples were made from: ramps along x and y, and squares of 4 x 4 texels.
int sourceOf(const Sample& sample, int x, int y, size_t channel) {
  const std::string channels(sample.channels);
  const int red = 255 * x / (sample.width - 1);
  const int green = 255 * y / (sample.height - 1);
  const int blue = channels == "rg" ? 0 : (x / 4 + y / 4) % 2 != 0 ? 64 : 160;
  const int alpha = channels == "rgba" ? 255 - red * green / 255 : 255;
  return std::array{red, green, blue, alpha}[channel];
}

std::string headerRefusal(const Bytes& bytes) {
  try {
    readImageHeader(bytes);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

/// A header of 16 x 16 texels whose numbers were changed: by where they are.
std::string refusalWith(const char* name, std::initializer_list<std::pair<size_t, uint32_t>> changes) {
  Bytes bytes = fileOf(name);
  for (const auto& [at, value] : changes) std::memcpy(bytes.data() + at, &value, sizeof value);
  return headerRefusal(bytes);
}

struct Ktx2Codec : testing::Test {
  void SetUp() override {
    if (!whyNoKtx2().empty()) GTEST_SKIP() << whyNoKtx2();
  }
};

std::span<const uint8_t> valuesOf(const TexelImage& image) {
  return std::get<std::span<const uint8_t>>(image.rgba);
}

TEST_F(Ktx2Codec, EveryTexelIsWhatASecondDecoderSays) {
  for (const Sample& sample : kSamples) {
    const TexelImage read = decodeTexels(fileOf(sample.name + std::string(".ktx2")), sample.name);
    const TexelImage expected = decodeTexels(fileOf(sample.name + std::string(".png")), sample.name);
    ASSERT_EQ(read.width, sample.width) << sample.name;
    ASSERT_EQ(read.height, sample.height) << sample.name;
    EXPECT_TRUE(std::ranges::equal(valuesOf(read), valuesOf(expected))) << sample.name;
  }
}

TEST_F(Ktx2Codec, TexelsAreThePictureUpToTheEncodersError) {
  for (const Sample& sample : kSamples) {
    const TexelImage read = decodeTexels(fileOf(sample.name + std::string(".ktx2")), sample.name);
    const auto values = valuesOf(read);
    double sum = 0.0;
    for (size_t i = 0; i < values.size(); ++i) {
      const auto pixel = int(i / 4);
      const int source = sourceOf(sample, pixel % read.width, pixel / read.width, i % 4);
      sum += std::pow(double(values[i]) - source, 2.0);
    }
    EXPECT_LE(std::sqrt(sum / double(values.size())), sample.error) << sample.name;
  }
}

TEST_F(Ktx2Codec, TheGreenOfTwoChannelsIsStoredAsAlpha) {
  Bytes file = fileOf("libktx_uastc_alpha.ktx2");
  const TexelImage before = decodeTexels(file, "rgba");
  uint32_t format = 0;
  std::memcpy(&format, file.data() + 48, sizeof format);
  constexpr uint8_t kRedAndGreen = 5;
  file[format + 31] = kRedAndGreen;  // the channel of its one sample
  const TexelImage after = decodeTexels(file, "rg");
  const auto rgba = valuesOf(before), rg = valuesOf(after);
  for (size_t i = 0; i < rgba.size(); i += 4) {
    EXPECT_EQ(rg[i], rgba[i]);
    EXPECT_EQ(rg[i + 1], rgba[i + 3]);
    EXPECT_EQ(rg[i + 2], 0);
    EXPECT_EQ(rg[i + 3], 255);
  }
}

TEST_F(Ktx2Codec, BrokenFilesAreRefusedOrDecodedWithinTheirLimits) {
  std::mt19937 random(47);
  size_t refused = 0;
  const auto start = std::chrono::steady_clock::now();
  const auto decode = [&refused](const Bytes& bytes) {
    try {
      decodeTexels(bytes, "broken.ktx2");
    } catch (const InputError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("cannot read the picture broken.ktx2: "))
          << error.what();
      ++refused;
    }
  };
  for (const char* name : {"basisu_etc1s_alpha", "basisu_uastc_zstd_alpha", "libktx_uastc_zstd_mips"}) {
    const Bytes whole = fileOf(name + std::string(".ktx2"));
    for (size_t size = 0; size < whole.size(); size += 37)
      decode({whole.begin(), whole.begin() + std::ptrdiff_t(size)});
    for (int i = 0; i < 60; ++i) {
      Bytes broken = whole;
      for (int flips = 0; flips < 3; ++flips) broken[random() % broken.size()] ^= uint8_t(1 << random() % 8);
      decode(broken);
    }
  }
  EXPECT_GT(refused, 50u);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
}

/// The unchanged transcoder reads beyond its tree, as AddressSanitizer sees.
TEST_F(Ktx2Codec, ACodeOfOneLongSymbolStaysWithinItsTree) {
  try {
    decodeTexels(fileOf("one_long_code.ktx2"), "file");
    ADD_FAILURE() << "the file is taken";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "cannot read the picture file: its level 0 is broken");
  }
}

TEST(Ktx2Header, TheSizeIsReadWithoutTheCodec) {
  for (const Sample& sample : kSamples) {
    const ImageHeader header = readImageHeader(fileOf(sample.name + std::string(".ktx2")));
    EXPECT_EQ(header.format, ImageFormat::Ktx2) << sample.name;
    EXPECT_EQ(header.width, sample.width) << sample.name;
    EXPECT_EQ(header.height, sample.height) << sample.name;
  }
}

TEST(Ktx2Header, WhatGltfDoesNotAllowIsNamed) {
  constexpr size_t kFormat = 12, kWidth = 20, kDepth = 28, kLayers = 32, kFaces = 36, kScheme = 44,
                   kUncompressed = 96;
  const char* const uastc = "basisu_uastc.ktx2";
  EXPECT_EQ(refusalWith(uastc, {}), "");
  EXPECT_EQ(refusalWith(uastc, {{kFaces, 6}}), "it is a cube map, and textures of glTF have two dimensions");
  EXPECT_EQ(refusalWith(uastc, {{kLayers, 4}}), "it is an array or a film of 4 layers, and no picture");
  EXPECT_EQ(refusalWith(uastc, {{kDepth, 2}}), "it has three dimensions, not two");
  EXPECT_EQ(refusalWith(uastc, {{kWidth, 0}}), "it has one dimension, not two");
  EXPECT_EQ(refusalWith(uastc, {{kWidth, 20000}}), "a size of 20000 x 16 pixels is not supported");
  EXPECT_EQ(refusalWith(uastc, {{kWidth, 20}}), "its level 0 has 256 bytes for 20 blocks");
  EXPECT_EQ(refusalWith(uastc, {{kUncompressed, 272}}), "its level 0 has 272 bytes for 16 blocks");
  EXPECT_EQ(refusalWith(uastc, {{kFormat, 37}}),
            "it is neither ETC1S nor UASTC, which textures of glTF have (vkFormat 37, colour model 166, "
            "supercompression 0)");
  EXPECT_NE(refusalWith(uastc, {{kScheme, 1}}).find("(vkFormat 0, colour model 166, supercompression 1)"),
            std::string::npos);
}

TEST(Ktx2Header, ColoursThatAreMultipliedByAlphaAreRefused) {
  Bytes file = fileOf("libktx_uastc_alpha.ktx2");
  uint32_t format = 0;
  std::memcpy(&format, file.data() + 48, sizeof format);
  constexpr size_t kFlags = 15;
  EXPECT_EQ(file[format + kFlags], 0);  // KHR_DF_FLAG_ALPHA_STRAIGHT
  file[format + kFlags] = 1;            // KHR_DF_FLAG_ALPHA_PREMULTIPLIED
  EXPECT_EQ(headerRefusal(file), "its colours are multiplied by alpha, which textures of glTF must not be");
}

TEST(Ktx2Header, MetadataThatTurnOrSwizzleAreRefused) {
  const Bytes whole = fileOf("libktx_uastc_alpha.ktx2");
  const auto with = [&whole](const std::string& from, const std::string& to) {
    std::string text(whole.begin(), whole.end());
    const size_t at = text.find(from);
    if (at == std::string::npos) return std::string("not found");
    text.replace(at, to.size(), to);
    return headerRefusal({text.begin(), text.end()});
  };
  const std::string orientation = std::string("KTXorientation") + '\0';
  EXPECT_EQ(with(orientation + "rd", orientation + "ru"),
            "its KTXorientation is not rd, as it must be in glTF");
  EXPECT_EQ(with(orientation + "rd", orientation + "rd"), "");
  // An entry of the same length: its key ends earlier.
  const std::string swizzle = std::string("KTXswizzle") + '\0' + "rrr1";
  EXPECT_EQ(with(orientation, swizzle), "its KTXswizzle is not rgba, as it must be in glTF");
}

TEST(Ktx2Header, TruncationIsNamed) {
  for (const size_t size : {20u, 90u, 110u, 200u})
    EXPECT_EQ(headerRefusal([&] {
                Bytes bytes = fileOf("basisu_uastc.ktx2");
                bytes.resize(size);
                return bytes;
              }()),
              "the file is truncated")
        << size;
}

GltfBuilder withTexture(const json& texture, bool isRequired) {
  GltfBuilder builder;
  const Bytes ktx2 = fileOf("basisu_uastc.ktx2");
  builder.root["images"] = {{{"uri", kPixelUri}},
                            {{"uri", "data:image/ktx2;base64," + base64({ktx2.begin(), ktx2.end()})}}};
  builder.root["textures"] = {texture};
  builder.root["materials"] = {{{"emissiveTexture", {{"index", 0}}}}};
  builder.root["extensionsUsed"] = {"KHR_texture_basisu"};
  if (isRequired) builder.root["extensionsRequired"] = {"KHR_texture_basisu"};
  return builder;
}

const json kBasisuOnly = {{"extensions", {{"KHR_texture_basisu", {{"source", 1}}}}}};

TEST(GltfBasisu, TheFallbackIsTakenWithTheCodecAndWithoutIt) {
  json texture = kBasisuOnly;
  texture["source"] = 0;
  GltfBuilder builder = withTexture(texture, false);
  const Scene scene = load(builder);
  ASSERT_EQ(scene.images.size(), 1u);
  EXPECT_EQ(scene.images[0].width, 1);
  EXPECT_EQ(scene.warnings.size(), 0u);
}

TEST(GltfBasisu, WithoutAFallbackTheTextureIsDrawnOrItsAbsenceIsSaid) {
  const std::string& why = whyNoKtx2();
  GltfBuilder used = withTexture(kBasisuOnly, false);
  GltfBuilder required = withTexture(kBasisuOnly, true);
  const Scene scene = load(used);
  EXPECT_EQ(scene.images.size(), why.empty() ? 1u : 0u);
  EXPECT_EQ(
      anyWarningHas(scene, "/textures/0/extensions/KHR_texture_basisu: is left out: KTX2 cannot be decoded"),
      !why.empty());
  GltfOptions refusing;
  refusing.limits.drawMissingTextures = false;
  required.addTriangle()["material"] = 0;
  required.embedBuffer();
  EXPECT_EQ(faultOf(required, refusing).find("KTX2 cannot be decoded") == std::string::npos, why.empty());
  if (why.empty()) {
    ASSERT_EQ(scene.images[0].width, 16);
  } else {
    EXPECT_NE(why.find("scripts/setup ktx2"), std::string::npos) << why;
    EXPECT_NE(why.find("gltf-transform ktxdecompress"), std::string::npos) << why;
  }
}

TEST(GltfBasisu, APictureThatDoesNotExistIsAbsent) {
  json texture = kBasisuOnly;
  texture["extensions"]["KHR_texture_basisu"]["source"] = 7;
  GltfBuilder builder = withTexture(texture, false);
  EXPECT_EQ(faultOf(builder),
            "test.gltf: /textures/0/extensions/KHR_texture_basisu/source: index 7 is past the 2 elements of "
            "/images; it is taken as absent");
}

}  // namespace
}  // namespace fragtrace::gltf_test
