// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "gltf/assemble/animation.h"
#include "gltf_builder.h"
#include "image_samples.h"

namespace fragtrace::gltf_test {
namespace {

constexpr double kPi = 3.14159265358979324;

/// Adds a sampler and a channel to the first animation, and returns the channel.
json& addChannel(GltfBuilder& builder, const json& target, const std::string& interpolation, int input,
                 int output) {
  json& animation = builder.root["animations"][0];
  animation["samplers"].push_back({{"input", input}, {"output", output}, {"interpolation", interpolation}});
  animation["channels"].push_back({{"sampler", animation["samplers"].size() - 1}, {"target", target}});
  return animation["channels"].back();
}

/// Animates node 0, with float values of the accessor type `type`.
json& animate(GltfBuilder& builder, const std::string& path, const std::string& type,
              const std::vector<float>& times, const std::vector<float>& values,
              const std::string& interpolation = "LINEAR") {
  return addChannel(builder, {{"node", 0}, {"path", path}}, interpolation,
                    builder.addAccessor<float>("SCALAR", times), builder.addAccessor<float>(type, values));
}

json& animatePointer(GltfBuilder& builder, const std::string& pointer, const std::string& type,
                     const std::vector<float>& values) {
  builder.root["extensionsUsed"] = {"KHR_animation_pointer"};
  return addChannel(
      builder, {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}},
      "LINEAR", builder.addAccessor<float>("SCALAR", {0, 1}), builder.addAccessor<float>(type, values));
}

Scene loadAt(GltfBuilder& builder, double seconds, const std::string& animation = "") {
  GltfOptions options;
  options.selection.animationTime = seconds;
  options.selection.animation = animation;
  return load(builder, options);
}

/// The reason why the file is refused at that time, or the first warning.
std::string faultAt(GltfBuilder& builder, double seconds) {
  GltfOptions options;
  options.selection.animationTime = seconds;
  const std::string fault = faultOf(builder, options);
  return fault.empty() ? fault : fault.substr(fault.find(": ") + 2);
}

std::vector<double> quaternion(double degrees) {
  return {0.0, 0.0, std::sin(degrees * kPi / 360.0), std::cos(degrees * kPi / 360.0)};
}

Keyframes rotations(double from, double to, double sign) {
  Keyframes keys{Interpolation::Linear, true, 4, {0.0f, 1.0f}, {}};
  for (const double x : quaternion(from)) keys.values.push_back(float(x));
  for (const double x : quaternion(to)) keys.values.push_back(float(sign * x));
  return keys;
}

TEST(GltfAnimation, LinearKeysAreJoinedByLinesAndHeldOutside) {
  const Keyframes keys{Interpolation::Linear, false, 2, {1.0f, 2.0f, 4.0f}, {0, 10, 1, 20, 5, 20}};
  EXPECT_EQ(valuesAt(keys, 0.0), (std::vector<double>{0, 10}));
  EXPECT_EQ(valuesAt(keys, 1.25), (std::vector<double>{0.25, 12.5}));
  EXPECT_EQ(valuesAt(keys, 2.0), (std::vector<double>{1, 20}));
  EXPECT_EQ(valuesAt(keys, 3.0), (std::vector<double>{3, 20}));
  EXPECT_EQ(valuesAt(keys, 1e9), (std::vector<double>{5, 20}));
}

TEST(GltfAnimation, StepsHoldTheKeyBefore) {
  const Keyframes keys{Interpolation::Step, false, 1, {1.0f, 2.0f}, {3, 7}};
  EXPECT_EQ(valuesAt(keys, 0.5)[0], 3.0);
  EXPECT_EQ(valuesAt(keys, std::nextafter(2.0, 0.0))[0], 3.0);
  EXPECT_EQ(valuesAt(keys, 2.0)[0], 7.0);
}

TEST(GltfAnimation, OfKeysAtTheSameTimeTheLastCounts) {
  const Keyframes keys{Interpolation::Linear, false, 1, {0.0f, 1.0f, 1.0f, 2.0f}, {0, 1, 5, 6}};
  EXPECT_EQ(valuesAt(keys, 1.0)[0], 5.0);
  EXPECT_EQ(valuesAt(keys, 0.5)[0], 0.5);
}

TEST(GltfAnimation, WhileAShutterIsOpenMotionContinuesBeyondCutsAndEnds) {
  using Values = std::vector<double>;
  const Keyframes line{Interpolation::Linear, false, 1, {1.0f, 2.0f, 2.0f, 3.0f}, {0, 2, 10, 13}};
  const OpenShutter atBegin{1.0, 1.0, 3.0}, beforeCut{1.9, 1.0, 3.0}, atCut{2.0, 1.0, 3.0};
  EXPECT_EQ(valuesWhileOpen(line, 0.5, atBegin), Values{-1});
  EXPECT_EQ(valuesWhileOpen(line, 1.5, atBegin), Values{1});
  EXPECT_EQ(valuesWhileOpen(line, 2.5, beforeCut), Values{3});
  EXPECT_EQ(valuesWhileOpen(line, 1.5, atCut), Values{8.5});
  EXPECT_EQ(valuesWhileOpen(line, 3.5, {3.0, 1.0, 3.0}), Values{14.5});
  // A channel that begins later than others rests before, and all rest after the end.
  EXPECT_EQ(valuesWhileOpen(line, 0.5, {1.0, 0.0, 3.0}), Values{0});
  EXPECT_EQ(valuesWhileOpen(line, 3.5, {3.25, 1.0, 3.0}), Values{13});
  const Keyframes steps{Interpolation::Step, false, 1, {1.0f, 2.0f}, {3, 7}};
  EXPECT_EQ(valuesWhileOpen(steps, 2.5, {1.9, 1.0, 2.0}), Values{3});
  EXPECT_EQ(valuesWhileOpen(steps, 1.5, {2.0, 1.0, 2.0}), Values{7});
  const Keyframes scale{Interpolation::Linear, false, 1, {0.0f, 1.0f}, {1, 3}, true};
  EXPECT_EQ(valuesWhileOpen(scale, -0.25, {0.0, 0.0, 1.0}), Values{0.5});
  EXPECT_EQ(valuesWhileOpen(scale, -0.75, {0.0, 0.0, 1.0}), Values{1}) << "it would be turned over";
  // A quarter turn in a second, about z.
  const float half = std::sqrt(0.5f);
  const Keyframes turn{Interpolation::Linear, true, 4, {0.0f, 1.0f}, {0, 0, 0, 1, 0, 0, half, half}};
  EXPECT_NEAR(valuesWhileOpen(turn, -1.0, {0.0, 0.0, 1.0})[2], -half, 1e-6);
}

/// A cubic polynomial is its own Hermite spline, whatever its keys.
TEST(GltfAnimation, SplinesWithTheTangentsOfACubicAreTheCubic) {
  const auto cubic = [](double t) { return ((2.0 * t - 3.0) * t + 0.5) * t + 4.0; };
  const auto slope = [](double t) { return (6.0 * t - 6.0) * t + 0.5; };
  Keyframes keys{Interpolation::CubicSpline, false, 1, {0.5f, 2.0f, 2.5f}, {}};
  for (const float t : keys.times) {
    keys.values.push_back(float(slope(double(t))));
    keys.values.push_back(float(cubic(double(t))));
    keys.values.push_back(float(slope(double(t))));
  }
  for (double t = 0.5; t <= 2.5; t += 0.125) EXPECT_NEAR(valuesAt(keys, t)[0], cubic(t), 1e-12) << t;
  EXPECT_EQ(valuesAt(keys, 0.0)[0], cubic(0.5));
  EXPECT_EQ(valuesAt(keys, 9.0)[0], cubic(2.5));
}

TEST(GltfAnimation, RotationsTurnEvenlyAlongTheShorterWay) {
  for (const double sign : {1.0, -1.0}) {  // both mean the same rotation
    const Keyframes keys = rotations(10.0, 130.0, sign);
    for (const double part : {0.1, 0.5, 0.9}) {
      const std::vector<double> found = valuesAt(keys, part);
      const std::vector<double> expected = quaternion(10.0 + 120.0 * part);
      double dot = 0.0;
      for (size_t i = 0; i < 4; ++i) dot += found[i] * expected[i];
      EXPECT_NEAR(std::abs(dot), 1.0, 1e-13) << part;
    }
  }
}

TEST(GltfAnimation, RotationsThatAreNearlyTheSameStayUnit) {
  EXPECT_NEAR(valuesAt(rotations(30.0, 30.0, 1.0), 0.3)[2], quaternion(30.0)[2], 1e-7);
  const std::vector<double> found = valuesAt(rotations(30.0, 30.0 + 1e-4, -1.0), 0.3);
  EXPECT_NEAR(found[2] * found[2] + found[3] * found[3], 1.0, 1e-14);
  EXPECT_NEAR(2.0 * std::atan2(std::abs(found[2]), std::abs(found[3])) * 180.0 / kPi, 30.0 + 0.3e-4, 1e-5);
}

TEST(GltfAnimation, SplinesOfRotationsAreNormalized) {
  Keyframes keys{Interpolation::CubicSpline, true, 4, {0.0f, 1.0f}, {}};
  const std::vector<float> zero(4, 0.0f);
  for (const double degrees : {0.0, 90.0}) {
    keys.values.insert(keys.values.end(), zero.begin(), zero.end());
    for (const double x : quaternion(degrees)) keys.values.push_back(float(x));
    keys.values.insert(keys.values.end(), zero.begin(), zero.end());
  }
  // The middle of the chord between both, made unit, is the rotation by half of the angle.
  const std::vector<double> found = valuesAt(keys, 0.5);
  for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(found[i], quaternion(45.0)[i], 1e-7);
}

TEST(GltfAnimation, NodesMoveTurnAndGrow) {
  GltfBuilder builder;
  builder.addTriangle();
  const float h = float(std::sqrt(0.5));
  animate(builder, "translation", "VEC3", {0, 2}, {0, 0, 0, 4, 0, 0});
  animate(builder, "rotation", "VEC4", {0, 2}, {0, 0, 0, 1, 0, 0, h, h});
  animate(builder, "scale", "VEC3", {1, 3}, {1, 1, 1, 3, 3, 3}, "STEP");
  const Scene scene = loadAt(builder, 1.0);
  const double c = std::sqrt(0.5);
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 1), {2.0 + c, c, 0}));
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 2), {2.0 - c, c, 0}));
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_TRUE(isNear(worldCornerOf(loadAt(builder, 9.0), 0, 1), {4, 3, 0}));
  EXPECT_TRUE(isNear(worldCornerOf(load(builder), 0, 1), {1, 0, 0}));
}

