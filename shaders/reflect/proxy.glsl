// What stands for a capture's surroundings: a box and a sphere around its centre, scene units.
struct Proxy {
    vec3 lo; // bounds of the captured points, from the centre; lo > hi: nothing was captured
    vec3 hi;
    float radius; // their mean distance over all directions that show one; 0: none does
};
