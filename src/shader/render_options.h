// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

#include "image/display/tone_map.h"
#include "image/files/video_format.h"
#include "image/format.h"
#include "image/image.h"
#include "scene/camera.h"
#include "scene/parts.h"
#include "scene/scene.h"
#include "scene/sky/sky.h"
#include "scene/studio.h"
#include "shader/stage.h"

namespace fragtrace {

// Values that can be drawn instead of radiance: layers of .exr files, and debug views, which show layers or
// counts as colours (docs/output.md).

/// Properties of a first hit besides its radiance, and parts of that radiance.
enum class Aov : uint8_t {
  None,
  Albedo,
  Normal,
  Depth,
  GeometricNormal,
  Roughness,
  Texcoords,
  Position,
  Object,    ///< number of the glTF node, from 1 on
  Material,  ///< number of the glTF material, from 1 on
  Emission,  ///< the parts of its radiance, which add up to it: what surfaces and surroundings send to the
             ///< camera,
  Diffuse,   ///< light that was scattered first by a diffuse surface,
  Specular,  ///< light that was scattered first by any other surface
  Guides,    ///< guides of filters, all in one: kGuideChannels
  CryptoObject,   ///< Cryptomatte of the glTF nodes: ids and shares of each pixel (image/channels.h)
  CryptoMaterial  ///< the same of the materials
};

struct AovRow {
  std::string_view name;      ///< name of the layer
  std::string_view channels;  ///< a letter each, behind the name and a dot
};

/// The layers, in the order of Aov.
inline constexpr std::array<AovRow, 16> kAovRows{{{"", ""},
                                                  {"albedo", "RGB"},
                                                  {"normal", "XYZ"},
                                                  {"depth", "Z"},
                                                  {"geometric-normal", "XYZ"},
                                                  {"roughness", "Y"},
                                                  {"texcoords", "UV"},
                                                  {"position", "XYZ"},
                                                  {"object", "Y"},
                                                  {"material", "Y"},
                                                  {"emission", "RGB"},
                                                  {"diffuse", "RGB"},
                                                  {"specular", "RGB"},
                                                  {"denoising", ""},
                                                  {"crypto-object", ""},
                                                  {"crypto-material", ""}}};

inline const AovRow& rowOf(Aov aov) { return kAovRows[size_t(aov)]; }

/// Returns true if the AOV is a share of the light, for which paths are traced to their ends.
inline bool isLightPart(Aov aov) {
  return aov == Aov::Emission || aov == Aov::Diffuse || aov == Aov::Specular;
}

/// Returns true if the AOV is a Cryptomatte.
inline bool isMatte(Aov aov) { return aov == Aov::CryptoObject || aov == Aov::CryptoMaterial; }

/// The content of a picture. All but None are colours to be displayed as they are, without exposure and tone
/// curve.
enum class DebugView : uint8_t {
  None,
  GeometricNormal,
  Normal,
  Albedo,
  Roughness,
  Texcoords,
  Depth,
  Visits,
  Samples,
  Variance
};

struct DebugViewRow {
  std::string_view name;   ///< on the command line
  std::string_view label;  ///< the name in the viewer
  std::string_view sentence;
  Aov aov;  ///< drawn for it; None: it shows counts, of samples drawn as ever or of nodes
};

/// The debug views, in the order of DebugView.
inline constexpr std::array<DebugViewRow, 10> kDebugViewRows{{
    {"none", "Radiance", "the picture itself", Aov::None},
    {"geometric-normal", "Geometric normal", "0.5 + 0.5 N of the triangle, towards the camera",
     Aov::GeometricNormal},
    {"normal", "Shading normal", "0.5 + 0.5 N with vertex normals and maps", Aov::Normal},
    {"albedo", "Base colour", "base colour: factor, texture, vertex colour", Aov::Albedo},
    {"roughness", "Roughness", "perceptual roughness, from black to white", Aov::Roughness},
    {"texcoords", "Texture coordinates", "the fractions of TEXCOORD_0, red and green", Aov::Texcoords},
    {"depth", "Depth", "along the view's axis, from white (nearest) to dark grey (farthest)", Aov::Depth},
    {"visits", "Node visits", "nodes of the tree that a camera ray visits, as a heat map", Aov::None},
    {"samples", "Samples", "samples per pixel, as a heat map", Aov::None},
    {"variance", "Variance", "estimated relative error of each pixel in per cent, as a heat map", Aov::None},
}};

inline const DebugViewRow& rowOf(DebugView view) { return kDebugViewRows[size_t(view)]; }

// Everything a render is asked for, as the command line and the viewer spell it.

/// The method by which rays find triangles. Literals: a small scene's triangles are part of the shader's text
/// (src/pack/literals.h).
enum class TraversalMethod : uint8_t { Auto, Iterative, Bvh, FrontToBack, Literals };
inline constexpr std::array<std::string_view, 5> kTraversalNames{"auto", "iterative", "bvh", "front-to-back",
                                                                 "literals"};
enum class Backend : uint8_t { Auto, Egl, OsMesa };
inline constexpr std::array<std::string_view, 3> kBackendNames{"auto", "egl", "osmesa"};
/// The way in which the shader reads the scene: storage buffers, image buffers or texel buffers. The buffers
/// are the same, only bound in another way.
enum class BufferReads : uint8_t { Auto, Ssbo, Image, Texel };
inline constexpr std::array<std::string_view, 4> kBufferReadsNames{"auto", "ssbo", "image", "texel"};

/// How texels are filtered where many of them lie in a pixel: exactly, by samples alone, or by mip levels
/// that ray cones choose.
enum class TextureFilter : uint8_t { Exact, Cones };
inline constexpr std::array<std::string_view, 2> kTextureFilterNames{"exact", "cones"};
/// How the shader reads texels; Auto means words on software, array textures on GPUs.
enum class TextureReads : uint8_t { Auto, Words, Arrays };
inline constexpr std::array<std::string_view, 3> kTextureReadsNames{"auto", "words", "arrays"};
/// The stage of the pipeline that runs the tracer: one fragment or one compute invocation a pixel.
enum class Dispatch : uint8_t { Auto, Fragment, Compute };
inline constexpr std::array<std::string_view, 3> kDispatchNames{"auto", "fragment", "compute"};
/// The kind of compiler for which the shaders' text is written (docs/measurements/gpu.md). Pictures do not
/// depend on it.
enum class Tune : uint8_t { Auto, Software, Gpu };
inline constexpr std::array<std::string_view, 3> kTuneNames{"auto", "software", "gpu"};
/// Bits of the vectors that Mesa's software driver computes with, and so how many invocations run in
/// lockstep: 8 or 16. Auto: as the driver has it, 256 today. Mesa 22.3 to 26.1 crash on some shaders with 512
/// (docs/design/platforms.md).
enum class VectorWidth : uint8_t { Auto, Bits256, Bits512 };
inline constexpr std::array<std::string_view, 3> kVectorWidthNames{"auto", "256", "512"};
/// The way in which paths share the lanes of a draw: one pixel per lane, or many, whose rays are traced
/// together (shaders/wavefront.glsl).
enum class Schedule : uint8_t { Auto, Megakernel, Wavefront };
inline constexpr std::array<std::string_view, 3> kScheduleNames{"auto", "megakernel", "wavefront"};
/// The way in which light samples of gi choose a light: by what it may send to the point
/// (pack/pack_lights.h), by its power, or all alike.
enum class LightSelection : uint8_t { Auto, Tree, Power, Uniform };
inline constexpr std::array<std::string_view, 4> kLightSelectionNames{"auto", "tree", "power", "uniform"};
/// The light samples of which a scattering takes one (shaders/reuse/): a single one, several candidates, or,
/// at the first surface, those of the pixel and of others near it.
enum class LightReuse : uint8_t { None, Candidates, Spatial };
inline constexpr std::array<std::string_view, 3> kLightReuseNames{"none", "candidates", "spatial"};
/// Light paths bring the caustics of lamps and of a sky's sun, or not (shaders/caustics/); auto: where there
/// are lamps or a sun, and casters.
enum class Caustics : uint8_t { Auto, On, Off };
inline constexpr std::array<std::string_view, 3> kCausticsNames{"auto", "on", "off"};
/// The light of a scene that has none of its own: white from all sides, which the camera does not see, the
/// built-in environment (scene/studio.h), or nothing.
enum class DefaultLight : uint8_t { White, Studio, None };
inline constexpr std::array<std::string_view, 3> kDefaultLightNames{"white", "studio", "none"};
/// The units in which the file gives its lamps: as glTF has them; lumens that were watts, 683 times too many;
/// or whichever of these lights what is seen (pack/own_light.h).
enum class LampUnits : uint8_t { Auto, Photometric, Radiometric };
inline constexpr std::array<std::string_view, 3> kLampUnitsNames{"auto", "photometric", "radiometric"};
/// The filter that removes noise from a finished picture (render/denoise.h, image/denoise/oidn.h). Auto: Open
/// Image Denoise where it is installed, else the variance filter.
enum class Denoise : uint8_t { None, Variance, Oidn, Auto };
inline constexpr std::array<std::string_view, 4> kDenoiseNames{"none", "variance", "oidn", "auto"};
/// The form of progress on stderr: a bar or lines of text; JSON lines, all messages included
/// (base/report.h); nothing.
enum class ProgressForm : uint8_t { Auto, Json, None };
inline constexpr std::array<std::string_view, 3> kProgressNames{"auto", "json", "none"};
/// The way in which programs are expected to lay a .png with alpha over something: by its light, or by its
/// sRGB values. Auto: by these, where the picture has a shadow or glass that the page shows through.
enum class AlphaOf : uint8_t { Linear, Display, Auto };
inline constexpr std::array<std::string_view, 3> kAlphaNames{"linear", "display", "auto"};
/// What turns in a turntable: the camera about the object, or the object before camera, light and ground.
enum class Turn : uint8_t { Camera, Object };
inline constexpr std::array<std::string_view, 2> kTurnNames{"camera", "object"};
/// The distribution of camera samples about the middle of their pixel (shaders/pixel_filter.glsl).
enum class PixelFilter : uint8_t { Box, Gaussian, BlackmanHarris };
inline constexpr std::array<std::string_view, 3> kPixelFilterNames{"box", "gaussian", "blackman-harris"};

struct FrameRange {
  int first = 0;
  int last = 0;  ///< belongs to it
  int step = 1;