TEST(GltfAnimation, NormalizedIntegersAndSparseElementsAreRead) {
  GltfBuilder builder;
  builder.addTriangle();
  const int times = builder.addAccessor<float>("SCALAR", {0, 1});
  const int turns = builder.addAccessor<int16_t>("VEC4", {0, 0, 0, 32767, 0, 0, 32767, 0}, true);
  addChannel(builder, {{"node", 0}, {"path", "rotation"}}, "LINEAR", times, turns);
  const int moves = builder.addAccessor<float>("VEC3", {0, 0, 0, 0, 0, 0});
  builder.root["accessors"][size_t(moves)]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", builder.addView<uint8_t>({1})}, {"componentType", 5121}}},
      {"values", {{"bufferView", builder.addView<float>({0, 0, 8})}}}};
  addChannel(builder, {{"node", 0}, {"path", "translation"}}, "LINEAR", times, moves);
  EXPECT_TRUE(isNear(worldCornerOf(loadAt(builder, 0.5), 0, 1), {0, 1, 4}));
}

TEST(GltfAnimation, PointersDriveMaterialsLightsAndCameras) {
  GltfBuilder builder;
  builder.addTriangle()["material"] = 0;
  builder.root["materials"] = {{{"emissiveFactor", {1, 1, 1}}}};
  builder.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}}};
  builder.node(0)["camera"] = 0;
  animatePointer(builder, "/materials/0/emissiveFactor", "VEC3", {0, 0, 0, 2, 4, 6});
  animatePointer(builder, "/materials/0/pbrMetallicRoughness/roughnessFactor", "SCALAR", {0.5f, 0.0f});
  animatePointer(builder, "/cameras/0/perspective/yfov", "SCALAR", {1, 2});
  animatePointer(builder, "/nodes/0/translation", "VEC3", {0, 0, 0, 2, 0, 0});
  const Scene scene = loadAt(builder, 0.5);
  EXPECT_EQ(scene.materials[0].emissiveFactor, glm::vec3(1, 2, 3));
  EXPECT_EQ(scene.materials[0].roughnessFactor, 0.25f);
  EXPECT_EQ(scene.cameras.at(0).fovY, 1.5);
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 0), {1, 0, 0}));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfAnimation, PointersToWhatIsNotThereAreWarnedAbout) {
  for (const std::string pointer :
       {"/materials/0/emissiveFactor", "/nodes/1/translation", "/nodes/00/translation",
        "/nodes/x/translation", "nodes/0/translation", "/accessors/0/count", "/nodes/0/name", "", "/",
        "/nodes/-1/translation", "/nodes/0/extensions/KHR_lights_punctual/light"}) {
    GltfBuilder builder;
    builder.addTriangle();
    animatePointer(builder, pointer, "VEC3", {0, 0, 0, 1, 1, 1});
    EXPECT_TRUE(anyWarningHas(loadAt(builder, 0.5), "/animations/0/channels/0/target: is nothing that"))
        << pointer;
  }
}

