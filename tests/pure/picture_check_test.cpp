// SPDX-License-Identifier: MIT
#include "bench/report/picture_check.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "film_samples.h"

namespace fragtrace {
namespace {

constexpr glm::ivec2 kSize{64, 48};

/// Independent samples with the mean 1 + x / 64, of which a part `rare` is bright and the rest dark.
FilmPixels noisy(uint32_t seed, int samples, double rare = 0.5, double brighter = 1.0) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> chance(0.0, 1.0);
  return filmOf(kSize, [&](int x, int) {
    std::vector<double> values;
    values.reserve(size_t(samples));
    for (int i = 0; i < samples; ++i)
      values.push_back(chance(random) < rare ? brighter * (1.0 + x / 64.0) / rare : 0.0);
    return values;
  });
}

FilmPixels exact(double value) {
  return filmOf(kSize, [&](int x, int) { return std::vector<double>(4, value * (1.0 + x / 64.0)); });
}

TEST(PictureCheck, NoiseOfIndependentPicturesIsRightWhateverItsShape) {
  for (const double rare : {0.9, 0.5, 0.05, 0.002}) {
    for (const int samples : {4, 16, 64}) {
      for (uint32_t seed = 0; seed < 2; ++seed) {
        const FilmPixels a = noisy(2 * seed, samples, rare);
        EXPECT_EQ(checkPicture(a, noisy(2 * seed + 1, samples, rare), CheckAgainst::OtherSamples).wrong, "")
            << rare << " " << samples;
        EXPECT_EQ(checkPicture(a, noisy(2 * seed + 1, 256, 0.5), CheckAgainst::OtherSamples).wrong, "")
            << rare;
        EXPECT_EQ(checkPicture(a, exact(1.0), CheckAgainst::NoiseFree).wrong, "") << rare << " " << samples;
      }
    }
  }
}

TEST(PictureCheck, APictureThatIsAFewPercentTooBrightIsWrong) {
  for (const CheckAgainst against : {CheckAgainst::OtherSamples, CheckAgainst::NoiseFree}) {
    const FilmPixels other = against == CheckAgainst::NoiseFree ? exact(1.0) : noisy(1, 64);
    const PictureCheck check = checkPicture(noisy(2, 64, 0.5, 1.05), other, against);
    EXPECT_NE(check.wrong.find("mean"), std::string::npos) << check.wrong;
    EXPECT_GT(check.meanErrors, kMostMeanErrors);
  }
}

TEST(PictureCheck, LightThatIsOnlyMovedIsWrong) {
  FilmPixels moved = noisy(3, 64);
  for (size_t i = 0; i < moved.pixels.size(); ++i) {
    const size_t y = i / size_t(kSize.x);
    // Eight rows give to the next eight.
    moved.pixels[i].sum *= (y / 8) % 2 == 0 ? 0.7 : 1.3;
  }
  const PictureCheck check = checkPicture(moved, noisy(4, 64), CheckAgainst::OtherSamples);
  EXPECT_NE(check.wrong.find("blocks"), std::string::npos) << check.wrong;
  EXPECT_GT(check.farBlocks, 0.5);
}

TEST(PictureCheck, WithoutNoiseAnyDifferenceBeyondRoundingIsWrong) {
  EXPECT_EQ(checkPicture(exact(1.0 + 1e-6), exact(1.0), CheckAgainst::OtherSamples).wrong, "");
  EXPECT_NE(checkPicture(exact(1.001), exact(1.0), CheckAgainst::OtherSamples).wrong, "");
  EXPECT_EQ(checkPicture(exact(0.0), exact(0.0), CheckAgainst::OtherSamples).wrong, "");
  EXPECT_NE(checkPicture(exact(0.0), exact(1.0), CheckAgainst::OtherSamples).wrong, "");
  EXPECT_NE(checkPicture(exact(1.0), exact(0.0), CheckAgainst::OtherSamples).wrong, "");
}

TEST(PictureCheck, OfTheSameSamplesFewPixelsMayDiffer) {
  const FilmPixels other = noisy(5, 16);
  FilmPixels picture = other;
  EXPECT_EQ(checkPicture(picture, other, CheckAgainst::SameSamples).wrong, "");
  EXPECT_EQ(checkPicture(picture, other, CheckAgainst::SameSamples).rmse, 0.0);
  const auto change = [&](size_t count, double factor) {
    for (size_t i = 0; i < count; ++i) picture.pixels[i * 100].sum *= factor;
  };
  change(10, 1.01);  // 10 of 3072 pixels
  const PictureCheck check = checkPicture(picture, other, CheckAgainst::SameSamples);
  EXPECT_EQ(check.wrong, "");
  EXPECT_NEAR(check.differing, 10.0 / 3072.0, 1e-3);
  EXPECT_GT(check.rmse, 0.0);
  change(30, 1.01);
  EXPECT_NE(checkPicture(picture, other, CheckAgainst::SameSamples).wrong, "");
  // One sample is enough for that, but for nothing else.
  EXPECT_EQ(checkPicture(noisy(6, 1), noisy(6, 1), CheckAgainst::SameSamples).wrong, "");
  EXPECT_NE(checkPicture(noisy(6, 1), noisy(7, 1), CheckAgainst::SameSamples).wrong, "");
  EXPECT_NE(checkPicture(noisy(6, 1), noisy(7, 1), CheckAgainst::OtherSamples).wrong, "");
}

TEST(PictureCheck, OfTheSameSamplesMorePixelsMayDifferTheMoreSamplesTheyHave) {
  const auto checked = [](int samples, size_t every, double factor) {
    const FilmPixels other = noisy(6, samples);
    FilmPixels picture = other;
    for (size_t i = 0; i < picture.pixels.size(); i += every) picture.pixels[i].sum *= factor;
    return checkPicture(picture, other, CheckAgainst::SameSamples).wrong;
  };
  EXPECT_NE(checked(64, 100, 1.01).find("differ"), std::string::npos);
  EXPECT_EQ(checked(256, 100, 1.01), "");
  EXPECT_NE(checked(256, 40, 1.01).find("differ"), std::string::npos);
  EXPECT_NE(checked(256, 100, 200.0).find("mean"), std::string::npos) << checked(256, 100, 200.0);
}

TEST(PictureCheck, PixelsThatAreNoPictureAreWrong) {
  const FilmPixels other = noisy(8, 8);
  FilmPixels picture = other;
  picture.pixels[7].sum.y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(checkPicture(picture, other, CheckAgainst::SameSamples).wrong, "");
  EXPECT_NE(checkPicture(other, picture, CheckAgainst::OtherSamples).wrong, "");
  picture = other;
  picture.pixels[9] = {};
  EXPECT_NE(checkPicture(picture, other, CheckAgainst::SameSamples).wrong, "");
  EXPECT_NE(checkPicture(emptyFilm({8, 8}), emptyFilm({8, 16}), CheckAgainst::SameSamples).wrong, "");
}

TEST(PictureCheck, AFileWithLayersIsTheFilmThatItWasMadeOf) {
  const FilmPixels film = noisy(9, 16);
  bool noiseFree = true;
  const FilmPixels read = filmOf(imageOf(film, {false, true, true}), noiseFree);
  EXPECT_FALSE(noiseFree);
  ASSERT_EQ(read.size, film.size);
  for (size_t i = 0; i < film.pixels.size(); ++i) {
    EXPECT_EQ(read.pixels[i].samples, 16u);
    EXPECT_NEAR(read.pixels[i].luminance(), film.pixels[i].luminance(), 1e-6 * film.pixels[i].luminance());
    EXPECT_NEAR(read.pixels[i].m2, film.pixels[i].m2, 1e-5 * film.pixels[i].m2);
  }
  filmOf(imageOf(film, {}), noiseFree);
  EXPECT_TRUE(noiseFree);
}

}  // namespace
}  // namespace fragtrace