  bool operator==(const FrameRange&) const = default;
};

/// Pictures of one scene, numbered: at times of an animation, or from all around.
struct SequenceOptions {
  std::optional<FrameRange> frames;  ///< frames of the animation
  double fps = 24.0;                 ///< picture k is the animation at k / fps seconds
  int turntable = 0;                 ///< pictures of a whole turn about the focal point; 0: none
  Turn turn = Turn::Camera;          ///< of a turntable
  bool keep = false;                 ///< pictures that are there already are not drawn again

  bool operator==(const SequenceOptions&) const = default;
};

/// Depth of field of perspective cameras.
struct LensOptions {
  std::optional<double> fStop;          ///< none: a pinhole
  std::optional<double> focusDistance;  ///< along the view, metres; none: to the focal point
  int blades = 0;                       ///< blades of the aperture; 0: it is round

  bool operator==(const LensOptions&) const = default;
};

/// From where a scene is seen, and what a pixel is.
struct CameraOptions {
  std::optional<glm::ivec2> resolution;
  std::optional<Region> region;  ///< the drawn part of the picture; none: all of it
  std::optional<int> index;
  CameraOverrides overrides;
  LensOptions lens;
  double shutter =
      0.0;  ///< the part of a frame's time for which it is open, degrees of 360; 0: no motion blur
  std::optional<glm::dvec3>
      sceneOrigin;  ///< place that positions are rounded about; none: the focal point given
  PixelFilter pixelFilter = PixelFilter::Box;
  double lineWidth = 2.0;  ///< width of points and lines, pixels