TEST(GltfAnimation, AnimationsAreChosenByNameElseByIndex) {
  GltfBuilder builder;
  builder.addTriangle();
  animate(builder, "translation", "VEC3", {0}, {1, 0, 0});
  json second = builder.root["animations"][0];
  second["samplers"][0]["output"] = builder.addAccessor<float>("VEC3", {5, 0, 0});
  second["name"] = "0";
  builder.root["animations"].push_back(second);
  EXPECT_TRUE(isNear(worldCornerOf(loadAt(builder, 0), 0, 0), {1, 0, 0}));
  EXPECT_TRUE(isNear(worldCornerOf(loadAt(builder, 0, "1"), 0, 0), {5, 0, 0}));
  EXPECT_TRUE(isNear(worldCornerOf(loadAt(builder, 0, "0"), 0, 0), {5, 0, 0}));  // its name
  EXPECT_THROW(loadAt(builder, 0, "walk"), UsageError);
  EXPECT_THROW(loadAt(builder, 0, "2"), UsageError);
}

TEST(GltfAnimation, ATimeInAFileWithoutAnimationsIsWarnedAbout) {
  GltfBuilder builder;
  builder.addTriangle();
  EXPECT_TRUE(anyWarningHas(loadAt(builder, 1), "has no animation"));
  EXPECT_THROW(loadAt(builder, 1, "walk"), UsageError);
  GltfOptions noTime;
  noTime.selection.animation = "0";
  EXPECT_THROW(load(builder, noTime), UsageError);
}

