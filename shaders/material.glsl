// SPDX-License-Identifier: MIT
// Materials as packed by src/pack/gpu_scene.cpp, evaluated at a point.

uvec4 materialRow(uint material, uint row) {
  return kLiterals ? literalMaterial(material, row) : readMaterials(int(material * kMaterialRows + row));
}

vec4 materialFloats(uint material, uint row) { return uintBitsToFloat(materialRow(material, row)); }

uvec4 textureSlot(uint material, uint slot) { return materialRow(material, kMaterialTextures + slot); }

// slots.glsl is written by src/shader/assemble.cpp: for each texture of kTextureRefs (src/scene/scene.h) its row of a
// material and its texel, as slotBaseColour(material) and texelBaseColour(material, texcoords). Where the scene has no
// such texture, the row is empty and the texel white.
#include "slots.glsl"

/// Light may go through surfaces.
const bool kPassesLight = kTransmission || kDiffuseTransmission;

uint materialFlags(uint material) { return materialRow(material, kMaterialMaps).w; }

/// Base colour and alpha at a point: factor x texture x vertex colour.
vec4 baseColorAt(uint material, vec4 texcoords, vec4 vertexColor) {
  vec4 color = materialFloats(material, kMaterialBaseColor);
  if (kVertexColors) color *= vertexColor;
  color *= texelBaseColour(material, texcoords);
  return color;
}

/// Alpha of a point after the cutoff of MASK.
float alphaAt(uint material, uint flags, float alpha) {
  if ((flags & kMaterialMask) != 0u) return alpha >= materialFloats(material, kMaterialEmission).w ? 1.0 : 0.0;
  return clamp(alpha, 0.0, 1.0);
}

/// Radiance that a surface emits from its emitting side.
vec3 emissionAt(uint material, vec4 texcoords) {
  if (!kEmission) return vec3(0.0);
  vec3 radiance = materialFloats(material, kMaterialEmission).rgb;
  radiance *= texelEmission(material, texcoords).rgb;
  return radiance;
}

/// The parameters of the reflection models at a point.
struct SurfaceMaterial {
  vec3 baseColor;
  float metallic;
  float roughness;
  float transmission;
  float ior;
  float specular;      // f90 of the dielectric layer
  vec3 dielectricF0;   // f0 of the dielectric layer, with the specular factors
  bool solid;          // bounds a volume, else thin-walled
};

SurfaceMaterial materialAt(uint material, vec3 baseColor, vec4 texcoords) {
  vec4 surface = materialFloats(material, kMaterialSurface);
  SurfaceMaterial m;
  m.baseColor = baseColor;
  m.metallic = surface.x;
  m.roughness = surface.y;
  m.ior = surface.z;
  m.transmission = kTransmission ? surface.w : 0.0;
  vec4 texel = texelMetalAndRoughness(material, texcoords);
  m.metallic *= texel.b;
  m.roughness *= texel.g;
  m.transmission *= texelTransmission(material, texcoords).r;
  m.specular = 0.0;
  m.dielectricF0 = vec3(0.0);
  vec4 specular = vec4(0.0);
  float glossiness = 1.0;
  if (kSpecular || kSpecularGlossiness) {
    specular = materialFloats(material, kMaterialSpecular);
    specular.a *= texelSpecular(material, texcoords).a;
    texel = texelSpecularColour(material, texcoords);
    specular.rgb *= texel.rgb;
    glossiness = texel.a;
  }
  if (kSpecularGlossiness && (materialFlags(material) & kMaterialSpecularGlossiness) != 0u) {
    m.baseColor *= 1.0 - maxComponent(specular.rgb);
    m.roughness = 1.0 - (1.0 - m.roughness) * glossiness;
  }
  if (kSpecular) {
    float root = (m.ior - 1.0) / (m.ior + 1.0);
    m.dielectricF0 = min(root * root * specular.rgb, vec3(1.0)) * specular.a;
    m.specular = specular.a;
  } else {
    m.metallic = 0.0;
  }
  m.solid = kPassesLight && materialFloats(material, kMaterialVolume).w > 0.0;
  return m;
}