  bool operator==(const CameraOptions&) const = default;
};

inline constexpr int kMostCameraRays = 8;  ///< per sample
inline constexpr int kUnlimitedBounces = std::numeric_limits<int>::max() - 1;

/// The number and the length of paths.
/// Goals of noise, with a filter, for those who do not count samples. None: the other options say it all.
enum class Quality : uint8_t { None, Draft, Good, Best };
inline constexpr std::array<std::string_view, 4> kQualityNames{"none", "draft", "good", "best"};

struct SamplingOptions {
  Quality quality = Quality::None;  ///< finishRender() sets noise, spp and the filter by it
  int spp = 64;
  int sampleOffset = 0;  ///< index of the first sample in the seed's sequence
  uint32_t seed = 0;
  int cameraRays = 0;     ///< per sample; 0: chosen by the scene
  int bounces = 16;       ///< kUnlimitedBounces: no limit
  int rouletteDepth = 6;  ///< roulette from this scattering on, the first being 1
  TextureFilter textureFilter = TextureFilter::Exact;
  double clampIndirect = 0.0;  ///< largest radiance that two scatterings or more may add; 0: no limit
  double noise = 0.0;          ///< relative error to reach, adaptively; 0: spp samples in every pixel
  double seconds = 0.0;        ///< time to spend, adaptively; 0: no limit

