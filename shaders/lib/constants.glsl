// Specialisation constants under one number each, as bindings are; the engine sets them by their names. A program's
// own, which nothing else includes, count from OWN_CONSTANTS: a new technique needs no line here.
#ifndef CATOPTRIC_CONSTANTS_GLSL
#define CATOPTRIC_CONSTANTS_GLSL

#define DISTANCE_SCALE_CONSTANT 0
#define HALF_STEP_CONSTANT 1
#define STORED_UNIT_CONSTANT 2
#define HOPS_CONSTANT 3
#define RANGE_ENDS_CONSTANT 4
#define KEEPS_SURFACE_CONSTANT 5
#define BY_OBJECT_CONSTANT 6
#define HAS_SURFACES_CONSTANT 7
#define ASKS_OTHERS_CONSTANT 8
#define SHOW_CONSTANT 9
#define MAX_DEPTH_CONSTANT 10
#define SHADOW_CONSTANT 11
#define EXACT_SPHERES_CONSTANT 12
#define PICTURE_WIDTH_CONSTANT 13
#define PICTURE_HEIGHT_CONSTANT 14
#define WITHOUT_CONSTANT 15
#define FIXED_OFFSET_CONSTANT 16
#define LARGEST_COLOUR_CONSTANT 17
#define TESTS_VOID_CONSTANT 18
#define OWN_SPACES_CONSTANT 19
#define TRACER_CONSTANT 20
#define TRUSTS_NONE_CONSTANT 21
#define ARRAY_COUNT_CONSTANT 22
#define OWN_CONSTANTS 32

#endif
