// SPDX-License-Identifier: MIT
// One line a broken document: what is changed in a valid one, and the one line that it is refused with.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "gltf_builder.h"

namespace fragtrace::gltf_test {
namespace {

/// An indexed triangle with a camera, a light, a texture and a child node.
GltfBuilder validScene() {
  GltfBuilder builder;
  json& primitive = builder.addTriangle();
  primitive["indices"] = builder.addAccessor<uint16_t>("SCALAR", {0, 1, 2});
  primitive["material"] = 0;
  builder.root["images"] = {{{"uri", kPixelUri}}};
  builder.root["textures"] = {{{"source", 0}}};
  builder.root["materials"] = {{{"emissiveTexture", {{"index", 0}}}}};
  builder.root["extensionsUsed"] = {"KHR_lights_punctual"};
  builder.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  builder.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  builder.node(0)["children"] = {1};
  builder.root["nodes"].push_back({{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  builder.root["scenes"] = {{{"nodes", {0}}}};
  builder.embedBuffer();
  return builder;
}

std::string refusalAfter(const std::string& pointer, const json& value) {
  GltfBuilder builder = validScene();
  builder.root[json::json_pointer(pointer)] = value;
  return refusalOf(builder);
}

/// The first warning of a scene that is drawn nevertheless.
std::string warningAfter(const std::string& pointer, const json& value) {
  GltfBuilder builder = validScene();
  builder.root["materials"][0].erase("emissiveTexture");  // the triangle has no texture coordinates
  builder.root[json::json_pointer(pointer)] = value;
  EXPECT_EQ(load(builder).triangles.size(), 1u) << pointer;
  return faultOf(builder);
}

TEST(GltfRefusals, TheValidSceneIsLoadedWithoutWarning) {
  GltfBuilder builder = validScene();
  builder.root["materials"][0].erase("emissiveTexture");
  EXPECT_EQ(refusalOf(builder), "");
  EXPECT_TRUE(load(builder).warnings.empty());
}

TEST(GltfRefusals, EveryReferenceIsCheckedBeforeItIsUsed) {
  for (const char* pointer :
       {"/nodes/0/mesh", "/nodes/1/camera", "/nodes/1/extensions/KHR_lights_punctual/light",
        "/nodes/0/children/0", "/scenes/0/nodes/0", "/scene", "/meshes/0/primitives/0/attributes/POSITION",
        "/meshes/0/primitives/0/attributes/NORMAL", "/meshes/0/primitives/0/indices",
        "/meshes/0/primitives/0/material", "/accessors/0/bufferView", "/bufferViews/0/buffer",
        "/textures/0/source", "/textures/0/sampler", "/materials/0/emissiveTexture/index",
        "/materials/0/normalTexture/index"}) {
    const std::string place = std::string("test.gltf: ") + pointer + ": ";
    const std::string refusal = refusalAfter(pointer, 99);
    EXPECT_TRUE(refusal.starts_with(place + "index 99 is past the ")) << pointer << ": " << refusal;
    EXPECT_EQ(refusalAfter(pointer, -1), place + "is not a non-negative integer");
    EXPECT_EQ(refusalAfter(pointer, "0"), place + "is not a non-negative integer");
    EXPECT_EQ(refusalAfter(pointer, 1e300), place + "is not a non-negative integer");
    EXPECT_EQ(refusalAfter(pointer, uint64_t(1) << 32), place + "is too large");
  }
}

TEST(GltfRefusals, VertexIndexPastTheVertices) {
  GltfBuilder builder;
  json& primitive = builder.addTriangle();
  primitive["indices"] = builder.addAccessor<uint16_t>("SCALAR", {0, 1, 99});
  EXPECT_EQ(refusalOf(builder), "test.gltf: /meshes/0/primitives/0/indices: index 99 is past the 3 vertices");
}

TEST(GltfRefusals, SparseIndexPastTheElements) {
  GltfBuilder builder;
  builder.addTriangle();
  const int indices = builder.addView<uint32_t>({3});
  const int values = builder.addView<float>({0, 0, 0});
  builder.root["accessors"][0]["sparse"] = {{"count", 1},
                                            {"indices", {{"bufferView", indices}, {"componentType", 5125}}},
                                            {"values", {{"bufferView", values}}}};
  EXPECT_EQ(refusalOf(builder), "test.gltf: /accessors/0/sparse/indices: index 3 is past the 3 elements");
  builder.root["accessors"][0]["sparse"]["count"] = 4;
  EXPECT_EQ(refusalOf(builder), "test.gltf: /accessors/0/sparse/count: 4 is not from 0 to 3");
  builder.root["accessors"][0]["sparse"]["count"] = 2;
  EXPECT_EQ(refusalOf(builder),
            "test.gltf: /accessors/0/sparse/indices: 2 elements reach past the 4 bytes of buffer view 1");
}

TEST(GltfRefusals, AccessorPastItsBufferView) {
  const std::string tail = " elements reach past the 36 bytes of buffer view 0";
  EXPECT_EQ(refusalAfter("/accessors/0/count", 4), "test.gltf: /accessors/0: 4" + tail);
  EXPECT_EQ(refusalAfter("/accessors/0/byteOffset", 4), "test.gltf: /accessors/0: 3" + tail);
  EXPECT_EQ(refusalAfter("/accessors/0/byteOffset", uint64_t(1) << 53), "test.gltf: /accessors/0: 3" + tail);
}

TEST(GltfRefusals, ACountThatWrapsRoundIn64BitsIsStillTooLarge) {
  GltfBuilder builder = validScene();
  builder.root["bufferViews"][0]["byteStride"] = 128;
  // 2^53 * 128 = 2^60; with 32-bit arithmetic both would be 0.
  const uint64_t count = uint64_t(1) << 53;
  builder.root["accessors"][0]["count"] = count;
  EXPECT_EQ(refusalOf(builder), "test.gltf: /accessors/0: " + std::to_string(count) +
                                    " elements reach past the 36 bytes of buffer view 0");
  builder.root["accessors"][0]["count"] = uint64_t(1) << 25;
  EXPECT_NE(refusalOf(builder), "");
}

TEST(GltfRefusals, BufferViewPastItsBuffer) {
  EXPECT_EQ(refusalAfter("/bufferViews/0/byteLength", 1000),
            "test.gltf: /bufferViews/0: 1000 bytes from byte 0 reach past the 42 of its buffer");
  EXPECT_NE(refusalAfter("/bufferViews/0/byteOffset", uint64_t(1) << 53), "");
  EXPECT_EQ(refusalAfter("/bufferViews/0/byteStride", 8),
            "test.gltf: /accessors/0: elements of 12 bytes lie 8 bytes apart");
}

TEST(GltfRefusals, BufferShorterThanItSays) {
  EXPECT_EQ(refusalAfter("/buffers/0/byteLength", 43), "");
  EXPECT_EQ(refusalAfter("/buffers/0/uri", "data:;base64,AAAA"),
            "test.gltf: /buffers/0: holds 3 bytes, fewer than its byteLength of 42");
  EXPECT_EQ(refusalAfter("/buffers/0/uri", "data:;base64,!!!!"),
            "test.gltf: /buffers/0/uri: the data URI is not valid base64");
  EXPECT_EQ(refusalAfter("/buffers/0/uri", "data:application/octet-stream;;base64,AA=="),
            "test.gltf: /buffers/0/uri: the data URI has an empty parameter");
  EXPECT_NE(refusalAfter("/buffers/0/uri", "/dev/zero").find("leads out of the scene's folder"),
            std::string::npos);
}

TEST(GltfRefusals, ZerosWithoutAnyBytesBehindThemAreBounded) {
  GltfBuilder builder;
  builder.root["accessors"] = {{{"componentType", 5126}, {"count", uint64_t(1) << 40}, {"type", "VEC3"}}};
  builder.addMesh({{"POSITION", 0}});
  EXPECT_EQ(refusalOf(builder), "test.gltf: /accessors/0: 1099511627776 elements without a buffer view");
}

TEST(GltfRefusals, WrongTypesOfAccessors) {
  EXPECT_EQ(refusalAfter("/accessors/0/type", "VEC2"),
            "test.gltf: /meshes/0/primitives/0/attributes/POSITION: accessor 0 is not of type VEC3");
  EXPECT_EQ(refusalAfter("/accessors/0/componentType", 5130),
            "test.gltf: /accessors/0/componentType: 5130 is not a component type");
  EXPECT_EQ(
      refusalAfter("/accessors/1/componentType", 5122),
      "test.gltf: /meshes/0/primitives/0/indices: accessor 1 does not hold unsigned integers of type SCALAR");
  EXPECT_NE(refusalAfter("/accessors/0/type", "MAT4"), "");
  EXPECT_NE(refusalAfter("/accessors/0/type", "VEC9"), "");
}

TEST(GltfRefusals, AttributesOfDifferentLength) {
  GltfBuilder builder;
  json& primitive = builder.addTriangle();
  primitive["attributes"]["NORMAL"] = builder.addAccessor<float>("VEC3", {0, 0, 1, 0, 0, 1});
  EXPECT_EQ(refusalOf(builder),
            "test.gltf: /meshes/0/primitives/0/attributes/NORMAL: has 2 elements for 3 positions");
}

TEST(GltfRefusals, PositionsThatAreNotFinite) {
  for (const float value :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    GltfBuilder builder;
    builder.addMesh({{"POSITION", builder.addAccessor<float>("VEC3", {0, 0, 0, 1, 0, value, 0, 1, 0})}});
    EXPECT_EQ(refusalOf(builder),
              "test.gltf: /meshes/0/primitives/0/attributes/POSITION: vertex 1 is not finite");
  }
}

/// JSON itself has no NaN and no infinity; products of what it has may be.
TEST(GltfRefusals, FactorsThatAreNotFinite) {
  const std::string text =
      R"({"asset": {"version": "2.0"}, "materials": [{"emissiveFactor": [1, 1, NUMBER]}]})";
  for (const char* number : {"1e999", "-1e999", "NaN", "Infinity"}) {
    const TemporaryFolder folder;
    std::string broken = text;
    broken.replace(broken.find("NUMBER"), 6, number);
    const std::string refusal = refusalOf(folder.write("test.gltf", broken));
    EXPECT_TRUE(refusal.starts_with("test.gltf: the JSON is broken: ")) << refusal;
  }
  EXPECT_EQ(
      warningAfter("/materials/0",
                   {{"emissiveFactor", {0, 3e38, 0}},
                    {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 2}}}}}}),
      "test.gltf: /materials/0/emissiveFactor: is out of range, the nearest possible value is taken: 1e+20");
  EXPECT_EQ(
      warningAfter("/extensions/KHR_lights_punctual/lights/0/intensity", 1e39),
      "test.gltf: /extensions/KHR_lights_punctual/lights/0/intensity: times its colour is out of range, "
      "the nearest possible value is taken: 1e+20");
}

TEST(GltfRefusals, NodesThatAreNoTrees) {
  EXPECT_EQ(refusalAfter("/nodes/1/children", {0}),
            "test.gltf: /nodes/0: is in a loop: it is its own ancestor");
  EXPECT_EQ(refusalAfter("/nodes/0/children", {0}),
            "test.gltf: /nodes/0: is in a loop: it is its own ancestor");
  EXPECT_EQ(refusalAfter("/nodes/0/children", {1, 1}),
            "test.gltf: /nodes/0/children/1: node 1 is already a child of node 0");
  EXPECT_EQ(refusalAfter("/scenes/0/nodes", {0, 1}), "test.gltf: /scenes/0/nodes: node 1 is not a root node");
  EXPECT_EQ(warningAfter("/scenes/0/nodes", {0, 0}),
            "test.gltf: /scenes/0/nodes: names node 0 twice, which is drawn once");
}

TEST(GltfRefusals, TransformsThatAreNone) {
  EXPECT_EQ(warningAfter("/nodes/0/rotation", {0, 0, 0, 0}),
            "test.gltf: /nodes/0/rotation: is a quaternion of zeros; it is taken as absent");
  EXPECT_EQ(warningAfter("/nodes/0/scale", {1, 2}),
            "test.gltf: /nodes/0/scale: does not hold 3 numbers; it is taken as absent");
  EXPECT_EQ(refusalAfter("/nodes/0/matrix", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}),
            "test.gltf: /nodes/0/matrix: is not affine: its last row is not 0, 0, 0, 1");
  EXPECT_EQ(refusalAfter("/nodes/0/scale", {1e300, 1, 1}),
            "test.gltf: /nodes/0: its world transform overflows");
  EXPECT_EQ(refusalAfter("/nodes/0/scale", {1, 1e31, 1}),
            "test.gltf: /nodes/0: its mesh reaches farther than 1e30 m from the origin");
}