  bool operator==(const SamplingOptions&) const = default;
};

/// A clear sky with its sun (scene/sky/sky.h).
struct SkyOptions {
  bool on = false;
  SunPlace sun{};                     ///< the sun's place, if `time` does not give it
  std::string time{};                 ///< daysOf() reads it; empty: `sun` is the place
  std::optional<glm::dvec2> place{};  ///< latitude and longitude in degrees, north and east positive
  double turbidity = 3.0;
  double groundAlbedo = 0.2;

  bool operator==(const SkyOptions&) const = default;
};

/// A level plane under the scene that is seen.
struct GroundOptions {
  glm::vec3 color{0.5f};
  double roughness = 0.6;

  bool operator==(const GroundOptions&) const = default;
};

/// The light of a scene, its sampling, and the surroundings.
struct LightOptions {
  LightSelection selection = LightSelection::Auto;
  LightReuse reuse = LightReuse::None;
  Caustics caustics = Caustics::Auto;
  std::filesystem::path hdriFile;
  double hdriRotationDegrees = 0.0;
  double hdriIntensity = 1.0;                ///< factor of the environment's radiance
  double backgroundBlur = 0.0;               ///< standard deviation of the blur that the camera sees, degrees
  std::optional<glm::vec3> backgroundColor;  ///< none: the environment map, black without one
  bool background = true;
  DefaultLight defaultLight = DefaultLight::Studio;
  LampUnits lampUnits = LampUnits::Auto;
  SkyOptions sky;
  bool studio = false;  ///< the built-in environment (scene/studio.h)
  StudioLook studioLook = StudioLook::Soft;
  std::optional<GroundOptions> ground;
  bool transparentGlass = false;        ///< the camera sees the page through glass, and alpha says how much
  bool shadowCatcher = false;           ///< a plane that shows nothing but shadows
  std::optional<double> catcherHeight;  ///< its Y in world space, metres; none: the bottom of the scene
  /// The parts of the picture's smaller side over which the shadow ends before the edges at the sides, and
  /// above and below; none: as shadowFadeOf().
  std::optional<glm::dvec2> shadowFade;

  bool operator==(const LightOptions&) const = default;
};

/// Fog in a ball round the scene (scene/scene.h).
struct FogOptions {
  double density = 0.0;            ///< extinction, 1/m; 0: there is none
  std::optional<glm::vec3> color;  ///< albedo of one scattering; none: 1
  double anisotropy = 0.0;
  /// Metres over which the density falls by the factor e; none: it does not fall.
  std::optional<double> height;
  std::optional<double> base;      ///< Y above which the density falls, metres; none: the bottom of the scene
  std::optional<double> distance;  ///< radius, metres; none: in proportion to the scene

