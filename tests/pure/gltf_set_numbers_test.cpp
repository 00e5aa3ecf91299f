// SPDX-License-Identifier: MIT
// Numbers instead of the file's: as they are loaded, set in a scene that is there, and written.
#include <gtest/gtest.h>

#include "gltf/assemble/numbers.h"
#include "gltf/edit/changed_file.h"
#include "gltf/edit/factors.h"
#include "gltf_builder.h"
#include "image/files/whole_file.h"

namespace fragtrace::gltf_test {
namespace {

const std::string kRoughness = "/materials/0/pbrMetallicRoughness/roughnessFactor";
const std::string kIntensity = "/extensions/KHR_lights_punctual/lights/0/intensity";

/// A triangle of a coated material, which a lamp lights.
GltfBuilder coated() {
  GltfBuilder builder;
  builder.addTriangle()["material"] = 0;
  builder.root["extensionsUsed"] = {"KHR_materials_clearcoat", "KHR_lights_punctual"};
  builder.root["materials"] = {{{"extensions", {{"KHR_materials_clearcoat", {{"clearcoatFactor", 0.5}}}}}}};
  builder.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"color", {0.25, 0.5, 0.1}}, {"intensity", 543.5141306588226}}};
  builder.root["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  return builder;
}

Scene loadWith(std::vector<SetNumber> set) {
  GltfBuilder builder = coated();
  GltfOptions options;
  options.selection.set = std::move(set);
  return load(builder, options);
}

/// All that can be set, of the first material and the first lamp.
std::vector<float> numbersOf(const Scene& scene) {
  std::vector<float> numbers;
  Material material = scene.materials.at(0);
  for (const Factor& factor : factors())
    numbers.insert(numbers.end(), factor.at(material), factor.at(material) + factor.width);
  for (int c = 0; c < 3; ++c) numbers.push_back(scene.lights.at(0).intensity[c]);
  return numbers;
}

TEST(SetNumbers, AreThoseOfAFileThatHasThem) {
  GltfBuilder builder = coated();
  builder.root["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 0.3;
  builder.root["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"] = 7.1;
  const Scene scene = loadWith({{kRoughness, {0.9}}, {kRoughness, {0.3}}, {kIntensity, {7.1}}});
  EXPECT_EQ(numbersOf(scene), numbersOf(load(builder)));
  EXPECT_EQ(scene.materials[0].roughnessFactor, 0.3f);
}

TEST(SetNumbers, NeedAPlaceOfTheFileAndItsWidth) {
  for (const char* wrong : {"/materials/1/pbrMetallicRoughness/roughnessFactor", "/materials/0/name",
                            "/materials/0/extensions/KHR_materials_sheen/sheenRoughnessFactor", "/nodes"})
    EXPECT_THROW(loadWith({{wrong, {0.5}}}), UsageError) << wrong;
  EXPECT_THROW(loadWith({{kRoughness, {0.5, 0.5}}}), UsageError);
  EXPECT_THROW(loadWith({{"/materials/0/emissiveFactor", {1.0}}}), UsageError);
}

TEST(SetNumbers, MakeTheSceneThatWouldBeLoaded) {
  const std::string coat = "/materials/0/extensions/KHR_materials_clearcoat/clearcoat";
  const std::vector<SetNumber> all = {
      {kRoughness, {0.3}},
      {"/materials/0/pbrMetallicRoughness/metallicFactor", {0.7}},
      {"/materials/0/pbrMetallicRoughness/baseColorFactor", {0.1, 0.2, 0.3, 1}},
      {coat + "Factor", {0.25}},
      {coat + "RoughnessFactor", {0.125}},
      {kIntensity, {7.1}},
      {"/extensions/KHR_lights_punctual/lights/0/color", {0.9, 0.1, 0.3}}};
  const Scene file = loadWith({});
  Scene scene = file;
  ASSERT_TRUE(setByEye(scene, file.materials, file.lightSources, all));
  EXPECT_EQ(numbersOf(scene), numbersOf(loadWith(all)));
  // A number that is no longer set is the file's again.
  ASSERT_TRUE(setByEye(scene, file.materials, file.lightSources, {}));
  EXPECT_EQ(numbersOf(scene), numbersOf(file));
}

TEST(SetNumbers, BeyondTheirRangeCountAsTheNearest) {
  const std::string emission = "/materials/0/emissiveFactor";
  const std::vector<SetNumber> all = {{kRoughness, {7.0}}, {emission, {0, 3, 0}}};
  const Scene loaded = loadWith(all);
  Material material = loadWith({}).materials.at(0);
  setFactors(material, all);
  EXPECT_EQ(material.roughnessFactor, 1.0f);
  EXPECT_EQ(material.roughnessFactor, loaded.materials[0].roughnessFactor);
  EXPECT_EQ(material.emissiveFactor, glm::vec3(0, 3, 0));
  EXPECT_EQ(loaded.materials[0].emissiveFactor, glm::vec3(0, 3, 0));
  // The loader says what the viewer says of the numbers alone.
  ASSERT_EQ(loaded.warnings.size(), 2u);
  const std::vector<std::string> warnings = warningsOf(all);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0],
            "--set: " + kRoughness + ": is out of range, the nearest possible value is taken: 1");
  EXPECT_EQ(warnings[1], "--set: " + emission + ": " + whatIsBright(all[1]));
  EXPECT_TRUE(warningsOf(std::vector<SetNumber>{{kRoughness, {0.3}}, {emission, {0, 1, 0}}}).empty());
}

