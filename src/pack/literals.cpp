// SPDX-License-Identifier: MIT
#include "pack/literals.h"

#include <algorithm>
#include <optional>

#include "base/text.h"
#include "bvh/pruned.h"
#include "pack/literal_faces.h"
#include "pack/literal_traversal.h"

namespace fragtrace {

namespace {

std::string word(uint32_t x) { return formatted("0x%xu", x); }

/// An expression for values[index], by bisection. Equal values need no choice, and values that nobody asks
/// for may be anything.
std::string chosen(const std::string& index, const std::vector<std::optional<uint32_t>>& values, size_t from,
                   size_t to) {
  std::optional<uint32_t> only;
  bool same = true;
  for (size_t i = from; i < to; ++i) {
    if (!values[i]) continue;
    same = same && (!only || *only == *values[i]);
    only = values[i];
  }
  if (same) return word(only.value_or(0u));
  const size_t mid = (from + to) / 2;
  return "(" + index + " < " + std::to_string(mid) + " ? " + chosen(index, values, from, mid) + " : " +
         chosen(index, values, mid, to) + ")";
}

/// The row of the index-th entry of a buffer that holds `rows` rows per entry.
std::string chosenRow(const Words& words, const std::string& index, size_t count, size_t rows, size_t row,
                      const std::vector<bool>& used) {
  std::string text = "uvec4(";
  for (size_t c = 0; c < 4; ++c) {
    std::vector<std::optional<uint32_t>> values(count);
    for (size_t i = 0; i < count; ++i) {
      if (used.empty() || used[i]) values[i] = words[(i * rows + row) * 4 + c];
    }
    text += (c > 0 ? ", " : "") + chosen(index, values, 0, count);
  }
  return text + ")";
}

/// Writes a function of an entry and a row; callers pass a constant row.
std::string rowFunction(const std::string& head, const std::string& index, const Words& words, size_t count,
                        size_t rows, const std::vector<bool>& used = {}) {
  std::string text = head + " {\n";
  for (size_t row = 0; row + 1 < rows; ++row)
    text += "  if (row == " + std::to_string(row) + ") return " +
            chosenRow(words, index, count, rows, row, used) + ";\n";
  return text + "  return " + chosenRow(words, index, count, rows, rows - 1, used) + ";\n}\n";
}

constexpr const char* kNoRows = R"(
uvec4 literalFace(int slot, int row) { return uvec4(0u); }
uvec4 literalInset(int slot, int row) { return uvec4(0u); }
uvec4 literalMaterial(uint material, uint row) { return uvec4(0u); }
uvec4 literalEmitter(int emitter, int row) { return uvec4(0u); }
)";

// Instructions for eight rays, counted on llvmpipe: a face with its part of the points and edges, a visit of
// a node or a leaf. Rays in lockstep wait for the longest of them.
constexpr double kFace = 55.0;
constexpr double kVisit = 380.0;
constexpr double kLockstep = 1.6;
// Measured on the same machine with two cores: the time saved in the Cornell box over the instructions above,
// and the time by which a face makes compilation longer.
constexpr double kNanosecondsAnInstruction = 0.25;
constexpr double kCompilationOfAFace = 4e6;  // nanoseconds
constexpr double kRaysAPath = 7.0;

/// Both triangles of a parallelogram have the same formula for barycentric weights.
Joining joiningFor(bool weights) { return weights ? Joining::Parallelograms : Joining::ConvexQuadrilaterals; }

/// The light tree needs the triangles of a lamp apart.
bool partsLamps(const ShaderVariant& variant) { return has(variant.traits, Trait::LightTree); }

LiteralOptions optionsOf(const ShaderVariant& variant, bool whole) {
  return {.weights = keepsWeights(variant),
          .whole = whole,
          .passing = passesSurfaces(variant) || testsAlpha(variant),
          .backFaces = has(variant.traits, Trait::Caustics)};
}

}  // namespace

