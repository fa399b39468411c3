// Tests that engines are independent: two threads with an engine each must render the same pictures
// as one thread.
#include "import/load.hpp"
#include "scene/built_in.hpp"
#include "session/session.hpp"

#include <gtest/gtest.h>
#include <thread>

namespace {

using namespace catoptric;

measure::Picture render_on_engine(session::Engine& engine, const scene::Scene& scene) {
    session::Session session(engine, scene);
    measure::Picture last;
    for (const char* technique : {"parallax:face=64", "secant:face=64", "parallax:face=64"})
        last = session
                   .frame({.techniques = {technique},
                           .camera = scene.cameras.front(),
                           .size = {48, 48}})
                   .hdr();
    return last;
}

TEST(Threads, TwoEnginesInTwoThreadsRenderTheSame) {
    const scene::Scene scene = scene::make_cornell();
    session::Engine one({}), other({});
    const measure::Picture truth = render_on_engine(one, scene);
    for (int round = 0; round < 3; ++round) {
        measure::Picture here, there;
        std::thread thread([&] { there = render_on_engine(other, scene); });
        here = render_on_engine(one, scene);
        thread.join();
        EXPECT_TRUE(here.pixels == truth.pixels);
        EXPECT_TRUE(there.pixels == truth.pixels);
    }
}

} // namespace
