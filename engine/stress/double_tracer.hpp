#pragma once

#include "scene/scene.hpp"

#include <limits>
#include <vector>

namespace catoptric::stress {

/// Of the ray through a place of the picture in pixels, whole numbers at their middles; unit
/// length.
dvec3 pixel_direction(const scene::Camera& camera, uvec2 size, double x, double y);

/// A ray tracer of a page in double precision, written from the formula in the documentation alone:
/// it shares nothing with the rest of the engine but the scene's data. Mirrors must be exact
/// spheres, scenes about 1 in size; lamps are flat and throw no shadow.
class DoubleTracer {
public:
    /// Keeps a reference to the scene.
    DoubleTracer(const scene::Scene& scene, double ambient);

    /// Radiance at the middle of a pixel.
    dvec3 pixel(const scene::Camera& camera, uvec2 size, std::uint32_t x, std::uint32_t y,
                int depth) const;
    /// To what the ray meets first, in lengths of `direction`; infinite where that is nothing.
    double distance(dvec3 origin, dvec3 direction) const {
        return closest(origin, direction, std::numeric_limits<double>::infinity(), false).t;
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
    const scene::Material& material(std::size_t object) const {
        return scene_.materials[scene_.objects[object].material];
    }
    Hit closest(dvec3 origin, dvec3 direction, double most, bool for_shadow) const;
    dvec3 radiance(dvec3 origin, dvec3 direction, int depth) const;
    dvec3 shade(const scene::Material& surface, dvec3 x, dvec3 normal) const;

    const scene::Scene& scene_;
    double ambient_;
    std::vector<Triangle> triangles_;
    std::vector<Lamp> lamps_;
};

} // namespace catoptric::stress