std::string whyNoLiterals(const Scene& scene, const GpuScene& packed) {
  constexpr size_t kMostTriangles = 256;
  constexpr size_t kMostMaterials = 16;
  constexpr size_t kMostEmitters = 16;
  const auto tooMany = [](size_t count, size_t most, const char* what) {
    return count <= most
               ? std::string()
               : std::to_string(count) + " " + what + ", at most " + std::to_string(most) + " can be";
  };
  if (!scene.spheres.empty()) return "the scene has spheres";
  if (std::ranges::count(packed.cutOut, false) == 0 && scene.triangles.size() == packed.cutOut.size())
    return "the scene has no triangle";
  if (!scene.instances.empty()) return "the scene shares meshes";
  if (std::ranges::any_of(scene.triangles, [](const Triangle& t) { return t.reach > 0; }))
    return "surfaces of the scene coincide";
  std::string reason = tooMany(scene.triangles.size(), kMostTriangles, "triangles");
  if (reason.empty()) reason = tooMany(scene.materials.size(), kMostMaterials, "materials");
  if (reason.empty()) reason = tooMany(packed.emitterCount, kMostEmitters, "emitters");
  return reason;
}

bool paysAsLiterals(const Scene& scene, const Bvh& bvh, const GpuScene& packed, double paths) {
  if (!whyNoLiterals(scene, packed).empty()) return false;
  const Bvh drawn = pruned(bvh, packed.cutOut);
  const double faces = double(literalMesh(scene, drawn, 0, Joining::None).faces.size());
  const double saved = bvhQuality(drawn).sahCost * kLockstep * kVisit - faces * kFace;
  return paths * kRaysAPath * saved / 8.0 * kNanosecondsAnInstruction > faces * kCompilationOfAFace;
}

bool paysBeside(const Bvh& tree, const Bvh& beside) {
  const double faces = 2.0 * beside.besideTree;
  return faces * kFace < (bvhQuality(tree).sahCost - bvhQuality(beside).sahCost) * kLockstep * kVisit;
}

std::string largeFirst(const Scene& scene, const Bvh& bvh, const ShaderVariant& variant) {
  const bool weights = keepsWeights(variant);
  const LiteralMesh mesh = literalMesh(scene, bvh, uint32_t(bvh.leaves.size()) - bvh.besideTree,
                                       joiningFor(weights), partsLamps(variant));
  return "const bool kLiterals = false;\nconst bool kLargeFirst = true;\n" +
         literalTraversal(mesh, optionsOf(variant, false)) + kNoRows;
}

std::string literalScene(const Scene& scene, const Bvh& bvh, const GpuScene& packed,
                         const ShaderVariant& variant) {
  const bool weights = keepsWeights(variant);
  const LiteralMesh mesh =
      literalMesh(scene, pruned(bvh, packed.cutOut), 0, joiningFor(weights), partsLamps(variant));
  const size_t slots = bvh.leaves.size() * 2;
  std::vector<bool> used(slots, false);
  for (const LiteralFace& face : mesh.faces) {
    used[face.slot] = true;
    if (weights && face.quad) used[face.otherSlot] = true;
  }
  Words faces = packed.buffers[layout::kFacesBinding];
  for (size_t slot = 0; slot < slots && !weights; ++slot) {
    // Vertices are read by their index only where they have attributes.
    for (size_t c = 1; c < 4; ++c) faces[(slot * layout::kFaceRows + 1) * 4 + c] = 0u;
  }
  std::string text = "const bool kLiterals = true;\nconst bool kLargeFirst = false;\n";
  text += literalTraversal(mesh, optionsOf(variant, true));
  text += rowFunction("uvec4 literalFace(int slot, int row)", "slot", faces, slots, layout::kFaceRows, used);
  if (has(variant.traits, Trait::Creases)) {
    const Words insets(faces.begin() + ptrdiff_t(slots * layout::kFaceRows * 4), faces.end());
    text += rowFunction("uvec4 literalInset(int slot, int row)", "slot", insets, slots, 1, used);
  } else {
    text += "uvec4 literalInset(int slot, int row) { return uvec4(0u); }\n";
  }
  text +=
      rowFunction("uvec4 literalMaterial(uint material, uint row)", "material",
                  packed.buffers[layout::kMaterialsBinding], scene.materials.size(), layout::kMaterialRows);
  if (packed.emitterCount > 0) {
    text += rowFunction("uvec4 literalEmitter(int emitter, int row)", "emitter",
                        packed.buffers[layout::kEmittersBinding], packed.emitterCount, layout::kEmitterRows);
  } else {
    text += "uvec4 literalEmitter(int emitter, int row) { return uvec4(0u); }\n";
  }
  return text;
}

}  // namespace fragtrace
