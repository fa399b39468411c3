// Compiled with the options of whitted.cpp, for this machine's processor.
#include "rays.hpp"

#include "lanes.hpp"

#include <atomic>
#include <limits>
#include <thread>

namespace peers {

namespace {

constexpr std::size_t kRaysPerTask = 256;

template <typename Kind>
void trace_consecutive_rays(RTCScene tree, std::span<const Ray> rays, FirstRayHit* met) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context); // default flags: the rays of a call are incoherent
    using Real = typename Kind::Real;
    using Mask = typename Kind::Mask;
    for (std::size_t first = 0; first < rays.size(); first += Kind::kRaysPerPacket) {
        typename Kind::Hits hits;
        PacketVector<Real> origin{}, direction{};
        for (int i = 0; i < Kind::kRaysPerPacket; ++i) {
            const Ray& ray = rays[first + static_cast<std::size_t>(i)];
            write_lane(origin, i, ray.origin), write_lane(direction, i, ray.direction);
        }
        store_packet_values(hits.ray.org_x, origin.x),
            store_packet_values(hits.ray.org_y, origin.y),
            store_packet_values(hits.ray.org_z, origin.z);
        store_packet_values(hits.ray.dir_x, direction.x),
            store_packet_values(hits.ray.dir_y, direction.y),
            store_packet_values(hits.ray.dir_z, direction.z);
        store_packet_values(hits.ray.tnear, Real{}), store_packet_values(hits.ray.time, Real{});
        store_packet_values(hits.ray.tfar, Real{} + std::numeric_limits<float>::infinity());
        store_packet_values(hits.ray.mask, Mask{} - 1), store_packet_values(hits.ray.id, Mask{}),
            store_packet_values(hits.ray.flags, Mask{});
        store_packet_values(hits.hit.geomID, Mask{} + static_cast<int>(RTC_INVALID_GEOMETRY_ID));
        store_packet_values(hits.hit.instID[0], Mask{} + static_cast<int>(RTC_INVALID_GEOMETRY_ID));
        Kind::find_closest_hits(Mask{} - 1, tree, &context, hits);
        const Mask geometry = load_packet_values<Mask>(hits.hit.geomID),
                   triangle = load_packet_values<Mask>(hits.hit.primID);
        const Real t = load_packet_values<Real>(hits.ray.tfar);
        for (int i = 0; i < Kind::kRaysPerPacket; ++i)
            met[first + static_cast<std::size_t>(i)] = {
                read_lane(t, i), read_lane(geometry, i) < 0
                                     ? FirstRayHit::kNoTriangle
                                     : static_cast<std::uint32_t>(read_lane(triangle, i))};
    }
}

} // namespace

std::vector<FirstRayHit> find_closest_hits_of_rays(RTCScene tree, std::span<const Ray> rays,
                                                   int width, int threads) {
    const auto some = width == 1   ? trace_consecutive_rays<OneRayPacket>
                      : width == 8 ? trace_consecutive_rays<EightRayPacket>
                                   : trace_consecutive_rays<SixteenRayPacket>;
    std::vector<FirstRayHit> met(rays.size());
    std::atomic<std::size_t> next{0};
    std::vector<std::thread> workers;
    for (int i = 0; i < threads; ++i)
        workers.emplace_back([&] {
            for (std::size_t first; (first = next.fetch_add(kRaysPerTask)) < rays.size();)
                some(tree, rays.subspan(first, std::min(kRaysPerTask, rays.size() - first)),
                     &met[first]);
        });
    for (std::thread& worker : workers) worker.join();
    return met;
}

} // namespace peers
