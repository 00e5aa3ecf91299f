// SPDX-License-Identifier: MIT
// Files that ask for too much, lead somewhere else, or count wrongly.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <clocale>
#include <locale>
#include <regex>

#include "gltf_builder.h"

namespace fragtrace::gltf_test {
namespace {

/// Everything with an integer in it: views, strides, sparse values, indices, a texture, a camera, a light.
GltfBuilder integerScene() {
  GltfBuilder builder;
  json& primitive = builder.addTriangle();
  primitive["indices"] = builder.addAccessor<uint16_t>("SCALAR", {0, 1, 2});
  primitive["material"] = 0;
  primitive["mode"] = 4;
  const int indices = builder.addView<uint16_t>({1});
  const int values = builder.addView<float>({0, 0, 0});
  builder.root["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", indices}, {"byteOffset", 0}, {"componentType", 5123}}},
      {"values", {{"bufferView", values}, {"byteOffset", 0}}}};
  builder.root["accessors"][0]["byteOffset"] = 0;
  builder.root["bufferViews"][0]["byteStride"] = 12;
  builder.root["images"] = {{{"uri", kPixelUri}}};
  builder.root["samplers"] = {{{"wrapS", 10497}, {"wrapT", 10497}, {"magFilter", 9729}}};
  builder.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
  builder.root["materials"] = {{{"emissiveTexture", {{"index", 0}, {"texCoord", 0}}}}};
  builder.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  builder.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  builder.node(0)["children"] = {1};
  builder.root["nodes"].push_back({{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  builder.root["scenes"] = {{{"nodes", {0}}}};
  builder.root["scene"] = 0;
  builder.embedBuffer();
  return builder;
}

TEST(GltfLimits, AnyIntegerMayBeAnyOther) {
  const GltfBuilder valid = integerScene();
  const TemporaryFolder folder;
  size_t count = 0;
  const json flat = valid.root.flatten();
  for (const auto& member : flat.items()) {
    if (!member.value().is_number_integer()) continue;
    for (const uint64_t value :
         {uint64_t(0), uint64_t(1) << 31, uint64_t(1) << 32, uint64_t(1) << 62, UINT64_MAX}) {
      json changed = valid.root;
      changed[json::json_pointer(member.key())] = value;
      const std::string refusal = refusalOf(folder.write("test.gltf", changed.dump()));
      EXPECT_TRUE(refusal.empty() || refusal.starts_with("test.gltf: /")) << member.key() << ": " << refusal;
      ++count;
    }
  }
  EXPECT_GT(count, 150u);
}

TEST(GltfLimits, AFileCutAnywhereIsRefused) {
  const TemporaryFolder folder;
  const std::string whole = integerScene().text();
  for (size_t length = 0; length < whole.size(); ++length) {
    const std::string refusal = refusalOf(folder.write("cut.gltf", whole.substr(0, length)));
    EXPECT_TRUE(refusal.starts_with("cut.gltf: ")) << length;
  }
}

TEST(GltfLimits, HalfAMillionBracketsAreRefusedBeforeTheyAreParsed) {
  const TemporaryFolder folder;
  for (const char bracket : {'[', '{'}) {
    std::string text = R"({"asset":{"version":"2.0"},"extras":)";
    for (int i = 0; i < 512000; ++i) text += bracket == '[' ? "[" : "{\"a\":";
    EXPECT_EQ(refusalOf(folder.write("a.gltf", text)), "a.gltf: the JSON is nested deeper than 256");
  }
}

TEST(GltfLimits, MemoryFromNothingIsRefused) {
  // A thousand primitives of 67 million zeros each, none of which takes room in the file.
  GltfBuilder builder;
  builder.root["accessors"] = {{{"componentType", 5126}, {"count", 1 << 26}, {"type", "VEC3"}}};
  for (int i = 0; i < 1000; ++i) builder.addMesh({{"POSITION", 0}});
  GltfOptions options;
  options.limits.memoryBytes = uint64_t(1) << 30;
  try {
    load(builder, options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("/meshes/0/primitives/0/attributes/POSITION: would take"),
              std::string::npos)
        << error.what();
  }
}

TEST(GltfLimits, ManyNodesThatShowAMeshAreCountedBeforeItIsCopied) {
  GltfBuilder builder;
  builder.addTriangle();
  for (int i = 0; i < 10000; ++i) builder.root["nodes"].push_back({{"mesh", 0}});
  GltfOptions options;
  options.limits.memoryBytes = 20'000'000;
  EXPECT_EQ(load(builder, options).triangles.size(), 10001u);
  options.limits.memoryBytes = 8'000'000;
  EXPECT_THROW(load(builder, options), InputError);
}

TEST(GltfLimits, ATextureBeyondTheLimitIsNotMissing) {
  const TemporaryFolder folder;
  folder.write("a.png", std::string(5'000'000, ' '));
  GltfBuilder builder;
  builder.root["images"] = {{{"uri", "a.png"}}};
  builder.root["textures"] = {{{"source", 0}}};
  builder.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  builder.addTriangle()["material"] = 0;
  const auto path = folder.write("a.gltf", builder.text());
  GltfOptions options;
  options.limits.memoryBytes = 4'000'000;
  for (const bool drawn : {false, true}) {
    options.limits.drawMissingTextures = drawn;
    try {
      loadGltf(path, options);
      ADD_FAILURE() << drawn;
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_TRUE(text.ends_with("more than the 4 MB of --memory-limit")) << text;
    }
  }
}

TEST(GltfLimits, AFileLargerThanTheLimitIsNotRead) {
  const TemporaryFolder folder;
  GltfOptions options;
  options.limits.memoryBytes = 1000;
  const auto path = folder.write("a.gltf", integerScene().text() + std::string(1000, ' '));
  EXPECT_THROW(loadGltf(path, options), InputError);
  EXPECT_EQ(refusalOf(path), "");
  EXPECT_EQ(refusalOf("/dev/zero"), "zero: is a device, neither a file nor a pipe");
}

std::string refusalOfUri(const TemporaryFolder& folder, const std::string& uri, bool allowExternal = false) {
  GltfBuilder builder;
  builder.addTriangle();
  builder.root["buffers"] = {{{"byteLength", builder.buffer().size()}, {"uri", uri}}};
  GltfOptions options;
  options.limits.allowExternalFiles = allowExternal;
  std::filesystem::create_directories(folder.path() / "scene/sub");
  folder.write("out.bin", builder.buffer());
  folder.write("scene/in.bin", builder.buffer());
  try {
    loadGltf(folder.write("scene/a.gltf", builder.text()), options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(GltfLimits, UrisStayInTheFolder) {
  const TemporaryFolder folder;
  const std::string absolute = (folder.path() / "out.bin").string();
  EXPECT_EQ(refusalOfUri(folder, "in.bin"), "");
  EXPECT_EQ(refusalOfUri(folder, "../scene/./in.bin", true), "");
  for (const std::string& uri : {std::string("../out.bin"), std::string("%2e%2e/out.bin"),
                                 std::string("sub/../../out.bin"), absolute}) {
    EXPECT_NE(refusalOfUri(folder, uri).find("leads out of the scene's folder"), std::string::npos) << uri;
    EXPECT_EQ(refusalOfUri(folder, uri, true), "") << uri;
    const std::string escaped = std::regex_replace(uri, std::regex("/"), "%5C");
    EXPECT_NE(refusalOfUri(folder, escaped).find("leads out of the scene's folder"), std::string::npos)
        << escaped;
    EXPECT_EQ(refusalOfUri(folder, escaped, true), "") << escaped;
  }
  EXPECT_EQ(refusalOfUri(folder, "sub\\..\\in.bin"), "");
  folder.write("scene/sub\\..\\..\\out.bin", "another file, of that name");
  EXPECT_NE(refusalOfUri(folder, "sub\\..\\..\\out.bin"), "") << "it is the one that is read";
  for (const char* uri : {"http://example.com/a.bin", "file:///etc/passwd", "C:\\a.bin", ":", "in.bin%00"})
    EXPECT_NE(refusalOfUri(folder, uri, true).find("neither a data URI nor a relative path"),
              std::string::npos)
        << uri;
}

/// Found by the fuzzer: a data URI whose "data:" is misspelt is a file's name.
TEST(GltfLimits, ANameOfThousandsOfBytesIsShortened) {
  const TemporaryFolder folder;
  const std::string refusal = refusalOfUri(folder, "dat~:a/b;base64," + std::string(5000, 'A'));
  EXPECT_NE(refusal.find("AA...\" cannot be opened"), std::string::npos) << refusal;
  EXPECT_LT(refusal.size(), 500u);
}

TEST(GltfLimits, UrisLeadToRegularFilesOnly) {
  const TemporaryFolder folder;
  EXPECT_EQ(refusalOfUri(folder, "in.bin"), "");
  ASSERT_EQ(::mkfifo((folder.path() / "scene/pipe.bin").c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/zero", folder.path() / "scene/zero.bin");
  std::filesystem::create_symlink("../out.bin", folder.path() / "scene/link.bin");
  std::filesystem::create_symlink("in.bin", folder.path() / "scene/inner.bin");
  std::filesystem::create_directory(folder.path() / "scene/folder.bin");
  for (const char* uri : {"pipe.bin", "folder.bin", "."})
    EXPECT_NE(refusalOfUri(folder, uri).find("is not a regular file"), std::string::npos) << uri;
  for (const char* uri : {"link.bin", "zero.bin"})
    EXPECT_NE(refusalOfUri(folder, uri).find("is a link out of the scene's folder"), std::string::npos)
        << uri;
  EXPECT_NE(refusalOfUri(folder, "zero.bin", true).find("is not a regular file"), std::string::npos);
  EXPECT_EQ(refusalOfUri(folder, "link.bin", true), "");
  EXPECT_EQ(refusalOfUri(folder, "inner.bin"), "");
}

struct DecimalComma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
};

TEST(GltfLimits, ALocaleWithADecimalCommaChangesNothing) {
  const std::locale before = std::locale::global(std::locale(std::locale(), new DecimalComma));
  const std::string beforeC = std::setlocale(LC_ALL, nullptr);
  // Those of C are often not installed; those of C++'s streams can be made.
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8"}) {
    if (std::setlocale(LC_ALL, name) != nullptr) break;
  }
  GltfBuilder builder;
  builder.addTriangle();
  builder.node(0)["translation"] = {0.5, 1.25, -2.75};
  const Scene scene = load(builder);
  std::setlocale(LC_ALL, beforeC.c_str());
  std::locale::global(before);
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 0), {0.5, 1.25, -2.75}));
}

TEST(GltfLimits, BytesThatAreNoUtf8BecomeReplacements) {
  const TemporaryFolder folder;
  const auto path =
      folder.write("a.gltf", "{\"asset\":{\"version\":\"2.0\"},\"materials\":[{\"name\":\"\xff\xfe\"}]}");
  const Scene scene = loadGltf(path);
  EXPECT_EQ(scene.materials[0].name, "\xef\xbf\xbd\xef\xbf\xbd");
  EXPECT_EQ(faultOf(path),
            "a.gltf: /materials/0/name: holds bytes that are no UTF-8, which become U+FFFD (2 times)");
}

}  // namespace
}  // namespace fragtrace::gltf_test
