// SPDX-License-Identifier: MIT
// Bindings, sentinels and packed layouts that C++ and GLSL share (src/shader/layout.h includes this file).

// Scene buffers, each of which is read through one function: src/shader/layout.h lists them.
const uint kSceneBufferCount = 13u;

// Film images, one texel per pixel.
const uint kFilmSumBinding = 0u;           // rgba32f: sum of radiance, sum of alpha
const uint kFilmCompensationBinding = 1u;  // rgba32f: Kahan compensation of the sum, Welford's M2 of the luminance
const uint kFilmCountsBinding = 2u;        // rgba32ui: samples, rays, non-finite samples, kPixel* flags

// Storage buffers that the tracer writes.
const uint kPathStatesBinding = 13u;
const uint kProgressBinding = 14u;
const uint kWorkBinding = 15u;
// uvec4s a path (path_rows.glsl); where no ray passes surfaces, the wavefront leaves the last ones out. Behind those of
// a suspended path come one more, those of its stack, and those of its integrator's state.
const uint kPathRows = 12u;
const uint kPathPassingRows = 3u;
const uint kPathOwnRows = 3u;
// A lane of the wavefront has this many pixels of a column of its tile, each with the state of its path, and a row of
// its own before them.
const uint kWaveSlots = 32u;
const uint kWaveLaneRows = kWaveSlots * kPathRows + 1u;

// The number of work groups in a draw of the compute entries is a multiple of this on software; on GPUs they fill
// squares with sides of so many groups (work_group.glsl).
const uint kWorkGroupHands = 8u;
const uint kMortonSide = 8u;

// The uniform block of one draw, and those of the scene's fog, of its grid, and of a camera that moves.
const uint kFrameBinding = 0u;
const uint kFogBinding = 1u;
const uint kVolumeBinding = 2u;
const uint kShutterBinding = 3u;

// A program draws an AOV instead of radiance (kAov). These are known by their numbers, as in enum Aov of
// src/shader/render_options.h; integrators/first_hit.glsl has the others.
const int kAovNone = 0;
const int kAovObject = 8;
const int kAovMaterial = 9;
const int kAovEmission = 10;
const int kAovDiffuse = 11;
const int kAovSpecular = 12;

// Film flags.
const uint kPixelSuspended = 1u;  // the path of this pixel continues in the next draw
const uint kPixelBudgetHit = 2u;  // a loop was ended by something other than its own condition
const uint kPixelOverWhite = 4u;    // its luminance is that of the pixel laid over white: the shadow is in alpha alone
const uint kPixelTargetShift = 3u;  // above: the most samples this pixel is to have; 0: what the draw says

// A node: origin of its grid, and the size of its cells as three bytes, each the exponent of a float; a byte a child
// for each side of the boxes: low and high x, low and high y; low and high z; inner children and leaves as groups.
const uint kNodeRows = 3u;
const float kBoxPadding = 0.000244140625f;  // by this part of a cell, boxes are larger than packed
// A group is a bit for each of its children and, below, the index that child 0 would have: children are numbered
// through a node, inner ones first, and both kinds stand side by side. A group that has only the end of the traversal
// is an empty stack. There are at most 2^26 nodes and leaves each.
const uint kFirstChild = 0x08000000u;
const uint kBaseMask = 0x07ffffffu;
const int kTraversalDone = -1;
const uint kEndGroup = 0x0fffffffu;
const uint kLeafRows = 5u;
// If surfaces move (kMoving), nodes and leaves have these rows twice: for the beginning and for the end of their
// segment.
const uint kLeafBlock = 4u;  // the iterative traversal tests this many leaves in one loop iteration

// An instance is the only leaf of a node of the upper tree. Its index is kInstanceLeaf + its number, which is that of
// its first row / kInstanceRows. The node kInstanceEnd leads back out of it. Rows: three of the matrix from local space
// into its mesh's, next to them the mesh's origin in local space; root of its tree, and scale of offsets; three rows of
// the matrix back, next to them what is added to offsets, -1 where the matrix mirrors, else 1, and how much lengths can
// grow on the way into the mesh's space.
const int kInstanceLeaf = 0x04000000;
const int kInstanceEnd = -2;
const uint kInstanceEndGroup = 0x0ffffffeu;
const uint kInstanceRows = 7u;
const float kAlbedoFloor = 0.04f;  // part of white in the albedo by which denoising divides light
const float kMeshReach = 1.75f;  // a shared mesh lies within this distance of its origin: coordinates are at most 1

