// SPDX-License-Identifier: MIT
// Scene buffers read as texel buffers: buffer textures on the texture units of their bindings.

layout(binding = kNodesBinding) uniform usamplerBuffer nodesBuffer;
uvec4 readNodes(int index) { return texelFetch(nodesBuffer, index); }
layout(binding = kLeavesBinding) uniform usamplerBuffer leavesBuffer;
uvec4 readLeaves(int index) { return texelFetch(leavesBuffer, index); }
layout(binding = kFacesBinding) uniform usamplerBuffer facesBuffer;
uvec4 readFaces(int index) { return texelFetch(facesBuffer, index); }
layout(binding = kNormalsBinding) uniform usamplerBuffer normalsBuffer;
uvec4 readNormals(int index) { return texelFetch(normalsBuffer, index); }
layout(binding = kTexcoordsBinding) uniform usamplerBuffer texcoordsBuffer;
uvec4 readTexcoords(int index) { return texelFetch(texcoordsBuffer, index); }
layout(binding = kTangentsBinding) uniform usamplerBuffer tangentsBuffer;
uvec4 readTangents(int index) { return texelFetch(tangentsBuffer, index); }
layout(binding = kColorsBinding) uniform usamplerBuffer colorsBuffer;
uvec4 readColors(int index) { return texelFetch(colorsBuffer, index); }
layout(binding = kMaterialsBinding) uniform usamplerBuffer materialsBuffer;
uvec4 readMaterials(int index) { return texelFetch(materialsBuffer, index); }
layout(binding = kTexelsBinding) uniform usamplerBuffer texelsBuffer;
uvec2 readTexels(int index) { return texelFetch(texelsBuffer, index).xy; }
layout(binding = kEmittersBinding) uniform usamplerBuffer emittersBuffer;
uvec4 readEmitters(int index) { return texelFetch(emittersBuffer, index); }
layout(binding = kLightsBinding) uniform usamplerBuffer lightsBuffer;
uvec4 readLights(int index) { return texelFetch(lightsBuffer, index); }
layout(binding = kEnvironmentBinding) uniform usamplerBuffer environmentBuffer;
uvec4 readEnvironment(int index) { return texelFetch(environmentBuffer, index); }
layout(binding = kEnvironmentInversionBinding) uniform usamplerBuffer environmentInversionBuffer;
uvec4 readEnvironmentInversion(int index) { return texelFetch(environmentInversionBuffer, index); }
