// Structures that C++ and GLSL share. The layout is scalar: members follow each other without padding, so the size of
// a structure is the sum of its members' sizes. Assertions below check sizes, tests/gpu/layout_test.cpp checks offsets.
// All lengths and positions are in scene units: world positions minus an origin, times a power of two, so that the
// scene is about 1 in size (render::SceneUnits).
#ifndef CATOPTRIC_SHARED_H
#define CATOPTRIC_SHARED_H

#ifdef __cplusplus
#include "core/math.hpp"

#include <cstdint>

namespace catoptric::shared {
using uint = std::uint32_t;
#define IN_QUADS alignas(16) // elements of a list of uvec4
#else
#define IN_QUADS
#extension GL_EXT_scalar_block_layout : require
#endif

struct Vertex {
    vec3 position;
    vec3 normal;
};

// The reflection and emission of one object's surface.
struct Surface {
    vec3 albedo;      // diffuse base colour, linear (kd)
    vec3 emission;    // emitted radiance (Ke)
    vec3 reflectance; // share of light that the mirror reflects, 0 to 1
    uint mirror;      // mirror number, from 1; 0: the object is not a mirror
    uint detail;      // index of the object's MaterialParameters
    vec3 centre;      // centre of the exact sphere that the mesh approximates
    float radius;     // radius of the exact sphere; 0: the mesh approximates no sphere
};

// Smoother surfaces reflect as perfect mirrors, rougher ones in lobes.
const float kMaxSharpRoughness = 0.04f;

// A texture as a material uses it: texels, wrap mode and transform (lib/material.glsl, lib/math/surface.glsl).
struct TextureUse {
    uint first; // index of the texture's first texel in the list of all texels
    uint size;  // texture size: width | height << 16; 0: no texture
    uint how;   // sampling flags: wrap mode along u | wrap mode along v << 2 | kTexture...
    vec3 u_row; // row of the texture transform: texture u = dot(u_row, (u, v, 1)) of the mesh
    vec3 v_row; // row of the texture transform: texture v = dot(v_row, (u, v, 1)) of the mesh
};
// The list of texture words begins with two tables (lib/material.glsl): linear light of each sRGB byte, and the albedo of
// rough lobes by the root of the cosine (columns, 0 to 1) and roughness (rows, 0 to 1).
const uint kSrgbTableWords = 256u, kLobeTableEdge = 32u;
const uint kTextureNearestFlag = 16u, kTextureSrgbFlag = 32u, kTextureSecondUvFlag = 64u;

// The factors of a material, one row each: FACTOR(name, extension, key, gltf_default, largest). scene::Material has a
// member of this name. glTF keeps the value in the extension's JSON object, or in pbrMetallicRoughness, under this key.
// Without the key the value is gltf_default. Values range from 0 to largest. A new factor is a row of
// FURTHER_MATERIAL_FACTORS, and a member of scene::Material after `dispersion`, in the order of the rows.
#define FURTHER_MATERIAL_FACTORS(FACTOR)
#define MATERIAL_FACTORS(FACTOR)                                                                                       \
    /* share of the surface that is metal */                                                                           \
    FACTOR(metallic, pbrMetallicRoughness, metallicFactor, 1.0f, 1.0f)                                                 \
    /* root of the lobe's alpha */                                                                                     \
    FACTOR(roughness, pbrMetallicRoughness, roughnessFactor, 1.0f, 1.0f)                                               \
    /* share of light not reflected that passes through */                                                             \
    FACTOR(transmission, KHR_materials_transmission, transmissionFactor, 0.0f, 1.0f)                                   \
    /* of glass: 20 divided by the Abbe number; 0: all colours bend alike */                                           \
    FACTOR(dispersion, KHR_materials_dispersion, dispersion, 0.0f, 3.4e38f)                                            \
    /* share of the surface under a clear coat */                                                                      \
    FACTOR(clearcoat, KHR_materials_clearcoat, clearcoatFactor, 0.0f, 1.0f)                                            \
    /* glTF roughness of the coat */                                                                                   \
    FACTOR(clearcoat_roughness, KHR_materials_clearcoat, clearcoatRoughnessFactor, 0.0f, 1.0f)                         \
    FURTHER_MATERIAL_FACTORS(FACTOR)

// The parameters of a glTF material that Surface does not hold. Objects with equal parameters share one element.
struct IN_QUADS MaterialParameters {
    uint flags;             // material flags, kMaterial...
    uint first_attribute;   // index of a vertex's VertexAttribute, minus the index of the vertex
    float max_specular_roughness; // highest roughness at which a mirror's reflections come from captures
    float alpha;
    float alpha_cutoff;     // alpha below which the surface is cut out; 0: no alpha test
    vec3 f0;                // reflectance of the dielectric part, seen head-on
    vec3 f90;               // reflectance of the dielectric part at grazing angle
    TextureUse albedo;      // texture of base colour and alpha
    TextureUse emission;
    TextureUse rough;       // texture with roughness in green and metallic in blue
    TextureUse normal;      // texture of normals in tangent space
    float normal_scale;     // factor of the texture's x and y
    vec3 absorption;        // in solid glass, per scene unit: light falls by e^-absorption
    float ior;              // index of refraction of glass
#define DECLARE_FACTOR(name, extension, key, gltf_default, largest) float name;
    MATERIAL_FACTORS(DECLARE_FACTOR)
#undef DECLARE_FACTOR
};
#define ADD_ONE_PER_FACTOR(name, extension, key, gltf_default, largest) +1u
const uint kMaterialWordsBeforeFactors = 52u; // words of a MaterialParameters before its factors
const uint kWordsPerMaterial = kMaterialWordsBeforeFactors MATERIAL_FACTORS(ADD_ONE_PER_FACTOR);
#undef ADD_ONE_PER_FACTOR
const uint kMaterialVariesFlag = 1u; // material flag: several colours, or sharp reflection without being a mirror
const uint kMaterialHasAttributesFlag = 2u; // material flag: the vertices have attributes
// material flag: the surface reflects Surface::reflectance at any angle
const uint kMaterialConstantReflectanceFlag = 4u;
const uint kMaterialUnlitFlag = 8u;
const uint kMaterialTwoSidedFlag = 16u; // material flag: two-sided, the normal turns to the viewer's side
// Material flag: some vertex normals differ from their facets' normals, so shading also asks on which side of the facet
// a light is.
const uint kMaterialTestsFacetSideFlag = 32u;
// material flag: the lobe gets back the light that single scattering loses
const uint kMaterialMultipleScatteringFlag = 64u;
const uint kMaterialGlassFlag = 128u; // material flag: rays pass through
const uint kMaterialSolidFlag = 256u; // material flag: the glass is a solid body, else a thin sheet
const uint kMaterialBlendedFlag = 512u; // material flag: the surface covers what is behind it by its alpha
// material flag: thin glass whose mesh is not closed, so that one facet is a whole sheet
const uint kMaterialOpenSheetFlag = 1024u;
const uint kMaterialRankedFlag = 2048u; // material flag: solid glass that shares space with other solid glass
const uint kMaxRankedGlass = 255u;      // most MaterialParameters with this flag; they come first, by falling rank

// The data of a vertex other than position and normal.
struct VertexAttribute {
    vec4 uv;     // two sets of texture coordinates
    vec4 colour; // vertex colour, linear, with alpha
};

// A light as the shading formula sees the light: the point that replaces a lamp, or a light without a surface.
// `right`, `down` and `forward` are the unit axes of the light's shadow faces. Face +Z looks along `forward`. A spot or
// directional light shines along `forward`.
struct Light {
    vec3 position;
    // Normal of the lamp. Zero: the light has no cosine factor. For kLightKindTwoSidedLamp: the mean |cosine| between
    // the lamp's facets and the axes `right`, `down` and `forward`.
    vec3 normal;
    vec3 intensity;   // emission times the effective area of the lamp
    vec3 right;
    vec3 down;
    vec3 forward;
    float near;       // near distance of the shadow faces, which store reversed depth
    float reach;      // 1 / range of the light; 0: the range is infinite
    float cos_outer;  // cosine of a spot's outer cone angle; below -1: the light has no cone
    float sharpness;  // 1 / max(.001, cos inner - cos outer) of a spot's cone angles
    uint kind;        // kind of light, kLight...
};
// Kinds of light: a point or spot light; a directional light; an open lamp that emits on both sides; any other lamp.
const uint kLightKindPoint = 0u, kLightKindDirectional = 1u, kLightKindTwoSidedLamp = 2u, kLightKindLamp = 3u;
// The extent of a lamp, in the axes of its shadow map (right, -down, forward), scene units. Points of the box
// a * first + b * second + c * third, -1 <= a, b, c <= 1, replace the lamp's surface (lib/soft_shadow.glsl). All members
// of a light without a surface are zero.
struct LampExtent {
    vec3 first;
    vec3 second;
    vec3 third;
    vec3 flat_normal; // unit normal of a flat lamp; zero: the lamp is not flat
};
const uint kMaxLights = 128u; // most lights of a scene: 178 fit into 16 KiB, the uniform buffer that every device has

// The data of a mirror's capture. Mirror n, counted from 0, has the layers [6 n, 6 n + 6) of the cube arrays.
struct Probe {
    vec3 centre;      // from which the capture is drawn (engine/scene/capture_centre.hpp)
    vec3 sphere;      // centre of the exact sphere that the mirror's mesh approximates
    float radius;     // radius of the exact sphere; 0: the mirror's mesh approximates no sphere
    vec3 reflectance; // reflectance of the mirror; for a metal, seen head-on
    vec3 lowest;      // lowest corner of the mirror's bounds
    vec3 highest;     // highest corner of the mirror's bounds
    uint kind;        // kind of mirror, kMirror...
    uint holds;       // 1: other objects may lie in the mirror, at least in part
};
// Kinds of mirror: constant, with the same reflectance at any angle; metal, by Schlick's approximation; lit, which also
// has diffuse or emitted light that only captures show. Bodies of glass are lit mirrors, told apart by the model of the
// body that comes closest (engine/scene/glass_body.hpp).
const uint kMirrorConstantReflectance = 0u, kMirrorMetal = 1u, kMirrorLit = 2u, kMirrorThinGlass = 3u, kMirrorGlassSphere = 4u,
           kMirrorGlassBox = 5u;

// Models of the glass body behind the drawn surface (shaders/lib/refraction.glsl). None: no light passes. Auto: the model that
// Probe::kind names. Thin: rays are not bent. Sphere: a ball that touches the surface, as thick as the body's bounds at their
// thinnest (Guy and Agopian, "Physically Based Rendering in Filament", section 6.3). Box: the body's bounds. Traced: a tracer
// draws the pixel; shaders without a tracer take auto.
const uint kRefractNone = 0u, kRefractAuto = 1u, kRefractThin = 2u, kRefractSphere = 3u, kRefractBox = 4u, kRefractTraced = 5u;

// The parts of blended surfaces that a pass draws: those that are opaque, with all other surfaces; those that are not, over
// the finished picture; or all, as if they were opaque.
const uint kDrawOpaqueParts = 0u, kDrawBlendedParts = 1u, kDrawAllParts = 2u;

// One cube array with captures of one size and format, and the encoding of its distances.
struct CaptureArrayEntry {
    float stored_unit; // stored distance 1 in scene units
    uint range_ends;   // 1: the stored distance 1 means either the end of the range or no surface
};
const uint kMaxCubeArrays = 8u;
const uint kMaxCapturedMirrors = 2048u; // most mirrors with captures: a 16-bit float holds their numbers exactly
// The place of each mirror's capture, for mirrors counted from 0: array << 16 | cube, both from 0. The array number
// kMaxCubeArrays means that the mirror has no capture.
struct CaptureLookupTable {
    CaptureArrayEntry arrays[kMaxCubeArrays];
    uint places[kMaxCapturedMirrors];
};

// The grid of light probes (lib/light_probes.glsl), scene units. Probe (x, y, z) has the number
// x + counts.x (y + counts.y z), and lies at first + (x, y, z) step. There are at least two probes along each axis.
struct LightProbeGrid {
    vec3 first;
    vec3 step;
    uvec3 counts;
};
const uint kLightProbeFace = 16u; // edge of a light probe's capture, texels
// Values of the constant light_probe_content. Light probes hold the light of surfaces and environment, or the light of the
// environment that surfaces leave visible.
const uint kLightProbesOfSurfaces = 1u, kLightProbesOfEnvironment = 2u;

// A projection of the vector v = position - eye.
// Perspective: clip = (dot(right, v), dot(down, v), near, dot(forward, v)). Depth is reversed and has no far plane:
// depth = near / distance along forward.
// Orthographic: clip = (dot(right, v), dot(down, v), 1 - near dot(forward, v), 1), where `near` is 1 / far distance.
struct View {
    vec3 eye;
    vec3 right;   // right axis, scaled by 1 / tan(half horizontal field of view), or by 1 / half the width
    vec3 down;    // down axis, scaled by 1 / tan(half vertical field of view), or by 1 / half the height
    vec3 forward; // view direction, unit length
    float near;
    vec3 eye_low; // rounding error of `eye`: the exact eye is eye + eye_low
    uint parallel; // 1: the view is orthographic
    vec4 clip;     // clip plane of a mirrored view, which shows points with dot(clip.xyz, v) + clip.w >= 0
};

// Level k of the environment, from 1, holds the environment as a surface of roughness k / SKY_LEVEL_COUNT reflects it.
#define SKY_LEVEL_COUNT 8
// The environment of the scene.
struct Sky {
    uvec2 size;         // size of the environment map, texels
    float scale;        // factor of the environment's radiance
    vec2 turn;          // cosine and sine of the environment's rotation about the y axis
    vec3 irradiance[9]; // spherical harmonics coefficients of the irradiance, with scale and rotation applied
    uint level_first[SKY_LEVEL_COUNT]; // index of the first texel of each level, from level 1 on (lib/environment.glsl)
    uint level_width[SKY_LEVEL_COUNT]; // texels of each level along a row; a level has half as many rows
    // Cells of the environment map that are brighter than its mean, for drawing directions (lib/environment.glsl): index of
    // the first cell's texel, number of cells (0: none), the mean (sum of the channels, without scale), and the factor of
    // environment_radiance_and_density.
    uint cell_first, cell_count;
    float cell_threshold, cell_density;
};

// Values that are the same for the whole frame.
struct Frame {
    float ambient;          // ambient light, grey; each surface receives it times its albedo
    uint light_count;
    uint mirror_count;
    uint object_count;
    uint shadow_faces; // shadow map layers of each light: 5 if every light is one-sided, else 6
};

// Push constants of a pass that draws objects. All objects of the pass share them, because a driver may copy its state
// for each draw that changes push constants.
struct DrawParameters {
    uint first_view; // index of the view that layer 0 shows
    uint ablated;     // causes of error to remove, kAblate...; used by variants with ABLATE (lib/ablate.glsl)
    // Drawn part of the mirrored view that the mirror shows: the lowest and the highest place, from 0 to 1 across and down
    // the picture; used by reflect/planar.frag.
    vec4 shown;
};
// gl_InstanceIndex of a draw of an object is (index of the object) << kInstanceLayerBits | layer.
const uint kInstanceLayerBits = 3u;

// The placement of an object whose vertices are in object space.
struct Placement {
    vec3 x, y, z;    // columns of the matrix from object space to the scene's axes
    vec3 centre;     // origin of the object space, scene units
    vec3 centre_low; // rounding error of `centre`: the exact origin is centre + centre_low
};

// Causes of error that an ablation removes: each flag replaces an approximation by its exact value
// (engine/study/causes.cpp).
const uint kAblateDistance = 1u; // ablation: the captured distance becomes the exact distance
const uint kAblateDirection = 2u; // ablation: the looked-up direction becomes that of the point which the ray meets
const uint kAblateHiddenPoints = 4u; // ablation: points hidden from the capture's centre get their true colour
const uint kAblateTexelColour = 8u; // ablation: the texels' colour becomes the surface's colour at the exact point
// ablation: a captured picture of a mirror becomes the mirror's true reflection
const uint kAblateMirrorReflections = 16u;
// ablation: a mirror shows its reflection in itself, which its capture leaves out
const uint kAblateSelfReflection = 32u;
const uint kAblateShadows = 64u; // ablation: the shadow map becomes a shadow ray
// Ablations of rough mirrors: filtered levels of captures become directions that are looked up sharply, the level that
// follows from the distance becomes a search in each direction, and the lobe seen head-on becomes the surface's lobe.
const uint kAblateFilter = 128u, kAblateDistanceLaw = 256u, kAblateLobeShape = 512u;
// With these, a picture draws so many directions in a pixel. The bits of DrawParameters::ablated from kAblateDrawBits on
// are a number; pictures with different numbers draw different directions.
const uint kAblatedLobeRays = 4u, kAblateDrawBits = 16u;

// Push constants of one dispatch of the ray tracer.
struct TraceParameters {
    vec2 sample_offset; // position of the sample inside the pixel; (0.5, 0.5) is the centre
    uint sample_index;  // number of the sample, from 0; sample 0 starts the sum
    uint sample_count;  // samples a pixel; the last sample divides the sum by this count
    uvec2 size;         // size of the picture, pixels
    uint seed;          // seed of the directions in which rays leave rough surfaces
    uint path_count;    // samples that share a camera ray (lib/path_start.glsl)
    uint first_group;   // first work group of this dispatch, which may be a range of all
};

// Where the paths of a camera ray part (lib/path_start.glsl): at a surface that a ray has met.
struct PathStart {
    vec3 barycentric;                    // of the hit, as in TraceHit of lib/trace.glsl
    float t;
    uint triangle, object, place, inside;
    vec3 origin, direction, origin_low;  // the ray, and the rounding error of its origin
    vec3 weight;                         // share of the surface's light in the pixel
    uint bounce;                         // surfaces that the path has met before; kNoPathStart: no path goes on
    uint is_shaded;                      // 1: the picture has the light of this surface's shading already
    uint pixel;                          // number of the pixel, row by row
    uint bodies;                         // of glass that the path is in (lib/nested_glass.glsl)
};
const uint kNoPathStart = 0xffffffffu;
const uint kMaxPathStarts = 262144u; // stored at a time; more pixels are traced in several turns
// The dispatch that resumes paths: its work groups, and the number of listed starts.
struct PathStartArguments {
    uint x, y, z;
    uint count;
};

// A traced picture's alpha is a word of engine/bvh/words.hpp: the number, from 1, of the mirror that the pixel's first
// ray meets, and the number of the next mirror << kBitsPerMirrorHit. 0 means no mirror. If the first surface reflects but
// is no mirror, the first number is 0, and the second says whether the surface is smooth or rough.
const uint kBitsPerMirrorHit = 15u, kMaxMirrors = 32767u, kHitSmoothDielectric = kMaxMirrors, kHitRoughNonMirror = kMaxMirrors - 1u;

// Counters of ray tracing, summed over all dispatches of the frame.
struct Counters {
    uint primary_rays;
    uint mirror_rays;
    uint shadow_rays;
    uint longest_walk;  // most BVH steps of one invocation in one dispatch
    uint exhausted;     // invocations that stopped at the step limit, so that their pixels are wrong
    uint mirror_pixels; // pixels drawn by a search that may list pixels for tracing; 0 in the ray tracer
    uint listed;        // mirror pixels that were listed for tracing
};

// Work that shaders count in frames that count work (lib/work.glsl). engine/core/work.hpp explains each kind.
const uint kWorkCameraRays = 0u, kWorkMirrorRays = 1u, kWorkShadowRays = 2u, kWorkBvhNodes = 3u, kWorkTriangleTests = 4u,
           kWorkNodeLanes = 5u, kWorkTriangleLanes = 6u, kWorkShadowLookups = 7u, kWorkColourLookups = 8u,
           kWorkDistanceLookups = 9u, kWorkColourLanes = 10u, kWorkDistanceLanes = 11u, kWorkSearchLanes = 12u,
           kWorkTextureLookups = 13u, kWorkMaterialReads = 14u, kWorkLightEvaluations = 15u;
const uint kShaderWorkKindCount = 16u;

// Push constants of the pass that shows pictures in a window (engine/session/screen.cpp).
struct ScreenParameters {
    uvec2 size;      // size of the pictures, pixels
    uint kind;       // kind of display, kDisplay...
    uint from_canvas; // 1: the first picture is the canvas; 2: the second picture is the canvas; 3: both are
    float divider;   // column that divides a split display: the first picture is left of this pixel
    float gain;      // factor that a difference of two pictures is multiplied by
};
const uint kDisplayFirstPicture = 0u, kDisplaySplitPictures = 1u, kDisplayDifference = 2u;

// A vertex of the triangles that draw controls and text over the window's picture.
struct OverlayVertex {
    vec2 position; // position in the window, pixels
    vec2 uv;       // position in the font texture, 0 to 1
    uint colour;   // vertex colour: r | g << 8 | b << 16 | a << 24
};
// Push constants of the pass that draws controls and text.
struct OverlayParameters {
    uvec2 window; // size of the window, pixels
    uvec2 font;   // size of the font texture, texels
};

// Number of four-component texels that one element takes in the lists of shaders/lib/bindings.glsl. Texels hold floats,
// those of materials hold unsigned integers.
const uint kTexelsPerSurface = 4u, kTexelsPerProbe = 5u, kQuadsPerMaterial = (kWordsPerMaterial + 3u) / 4u;

#ifdef __cplusplus
static_assert(sizeof(Vertex) == 24);
static_assert(sizeof(Surface) == 60);
static_assert(sizeof(Light) == 92);
static_assert(sizeof(LampExtent) == 48);
static_assert(sizeof(TextureUse) == 36);
static_assert(sizeof(MaterialParameters) == 16 * kQuadsPerMaterial);
static_assert(sizeof(VertexAttribute) == 32);
static_assert(sizeof(Probe) == 72);
static_assert(sizeof(CaptureLookupTable) == 8256); // fits into 16 KiB, the uniform buffer size that every device allows
static_assert(sizeof(View) == 84);
static_assert(sizeof(Sky) == 208);
static_assert(sizeof(Frame) == 20);
static_assert(sizeof(DrawParameters) == 24);
static_assert(sizeof(Placement) == 60);
static_assert(sizeof(TraceParameters) == 36);
static_assert(sizeof(PathStart) == 96);
static_assert(sizeof(PathStartArguments) == 16);
static_assert(sizeof(Counters) == 28);
static_assert(sizeof(ScreenParameters) == 24);
static_assert(sizeof(OverlayVertex) == 20);
} // namespace catoptric::shared
#endif
#endif