TEST(SetNumbers, OfAnotherKindOfMaterialAskForAnotherScene) {
  const Scene file = loadWith({});
  Scene scene = file;
  for (const SetNumber& set :
       {SetNumber{"/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor", {0}},
        SetNumber{"/materials/0/emissiveFactor", {1, 1, 1}}, SetNumber{kRoughness, {0.01}},  // a mirror
        SetNumber{"/materials/0/alphaCutoff", {0.25}}}) {
    EXPECT_FALSE(setByEye(scene, file.materials, file.lightSources, {{set}})) << set.pointer;
  }
  EXPECT_EQ(numbersOf(scene), numbersOf(file));
}

TEST(SetNumbers, FactorsAreOfferedWhereTheFileHasTheirObject) {
  const Scene scene = loadWith({});
  std::string offered;
  for (const Factor& factor : factors()) {
    if (isOffered(factor, scene.materials[0])) offered += std::string(factor.member) + " ";
  }
  EXPECT_EQ(offered,
            "baseColorFactor metallicFactor roughnessFactor emissiveFactor clearcoatFactor "
            "clearcoatRoughnessFactor ");
  EXPECT_FALSE(isOffered(factors()[0], Material{}));
}

TEST(JsonText, AllOtherBytesStay) {
  const auto changed = [](const std::string& text, const char* pointer, std::vector<double> values) {
    return withNumbers(text, {{{pointer, std::move(values)}}});
  };
  EXPECT_EQ(changed("{ \"a\" : [ {\"b\":1.50,\"c\":\"}]\\\"\"} ] }\n", "/a/0/b", {0.1}),
            "{ \"a\" : [ {\"b\":0.1,\"c\":\"}]\\\"\"} ] }\n");
  // Numbers that are the same as floats are left as they are written.
  EXPECT_EQ(changed("{\"c\":[ 0.10000000149 ,2e-1,\n3]}", "/c", {0.1, 0.2, 0.5}),
            "{\"c\":[ 0.10000000149 ,2e-1,\n0.5]}");
  EXPECT_EQ(changed("{\"c\":[1,2]}", "/c", {1, 2, 3}), "{\"c\":[1, 2, 3]}");
  // The reader takes the last of two, and \u0061 is a.
  EXPECT_EQ(changed("{\"a\":1,\"\\u0061\":2}", "/a", {3}), "{\"a\":1,\"\\u0061\":3}");
  EXPECT_EQ(changed("\xef\xbb\xbf{\"a/b\":1}", "/a~1b", {2}), "\xef\xbb\xbf{\"a/b\":2}");
  EXPECT_THROW(changed("{\"a\":[1]}", "/a/1", {2}), std::runtime_error);
  EXPECT_THROW(changed("{\"a\":1}", "/a/b", {2}), std::runtime_error);
}

