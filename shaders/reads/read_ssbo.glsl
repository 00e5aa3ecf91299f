// SPDX-License-Identifier: MIT
// Scene buffers read as shader storage buffers: the default on GPUs.

layout(std430, binding = kNodesBinding) readonly restrict buffer NodesBlock { uvec4 nodesBuffer[]; };
uvec4 readNodes(int index) { return nodesBuffer[index]; }
layout(std430, binding = kLeavesBinding) readonly restrict buffer LeavesBlock { uvec4 leavesBuffer[]; };
uvec4 readLeaves(int index) { return leavesBuffer[index]; }
layout(std430, binding = kFacesBinding) readonly restrict buffer FacesBlock { uvec4 facesBuffer[]; };
uvec4 readFaces(int index) { return facesBuffer[index]; }
layout(std430, binding = kNormalsBinding) readonly restrict buffer NormalsBlock { uvec4 normalsBuffer[]; };
uvec4 readNormals(int index) { return normalsBuffer[index]; }
layout(std430, binding = kTexcoordsBinding) readonly restrict buffer TexcoordsBlock { uvec4 texcoordsBuffer[]; };
uvec4 readTexcoords(int index) { return texcoordsBuffer[index]; }
layout(std430, binding = kTangentsBinding) readonly restrict buffer TangentsBlock { uvec4 tangentsBuffer[]; };
uvec4 readTangents(int index) { return tangentsBuffer[index]; }
layout(std430, binding = kColorsBinding) readonly restrict buffer ColorsBlock { uvec4 colorsBuffer[]; };
uvec4 readColors(int index) { return colorsBuffer[index]; }
layout(std430, binding = kMaterialsBinding) readonly restrict buffer MaterialsBlock { uvec4 materialsBuffer[]; };
uvec4 readMaterials(int index) { return materialsBuffer[index]; }
layout(std430, binding = kTexelsBinding) readonly restrict buffer TexelsBlock { uvec2 texelsBuffer[]; };
uvec2 readTexels(int index) { return texelsBuffer[index]; }
layout(std430, binding = kEmittersBinding) readonly restrict buffer EmittersBlock { uvec4 emittersBuffer[]; };
uvec4 readEmitters(int index) { return emittersBuffer[index]; }
layout(std430, binding = kLightsBinding) readonly restrict buffer LightsBlock { uvec4 lightsBuffer[]; };
uvec4 readLights(int index) { return lightsBuffer[index]; }
layout(std430, binding = kEnvironmentBinding) readonly restrict buffer EnvironmentBlock { uvec4 environmentBuffer[]; };
uvec4 readEnvironment(int index) { return environmentBuffer[index]; }
layout(std430, binding = kEnvironmentInversionBinding)
    readonly restrict buffer EnvironmentInversionBlock { uvec4 environmentInversionBuffer[]; };
uvec4 readEnvironmentInversion(int index) { return environmentInversionBuffer[index]; }
