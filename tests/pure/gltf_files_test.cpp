// SPDX-License-Identifier: MIT
// Tests of containers, URIs, pictures, extensions, and messages about files that cannot be loaded.
#include <chrono>
#include <filesystem>
#include <utility>

#include <gtest/gtest.h>

#include "gltf_builder.h"
#include "image_samples.h"

namespace fragtrace::gltf_test {
namespace {

TEST(GltfFiles, GlbHoldsTheSameSceneAsJson) {
  GltfBuilder builder;
  builder.addTriangle();
  const TemporaryFolder folder;
  const Scene scene = loadGltf(folder.write("box.glb", builder.glb()));
  ASSERT_EQ(scene.triangles.size(), 1u);
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 1), {1, 0, 0}));
}

TEST(GltfFiles, ContainerIsToldByContentNotByName) {
  GltfBuilder builder;
  builder.addTriangle();
  const TemporaryFolder folder;
  EXPECT_EQ(loadGltf(folder.write("box.gltf", builder.glb())).triangles.size(), 1u);
}

TEST(GltfFiles, BufferMayBeLongerThanItsByteLength) {
  GltfBuilder builder;
  builder.addTriangle();
  const TemporaryFolder folder;
  folder.write("data.bin", builder.buffer() + "more");
  builder.root["buffers"] = {{{"byteLength", builder.buffer().size()}, {"uri", "data.bin"}}};
  EXPECT_EQ(loadGltf(folder.write("box.gltf", builder.text())).triangles.size(), 1u);
}

TEST(GltfFiles, AnyFileNameWorksEscapedOrNot) {
  for (const auto& [name, uri] : std::vector<std::pair<std::string, std::string>>{
           {"a b+c.bin", "a%20b+c.bin"}, {"größe 木.bin", "größe 木.bin"}, {"ü%.bin", "%C3%BC%25.bin"}}) {
    GltfBuilder builder;
    builder.addTriangle();
    const TemporaryFolder folder;
    folder.write(name, builder.buffer());
    builder.root["buffers"] = {{{"byteLength", builder.buffer().size()}, {"uri", uri}}};
    EXPECT_EQ(loadGltf(folder.write("шкаф und so.gltf", builder.text())).triangles.size(), 1u) << uri;
  }
}

GltfBuilder withTexture(const json& image) {
  GltfBuilder builder;
  builder.root["images"] = nlohmann::json::array({image});
  builder.root["textures"] = {{{"source", 0}}};
  builder.root["materials"] = {{{"normalTexture", {{"index", 0}}}}};
  return builder;
}

TEST(GltfFiles, ImagesStayEncodedWhereverTheyCameFrom) {
  const std::vector<uint8_t> expected(std::begin(samples::kRgba8Png), std::end(samples::kRgba8Png));
  const std::string content(expected.begin(), expected.end());
  const TemporaryFolder folder;

  folder.write("my image.png", content);
  GltfBuilder beside = withTexture({{"uri", "my%20image.png"}});
  const EncodedImage fromFile = loadGltf(folder.write("a.gltf", beside.text())).images.at(0);
  EXPECT_EQ(fromFile.bytes, expected);
  EXPECT_EQ(fromFile.name, (folder.path() / "my image.png").string());

  GltfBuilder inUri = withTexture({{"uri", "data:image/webp;base64," + base64(content)}});
  const EncodedImage fromUri = loadGltf(folder.write("b.gltf", inUri.text())).images.at(0);
  EXPECT_EQ(fromUri.bytes, expected);
  EXPECT_EQ(fromUri.name, (folder.path() / "b.gltf").string() + ": /images/0");

  GltfBuilder inView = withTexture({{"bufferView", 0}, {"mimeType", "image/png"}});
  inView.addView(expected);
  EXPECT_EQ(loadGltf(folder.write("c.glb", inView.glb())).images.at(0).bytes, expected);
}

TEST(GltfFiles, MissingImagesAreNamedInOneLine) {
  GltfBuilder builder = withTexture({{"uri", "nowhere.png"}});
  EXPECT_EQ(
      faultOf(builder),
      "test.gltf: /images/0/uri: nowhere.png cannot be opened: No such file or directory; no drawn material "
      "has it");
  builder.root["images"].push_back({{"uri", "gone.png"}});
  builder.root["textures"].push_back({{"source", 1}});
  builder.root["materials"][0]["emissiveTexture"]["index"] = 1;
  builder.addTriangle()["material"] = 0;
  EXPECT_EQ(
      faultOf(builder),
      "test.gltf: /images/0/uri: nowhere.png, gone.png cannot be opened: No such file or directory; a base "
      "colour is drawn in magenta, other textures are left out");
  GltfOptions options;
  options.limits.drawMissingTextures = false;
  EXPECT_TRUE(
      faultOf(builder, options)
          .ends_with("/nowhere.png cannot be opened: No such file or directory; also missing: gone.png "
                     "(--missing-textures magenta draws the scene without it)"));
}

