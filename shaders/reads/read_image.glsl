// SPDX-License-Identifier: MIT
// Scene buffers read as image buffers: the fastest reads on llvmpipe (docs/design/traversal-decisions.md).

layout(rgba32ui, binding = kSceneImageBase + kNodesBinding) uniform readonly restrict uimageBuffer nodesBuffer;
uvec4 readNodes(int index) { return imageLoad(nodesBuffer, index); }
layout(rgba32ui, binding = kSceneImageBase + kLeavesBinding) uniform readonly restrict uimageBuffer leavesBuffer;
uvec4 readLeaves(int index) { return imageLoad(leavesBuffer, index); }
layout(rgba32ui, binding = kSceneImageBase + kFacesBinding) uniform readonly restrict uimageBuffer facesBuffer;
uvec4 readFaces(int index) { return imageLoad(facesBuffer, index); }
layout(rgba32ui, binding = kSceneImageBase + kNormalsBinding) uniform readonly restrict uimageBuffer normalsBuffer;
uvec4 readNormals(int index) { return imageLoad(normalsBuffer, index); }
layout(rgba32ui, binding = kSceneImageBase + kTexcoordsBinding) uniform readonly restrict uimageBuffer texcoordsBuffer;
uvec4 readTexcoords(int index) { return imageLoad(texcoordsBuffer, index); }
layout(rgba32ui, binding = kSceneImageBase + kTangentsBinding) uniform readonly restrict uimageBuffer tangentsBuffer;
uvec4 readTangents(int index) { return imageLoad(tangentsBuffer, index); }
layout(rgba32ui, binding = kSceneImageBase + kColorsBinding) uniform readonly restrict uimageBuffer colorsBuffer;
uvec4 readColors(int index) { return imageLoad(colorsBuffer, index); }
layout(rgba32ui, binding = kSceneImageBase + kMaterialsBinding) uniform readonly restrict uimageBuffer materialsBuffer;
uvec4 readMaterials(int index) { return imageLoad(materialsBuffer, index); }
layout(rg32ui, binding = kSceneImageBase + kTexelsBinding) uniform readonly restrict uimageBuffer texelsBuffer;
uvec2 readTexels(int index) { return imageLoad(texelsBuffer, index).xy; }
layout(rgba32ui, binding = kSceneImageBase + kEmittersBinding) uniform readonly restrict uimageBuffer emittersBuffer;
uvec4 readEmitters(int index) { return imageLoad(emittersBuffer, index); }
layout(rgba32ui, binding = kSceneImageBase + kLightsBinding) uniform readonly restrict uimageBuffer lightsBuffer;
uvec4 readLights(int index) { return imageLoad(lightsBuffer, index); }
layout(rgba32ui, binding = kSceneImageBase + kEnvironmentBinding)
    uniform readonly restrict uimageBuffer environmentBuffer;
uvec4 readEnvironment(int index) { return imageLoad(environmentBuffer, index); }
layout(rgba32ui, binding = kSceneImageBase + kEnvironmentInversionBinding)
    uniform readonly restrict uimageBuffer environmentInversionBuffer;
uvec4 readEnvironmentInversion(int index) { return imageLoad(environmentInversionBuffer, index); }
