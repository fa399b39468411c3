// The list of pixels to trace: what its writer and its reader agree on.
#define LOOKUP_BINDING 24
#define LIST_BINDING 25
#define ARGUMENTS_BINDING 26
#define MARKS_BINDING 27

const uint kListGroup = 64u;     // pixels of one work group
const uint kListGroups = 32768u; // work groups across, before a further row begins: every device allows 65535
