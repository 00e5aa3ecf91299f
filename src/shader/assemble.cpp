// SPDX-License-Identifier: MIT
#include "shader/assemble.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <set>

#include "base/errors.h"
#include "base/text.h"
#include "image/display/tone_map.h"
#include "shader/layout.h"
#include "shader/stack_text.h"
#include "shader/work.h"

namespace fragtrace {

namespace {

/// Scene buffers by binding (shader/layout.h).
constexpr std::array<std::string_view, layout::kSceneBufferCount> kSceneBuffers{
    "Nodes",  "Leaves",   "Faces",  "Normals",     "Texcoords",           "Tangents", "Colors", "Materials",
    "Bricks", "Emitters", "Lights", "Environment", "EnvironmentInversion"};

/// The first line of texts that are no files of shaders/.
constexpr const char* kMade = "// Made by src/shader/assemble.cpp.\n";

/// "Nodes": "nodesBuffer".
std::string variableOf(std::string_view name) {
  std::string variable = std::string(name) + "Buffer";
  variable[0] += 'a' - 'A';
  return variable;
}

/// "count", "camera_rays": "countCameraRays"; "texel", "base colour": "texelBaseColour".
std::string joinedName(std::string name, std::string_view words) {
  bool begins = true;
  for (const char c : words) {
    const bool gap = c == '_' || c == '-' || c == ' ';
    if (!gap) name += char(begins ? c - 'a' + 'A' : c);
    begins = gap;
  }
  return name;
}

/// The function that counts work of this kind.
std::string countOf(std::string_view kind) { return joinedName("count", kind); }

/// The variables in which a lane counts work, and the functions that do; empty ones without `counts`.
std::string workText(bool counts) {
  std::string text = kMade;
  // Indexed by constants alone, so that compilers keep it in registers.
  if (counts)
    text += formatted("const int kWorkCount = %d;\nuint work[kWorkCount];\n", int(kWorkNames.size()));
  for (size_t i = 0; i < kWorkNames.size(); ++i) {
    text += "void " + countOf(kWorkNames[i]) + "(uint number) {";
    text += counts ? formatted(" work[%d] += number; }\n", int(i)) : "}\n";
  }
  return text;
}

/// The function that reads a buffer, readNodes() and so on, for the kind of buffer that the variant names.
std::string readOf(size_t buffer, BufferReads reads, bool counts) {
  const std::string_view name = kSceneBuffers[buffer];
  const bool two = buffer == layout::kBricksBinding;  // words
  const std::string type = two ? "uvec2" : "uvec4";
  const std::string variable = variableOf(name);
  const std::string binding = std::to_string(buffer);
  std::string declared;
  std::string value;
  switch (reads) {
    case BufferReads::Image:
      declared = "layout(" + std::string(two ? "rg32ui" : "rgba32ui") +
                 ", binding = " + std::to_string(layout::kSceneImageBase + buffer) +
                 ") uniform readonly restrict uimageBuffer " + variable;
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
  const size_t kind = kWorkNames.size() - kSceneBuffers.size() + buffer;
  const std::string count = counts ? countOf(kWorkNames[kind]) + "(1u); " : "";
  return declared + ";\n" + type + " read" + std::string(name) + "(int index) { " + count + "return " +
         value + "; }\n";
}

/// readEnvironmentTexel(), which reads half a row of the environment. A storage buffer has a second block for
/// it, so that GPUs read 8 bytes and not 16.
std::string texelReadOfEnvironment(const ShaderVariant& variant) {
  const std::string begin = "uvec2 readEnvironmentTexel(int index) { ";
  if (variant.reads == BufferReads::Ssbo && !variant.countsWork)
    return "layout(std430, binding = " + std::to_string(layout::kEnvironmentBinding) +
           ") readonly restrict buffer EnvironmentTexelBlock { uvec2 environmentTexels[]; };\n" + begin +
           "return environmentTexels[index]; }\n";
  return begin + "uvec4 row = readEnvironment(index >> 1); return (index & 1) == 0 ? row.xy : row.zw; }\n";
}

/// The scene buffers and their functions.
std::string readsText(const ShaderVariant& variant) {
  std::string text = kMade;
  for (size_t i = 0; i < kSceneBuffers.size(); ++i) text += readOf(i, variant.reads, variant.countsWork);
  return text + texelReadOfEnvironment(variant);
}

/// The buffers of texels, readTexelWord(), and srgbValue() (shaders/tune/texels_words.glsl).
std::string texelWordsText(int buffers, bool table) {
  std::string text = kMade;
  std::string value;
  for (int i = 0; i < buffers; ++i) {
    const std::string number = std::to_string(i);
    text.append("layout(r32ui, binding = ").append(std::to_string(layout::kTexelImageBase + i));
    text.append(") uniform readonly restrict uimageBuffer texels").append(number).append(";\n");
    value.append(i == 0 ? "  uint" : formatted("  if (unit == %du)", i)).append(" word = imageLoad(texels");
    value.append(number).append(", index).x;\n");
  }
  text += "uint readTexelWord(uint unit, int index) {\n" + value + "  return word;\n}\n";
  // Only where textures are read; not in a function, each copy of which would have a table of its own.
  if (!table) return text + "float srgbValue(uint value) { return 0.0; }\n";
  text += "const float kSrgbValues[257] = float[257](";
  for (int i = 0; i <= 256; ++i)
    text += (i > 0 ? ", " : "") + formatted("%.9g", decodeSrgb(std::min(i, 255) / 255.0));
  return text + ");\nfloat srgbValue(uint value) { return kSrgbValues[int(value)]; }\n";
}

/// The functions that read a slot of a material: its row, and its texel (shaders/material.glsl).
std::string slotsText(const TraitSet& traits) {
  std::string text = kMade;
  for (uint32_t slot = 0; slot < layout::kSlotCount; ++slot) {
    const bool reads = has(traits, slotTrait(slot));
    const TextureRefRow& texture = kTextureRefs[slot];
    const std::string row = "textureSlot(material, " + std::to_string(slot) + "u)";
    const std::string srgb = texture.curve == TransferCurve::Srgb ? "true" : "false";
    const std::string texel = reads ? "sampleTexture(" + row + ", texcoords, " + srgb + ")" : "vec4(1.0)";
    text.append("uvec4 ").append(joinedName("slot", texture.name)).append("(uint material) { return ");
    text.append(reads ? row : "uvec4(0u)").append("; }\nvec4 ").append(joinedName("texel", texture.name));
    text.append("(uint material, vec4 texcoords) { return ").append(texel).append("; }\n");
  }
  return text;
}

/// The layer of the first hit that the variant draws, by its name (shaders/integrators/first_hit.glsl).
std::string layerText(Aov aov) {
  std::string_view name = aov == Aov::None ? rowOf(Aov::Albedo).name : rowOf(aov).name;
  constexpr std::string_view kCrypto = "crypto-";  // which show what the layers without it do
  if (name.starts_with(kCrypto)) name.remove_prefix(kCrypto.size());
  return std::string(kMade) + "vec3 layerAt(Path p, Surface s, vec3 baseColor) { return " +
         joinedName("layer", name) + "(p, s, baseColor); }\n";
}

/// The buffer of path states, which the tracer writes as pathStates[], and readPathStates(). imageUnit:
/// through which it is read, since llvmpipe reads images five times as fast; -1: through the buffer itself.
std::string pathStatesText(int imageUnit) {
  // Neither is `restrict`: image and buffer are the same memory.
  std::string text =
      std::string(kMade) +
      "layout(std430, binding = kPathStatesBinding) buffer PathStatesBlock { uvec4 pathStates[]; };\n";
  std::string value = "pathStates[index]";
  if (imageUnit >= 0) {
    text += "layout(rgba32ui, binding = " + std::to_string(imageUnit) +
            ") uniform readonly uimageBuffer pathStatesImage;\n";
    value = "imageLoad(pathStatesImage, index)";
  }
  return text + "uvec4 readPathStates(int index) { return " + value + "; }\n";
}

/// The file that says what happens to the rays of a variant.
const char* integratorOf(const ShaderVariant& v) {
  if (v.lightPaths) return "integrators/light.glsl";
  if (v.storesReservoirs) return "integrators/reservoir.glsl";
  if (v.aov == Aov::Guides) return "integrators/guide.glsl";
  const bool layer = v.aov != Aov::None && !isLightPart(v.aov);
  if (layer || v.countsVisits || !has(v.stages, Stage::Phong)) return "integrators/first_hit.glsl";
  return has(v.stages, Stage::Gi) ? "integrators/camera.glsl" : "integrators/local.glsl";
}

std::string shaderText(const ShaderSource& source, const std::string& name, const std::string& includedFrom) {
  const std::string where = includedFrom.empty() ? "" : " (included from " + includedFrom + ")";
  if (!source.folder.empty()) {
    std::ifstream file(source.folder / name, std::ios::binary);
    if (!file) throw InputError((source.folder / name).string() + ": cannot read shader" + where);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  for (const EmbeddedShader& shader : embeddedShaders()) {
    if (shader.name == name) return std::string(shader.text);
  }
  throw RenderError("shader " + name + " does not exist" + where);
}

struct Assembly {
  const ShaderSource& source;
  const ShaderVariant& variant;
  std::set<std::string> done;
  std::string text;

  void lineDirective(int line, const std::string& name) {
    text += "#line " + std::to_string(line);
    if (source.namedLines) text += " \"" + name + '"';
    text += '\n';
  }

  /// The text of a file, a text that is written from lists, or the scene as text.
  std::string textOf(const std::string& name, const std::string& includedFrom) const {
    const int vectors = variant.stackSize / 4;
    const bool shared = variant.gpu && variant.dispatch == Dispatch::Compute;
    const auto fileText = [&](const char* file) { return shaderText(source, file, includedFrom); };
    if (name == "read.glsl") return readsText(variant);
    if (name == "frame.glsl")
      return fileText(variant.gpu ? "tune/frame_uniform.glsl" : "tune/frame_variable.glsl");
    if (name == "texels.glsl")
      return fileText(variant.textureArrays ? "tune/texels_arrays.glsl" : "tune/texels_words.glsl");
    if (name == "slots.glsl") return slotsText(variant.traits);
    if (name == "layer.glsl") return layerText(variant.aov);
    if (name == "texel_words.glsl")
      return texelWordsText(variant.texelBuffers, readsTextures(variant.traits));
    if (name.starts_with("cones/") && !variant.rayCones) return "";
    if (name == "work/count.glsl" && !variant.countsWork) return fileText("work/none.glsl");
    if (name == "work/kinds.glsl") return workText(variant.countsWork);
    if (name == "shutter/camera.glsl" && !has(variant.traits, Trait::MovingCamera)) return "";
    if (name == "media/fog_block.glsl" && !has(variant.traits, Trait::Fog)) return "";
    if (name == "media/volume_block.glsl" && !has(variant.traits, Trait::DensityGrid)) return "";
    if (name == "stack.glsl") return shared ? fileText("tune/stack_shared.glsl") : stackText(vectors);
    if (name == "path_states.glsl")
      return pathStatesText(variant.waveUnit) +
             (shared ? fileText("tune/stack_shared_rows.glsl") : stackRowsText(vectors));
    if (name == "literals.glsl" && !variant.literals.empty()) return variant.literals;
    return shaderText(source, name, includedFrom);
  }

  void append(const std::string& name, const std::string& includedFrom) {
    if (!done.insert(name).second) return;
    const std::string whole = textOf(name, includedFrom);
    lineDirective(1, name);
    int number = 1;
    for (const std::string_view line : splitText(whole, '\n')) {
      const size_t open = line.find('"');
      if (line.starts_with("#include") && open != line.npos) {
        const std::string_view file = line.substr(open + 1, line.rfind('"') - open - 1);
        append(file == "integrator.glsl" ? integratorOf(variant) : std::string(file), name);
        lineDirective(number + 1, name);
      } else {
        text.append(line) += '\n';
      }
      ++number;
    }
  }
};

void appendConstants(std::string& text, const ShaderVariant& variant) {
  auto constant = [&](const char* name, bool value) {
    text.append("const bool ").append(name).append(value ? " = true;\n" : " = false;\n");
  };
  for (const StageRow& row : stageRows()) {
    if (row.constant) constant(row.constant, has(variant.stages, row.stage));
  }
  for (const TraitRow& row : traitRows()) {
    if (row.constant) constant(row.constant, has(variant.traits, row.trait));
  }
  constant("kLampTextures", readsLampTextures(variant.traits));
  constant("kCountVisits", variant.countsVisits);
  constant("kWeights", keepsWeights(variant));
  constant("kGlassTables", usesGlassTables(variant));
  constant("kPassing", passesSurfaces(variant));
  constant("kTestsAlpha", testsAlpha(variant));
  constant("kIterative", variant.traversal == TraversalMethod::Iterative);
  constant("kFrontToBack", variant.traversal == TraversalMethod::FrontToBack);
  constant("kResumable", variant.resumable);
  constant("kCandidates", variant.lightCandidates);
  constant("kStoresReservoirs", variant.storesReservoirs);
  constant("kNeighbours", variant.neighbours);
  constant("kClampIndirect", variant.clampIndirect);
  constant("kShadowCatcher", variant.shadowCatcher);
  constant("kTransparentGlass", variant.transparentGlass);
  constant("kLens", variant.lens);
  constant("kLensShift", variant.lensShift);
  constant("kPanorama", variant.camera == CameraType::Panorama);
  constant("kFisheye", variant.camera == CameraType::Fisheye);
  constant("kLightPaths", variant.lightPaths);
  constant("kGuided", usesGuiding(variant));
  constant("kGpu", variant.gpu);
  constant("kRayCones", variant.rayCones);
  const auto number = [&](const char* name, int value) {
    text.append("const int ").append(name).append(" = " + std::to_string(value) + ";\n");
  };
  number("kPixelFilter", int(variant.pixelFilter));
  number("kAov", int(variant.aov));
  number("kStackSize", variant.stackSize);
  number("kCameraRays", variant.cameraRays);
}

std::string wholeText(const ShaderSource& source, const std::string& entry, const ShaderVariant& variant) {
  Assembly assembly{source, variant, {}, {}};
  assembly.text += "#version 450 core\n";
  if (source.namedLines) assembly.text += "#extension GL_ARB_shading_language_include : enable\n";
  appendConstants(assembly.text, variant);
  assembly.append(entry, "");
  return std::move(assembly.text);
}

}  // namespace

std::string assembleShader(const ShaderSource& source, const std::string& entry,
                           const ShaderVariant& variant) {
  return liveText(wholeText(source, entry, variant));
}

std::string readableShader(ShaderSource source, const std::string& entry, const ShaderVariant& variant) {
  source.namedLines = true;
  return readableText(wholeText(source, entry, variant));
}

}  // namespace fragtrace