// Primitive words in a leaf: flags, and in the lowest byte the reach of coincidence as the exponent of a float, 0 where
// it has none (src/scene/coincidence.h).
const uint kPrimitiveNone = 0xffffffffu;
const uint kPrimitiveEmits = 0x08000000u;
const uint kPrimitiveCull = 0x80000000u;    // the back is not there
const uint kPrimitivePasses = 0x40000000u;  // light may pass: alpha, or glass
const uint kPrimitiveSphere = 0x20000000u;  // v0 is the centre, v1.x the radius
const uint kPrimitiveSliver = 0x10000000u;  // distances to it may be those to its plane

// Face rows. Triangle: unit normal and face word; distance of its plane from the origin, vertex indices. Sphere:
// rotation quaternion x, y, z with w >= 0 and face word; centre, radius. Face word: material, flag, and the bound on a
// hit point's error (local space) as the upper bits of a float. Of creases: the middle of the triangle and its inset
// (creaseInsets of src/scene/creases.h).
const uint kFaceRows = 2u;
const uint kFaceMaterialMask = 0xfffffu;
const uint kFaceSphere = 0x100000u;
const uint kFaceFlat = 0x200000u;   // no vertex normals
const uint kFaceErrorShift = 22u;   // the bits above are those of a positive float from bit 21 on
const uint kFloatErrorShift = 21u;

// Material rows.
const uint kMaterialBaseColor = 0u;    // base colour factor
const uint kMaterialEmission = 1u;     // radiance, alpha cutoff
const uint kMaterialSurface = 2u;      // metallic, roughness, index of refraction, transmission
const uint kMaterialSpecular = 3u;     // specular colour, specular factor
const uint kMaterialVolume = 4u;       // extinction coefficient (1 / local space), 1 + table of rough glass or 0: thin
// normal scale, occlusion strength, emitter pdf (1 / area in local space), flags
const uint kMaterialMaps = 5u;
const uint kMaterialPerlin = 6u;       // frequency, amplitude, octaves; and the number of the glTF material, from 1
const uint kMaterialTextures = 7u;     // then one row per texture slot (src/shader/layout.h)
const uint kSlotCount = 19u;
// Extensions add these rows; they are read only where a material of the scene has them.
const uint kMaterialClearcoat = kMaterialTextures + kSlotCount;       // weight, roughness, normal scale, dispersion
const uint kMaterialSheen = kMaterialClearcoat + 1u;                  // colour, roughness
const uint kMaterialAnisotropy = kMaterialSheen + 1u;                 // strength, cosine and sine of the rotation
const uint kMaterialIridescence = kMaterialAnisotropy + 1u;           // weight, index, least and largest thickness (nm)
const uint kMaterialDiffuseTransmission = kMaterialIridescence + 1u;  // colour, weight
// A solid has the albedo of one scattering here, a thin wall its multiscatter colour; w: anisotropy
const uint kMaterialScatter = kMaterialDiffuseTransmission + 1u;
const uint kMaterialScatterStrength = kMaterialScatter + 1u;  // strength of a thin wall
const uint kMaterialRows = kMaterialScatterStrength + 1u;

// Cells along each axis of the tables of energy and of sheen, which stand behind the materials and the transforms of
// textures. Behind them all are the numbers of objects (kObjectNumbers), four per row: one per leaf slot, then one per
// instance, whose numbers do not begin at 0.
const uint kEnergyCells = 32u;

// Material flags.
const uint kMaterialMask = 1u;
const uint kMaterialBlend = 2u;
const uint kMaterialDoubleSided = 4u;
const uint kMaterialUnlit = 8u;
const uint kMaterialSpecularGlossiness = 16u;
const uint kMaterialScatters = 64u;  // a solid inside of which light is scattered
const uint kMaterialCaster = 32u;  // its delta lobes make caustics that light paths draw (src/scene/casters.h)
const uint kMaterialGlossyCaster = 128u;  // its one lobe, which is none, does
const uint kMaterialClosed = 256u;      // a solid each part of which is closed
const uint kMaterialHoldsLamps = 512u;  // a solid inside of which punctual lights stand

const int kMostCasters = 16;  // balls round what makes caustics