TEST(JsonText, MissingMembersStandBehindTheLast) {
  const auto changed = [](const std::string& text, std::vector<double> values) {
    return withNumbers(text, {{{"/m/0/p/r", std::move(values)}}});
  };
  EXPECT_EQ(changed("{\"m\":[{\n  \"n\": 1,\n  \"p\": {\n    \"q\": [1]\n  }\n}]}", {0.5}),
            "{\"m\":[{\n  \"n\": 1,\n  \"p\": {\n    \"q\": [1],\n    \"r\": 0.5\n  }\n}]}");
  EXPECT_EQ(changed("{\"m\":[{\"n\":1}]}", {0.5, 1}), "{\"m\":[{\"n\":1,\"p\":{\"r\": [0.5, 1]}}]}");
  EXPECT_EQ(changed("{\"m\":[{ }]}", {0.5}), "{\"m\":[{\"p\": {\"r\": 0.5} }]}");
}

TEST(JsonText, WhatIsTakenOutGoesWithItsComma) {
  const auto without = [](const std::string& text) { return withNumbers(text, {{{"/m/0/t", {}, "none"}}}); };
  EXPECT_EQ(without("{\"m\":[{\"a\":1,\n \"t\": {\"index\":0},\n \"b\":2}]}"),
            "{\"m\":[{\"a\":1,\n \"b\":2}]}");
  EXPECT_EQ(without("{\"m\":[{\"t\": {}, \"b\":2}]}"), "{\"m\":[{\"b\":2}]}");
  EXPECT_EQ(without("{\"m\":[{\"a\":1, \"t\":3 }]}"), "{\"m\":[{\"a\":1 }]}");
  EXPECT_EQ(without("{\"m\":[{ \"t\":3 }]}"), "{\"m\":[{  }]}");
  for (const char* same : {"{\"m\":[{\"a\":1}]}", "{\"m\":[]}", "{\"a\":{\"t\":1}}"})
    EXPECT_EQ(without(same), same);
}

std::string contentOf(const std::filesystem::path& path) {
  const std::vector<uint8_t> bytes = readWholeFile(path);
  return {bytes.begin(), bytes.end()};
}

TEST(ChangedFile, OfAGlbKeepsItsOtherChunks) {
  const TemporaryFolder folder;
  GltfBuilder builder = coated();
  const auto from = folder.write("a.glb", builder.glb());
  const auto to = folder.path() / "b.glb";
  for (const double roughness : {0.5, 0.25, 0.125, 0.0625}) {  // their texts have all lengths that are padded
    writeChanged(from, to, {{{kRoughness, {roughness}}}});
    const Scene scene = loadGltf(to);
    EXPECT_EQ(scene.materials.at(0).roughnessFactor, float(roughness));
    EXPECT_TRUE(scene.warnings.empty());
    const std::string bytes = contentOf(to);
    EXPECT_EQ(bytes.size() % 4, 0u);
    const std::string binary = contentOf(from).substr(contentOf(from).find(std::string("BIN\0", 4)) - 4);
    EXPECT_TRUE(bytes.ends_with(binary));
  }
  writeChanged(from, to, {});
  EXPECT_EQ(contentOf(to), contentOf(from));
}

TEST(ChangedFile, HasWhatMaterialsGotByName) {
  const TemporaryFolder folder;
  GltfBuilder builder = coated();
  builder.root["materials"][0]["name"] = "oak: old";
  const auto from = folder.write("a.gltf", builder.text());
  const auto to = folder.path() / "b.gltf";
  writeChanged(from, to,
               {{{"oak*:sheenRoughness", {0.5}},
                 {"oak: old:index", {1.25}},
                 {"oa?? old:roughness", {0.5}},
                 {"oak: old:alphaMode", {}, "BLEND"},
                 {"oak: old:doubleSided", {}, "true"}}});
  const Scene scene = loadGltf(to);
  const Material& material = scene.materials.at(0);
  EXPECT_EQ(material.ior, 1.25f);
  EXPECT_EQ(material.sheenRoughnessFactor, 0.5f);
  EXPECT_EQ(material.alphaMode, AlphaMode::Blend);
  EXPECT_TRUE(material.doubleSided);
  EXPECT_TRUE(scene.warnings.empty());
  for (const char* name : {"KHR_materials_sheen", "KHR_materials_ior"})
    EXPECT_EQ(std::ranges::count(scene.extensionsUsed, name), 1) << name;
  EXPECT_THROW(checkChange(from, {{{"elm:roughness", {0.5}}}}), UsageError);
}