TEST(GltfFiles, NamesFromWindowsAreExplained) {
  const TemporaryFolder folder;
  folder.write("Wood.PNG", "x");
  const std::string refusal = faultOf(folder.write("a.gltf", withTexture({{"uri", "wood.png"}}).text()));
  EXPECT_NE(refusal.find("No such file or directory; Wood.PNG lies there"), std::string::npos) << refusal;
}

TEST(GltfFiles, MissingFileIsRefusedInOneLine) {
  const TemporaryFolder folder;
  EXPECT_EQ(refusalOf(folder.path() / "none.gltf"), "none.gltf: cannot be opened: No such file or directory");
  EXPECT_EQ(refusalOf(folder.path() / "."), ".: is a folder, not a file");
}

TEST(GltfFiles, MissingBufferIsRefusedByName) {
  GltfBuilder builder;
  builder.addTriangle();
  builder.root["buffers"] = {{{"byteLength", 36}, {"uri", "none.bin"}}};
  EXPECT_NE(refusalOf(builder).find("none.bin cannot be opened"), std::string::npos);
}

TEST(GltfFiles, EveryTruncationOfAGlbIsRefused) {
  GltfBuilder builder;
  builder.addTriangle();
  const std::string whole = builder.glb();
  const TemporaryFolder folder;
  for (size_t length = 0; length < whole.size(); ++length) {
    const auto path = folder.write("cut.glb", whole.substr(0, length));
    const std::string refusal = refusalOf(path);
    EXPECT_TRUE(refusal.starts_with("cut.glb: ")) << length;
    EXPECT_EQ(refusal.find('\n'), std::string::npos) << length;
  }
  EXPECT_EQ(refusalOf(folder.write("cut.glb", whole.substr(0, 100))),
            "cut.glb: truncated .glb: its header says " + std::to_string(whole.size()) +
                " bytes, the file has 100");
}

TEST(GltfFiles, WhatIsNotGltfIsRefused) {
  const TemporaryFolder folder;
  EXPECT_EQ(refusalOf(folder.write("a.gltf", "a cube")), "a.gltf: is not glTF: neither JSON nor a .glb");
  EXPECT_EQ(refusalOf(folder.write("a.gltf", "solid cube")),
            "a.gltf: is STL, not glTF; Blender opens it and writes a .glb");
  EXPECT_EQ(refusalOf(folder.write("a.gltf", "")), "a.gltf: is empty, not glTF");
  EXPECT_EQ(refusalOf(folder.write("a.gltf", "{}")), "a.gltf: \"asset\" is missing");
  EXPECT_TRUE(refusalOf(folder.write("a.gltf", "{\"asset\":")).starts_with("a.gltf: the JSON is broken: "));
  EXPECT_TRUE(
      refusalOf(folder.write("a.gltf", "{\n \"asset\": 1e309}")).ends_with("'1e309' at line 2, column 15"));
  EXPECT_EQ(refusalOf(folder.write("a.gltf", "PK\3\4 and so on")),
            "a.gltf: is a ZIP archive, which is to be unpacked first");
  EXPECT_EQ(refusalOf(folder.write("a.gltf", "<!DOCTYPE html>")),
            "a.gltf: is a page of the web or XML, not the model itself");
  // The version comes before what 2.0 has in other forms.
  EXPECT_EQ(refusalOf(folder.write("a.gltf", R"({"asset":{"version":"1.0"},"meshes":{"cube":{}}})")),
            "a.gltf: /asset/version: glTF \"1.0\" is not supported, only 2.x is");
}

