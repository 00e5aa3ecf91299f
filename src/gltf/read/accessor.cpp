// SPDX-License-Identifier: MIT
#include "gltf/read/accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "scene/scene.h"

namespace fragtrace {

std::span<const uint8_t> bytesOf(const Document& document, int bufferView) {
  document.diagnostics.need(pointerTo("bufferViews", bufferView));
  const tinygltf::BufferView& view = document.model.bufferViews.at(size_t(bufferView));
  if (view.byteLength == 0) return {};
  const std::vector<uint8_t>& bytes = document.bytes->buffers.at(size_t(view.buffer));
  if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset) {
    document.diagnostics.lose(pointerTo("bufferViews", bufferView), "is used, but its buffer has no data");
  }
  return {bytes.data() + view.byteOffset, view.byteLength};
}

namespace {

/// Elements in memory that are known to lie inside their buffer.
struct Elements {
  const uint8_t* data = nullptr;  ///< none: all elements are zero
  size_t stride = 0;
  size_t count = 0;
  int componentType = 0;
  int components = 1;
  bool normalized = false;
};

/// A component as a float: 1/255 and so on if normalised (glTF 2.0, section 3.11).
template <typename Component>
float componentToFloat(Component value, bool normalized) {
  if constexpr (std::is_floating_point_v<Component>) {
    return value;
  } else {
    if (!normalized) return float(value);
    return std::max(float(value) / float(std::numeric_limits<Component>::max()), -1.0f);
  }
}

/// Calls use(Component()) with the C++ type of a glTF component type.
template <typename Use>
void withComponentType(int componentType, const Use& use) {
  switch (componentType) {
    // Each branch has its own type: NOLINTNEXTLINE(bugprone-branch-clone)
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return use(int8_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return use(uint8_t());
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return use(int16_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return use(uint16_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return use(uint32_t());
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return use(float());
    default:
      return;
  }
}

/// Calls store(element, component, value) for everything that lies in memory.
template <typename Store>
void forEachComponent(const Elements& elements, const Store& store) {
  withComponentType(elements.componentType, [&](auto zero) {
    for (size_t i = 0; i < elements.count; ++i) {
      const uint8_t* element = elements.data + i * elements.stride;
      for (int c = 0; c < elements.components; ++c) {
        auto value = zero;
        std::memcpy(&value, element + size_t(c) * sizeof(value), sizeof(value));
        store(i, c, value);
      }
    }
  });
}

/// Points into a buffer view after checking that all elements lie inside it.
Elements checkedRange(const Document& document, const std::string& place, int view, size_t offset,
                      Elements elements, bool useStride) {
  const size_t size = componentSize(unsigned(elements.componentType)) * size_t(elements.components);
  const size_t declared =
      useStride && size_t(view) < document.strides.size() ? document.strides[size_t(view)] : 0;
  elements.stride = declared != 0 ? declared : size;
  const std::span<const uint8_t> bytes = bytesOf(document, view);
  const size_t length = bytes.size();
  elements.data = bytes.data();
  if (elements.count == 0) return elements;
  if (elements.stride < size) {
    document.diagnostics.lose(place, "elements of " + std::to_string(size) + " bytes lie " +
                                         std::to_string(elements.stride) + " bytes apart");
  }
  // The check divides instead of multiplying, so that no count is large enough to wrap around.
  if (offset > length || size > length - offset ||
      elements.count - 1 > (length - offset - size) / elements.stride) {
    document.diagnostics.lose(place, std::to_string(elements.count) + " elements reach past the " +
                                         std::to_string(length) + " bytes of buffer view " +
                                         std::to_string(view));
  }
  elements.data += offset;
  return elements;
}

Elements elementsOf(const Document& document, int index) {
  const tinygltf::Accessor& accessor = document.model.accessors.at(size_t(index));
  const std::string place = pointerTo("accessors", index);
  document.diagnostics.need(place);
  Elements elements;
  elements.count = accessor.count;
  elements.componentType = accessor.componentType;
  elements.components = tinygltf::GetNumComponentsInType(uint32_t(accessor.type));
  elements.normalized = accessor.normalized;
  if (size_t(accessor.bufferView) + 1 < document.model.bufferViews.size()) {  // the last one stands for none
    return checkedRange(document, place, accessor.bufferView, accessor.byteOffset, elements, true);
  }
  // Zeros take no room in the file, so only this limits the memory that they take.
  constexpr size_t kMostZeros = size_t(1) << 26;
  if (accessor.count > kMostZeros) {
    document.diagnostics.lose(place, std::to_string(accessor.count) + " elements without a buffer view");
  }
  return elements;
}

/// The elements that a sparse accessor replaces, and their new values.
struct SparseElements {
  std::vector<uint32_t> indices;
  Elements values;
};

/// Component is a type for which isIndexType() is true.
template <typename Component>
uint32_t indexOf(Component value) {
  if constexpr (std::is_unsigned_v<Component>) return value;
  return kMissIndex;
}

bool isIndexType(int componentType) {
  return componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

SparseElements sparseElementsOf(const Document& document, int index, const Elements& base) {
  const tinygltf::Accessor& accessor = document.model.accessors.at(size_t(index));
  SparseElements result;
  if (!accessor.sparse.isSparse || accessor.sparse.count == 0) return result;
  const std::string place = pointerTo("accessors", index, "sparse");
  const auto& sparse = accessor.sparse;
  if (sparse.count < 0 || size_t(sparse.count) > base.count) {
    document.diagnostics.lose(
        place + "/count", std::to_string(sparse.count) + " is not from 0 to " + std::to_string(base.count));
  }
  if (!isIndexType(sparse.indices.componentType)) {
    document.diagnostics.lose(place + "/indices/componentType",
                              std::to_string(sparse.indices.componentType) + " is not an unsigned integer");
  }
  Elements indices;
  indices.count = size_t(sparse.count);
  indices.componentType = sparse.indices.componentType;
  indices = checkedRange(document, place + "/indices", sparse.indices.bufferView,
                         size_t(sparse.indices.byteOffset), indices, false);
  result.indices.resize(indices.count);
  forEachComponent(indices, [&](size_t i, int, auto value) {
    result.indices[i] = indexOf(value);
    if (result.indices[i] >= base.count) {
      document.diagnostics.lose(place + "/indices", "index " + std::to_string(result.indices[i]) +
                                                        " is past the " + std::to_string(base.count) +
                                                        " elements");
    }
  });
  result.values = base;
  result.values.count = size_t(sparse.count);
  result.values = checkedRange(document, place + "/values", sparse.values.bufferView,
                               size_t(sparse.values.byteOffset), result.values, false);
  return result;
}

/// Takes integers for fractions where they are meant so, and warns of those that the file may not have.
void settleIntegers(Document& document, Integers integers, const std::string& place, Elements& elements) {
  const bool isMeant = integers == Integers::Whole || elements.normalized;
  if (elements.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT || isMeant) return;
  if (integers == Integers::Fractions) {
    elements.normalized = true;
    return document.diagnostics.warn(place,
                                     "holds integers that are not normalized, and read as if they were");
  }
  const auto& used = document.model.extensionsUsed;
  if (std::find(used.begin(), used.end(), "KHR_mesh_quantization") == used.end())
    document.diagnostics.warn(place,
                              "holds integers, as KHR_mesh_quantization allows; they are read as they are");
}

/// Calls store(element, component, value) for everything that lies in memory, and then for what a sparse
/// accessor replaces.
template <typename Store>
void forEachValue(const Document& document, int accessor, const Elements& elements, const Store& store) {
  const SparseElements sparse = sparseElementsOf(document, accessor, elements);
  if (elements.data != nullptr) forEachComponent(elements, store);
  if (sparse.indices.empty()) return;
  forEachComponent(sparse.values, [&](size_t i, int c, auto value) { store(sparse.indices[i], c, value); });
}

template <typename Vector>
std::vector<Vector> decodeAttribute(Document& document, int accessor, Elements elements, Integers integers,
                                    const std::string& place, const Vector& base) {
  settleIntegers(document, integers, place, elements);
  std::vector<Vector> result(elements.count, base);
  forEachValue(document, accessor, elements, [&](size_t i, int c, auto value) {
    result[i][c] = componentToFloat(value, elements.normalized);
  });
  return result;
}

int typeOf(const Document& document, int accessor) {
  return document.model.accessors.at(size_t(accessor)).type;
}

/// Throws a Loss unless the accessor is as it must be.
void expect(bool condition, const Document& document, int accessor, const std::string& place,
            const std::string& reason) {
  if (!condition) document.diagnostics.lose(place, "accessor " + std::to_string(accessor) + " " + reason);
}

}  // namespace

void takeMemory(Document& document, const std::string& place, uint64_t bytes) {
  document.diagnostics.attempt(place, [&] { document.memory.take(bytes); });
}

size_t accessorCount(const Document& document, int accessor) { return elementsOf(document, accessor).count; }

template <glm::length_t components>
std::vector<glm::vec<components, float>> readVectors(Document& document, int accessor,
                                                     const std::string& place, Integers integers) {
  const Elements elements = elementsOf(document, accessor);
  expect(typeOf(document, accessor) == components, document, accessor, place,  // TINYGLTF_TYPE_VEC2 is 2
         "is not of type VEC" + std::to_string(components));
  return decodeAttribute(document, accessor, elements, integers, place, glm::vec<components, float>(0.0f));
}

template std::vector<glm::vec2> readVectors<2>(Document&, int, const std::string&, Integers);
template std::vector<glm::vec3> readVectors<3>(Document&, int, const std::string&, Integers);
template std::vector<glm::vec4> readVectors<4>(Document&, int, const std::string&, Integers);

std::vector<glm::vec4> readColors(Document& document, int accessor, const std::string& place) {
  const Elements elements = elementsOf(document, accessor);
  const bool hasAlpha = typeOf(document, accessor) == TINYGLTF_TYPE_VEC4;
  expect(hasAlpha || typeOf(document, accessor) == TINYGLTF_TYPE_VEC3, document, accessor, place,
         "is not of type VEC3 or VEC4");
  return decodeAttribute(document, accessor, elements, Integers::Fractions, place,
                         glm::vec4(0.0f, 0.0f, 0.0f, hasAlpha ? 0.0f : 1.0f));
}

std::vector<glm::uvec4> readJoints(const Document& document, int accessor, const std::string& place) {
  const Elements elements = elementsOf(document, accessor);
  expect(typeOf(document, accessor) == TINYGLTF_TYPE_VEC4 && isIndexType(elements.componentType) &&
             elements.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
         document, accessor, place, "does not hold unsigned bytes or shorts of type VEC4");
  std::vector<glm::uvec4> result(elements.count, glm::uvec4(0));
  forEachValue(document, accessor, elements,
               [&](size_t i, int c, auto value) { result[i][c] = indexOf(value); });
  return result;
}

std::vector<glm::dmat4> readMatrices(Document& document, int accessor, const std::string& place) {
  const tinygltf::Accessor& source = document.model.accessors.at(size_t(accessor));
  expect(source.type == TINYGLTF_TYPE_MAT4 && source.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT, document,
         accessor, place, "does not hold floats of type MAT4");
  const std::vector<float> numbers = readComponents(document, accessor, 16, place);
  std::vector<glm::dmat4> result(numbers.size() / 16);
  for (size_t i = 0; i < numbers.size(); ++i) {
    if (!std::isfinite(numbers[i]))
      document.diagnostics.lose(place, "matrix " + std::to_string(i / 16) + " is not finite");
    result[i / 16][int(i % 16 / 4)][int(i % 4)] = double(numbers[i]);
  }
  return result;
}

std::vector<float> readComponents(Document& document, int accessor, int components, const std::string& place,
                                  Integers integers) {
  Elements elements = elementsOf(document, accessor);
  expect(elements.components == components, document, accessor, place,
         "does not have " + std::to_string(components) + " components an element");
  settleIntegers(document, integers, place, elements);
  const auto width = size_t(components);
  std::vector<float> result(elements.count * width, 0.0f);
  forEachValue(document, accessor, elements, [&](size_t i, int c, auto value) {
    result[i * width + size_t(c)] = componentToFloat(value, elements.normalized);
  });
  return result;
}

std::vector<uint32_t> readIndices(const Document& document, int accessor, size_t vertexCount,
                                  const std::string& place) {
  const Elements elements = elementsOf(document, accessor);
  expect(typeOf(document, accessor) == TINYGLTF_TYPE_SCALAR && isIndexType(elements.componentType), document,
         accessor, place, "does not hold unsigned integers of type SCALAR");
  std::vector<uint32_t> result(elements.count, 0);
  forEachValue(document, accessor, elements, [&](size_t i, int, auto value) { result[i] = indexOf(value); });
  const uint32_t largest = result.empty() ? 0 : std::ranges::max(result);
  if (!result.empty() && largest >= vertexCount) {
    document.diagnostics.lose(place, "index " + std::to_string(largest) + " is past the " +
                                         std::to_string(vertexCount) + " vertices");
  }
  return result;
}

}  // namespace fragtrace