TEST(GltfRefusals, ALongChainOfNodesNeitherRecursesNorTakesLong) {
  GltfBuilder builder;
  builder.addTriangle();
  for (int i = 0; i < 100000; ++i) builder.root["nodes"].push_back({{"children", {i}}});
  EXPECT_EQ(load(builder).triangles.size(), 1u);
  builder.node(0)["children"] = {100000};
  EXPECT_NE(refusalOf(builder).find("is in a loop"), std::string::npos);
}

TEST(GltfRefusals, CamerasAndLightsOutOfRangeCostThemselvesAlone) {
  EXPECT_EQ(warningAfter("/cameras/0/perspective/yfov", 4),
            "test.gltf: /cameras/0/perspective/yfov: is not between 0 and pi; the camera is left out");
  EXPECT_EQ(warningAfter("/cameras/0/type", "fisheye"),
            "test.gltf: /cameras/0/type: \"fisheye\" is no kind of camera; the camera is left out");
  EXPECT_EQ(
      warningAfter("/extensions/KHR_lights_punctual/lights/0/type", "area"),
      "test.gltf: /extensions/KHR_lights_punctual/lights/0/type: \"area\" is no kind of light; the light "
      "is left out");
}

/// Every value of the valid document in turn becomes something else; nothing may crash, hang or fail
/// unexplained.
TEST(GltfRefusals, AnyMemberOfAnyOtherTypeIsLoadedOrExplained) {
  GltfBuilder valid = validScene();
  const json flat = json::parse(valid.text()).flatten();
  const json replacements = {nullptr, true, "text", -1, 0.5, 1e300, 7, json::array(), json::object(), {{}}};
  const TemporaryFolder folder;
  for (const auto& member : flat.items()) {
    for (json::json_pointer pointer(member.key()); !pointer.empty(); pointer.pop_back()) {
      for (const json& replacement : replacements) {
        json changed = valid.root;
        changed[pointer] = replacement;
        const auto path = folder.write("test.gltf", changed.dump());
        const std::string refusal = refusalOf(path);
        EXPECT_TRUE(refusal.empty() || refusal.starts_with("test.gltf: ")) << refusal;
        EXPECT_EQ(refusal.find('\n'), std::string::npos) << refusal;
      }
    }
  }
}

}  // namespace
}  // namespace fragtrace::gltf_test
