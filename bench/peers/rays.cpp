// Compiled with the options of whitted.cpp, for this machine's processor.
#include "rays.hpp"

#include "lanes.hpp"

#include <atomic>
#include <limits>
#include <thread>

namespace peers {

namespace {

constexpr std::size_t kRun = 256;

template <typename Kind>
void meet_some(RTCScene tree, std::span<const Ray> rays, Met* met) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context); // default flags: the rays of a call are incoherent
    using Real = typename Kind::Real;
    using Mask = typename Kind::Mask;
    for (std::size_t first = 0; first < rays.size(); first += Kind::kCount) {
        typename Kind::Hits hits;
        Three<Real> origin{}, direction{};
        for (int i = 0; i < Kind::kCount; ++i) {
            const Ray& ray = rays[first + static_cast<std::size_t>(i)];
            put(origin, i, ray.origin), put(direction, i, ray.direction);
        }
        store(hits.ray.org_x, origin.x), store(hits.ray.org_y, origin.y),
            store(hits.ray.org_z, origin.z);
        store(hits.ray.dir_x, direction.x), store(hits.ray.dir_y, direction.y),
            store(hits.ray.dir_z, direction.z);
        store(hits.ray.tnear, Real{}), store(hits.ray.time, Real{});
        store(hits.ray.tfar, Real{} + std::numeric_limits<float>::infinity());
        store(hits.ray.mask, Mask{} - 1), store(hits.ray.id, Mask{}), store(hits.ray.flags, Mask{});
        store(hits.hit.geomID, Mask{} + static_cast<int>(RTC_INVALID_GEOMETRY_ID));
        store(hits.hit.instID[0], Mask{} + static_cast<int>(RTC_INVALID_GEOMETRY_ID));
        Kind::meet(Mask{} - 1, tree, &context, hits);
        const Mask geometry = load<Mask>(hits.hit.geomID), triangle = load<Mask>(hits.hit.primID);
        const Real t = load<Real>(hits.ray.tfar);
        for (int i = 0; i < Kind::kCount; ++i)
            met[first + static_cast<std::size_t>(i)] = {
                lane(t, i), lane(geometry, i) < 0 ? Met::kNothing
                                                  : static_cast<std::uint32_t>(lane(triangle, i))};
    }
}

} // namespace

std::vector<Met> meet(RTCScene tree, std::span<const Ray> rays, int width, int threads) {
    const auto some = width == 1   ? meet_some<One>
                      : width == 8 ? meet_some<Eight>
                                   : meet_some<Sixteen>;
    std::vector<Met> met(rays.size());
    std::atomic<std::size_t> next{0};
    std::vector<std::thread> workers;
    for (int i = 0; i < threads; ++i)
        workers.emplace_back([&] {
            for (std::size_t first; (first = next.fetch_add(kRun)) < rays.size();)
                some(tree, rays.subspan(first, std::min(kRun, rays.size() - first)), &met[first]);
        });
    for (std::thread& worker : workers) worker.join();
    return met;
}

} // namespace peers
