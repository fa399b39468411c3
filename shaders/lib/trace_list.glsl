// The list of pixels to trace, for the shaders that write and read the list. An entry is the pixel's number. If rays
// start at triangles that the rasteriser drew, the two words of the triangle follow (lib/first_hit.glsl), because the
// first ray of the pixel overwrites these words in the picture.
uint words_per_list_entry(uint first_raster) { return first_raster != 0u ? 3u : 1u; }
#define LOOKUP_BINDING 24
#define LIST_BINDING 25
#define ARGUMENTS_BINDING 26
#define MARKS_BINDING 27

const uint kPixelsPerListGroup = 64u;     // listed pixels that one work group traces
const uint kMaxListGroupsPerRow = 32768u; // most work groups in a row of the dispatch; every device allows 65535

// Lists of the pixels whose paths go on from stored starts (lib/path_start.glsl).
#define STARTS_BINDING 21
#define START_LIST_BINDING 22
#define START_ARGUMENTS_BINDING 23