  bool operator==(const FogOptions&) const = default;
};

/// The files that are written, their content, and messages meanwhile.
struct OutputOptions {
  std::filesystem::path file;
  std::filesystem::path place;  ///< where the picture goes, if `file` only tells its format
  std::string format;           ///< format of standard output, or of a file with any name
  std::filesystem::path statsFile;
  std::filesystem::path traceFile;       ///< file of the timeline
  std::filesystem::path shaderText;      ///< file of the tracer's text
  std::filesystem::path oidnLibrary;     ///< file of Open Image Denoise; none: it is looked for
  std::vector<Aov> aovs;                 ///< more layers of .exr files
  std::vector<std::string> lightGroups;  ///< names of the lights that have a layer each
  SequenceOptions sequence;
  double checkpointSeconds = 0.0;  ///< between two checkpoints; 0: none is written
  std::optional<double> exposure;  ///< stops; none: 0, unless the scene's light is far too bright or too dark
  ToneMap toneMap = ToneMap::Neutral;
  OcioView ocio;  ///< takes the curve's place
  Encoding encoding;
  std::optional<int> treeLevel;  ///< its boxes are drawn over the picture
  AlphaOf alpha = AlphaOf::Auto;
  DebugView debugView = DebugView::None;
  Denoise denoise = Denoise::None;
  ProgressForm progress = ProgressForm::Auto;
  bool toStandardOutput = false;  ///< the picture; `file` then tells its format and what messages call it
  bool aovSamples = false;
  bool aovVariance = false;
  bool dither = true;      ///< display values before they are rounded to 8 bits
  bool resume = false;     ///< continue from the checkpoint next to the output
  bool countWork = false;  ///< the work of samples (shader/work.h)
  bool quiet = false;
  bool verbose = false;

  bool operator==(const OutputOptions&) const = default;
};

/// The device and the method that trace the picture. They change only its time and rounding.
struct DeviceOptions {
  TraversalMethod traversal = TraversalMethod::Auto;
  Instancing instancing = Instancing::Auto;
  Backend backend = Backend::Auto;
  BufferReads bufferReads = BufferReads::Auto;
  TextureReads textureReads = TextureReads::Auto;
  Dispatch dispatch = Dispatch::Auto;
  Tune tune = Tune::Auto;
  VectorWidth vectorWidth = VectorWidth::Auto;
  Schedule schedule = Schedule::Auto;
  std::filesystem::path shaderFolder;  ///< shader text from disk instead of the embedded one
  std::string device;                  ///< its number, or a part of its name; empty: the first that works

  bool operator==(const DeviceOptions&) const = default;
};

struct RenderOptions {
  std::filesystem::path scene;
  SceneSelection selection;
  InputLimits limits;
  StageSet stages = stagesUpTo(Stage::Gi);
  CameraOptions camera;
  SamplingOptions sampling;
  LightOptions light;
  FogOptions fog;
  VolumeSource volume;
  OutputOptions output;
  DeviceOptions device;

  bool operator==(const RenderOptions&) const = default;
};

/// Returns true if an environment map lights the scene: of a file, built in, or a sky.
inline bool hasMap(const RenderOptions& o) {
  return o.light.studio || o.light.sky.on || !o.light.hdriFile.empty();
}

/// The sun's place in the sky, before the environment is turned.
SunPlace sunOf(const SkyOptions& sky);

/// Puts the sun there, whatever the time said.
void placeSun(SkyOptions& sky, const SunPlace& sun);

/// The turn of the environment about +Y in degrees. A sky is made with the sun in the north.
double environmentTurn(const LightOptions& light);

/// Returns true if noise or time ends a render, which places samples where they help most.
inline bool isAdaptive(const RenderOptions& o) { return o.sampling.noise > 0.0 || o.sampling.seconds > 0.0; }

/// The file that gets the picture.
inline const std::filesystem::path& placeOf(const OutputOptions& o) {
  return o.place.empty() ? o.file : o.place;
}

/// Returns true if numbered pictures are asked for.
inline bool isSequence(const RenderOptions& o) {
  return o.output.sequence.frames || o.output.sequence.turntable > 0;
}

/// The colour that stands behind the surfaces of a .png, .jpg or video as a page does, past exposure and tone
/// curve; none: there is no such page.
inline std::optional<glm::vec3> pageOf(const RenderOptions& o) {
  const bool isShown = o.light.background && o.output.debugView == DebugView::None;
  return isShown && holdsDisplay(o.output.file) ? o.light.backgroundColor : std::nullopt;
}

/// Returns true if the picture keeps how much of each pixel surfaces and shadows cover.
inline bool keepsAlpha(const RenderOptions& o) { return !o.light.background || pageOf(o); }

/// Width / height of the picture that a scene without a camera is framed for; without --resolution it is
/// wide, as good as square.
inline double framedAspect(const CameraOptions& camera) {
  const std::optional<glm::ivec2>& resolution = camera.resolution;
  return resolution ? double(resolution->x) / resolution->y : 1.0;
}

}  // namespace fragtrace
