// Tests that a session's host memory does not grow over many frames. The test runs in a process of
// its own, because driver threads of other sessions free about a megabyte at any time.
#include "support/rendering.hpp"

#include <malloc.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iostream>
#include <iterator>
#include <limits>

namespace {

using namespace catoptric;

TEST(Session, HostMemoryIsFlatOverManyFrames) {
    const scene::Scene scene = test::make_lit_room(2, 1);
    session::FrameSpec spec = test::make_test_request(scene, {"reuse:face=8,shadow_map=8"},
                                                      {16, 16});
    session::Session session(test::get_test_engine(), scene);
    constexpr int kMemoryTestFrames = 2000;
    // A leak grows from the first window to the second and from the second to the third. A block
    // that the driver takes once grows in one of these steps only. Each window counts its smallest
    // reading, because memory that driver threads have not freed yet is no leak.
    constexpr int kFrameWindows[] = {kMemoryTestFrames / 10, kMemoryTestFrames / 2,
                                     kMemoryTestFrames * 9 / 10};
    std::array<std::int64_t, std::size(kFrameWindows)> used;
    used.fill(std::numeric_limits<std::int64_t>::max());
    for (int k = 1; k <= kMemoryTestFrames; ++k) {
        spec.camera.eye.x += k % 2 ? .01 : -.01;
        session.frame(spec);
        for (std::size_t i = 0; i < used.size(); ++i)
            if (k > kFrameWindows[i] && k <= kFrameWindows[i] + kMemoryTestFrames / 10)
                used[i] = std::min(used[i], static_cast<std::int64_t>(mallinfo2().uordblks));
    }
    std::cout << "[ MEASURED ] bytes in use, at least: " << used[0] << ", " << used[1] << ", "
              << used[2] << " after a tenth, half and nine tenths of " << kMemoryTestFrames
              << " frames\n";
    EXPECT_LE(std::min(used[1] - used[0], used[2] - used[1]), 8 * 1024); // 10 bytes a frame
}

} // namespace
