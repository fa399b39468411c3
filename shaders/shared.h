// Structures that C++ and GLSL both see. Scalar layout: members follow each other without padding,
// so sizeof is the sum of the members (asserted below, offsets proven by tests/gpu/layout_test.cpp).
// All lengths and positions are in scene units: world positions minus the scene's centre, times
// its unit scale (render::Frame), so that everything is about 1.
#ifndef CATOPTRIC_SHARED_H
#define CATOPTRIC_SHARED_H

#ifdef __cplusplus
#include "core/math.hpp"

#include <cstdint>

namespace catoptric::shared {
using uint = std::uint32_t;
#else
#extension GL_EXT_scalar_block_layout : require
#endif

struct Vertex {
    vec3 position;
    vec3 normal;
};

// What the surface of one object does with light.
struct Surface {
    vec3 albedo;      // kd
    vec3 emission;    // Ke, radiance
    vec3 reflectance; // of a mirror
    uint mirror;      // 0: not a mirror; otherwise its number, from 1
    uint detail;      // index of its MaterialParameters
    vec3 centre;      // of the exact sphere the mesh stands for
    float radius;     // 0: no exact sphere
};

// How a surface reads texels; see lib/material.glsl and lib/math/surface.glsl.
struct TextureUse {
    uint first; // texel in the list of all
    uint size;  // width | height << 16; 0: no texture
    uint how;   // wrap along u | along v << 2 | kTexture...
    vec3 u_row; // texture space from the mesh's (u, v, 1)
    vec3 v_row;
};
const uint kTextureNearest = 16u, kTextureSrgb = 32u, kTextureSecondUv = 64u;

// What a surface is beyond Surface. Objects that agree in all of it share one.
struct MaterialParameters {
    uint flags;             // kDetail...
    uint first_attribute;   // added to the number of a vertex as it is drawn: its attribute
    float metallic;
    float roughness;
    float max_specular_roughness;      // or at that roughness it is sharp
    float alpha;
    float alpha_cutoff;     // 0: nothing is cut out
    vec3 f0;                // of the part that is no metal, towards the normal
    vec3 f90;               // and across it
    TextureUse albedo;      // and alpha
    TextureUse emission;
    TextureUse rough;       // roughness in green, metallic in blue
};
const uint kMaterialVaries = 1u;     // more than one colour, or sharp
const uint kMaterialAttributes = 2u; // its vertices have attributes
const uint kMaterialConstant = 4u;   // reflects Surface::reflectance at any angle
const uint kMaterialUnlit = 8u;
const uint kMaterialTurns = 16u;     // its normal turns to who looks
const uint kMaterialFacets = 32u;    // its normals leave those of its facets: light counts from above them

// What a vertex has beside position and normal.
struct Attribute {
    vec4 uv;     // both texture spaces
    vec4 colour; // linear, with alpha
};

// A light as the shading formula sees it: the one point of a lamp, or a light without a surface.
// `right`, `down`, `forward`: axes of its shadow faces, unit, face +Z along `forward`, where a spot or a directional
// light shines to.
struct Light {
    vec3 position;
    vec3 normal;      // zero: no cosine at the light; kLightOfTwoSides: mean |cosine| to right, down and forward
    vec3 intensity;   // emission * the area that counts
    vec3 right;
    vec3 down;
    vec3 forward;
    float near;       // of the shadow faces' reversed depth
    float reach;      // one over its range; 0: without end
    float cos_outer;  // of a spot's cone; below -1 where there is none
    float sharpness;  // 1 / max(.001, cos inner - cos outer) of it
    uint kind;        // kLight...
};
// From infinitely far, along `forward`; an open lamp of two sides; anything else.
const uint kLightAtPoint = 0u, kLightDirectional = 1u, kLightOfTwoSides = 2u;
const uint kMaxLights = 128u; // the smallest uniform buffer that every device has, 16 KiB, holds 178

// Where a mirror's surroundings are captured from: layers [6 n, 6 n + 6) of the cubes, n from 0.
struct Probe {
    vec3 centre;      // of the mirror's bounds
    vec3 sphere;      // centre of the exact sphere that the mirror stands for
    float radius;     // of that sphere; 0: the mirror stands for none
    vec3 reflectance; // of the mirror; of a metal, towards its normal
    vec3 lowest;      // corners of the mirror's bounds
    vec3 highest;
    uint kind;        // kProbe...
};
// Reflects the same at any angle; as a metal by Schlick; or has light of its own, which only captures show.
const uint kProbeConstant = 0u, kProbeMetal = 1u, kProbeLit = 2u;

// One of the cube arrays that captures are kept in, and how distances are in it.
struct CaptureArray {
    float stored_unit; // scene units of a stored 1
    uint range_ends;   // 1: where nothing is, a 1 is stored too
};
const uint kMostArrays = 8u;
const uint kMostCaptured = 2048u; // mirrors whose numbers a half holds exactly
// Where mirror n's capture is kept, n from 0: array << 16 | cube, both from 0; array kMostArrays: nowhere.
struct CaptureTable {
    CaptureArray arrays[kMostArrays];
    uint places[kMostCaptured];
};

// One projection: clip = (dot(right, v), dot(down, v), near, dot(forward, v)) with v = position - eye.
// Reversed-Z with infinite far: depth = near / distance along forward.
// A parallel one: clip = (dot(right, v), dot(down, v), 1 - near dot(forward, v), 1), `near` one over how far it looks.
struct View {
    vec3 eye;
    vec3 right;   // scaled by 1 / tan(half horizontal field of view), or by 1 / half the width
    vec3 down;    // scaled by 1 / tan(half vertical field of view), or by 1 / half the height
    vec3 forward; // unit length
    float near;
    vec3 eye_low; // what `eye` lacks as a sum of two floats
    uint parallel; // 1: an orthographic view
    vec4 clip;     // of a view in a mirror: what it shows has dot(clip.xyz, v) + clip.w >= 0
};

// What is seen where the scene ends.
struct Sky {
    uvec2 size;         // of its map, texels
    float scale;
    vec2 turn;          // cosine and sine of its rotation
    vec3 irradiance[9]; // coefficients, scaled and turned
};

// What is true for the whole frame.
struct Frame {
    float ambient;          // grey, times kd
    uint light_count;
    uint mirror_count;
    uint object_count;
    uint shadow_faces; // layers of each light: 5 when every light is one-sided, else 6
};

// Push constants of a pass that draws objects. They are the same for all of its objects: a driver may keep a copy of
// its state for each draw that changes them.
struct Draw {
    uint first_view; // the view of layer 0
    uint ablated;     // causes of error to take away: kMend..., in builds that can (lib/ablate.glsl)
};
// gl_InstanceIndex of such a draw: index of the object << kLayerBits | layer.
const uint kLayerBits = 3u;

// Where the vertices of an object with a space of its own are.
struct Placement {
    vec3 x, y, z;    // columns of the matrix to the scene's axes
    vec3 centre;     // of that space, scene units
    vec3 centre_low; // what `centre` lacks as a sum of two floats
};

// Causes of error that a rendering can be without (engine/app/causes.cpp).
const uint kAblateDistance = 1u;   // captured distance -> exact
const uint kAblateDirection = 2u;  // looked-up direction -> that of what the ray really meets
const uint kAblateHidden = 4u;     // what the capture's centre does not see -> its true colour
const uint kAblateTexels = 8u;     // texels -> the captured surface at the very point
const uint kAblateMirrors = 16u;   // a mirror's picture in a capture -> what that mirror really shows here
const uint kAblateOwn = 32u;       // the mirror's own reflection in itself, which its capture leaves out
const uint kAblateShadows = 64u;   // shadow map -> shadow ray

// Push constants of one dispatch of the ray tracer.
struct Trace {
    vec2 sample_offset; // inside the pixel, (0.5, 0.5) is its centre
    uint sample_index;  // 0 starts the sum
    uint sample_count;  // the last sample divides the sum
    uvec2 size;         // of the picture
};

// A traced picture's alpha, as a word of engine/bvh/words.hpp: the mirror that a pixel's first ray meets, from 1, and the
// one after that << kMetBits; 0: none.
const uint kMetBits = 15u, kMostMirrors = 32767u;

// What ray tracing counts, over all dispatches of the frame.
struct Counters {
    uint primary_rays;
    uint mirror_rays;
    uint shadow_rays;
    uint longest_walk;  // steps of the busiest invocation in one dispatch
    uint exhausted;     // invocations that gave up: their pixels are wrong
    uint mirror_pixels; // drawn by a search that may list some of them for tracing; 0 in the ray tracer
    uint listed;        // of them
};

// Push constants of the pass that shows pictures in a window (engine/app/screen.cpp).
struct Screening {
    uvec2 size;      // of the pictures
    uint kind;       // kShow...
    uint from_canvas; // 1: the first picture is the canvas; 2: the second is; 3: both
    float divider;   // of a split: the first picture is left of this pixel
    float gain;      // of a difference
};
const uint kShowFirst = 0u, kShowSplit = 1u, kShowDifference = 2u;

// A corner of the triangles that lie over it: controls, text.
struct OverlayVertex {
    vec2 position; // pixels of the window
    vec2 uv;       // in the font's picture, 0 to 1
    uint colour;   // r | g << 8 | b << 16 | a << 24
};
struct Overlaying {
    uvec2 window; // pixels
    uvec2 font;   // texels of its picture
};

// Texels of four floats of each in the lists that shaders/lib/bindings.glsl reads.
const uint kSurfaceTexels = 4u, kProbeTexels = 5u, kMaterialQuads = 10u; // the last of whole numbers

#ifdef __cplusplus
static_assert(sizeof(Vertex) == 24);
static_assert(sizeof(Surface) == 60);
static_assert(sizeof(Light) == 92);
static_assert(sizeof(TextureUse) == 36);
static_assert(sizeof(MaterialParameters) == 16 * kMaterialQuads);
static_assert(sizeof(Attribute) == 32);
static_assert(sizeof(Probe) == 68);
static_assert(sizeof(CaptureTable) == 8256); // every device has uniform buffers of 16 KiB
static_assert(sizeof(View) == 84);
static_assert(sizeof(Sky) == 128);
static_assert(sizeof(Frame) == 20);
static_assert(sizeof(Draw) == 8);
static_assert(sizeof(Placement) == 60);
static_assert(sizeof(Trace) == 24);
static_assert(sizeof(Counters) == 28);
static_assert(sizeof(Screening) == 24);
static_assert(sizeof(OverlayVertex) == 20);
} // namespace catoptric::shared
#endif
#endif