TEST(GltfAnimation, BrokenSamplersCostTheirChannel) {
  const std::string sampler = "/animations/0/samplers/0";
  const std::string output = "/animations/0/channels/0/sampler";
  const auto refusal = [](const std::vector<float>& times, const std::string& type,
                          const std::vector<float>& values, const std::string& interpolation) {
    GltfBuilder builder;
    builder.addTriangle();
    animate(builder, "translation", type, times, values, interpolation);
    return faultAt(builder, 0.5);
  };
  const std::vector<float> two(6, 0.0f);
  EXPECT_EQ(refusal({0, 1}, "VEC3", two, "LINEAR"), "");
  EXPECT_TRUE(refusal({1, 0}, "VEC3", two, "LINEAR").starts_with(sampler + "/input: key 1"));
  EXPECT_TRUE(refusal({0, NAN}, "VEC3", two, "LINEAR").starts_with(sampler + "/input: key 1"));
  EXPECT_TRUE(refusal({0, 1}, "VEC3", {0, 0, 0, INFINITY, 0, 0}, "LINEAR").starts_with(output));
  EXPECT_TRUE(refusal({0, 1, 2}, "VEC3", two, "LINEAR").starts_with(output + ": 2 elements"));
  EXPECT_TRUE(refusal({0, 1}, "VEC3", two, "CUBICSPLINE").starts_with(output + ": 2 elements"));
  EXPECT_TRUE(refusal({0, 1}, "VEC2", {0, 0, 0, 0}, "LINEAR").starts_with(output + ": accessor"));
  EXPECT_TRUE(refusal({0, 1}, "VEC3", two, "CUBIC").starts_with(sampler + "/interpolation"));
  EXPECT_TRUE(refusal({0}, "VEC3", {0, 0, 0, 0, 0, 0, 0, 0, 0}, "CUBICSPLINE")
                  .starts_with(sampler + "/input: is the only key of a spline"));
}