// Texture slot row: place of its picture, width | height << 16, flags, row of its transform among the materials or 0.
// A transform is two rows of a matrix. The place is the first word of a buffer, or x | y << 16 of a layer; the upper
// half of the flags says which buffer or layer.
const uint kTexturePresent = 1u;
const uint kTextureLinear = 2u;
const uint kTextureTexcoord1 = 4u;
const uint kTextureClampU = 8u;
const uint kTextureMirrorU = 16u;
const uint kTextureClampV = 32u;
const uint kTextureMirrorV = 64u;
const uint kTextureWide = 128u;  // its texels have 16 bits a channel
const uint kTextureLevelShift = 8u;  // of an array texture, only while a texel is read (tune/texels_arrays.glsl)
const uint kTexturePlaceShift = 16u;
// Pictures lie in buffers of words (tune/texels_words.glsl); or in array textures (tune/texels_arrays.glsl), whose
// three units are behind those of reservoirs.

// The table of a row of the environment has half as many steps as the row has texels, but at least one and at most
// these.
const int kMostEnvironmentSteps = 1024;

// The numbers of rows of factors, and of levels of lobes, of the environment's light.
const uint kIrradianceRows = 9u;
const uint kLobeLevels = 6u;

// The sun before a sky (sky/sun.glsl), behind the map and its backdrop: its direction before the map is turned and the
// chance that a light sample of the environment takes it; radiance and pdf in its middle; the luminance from which on a
// place of the map is its sun (kMapSun). Its radius in radians.
const uint kSunRows = 3u;
const float kSunRadius = 0.004651303f;

// Emitter rows: the first and the last emitter that its equal share of the numbers draws, the last number that draws
// itself, probability (float); of an emissive triangle its first vertex and material, its edges from there with 1 /
// area (float) and, of every emitter, what it is.
const uint kEmitterRows = 4u;
const uint kEmitterPunctual = 0x80000000u;     // flag of a light's index; without it a triangle's leaf slot
const uint kEmitterDoubleSided = 0x80000000u;  // flag of the material's index

// Behind the emitters, where they are chosen by a tree (src/pack/pack_lights.h): a row with the number of its nodes;
// the nodes, the root first; their parents, four per row; the leaves of emissive triangles, four per row, one per leaf
// slot of the scene. Node rows: middle, intensity; axis as three 10-bit numbers, cosine of the spread as a 16-bit
// number and, above it, the thickness along the axis in parts of the radius, radius or -1 for what shines everywhere,
// first child or kLightLeaf and the first emitter, with flags. A leaf has up to kMostLightsOfLeaf emitters, one after
// the other, which are chosen alike.
const uint kLightNodeRows = 2u;
const uint kLightLeaf = 0x80000000u;
const uint kLightBothSides = 0x40000000u;
const uint kLightSharp = 0x20000000u;  // nothing shines beyond the spread; else up to a right angle more
const uint kLightIndex = 0x03ffffffu;
const uint kMostLightsOfLeaf = 8u;
const uint kLightMoreShift = 26u;  // three bits: the number of a leaf's emitters behind the first
const uint kNoLightNode = 0xffffffffu;
const uint kNoNormal = 0xffffffu;  // replaces a normal as three 8-bit numbers (packNormal)

// Behind the lights, where there are casters of caustics: guiding lobes (caustics/guiding.glsl), kGuidingLobes rows for
// each of kGuidingCells. Rows: focus; spread as a float with 11 bits of its fraction, kGuidingAway instead of its
// sign, and the share up to the lobe instead of its last bits.
const uint kGuidingCells = 16384u;
const int kGuidingLobes = 8;
const uint kGuidingAway = 0x80000000u;
const uint kGuidingSpreadMask = 0x7ffff000u;
const uint kGuidingShareMask = 0xfffu;

// Light rows: intensity + type, position + range, direction + spot scale, spot offset.
const uint kLightRows = 4u;
const uint kLightCandidates = 4u;  // number of candidates for a light sample (reuse/candidates.glsl)
// Spatial reuse (reuse/reservoir.glsl): neighbours of a pixel that take part; the unit of the numbers of 24 bits that
// draw a direction of the environment; the first of its two texture units, behind those of the scene buffers.
const uint kReuseNeighbours = 4u;
const uint kReservoirUnit = 256u;
const uint kReservoirTextures = kSceneBufferCount;
const uint kTexelTextures = kReservoirTextures + 2u;
const float kLightSpot = 1.0f;
const float kLightDirectional = 2.0f;