TEST(MaterialNames, MatchPatterns) {
  for (const auto& [pattern, text] :
       std::initializer_list<std::pair<const char*, const char*>>{{"a", "a"},
                                                                  {"*", ""},
                                                                  {"*", "x"},
                                                                  {"a*c", "abbc"},
                                                                  {"*b*b*", "abcb"},
                                                                  {"?", "\xc3\xa4"},
                                                                  {"\\*", "*"},
                                                                  {"a\\?", "a?"},
                                                                  {"**a", "ba"}})
    EXPECT_TRUE(matchesPattern(pattern, text)) << pattern << " " << text;
  for (const auto& [pattern, text] : std::initializer_list<std::pair<const char*, const char*>>{
           {"a", "ab"}, {"ab", "a"}, {"?", ""}, {"\\*", "a"}, {"a*c", "abb"}, {"*b?", "ab"}, {"", "a"}})
    EXPECT_FALSE(matchesPattern(pattern, text)) << pattern << " " << text;
}

TEST(ChangedFile, IsNotWrittenWithNumbersThatItCannotHave) {
  const TemporaryFolder folder;
  GltfBuilder builder = coated();
  const auto from = folder.write("a.gltf", builder.text());
  const auto to = folder.path() / "b.gltf";
  const std::vector<SetNumber> wrong[] = {{{kRoughness, {0.5, 2.0}}},
                                          {{"/asset/version", {1.0}}},
                                          {{"/accessors/0/count", {99999.0}}},
                                          {{"/materials/9/alphaCutoff", {0.5}}}};
  for (const std::vector<SetNumber>& set : wrong) {
    EXPECT_THROW(writeChanged(from, to, set), InputError) << set[0].pointer;
    EXPECT_FALSE(std::filesystem::exists(to)) << set[0].pointer;
    EXPECT_THROW(checkChange(from, set), UsageError) << set[0].pointer;
  }
  EXPECT_NO_THROW(checkChange(from, {{{kRoughness, {0.5}}}}));
}

TEST(ChangedFile, ThatRefersToOthersStaysInItsFolder) {
  const TemporaryFolder folder;
  const TemporaryFolder other;
  GltfBuilder builder = coated();
  const auto whole = folder.write("whole.gltf", builder.text());
  builder.root["buffers"] = {{{"byteLength", builder.buffer().size()}, {"uri", "a.bin"}}};
  folder.write("a.bin", builder.buffer());
  const auto refers = folder.write("refers.gltf", builder.text());
  EXPECT_TRUE(loadGltf(refers).refersToFiles);
  EXPECT_FALSE(loadGltf(whole).refersToFiles);
  writeChanged(whole, other.path() / "whole.gltf", {{{kRoughness, {0.5}}}});
  EXPECT_EQ(loadGltf(other.path() / "whole.gltf").materials.at(0).roughnessFactor, 0.5f);
  writeChanged(refers, folder.path() / "b.gltf", {{{kRoughness, {0.5}}}});
  EXPECT_EQ(loadGltf(folder.path() / "b.gltf").materials.at(0).roughnessFactor, 0.5f);
  try {
    writeChanged(refers, other.path() / "b.gltf", {{{kRoughness, {0.5}}}});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("refers to other files, such as a.bin"), std::string::npos);
  }
  EXPECT_FALSE(std::filesystem::exists(other.path() / "b.gltf"));
}

}  // namespace
}  // namespace fragtrace::gltf_test