TEST(GltfAnimation, UnusedAnimationsAreNotDecoded) {
  GltfBuilder builder;
  builder.addTriangle();
  animate(builder, "translation", "VEC3", {1, 0}, {0, 0, 0, 0, 0, 0});
  EXPECT_TRUE(load(builder).warnings.empty());
}

TEST(GltfAnimation, ASamplerThatIsNotThereCostsItsChannel) {
  GltfBuilder builder;
  builder.addTriangle();
  animate(builder, "translation", "VEC3", {0}, {0, 0, 0})["sampler"] = 1;
  EXPECT_EQ(
      faultAt(builder, 0.0),
      "/animations/0/channels/0/sampler: is past the samplers of its animation; the channel is left out");
}

/// A triangle with a picture, whose node moves and whose material changes.
GltfBuilder movingAndChanging() {
  GltfBuilder builder;
  const int corners = builder.addAccessor<float>("VEC2", {0, 0, 1, 0, 0, 1});
  json& triangle = builder.addTriangle();
  triangle["material"] = 0;
  triangle["attributes"]["TEXCOORD_0"] = corners;
  builder.root["images"] = {{{"uri", "picture.png"}}};
  builder.root["textures"] = {{{"source", 0}}};
  builder.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  animate(builder, "translation", "VEC3", {0, 1}, {0, 0, 0, 4, 0, 0});
  animatePointer(builder, "/materials/0/pbrMetallicRoughness/roughnessFactor", "SCALAR", {0, 1});
  return builder;
}

/// Writes a scene as three files: document, buffer and picture.
std::filesystem::path writeFiles(GltfBuilder& builder, const TemporaryFolder& folder) {
  builder.root["buffers"] = {{{"byteLength", builder.buffer().size()}, {"uri", "data.bin"}}};
  folder.write("data.bin", builder.buffer());
  folder.write("picture.png", std::string(std::begin(samples::kRgba8Png), std::end(samples::kRgba8Png)));
  return folder.write("a.gltf", builder.text());
}

void expectSame(const Scene& a, const Scene& b) {
  EXPECT_EQ(a.space.origin, b.space.origin);
  EXPECT_EQ(a.vertices.position, b.vertices.position);
  EXPECT_EQ(a.vertices.texcoord0, b.vertices.texcoord0);
  EXPECT_EQ(a.bounds.minimum, b.bounds.minimum);
  EXPECT_EQ(a.materials.at(0).roughnessFactor, b.materials.at(0).roughnessFactor);
  EXPECT_EQ(a.images.at(0).bytes, b.images.at(0).bytes);
  EXPECT_EQ(a.images.at(0).name, b.images.at(0).name);
  EXPECT_EQ(a.animationNames, b.animationNames);
  EXPECT_EQ(a.warnings, b.warnings);
}

