#pragma once

#include "bvh/bvh.hpp"

#include <embree3/rtcore.h>

#include <span>
#include <stdexcept>
#include <string>

/// Embree beside our own tracer: as a witness in tests, as a peer in benchmarks.
namespace peers {

/// Embree's device, with so many threads for building; 0: as many as there are processors.
class EmbreeDevice {
public:
    explicit EmbreeDevice(int threads = 0)
        : device_(rtcNewDevice(("threads=" + std::to_string(threads)).c_str())) {}
    ~EmbreeDevice() { rtcReleaseDevice(device_); }
    EmbreeDevice(const EmbreeDevice&) = delete;
    EmbreeDevice& operator=(const EmbreeDevice&) = delete;

    RTCDevice get() const { return device_; }
    /// Throws where it has had an error since the last time.
    void check() const {
        if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
            throw std::runtime_error("Embree: error " + std::to_string(error));
    }

private:
    RTCDevice device_;
};

/// Triangles in Embree's hands: triangle i is primitive i. The caller's to release.
inline RTCGeometry triangle_geometry(const EmbreeDevice& device,
                                     std::span<const catoptric::bvh::Triangle> triangles) {
    using catoptric::vec3;
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
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

/// The tree over geometries; the device must outlive it.
class EmbreeScene {
public:
    EmbreeScene(const EmbreeDevice& device, RTCSceneFlags flags, RTCBuildQuality quality)
        : device_(device), scene_(rtcNewScene(device.get())) {
        rtcSetSceneFlags(scene_, flags);
        rtcSetSceneBuildQuality(scene_, quality);
    }
    ~EmbreeScene() { rtcReleaseScene(scene_); }
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    RTCScene get() const { return scene_; }

    /// `number`: no other's of the scene; comes back with a hit.
    void add(RTCGeometry geometry, unsigned number = 0) {
        rtcAttachGeometryByID(scene_, geometry, number);
    }
    void add_and_release(RTCGeometry geometry, unsigned number = 0) {
        add(geometry, number);
        rtcReleaseGeometry(geometry);
    }
    void commit() {
        rtcCommitScene(scene_);
        device_.check();
    }

private:
    const EmbreeDevice& device_;
    RTCScene scene_;
};

} // namespace peers
