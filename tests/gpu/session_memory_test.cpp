// Tests that a session's host memory does not grow over many frames. The test runs in a process of
// its own, because driver threads of other sessions free about a megabyte at any time.
#include "support/rendering.hpp"

#include <malloc.h>

#include <iostream>
#include <limits>

namespace {

using namespace catoptric;

TEST(Session, HostMemoryIsFlatOverManyFrames) {
    const scene::Scene scene = test::room(2, 1);
    app::FrameSpec spec = test::request(scene, {"reuse:face=8,shadow_map=8"}, {16, 16});
    app::Session session(test::engine(), scene);
    constexpr int kFrames = 2000;
    // The test compares the smallest of many readings, because memory that driver threads have not
    // freed yet is no leak.
    std::size_t early = std::numeric_limits<std::size_t>::max(), late = early;
    for (int k = 1; k <= kFrames; ++k) {
        spec.camera.eye.x += k % 2 ? .01 : -.01;
        session.frame(spec);
        const bool is_early = k > kFrames / 10 && k <= kFrames / 5, is_late = k > kFrames * 9 / 10;
        if (is_early) early = std::min(early, mallinfo2().uordblks);
        if (is_late) late = std::min(late, mallinfo2().uordblks);
    }
    std::cout << "[ MEASURED ] bytes in use, at least: " << early << " early, " << late
              << " late in " << kFrames << " frames\n";
    EXPECT_LE(late, early + 64 * 1024);
}

} // namespace
