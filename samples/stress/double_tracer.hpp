#pragma once

#include "scene/scene.hpp"

#include <limits>
#include <vector>

namespace catoptric::stress {

/// Returns the unit direction of the ray through a place of the picture. `x` and `y` are in pixels;
/// whole numbers are pixel centres.
dvec3 ray_direction(const scene::Camera& camera, uvec2 size, double x, double y);

/// Small reference ray tracer in double precision. It follows only the formula in the documentation
/// and shares nothing with the engine but the scene's data. Mirrors must be exact spheres and
/// scenes about 1 in size. Lamps are flat and cast no shadow.
class DoubleTracer {
public:
    /// Keeps a reference to the scene. `ambient` is the constant ambient light.
    DoubleTracer(const scene::Scene& scene, double ambient);

    /// Returns the radiance at the centre of a pixel.
    dvec3 trace_pixel(const scene::Camera& camera, uvec2 size, std::uint32_t x, std::uint32_t y,
                      int depth) const;
    /// Returns the distance to the first hit of the ray, in lengths of `direction`, or infinity if
    /// there is none.
    double hit_distance(dvec3 origin, dvec3 direction) const {
        return find_closest_hit(origin, direction, std::numeric_limits<double>::infinity(), false)
            .t;
    }

private:
    struct Triangle {
        dvec3 a, b, c;
        std::size_t object;
    };
    struct Lamp {
        dvec3 position, normal, power; ///< emission times area
    };
    struct Hit {
        double t = std::numeric_limits<double>::infinity();
        dvec3 normal{0};
        std::size_t object = 0;
    };

    void add_lamp(const scene::Object& object, const scene::Mesh& mesh);
    const scene::Material& material_of_object(std::size_t object) const {
        return scene_.materials[scene_.objects[object].material];
    }
    Hit find_closest_hit(dvec3 origin, dvec3 direction, double most, bool for_shadow) const;
    dvec3 radiance(dvec3 origin, dvec3 direction, int depth) const;
    dvec3 shade_hit(const scene::Material& surface, dvec3 x, dvec3 normal) const;

    const scene::Scene& scene_;
    double ambient_;
    std::vector<Triangle> triangles_;
    std::vector<Lamp> lamps_;
};

} // namespace catoptric::stress