TEST(GltfAnimation, NodesPosedInTheModelStandAsThoseThatAreParsedAgain) {
  GltfBuilder builder;
  builder.addTriangle();
  animate(builder, "translation", "VEC3", {0, 1}, {0, 0, 0, 1, 0.1f, 7});
  animate(builder, "rotation", "VEC4", {0, 1}, {0, 0, 0, 1, 0.6f, 0, 0, 0.8f});
  animate(builder, "scale", "VEC3", {0, 1}, {1, 1, 1, 0.3f, 2, 1e-3f});
  GltfOptions options;
  options.selection.animationTime = 0.37;
  const Scene inModel = load(builder, options);
  options.selection.set = {{"/nodes/0/translation", {5, 5, 5}}};  // the animation drives it
  const Scene parsedAgain = load(builder, options);
  EXPECT_EQ(parsedAgain.vertices.position, inModel.vertices.position);
  EXPECT_EQ(parsedAgain.bounds.minimum, inModel.bounds.minimum);
  EXPECT_NE(inModel.bounds.minimum, loadAt(builder, 0.0).bounds.minimum);
}

TEST(GltfAnimation, PosesOfAKeptDocumentNeedNoFile) {
  const TemporaryFolder folder;
  GltfBuilder builder = movingAndChanging();
  builder.root["extensionsUsed"].push_back("EXT_unknown");  // a warning
  const std::filesystem::path path = writeFiles(builder, folder);
  std::vector<GltfOptions> poses(4);
  poses[1].selection.animationTime = 0.5;
  poses[2].selection.animationTime = 1.0;
  poses[2].recenterOn = glm::dvec3(1, 2, 3);
  std::vector<Scene> expected;
  expected.reserve(poses.size());
  for (const GltfOptions& pose : poses) expected.push_back(loadGltf(path, pose));
  EXPECT_NE(expected[0].bounds.minimum, expected[1].bounds.minimum);
  EXPECT_FALSE(expected[0].warnings.empty());

  for (const size_t first : {0, 1}) {
    std::shared_ptr<KeptDocument> kept;
    expectSame(loadGltf(path, poses[first], &kept), expected[first]);
    for (const char* file : {"a.gltf", "data.bin", "picture.png"})
      std::filesystem::rename(folder.path() / file, folder.path() / (std::string(file) + ".away"));
    for (size_t i = 0; i < poses.size(); ++i) expectSame(loadGltf(path, poses[i], &kept), expected[i]);
    EXPECT_THROW(loadGltf(path, poses[0]), InputError);
    for (const char* file : {"a.gltf", "data.bin", "picture.png"})
      std::filesystem::rename(folder.path() / (std::string(file) + ".away"), folder.path() / file);
  }
}

TEST(GltfAnimation, AfterAPoseThatFailsTheNextIsRight) {
  const TemporaryFolder folder;
  GltfBuilder builder = movingAndChanging();
  animate(builder, "rotation", "VEC4", {0, 1}, {0, 0, 0, 1, 0, 0, 0, 0});
  const std::filesystem::path path = writeFiles(builder, folder);
  GltfOptions right;
  right.selection.animationTime = 0.5;
  GltfOptions wrong;
  wrong.selection.animationTime = 1.0;
  std::shared_ptr<KeptDocument> kept;
  const Scene expected = loadGltf(path, right, &kept);
  wrong.selection.animation = "none";
  EXPECT_THROW(loadGltf(path, wrong, &kept), UsageError);
  expectSame(loadGltf(path, right, &kept), expected);
}

TEST(GltfAnimation, OnlyAnimatedDocumentsAreKept) {
  GltfBuilder builder;
  builder.addTriangle();
  const TemporaryFolder folder;
  std::shared_ptr<KeptDocument> kept;
  EXPECT_EQ(loadGltf(folder.write("still.gltf", builder.text()), {}, &kept).triangles.size(), 1u);
  EXPECT_EQ(kept, nullptr);
}

}  // namespace
}  // namespace fragtrace::gltf_test
