// Part of lib/math.glsl; only lib/math.glsl includes this file.
// Mathematics of the environment.

// Rotates a direction from the scene's axes to the environment's axes. The rotation moves the environment's content
// from an azimuth (counted from -z towards +x) to that azimuth plus the angle with this cosine and sine.
INLINE vec3 rotate_to_environment_axes(vec3 d, real cosine, real sine) {
    return vec3(cosine * d.x + sine * d.z, d.y, cosine * d.z - sine * d.x);
}

// The four texels around a direction of any length in an equirectangular map, with their bilinear weights. Row 0 is at
// +y, the map's middle is at -z, and +x lies to the right of the middle. The map wraps horizontally and clamps at the
// poles.
struct EnvironmentMapPosition {
    uint left, right, above, below;
    real across, down;
};
// Returns the texels around equirectangular coordinates `u` and `v` in [0, 1], from the map's upper left corner.
INLINE EnvironmentMapPosition environment_map_position_at_uv(real u, real v, uint width, uint height) {
    real x = u * real(width) - real(0.5);
    real y = clamp(v * real(height) - real(0.5), real(0), real(height) - real(1));
    real first = floor(x);
    real top = min(floor(y), max(real(height) - real(2), real(0)));
    EnvironmentMapPosition place;
    place.left = uint(first + real(width)) % width;
    place.right = (place.left + 1u) % width;
    place.above = uint(top);
    place.below = min(place.above + 1u, height - 1u);
    place.across = x - first;
    place.down = y - top;
    return place;
}
// Returns the equirectangular coordinates of a direction of any length.
INLINE vec2 direction_to_equirectangular_uv(vec3 d) {
    real level = sqrt(d.x * d.x + d.z * d.z);
    real azimuth = level > real(0) ? atan(d.x, -d.z) : real(0);
    return vec2(real(0.5) + azimuth / (real(2) * kPi), atan(level, d.y) / kPi);
}
INLINE EnvironmentMapPosition direction_to_environment_map(vec3 d, uint width, uint height) {
    vec2 uv = direction_to_equirectangular_uv(d);
    return environment_map_position_at_uv(uv.x, uv.y, width, height);
}

// The cell of an environment map that holds a direction, and the direction's place in the cell. Between the centres of four
// texels lies one cell, in which the bilinear look-up has four fixed corners. Row 0 and row `height` are half as high, at
// the poles.
struct EnvironmentCell {
    uint left, right, above, below; // columns and rows of the four texels
    real across, down;              // bilinear weights
    real sine_ratio;                // sine of the angle from the +y axis, in the cell's middle over that of the direction
};
INLINE real environment_cell_middle_sine(uint row, uint height) {
    real middle = row == 0u ? real(0.25) : row == height ? real(height) - real(0.25) : real(row);
    return sin(kPi * middle / real(height));
}
INLINE EnvironmentCell direction_to_environment_cell(vec3 d, uint width, uint height) {
    real level = sqrt(d.x * d.x + d.z * d.z);
    real azimuth = level > real(0) ? atan(d.x, -d.z) : real(0);
    real x = (real(0.5) + azimuth / (real(2) * kPi)) * real(width) - real(0.5);
    real y = atan(level, d.y) / kPi * real(height) + real(0.5);
    real first = floor(x), row = clamp(floor(y), real(0), real(height));
    EnvironmentCell cell;
    cell.left = uint(first + real(width)) % width;
    cell.right = (cell.left + 1u) % width;
    cell.above = row > real(0) ? uint(row) - 1u : 0u;
    cell.below = min(uint(row), height - 1u);
    cell.across = x - first;
    cell.down = clamp(y - row, real(0), real(1));
    cell.sine_ratio = environment_cell_middle_sine(uint(row), height) / max(level, real(1e-9));
    return cell;
}

// Returns the unit direction at the place (`across`, `down`), each in [0, 1), of cell `cell`, counted by rows.
INLINE vec3 environment_cell_direction(uint cell, real across, real down, uint width, uint height) {
    uint row = cell / width;
    real x = real(cell % width) + real(0.5) + across;
    real top = row == 0u ? real(0) : real(row) - real(0.5);
    real y = top + down * (row == 0u || row == height ? real(0.5) : real(1));
    real azimuth = (x / real(width) - real(0.5)) * real(2) * kPi, angle = kPi * y / real(height);
    return vec3(sin(angle) * sin(azimuth), cos(angle), -sin(angle) * cos(azimuth));
}

// Returns the grey radiance of the built-in studio environment in the unit direction `d`. The studio has a bright
// ceiling that darkens to the floor, and a soft box to the left behind a camera that looks along -z.
INLINE real studio_radiance(vec3 d) {
    real grey = d.y < real(0) ? mix(real(0.6), real(0.25), -d.y) : mix(real(0.6), real(0.9), d.y);
    // Direction of the soft box: azimuth -150 degrees, elevation 50 degrees.
    vec3 box = vec3(real(-0.32139380484326967), real(0.76604444311897804), real(0.55667039922641936));
    vec3 right = normalize(cross(box, vec3(real(0), real(1), real(0))));
    vec3 up = cross(right, box);
    real ahead = dot(d, box);
    if (!(ahead > real(0))) return grey;
    real degree = kPi / real(180);
    real x = abs(atan(dot(d, right) / ahead)) / degree;
    real y = abs(atan(dot(d, up) / ahead)) / degree;
    return grey + real(6) * (real(1) - smoothstep(real(18), real(22), x)) * (real(1) - smoothstep(real(10.5), real(14.5), y));
}

// Returns the irradiance on a surface with unit normal `n`, from the nine coefficients of
// scene::irradiance_coefficients (Ramamoorthi and Hanrahan 2001). The coefficients include the constant factors of the spherical harmonics.
INLINE vec3 irradiance_from_harmonics(vec3 of[9], vec3 n) {
    vec3 sum = of[0] + n.y * of[1] + n.z * of[2] + n.x * of[3] + n.x * n.y * of[4] + n.y * n.z * of[5] +
               (real(3) * n.z * n.z - real(1)) * of[6] + n.x * n.z * of[7] + (n.x * n.x - n.y * n.y) * of[8];
    return max(sum, vec3(real(0)));
}
