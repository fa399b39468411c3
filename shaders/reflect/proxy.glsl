// The box and the sphere that approximate a capture's surroundings. Lengths are in scene units from the capture's
// centre.
struct ProxyShapes {
    vec3 lo; // lowest corner of the box around all captured points; lo > hi: no surface was captured
    vec3 hi; // highest corner of the box
    float radius; // radius of the sphere: mean captured distance over the solid angle; 0: no surface was captured
};
