// SPDX-License-Identifier: MIT
// These numbers stand for what is counted of the work of samples (work/count.glsl). src/shader/work.h names them in the
// same order.

const uint kWorkBinding = 15u;

const int kWorkCameraRays = 0;    // rays from the camera, also behind surfaces that let them pass
const int kWorkBounceRays = 1;    // rays that surfaces and media have scattered
const int kWorkShadowRays = 2;
const int kWorkLightRays = 3;     // rays of light paths
const int kWorkSplatRays = 4;     // shadow rays between light paths and the camera
const int kWorkPassed = 5;        // surfaces that let rays pass, which are then traced once more
const int kWorkNodes = 6;         // steps from inner nodes
const int kWorkBoxes = 7;         // boxes tested
const int kWorkPrimitives = 8;    // triangles and spheres tested
const int kWorkSurfaces = 9;      // points of surfaces whose attributes are computed
const int kWorkShadowSurfaces = 10;  // those of them that shadow rays have met
const int kWorkBsdfs = 11;        // evaluations of BSDFs
const int kWorkWalks = 12;        // walks through a grid of densities
const int kWorkWalkSteps = 13;
const int kWorkRows = 14;         // rows read of the scene buffers, one number for each
const int kWorkCount = kWorkRows + int(kSceneBufferCount);