TEST(GltfFiles, WhatIsNotGltfIsRefusedBeforeItIsRead) {
  const TemporaryFolder folder;
  constexpr uint64_t kSize = uint64_t(6) << 30;  // sparse: it takes no room on the disk
  const auto refusal = [&](const std::string& beginning) {
    const std::filesystem::path path = folder.write("large.glb", beginning);
    std::filesystem::resize_file(path, kSize);
    GltfOptions options;
    options.limits.memoryBytes = 2 * kSize;
    const auto start = std::chrono::steady_clock::now();
    std::string text;
    try {
      loadGltf(path, options);
    } catch (const InputError& error) {
      text = error.what();
    }
    // To fill so much memory takes more than a second.
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(500)) << text;
    return text.substr(text.rfind("large.glb"));
  };
  EXPECT_EQ(refusal(""), "large.glb: is not glTF: neither JSON nor a .glb");
  EXPECT_EQ(refusal(std::string("glTF\1\0\0\0\x20\0\0\0", 12)), "large.glb: .glb version 1 is not supported");
  EXPECT_NE(refusal(std::string("glTF\2\0\0\0\x14\0\0\0\0\0\0\0BIN\0", 20)).find("first chunk is not JSON"),
            std::string::npos);
  const std::string header("glTF\2\0\0\0\xfc\xff\xff\xff", 12);  // all that 32 bits can say
  EXPECT_EQ(refusal(header + std::string("\xf8\xff\xff\xffJSON{}", 10)),
            "large.glb: broken .glb: chunk 0 of 4294967288 bytes reaches past the end of the file");
  const std::string far = "{\"asset\":{}}" + std::string(100000, ' ');
  std::string json("    JSON" + far);
  const auto size = uint32_t(far.size());
  std::memcpy(json.data(), &size, sizeof size);
  EXPECT_EQ(refusal(header + json +
                    std::string("\xf0\xff\xff\xff"
                                "BIN\0",
                                8)),
            "large.glb: broken .glb: chunk 1 of 4294967280 bytes reaches past the end of the file");
}

TEST(GltfFiles, LoadingTellsHowFarItIsAndEndsWhenToldSo) {
  const TemporaryFolder folder;
  GltfBuilder builder;
  builder.addTriangle();
  builder.addView(std::vector<uint8_t>(40'000'000));
  const std::filesystem::path path = folder.write("large.glb", builder.glb());
  GltfOptions options;
  std::vector<std::string> steps;
  double last = 0.0;
  options.progress = [&](const std::string& step, double part) {
    EXPECT_GE(part, last);
    EXPECT_LE(part, 0.5);
    last = part;
    steps.push_back(step);
  };
  loadGltf(path, options);
  for (const char* step :
       {"reading the scene, 16 of 40 MB", "reading the scene, 40 of 40 MB", "building the meshes"})
    EXPECT_NE(std::ranges::find(steps, step), steps.end()) << step;

  struct Enough {};
  size_t calls = 0;
  options.progress = [&](const std::string&, double) {
    if (++calls == 2) throw Enough();
  };
  EXPECT_THROW(loadGltf(path, options), Enough);
  EXPECT_EQ(calls, 2u);
}

TEST(GltfFiles, JsonNestedTooDeeplyIsRefused) {
  const TemporaryFolder folder;
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  const auto path = folder.write("a.gltf", R"({"asset":{"version":"2.0"},"extras":)" + deep + "}");
  EXPECT_EQ(refusalOf(path), "a.gltf: the JSON is nested deeper than 256");
}

TEST(GltfFiles, UnknownExtensionIsRefusedOnlyIfRequired) {
  GltfBuilder builder;
  builder.root["extensionsUsed"] = {"KHR_materials_ior", "VENDOR_unknown"};
  const Scene scene = load(builder);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_TRUE(anyWarningHas(scene, "/extensionsUsed/1: the extension \"VENDOR_unknown\" is ignored"));
  EXPECT_EQ(scene.extensionsUsed.size(), 2u);
  builder.root["extensionsRequired"] = {"KHR_materials_ior", "VENDOR_unknown"};
  EXPECT_EQ(
      refusalOf(builder),
      "test.gltf: /extensionsRequired/1: the extension \"VENDOR_unknown\" is required and not supported "
      "(--ignore-required draws the scene without it)");
}

TEST(GltfFiles, AFileWithoutGeometryIsAnEmptyScene) {
  GltfBuilder builder;
  const Scene scene = load(builder);
  EXPECT_TRUE(scene.triangles.empty());
  EXPECT_TRUE(scene.bounds.empty());
  EXPECT_EQ(scene.space.origin, glm::dvec3(0.0));
  EXPECT_EQ(scene.materials.size(), 1u);
}

}  // namespace
}  // namespace fragtrace::gltf_test
