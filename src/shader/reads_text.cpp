// SPDX-License-Identifier: MIT
#include "shader/reads_text.h"

#include <array>
#include <string_view>

#include "shader/layout.h"

namespace fragtrace {

namespace {

/// Scene buffers by binding; layout.glsl has k...Binding of each.
constexpr std::array<std::string_view, layout::kSceneBufferCount> kSceneBuffers{
    "Nodes",  "Leaves",   "Faces",  "Normals",     "Texcoords",           "Tangents", "Colors", "Materials",
    "Texels", "Emitters", "Lights", "Environment", "EnvironmentInversion"};

/// "Nodes": "nodesBuffer".
std::string variableOf(std::string_view name) {
  std::string variable = std::string(name) + "Buffer";
  variable[0] += 'a' - 'A';
  return variable;
}

std::string readOf(std::string_view name, BufferReads reads) {
  const bool two = name == "Texels";  // words
  const std::string type = two ? "uvec2" : "uvec4";
  const std::string variable = variableOf(name);
  const std::string binding = "k" + std::string(name) + "Binding";
  std::string declared;
  std::string value;
  switch (reads) {
    case BufferReads::Image:
      declared = "layout(" + std::string(two ? "rg32ui" : "rgba32ui") + ", binding = kSceneImageBase + " +
                 binding + ") uniform readonly restrict uimageBuffer " + variable;
      value = "imageLoad(" + variable + ", index)";
      break;
    case BufferReads::Texel:
      declared = "layout(binding = " + binding + ") uniform usamplerBuffer " + variable;
      value = "texelFetch(" + variable + ", index)";
      break;
    default:
      declared = "layout(std430, binding = " + binding + ") readonly restrict buffer " + std::string(name) +
                 "Block { " + type + " " + variable + "[]; }";
      value = variable + "[index]";
  }
  if (two && reads != BufferReads::Ssbo) value += ".xy";
  return declared + ";\n" + type + " read" + std::string(name) + "(int index) { return " + value + "; }\n";
}

}  // namespace

std::string readsText(BufferReads reads) {
  std::string text;
  for (const std::string_view name : kSceneBuffers) text += readOf(name, reads);
  return text;
}

std::string pathStatesText(int imageUnit) {
  // Neither is `restrict`: image and buffer are the same memory.
  std::string text =
      "layout(std430, binding = kPathStatesBinding) buffer PathStatesBlock { uvec4 pathStates[]; };\n";
  std::string value = "pathStates[index]";
  if (imageUnit >= 0) {
    text += "layout(rgba32ui, binding = " + std::to_string(imageUnit) +
            ") uniform readonly uimageBuffer pathStatesImage;\n";
    value = "imageLoad(pathStatesImage, index)";
  }
  return text + "uvec4 readPathStates(int index) { return " + value + "; }\n";
}

}  // namespace fragtrace