// The constants of one draw; std140, each row 16 bytes.
struct Frame {
  vec3 cameraPosition;  // local space
  float orthographic;   // 1, or 0 for a perspective camera
  vec3 cameraRight;     // half of the view's width: at distance 1, local space (orthographic), radians (round)
  float firstInMiddle;  // 1 when the first sample is in the middle of its pixel
  vec3 cameraUp;        // half of the view's height
  uint cameraSolids;    // the solids that the camera stands in, or kPrimitiveNone (media/solids.glsl)
  vec3 cameraForward;   // size of the unit of local space
  float metresPerUnit;  // of local space
  vec3 sceneExtent;     // sides of the scene's box, local space
  float treeRounding;   // the least rounding of distances in the tree, local space
  vec3 background;      // radiance that camera rays see
  float backgroundShows;    // 1 when they see the environment instead; -1 when they see nothing
  vec2 environmentSize;     // width, height of the map
  vec2 environmentRotation;  // cosine, sine
  float environmentChance;  // probability that a light sample takes the environment
  float emitterCount;
  float energyRow;      // row of the energy table among the materials
  float punctualCount;  // lights
  ivec2 pictureSize;    // size of the whole picture; the film may be a part of it
  int samplesWanted;
  int seed;
  ivec4 tile;           // x, y (from the bottom), width, height
  int maxBounces;
  int rouletteDepth;
  int stepBudget;
  int leafCount;
  int firstSample;  // index in the seed's sequence
  int clampBits;    // bits of the largest indirect radiance
  int tileGoesOn;   // 1 when the draw before had this tile, too (wavefront)
  int objectRow;    // row of the numbers of objects among the materials
  ivec2 filmOffset;    // x, y (from the bottom) of the film's first pixel in the picture
  ivec2 backdropSize;  // width, height
  vec3 worldOrigin;    // origin of local space in world space, metres
  float catcherHeight;      // height of the shadow catcher, local space
  vec3 catcherIrradiance;   // irradiance of the shadow catcher by the environment when nothing is in the way
  float environmentScale;   // factor of the environment's radiance
  vec4 lens;                // the camera's lens, local space: radius, distance in focus along the view; blades
  vec2 lensShift;           // the middle of the picture, in halves of its width and height
  vec2 shadowFade;          // as in LightOptions
  // Surfaces move in straight pieces: their number, and nodes and leaves of each; vertices of one pose.
  ivec4 segments;
};

// A camera that moves while the shutter is open (shutter/camera.glsl), in segments of equal time; std140. A
// segment holds the turn from the camera of Frame to that in its middle (axis and angle), the position there
// (local space), and the turn and the motion over the whole segment.
struct CameraSegment {
  vec4 turn;
  vec4 position;
  vec4 turnOver;
  vec4 slide;
};
const int kMostCameraSegments = 32;
struct Shutter {
  ivec4 count;  // number of segments
  CameraSegment camera[kMostCameraSegments];
};

// Fog in a ball round the scene (media/fog.glsl); std140.
struct Fog {
  vec4 ball;     // local space: middle, radius
  vec4 medium;   // albedo of one scattering, anisotropy
  vec4 density;  // extinction at the base and below (1 / local space); 1 / the height in which it falls by e; base
};

// A grid of densities (media/volume.glsl); std140.
struct Volume {
  vec4 toBricksX;  // rows of the matrix from local space to bricks of the table
  vec4 toBricksY;
  vec4 toBricksZ;
  vec4 medium;      // albedo of one scattering, anisotropy
  vec4 extinction;  // extinction at the largest density (1 / local space); factor of the radiance, 0: no emission
  ivec4 table;      // numbers of bricks along X, Y, Z; 0
};
const int kBrickTexels = 128;
const int kMostVolumeSteps = 1024;  // limit of steps of one walk through the grid

// The report of one draw.
const float kCutUnits = 65536.0f;  // units for a throughput of 1
struct Progress {
  uint unfinished;  // pixels that have samples left
  uint stuck;       // of these, pixels that completed none, so that their path has to be suspended to come to an end
  uint cutLow;      // luminance of the throughput that --bounces cut, over all paths, in kCutUnits
  uint cutHigh;     // the upper 32 bits of it
};
