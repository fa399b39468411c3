#pragma once

#include "bvh/bvh.hpp"

#include <embree3/rtcore.h>

#include <span>
#include <stdexcept>
#include <string>

/// The ray tracer Embree, for comparison with our own ray tracer in tests and benchmarks.
namespace peers {

/// Embree's device. Builds trees with `threads` threads; 0 takes one thread per processor.
class EmbreeDevice {
public:
    explicit EmbreeDevice(int threads = 0)
        : peer_device_(rtcNewDevice(("threads=" + std::to_string(threads)).c_str())) {}
    ~EmbreeDevice() { rtcReleaseDevice(peer_device_); }
    EmbreeDevice(const EmbreeDevice&) = delete;
    EmbreeDevice& operator=(const EmbreeDevice&) = delete;

    RTCDevice embree_device_handle() const { return peer_device_; }
    /// Throws if Embree had an error since the last call.
    void throw_on_embree_error() const {
        if (const RTCError error = rtcGetDeviceError(peer_device_); error != RTC_ERROR_NONE)
            throw std::runtime_error("Embree: error " + std::to_string(error));
    }

private:
    RTCDevice peer_device_;
};

/// Returns an Embree geometry of triangles, in which triangle i is primitive i. The caller releases
/// the geometry.
inline RTCGeometry make_triangle_geometry(const EmbreeDevice& device,
                                          std::span<const catoptric::bvh::Triangle> triangles) {
    using catoptric::vec3;
    RTCGeometry geometry = rtcNewGeometry(device.embree_device_handle(),
                                          RTC_GEOMETRY_TYPE_TRIANGLE);
    const std::size_t count = triangles.size();
    auto* corners = static_cast<vec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3), 3 * count));
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), count));
    for (std::size_t i = 0; i < count; ++i) {
        corners[3 * i] = triangles[i].a, corners[3 * i + 1] = triangles[i].b,
                    corners[3 * i + 2] = triangles[i].c;
        for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) indices[k] = static_cast<std::uint32_t>(k);
    }
    rtcCommitGeometry(geometry);
    return geometry;
}

/// An Embree scene, a tree over geometries. The device must outlive the scene.
class EmbreeScene {
public:
    EmbreeScene(const EmbreeDevice& device, RTCSceneFlags flags, RTCBuildQuality quality)
        : peer_device_(device), embree_scene_(rtcNewScene(device.embree_device_handle())) {
        rtcSetSceneFlags(embree_scene_, flags);
        rtcSetSceneBuildQuality(embree_scene_, quality);
    }
    ~EmbreeScene() { rtcReleaseScene(embree_scene_); }
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    RTCScene embree_scene_handle() const { return embree_scene_; }

    /// Adds a geometry. `number` identifies the geometry in a hit and must be unique in the scene.
    void add_geometry(RTCGeometry geometry, unsigned number = 0) {
        rtcAttachGeometryByID(embree_scene_, geometry, number);
    }
    void add_geometry_and_release(RTCGeometry geometry, unsigned number = 0) {
        add_geometry(geometry, number);
        rtcReleaseGeometry(geometry);
    }
    void build_tree() {
        rtcCommitScene(embree_scene_);
        peer_device_.throw_on_embree_error();
    }

private:
    const EmbreeDevice& peer_device_;
    RTCScene embree_scene_;
};

} // namespace peers
