// SPDX-License-Identifier: MIT
// The table of extensions, docs/gltf.md and the sources that read them say the same.
#include "gltf/check/extensions.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>

#include "gltf_builder.h"

namespace fragtrace::gltf_test {
namespace {

std::string textOf(const std::filesystem::path& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// The state by extension, of the rows under "## Extensions".
std::map<std::string, std::string> documentedStates() {
  std::istringstream document(textOf(std::filesystem::path(FRAGTRACE_DOCS) / "gltf.md"));
  std::map<std::string, std::string> states;
  bool isBelow = false;
  for (std::string line; std::getline(document, line);) {
    if (line.starts_with("## ")) isBelow = line == "## Extensions";
    std::istringstream cells(line);
    std::string bar, name, state;
    if (!isBelow || !(cells >> bar >> name >> bar >> state) || line[0] != '|') continue;
    if (name == "extension" || name == "---") continue;
    EXPECT_TRUE(states.emplace(name, state).second) << name;
  }
  return states;
}

TEST(GltfExtensions, TheDocumentHasARowForEachAndNoOther) {
  std::map<std::string, std::string> expected;
  for (const Extension& extension : extensions()) {
    const char* const states[] = {"supported", "partly"};
    expected[std::string(extension.name)] = states[size_t(extension.support)];
  }
  EXPECT_EQ(documentedStates(), expected);
  EXPECT_EQ(expected.size(), extensions().size());
}

TEST(GltfExtensions, EachIsReadWhereTheTableSays) {
  const std::filesystem::path folder = std::filesystem::path(FRAGTRACE_DOCS) / "../src/gltf";
  for (const Extension& extension : extensions()) {
    EXPECT_NE(textOf(folder / extension.reader).find(extension.name), std::string::npos) << extension.name;
  }
}

TEST(GltfExtensions, MembersOfMaterialsThatAreReadAreInTheTable) {
  std::string members;
  for (const Extension& extension : extensions()) members += " " + std::string(extension.members);
  std::string reader = textOf(std::filesystem::path(FRAGTRACE_DOCS) / "../src/gltf/assemble/materials.cpp");
  const size_t first = reader.find("readEmissiveStrength(");  // behind glTF's own members
  reader = reader.substr(first, reader.find("Extension ofMaterials(") - first);
  const std::regex call(R"re(part\.(factor|color|texture)\("(\w+)")re");
  size_t found = 0;
  for (std::sregex_iterator it(reader.begin(), reader.end(), call), end; it != end; ++it, ++found) {
    const std::string entry = " " + (*it)[2].str() + ((*it)[1] == "color" ? "[3]" : "");
    EXPECT_NE((members + " ").find(entry + " "), std::string::npos) << entry;
  }
  EXPECT_GT(found, 30u);
}

TEST(GltfExtensions, EachMayBeUsedAndRequired) {
  for (const Extension& extension : extensions()) {
    GltfBuilder builder;
    builder.addTriangle();
    builder.root["extensionsUsed"] = {extension.name};
    EXPECT_FALSE(anyWarningHas(load(builder), "is ignored")) << extension.name;
    builder.root["extensionsRequired"] = {extension.name};
    EXPECT_EQ(refusalOf(builder), "") << extension.name;
  }
}

TEST(GltfExtensions, AreWarnedAboutWhereTheyMayNotStand) {
  for (const char* name : {"KHR_texture_transform", "KHR_materials_sheen", "KHR_materials_unheard_of"}) {
    GltfBuilder builder;
    builder.addTriangle();
    builder.root["extensionsUsed"] = {name};
    builder.node(0)["extensions"][name] = json::object();
    EXPECT_TRUE(
        anyWarningHas(load(builder), std::string("/nodes/0/extensions/") + name + ": is not expected here"));
  }
}

}  // namespace
}  // namespace fragtrace::gltf_test
