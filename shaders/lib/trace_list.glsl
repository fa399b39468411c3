// Constants of the list of pixels to trace, shared by the shaders that write and read the list.
#define LOOKUP_BINDING 24
#define LIST_BINDING 25
#define ARGUMENTS_BINDING 26
#define MARKS_BINDING 27

const uint kPixelsPerListGroup = 64u;     // listed pixels that one work group traces
const uint kMaxListGroupsPerRow = 32768u; // most work groups in a row of the dispatch; every device allows 65535
