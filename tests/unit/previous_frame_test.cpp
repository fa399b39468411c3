// Tests of what makes a picture depend on the frame before.
#include "session/frame_graph.hpp"

#include <gtest/gtest.h>

namespace {

using namespace catoptric;
using graph::ResourceUse;

/// Returns whether a frame depends on the frame before, if its one pass reads the previous contents
/// of an image, of a buffer, or of neither.
bool does_frame_remember(bool reads_image, bool reads_buffer) {
    session::FrameGraph frame;
    const graph::ImageHandle image = frame.graph.add_image({"image", TexelFormat::rgba32f, 8, 8});
    const graph::BufferHandle buffer = frame.graph.add_buffer({"buffer", 64});
    graph::PassBuilder pass = frame.graph.add_pass("pass");
    if (reads_image) pass.reads(frame.graph.previous(image), ResourceUse::sampled);
    if (reads_buffer) pass.reads(frame.graph.previous(buffer), ResourceUse::storage_read);
    pass.writes(image, ResourceUse::storage_write).writes(buffer, ResourceUse::storage_write);
    pass.record([](graph::PassCommands&) {});
    frame.graph.output(image);
    return session::remembers(frame, graph::plan_graph(frame.graph, {}, graph::default_sizer()),
                              {});
}

TEST(PreviousFrame, ImagesAndBuffersOfTheFrameBeforeAreHistory) {
    EXPECT_FALSE(does_frame_remember(false, false));
    EXPECT_TRUE(does_frame_remember(true, false));
    EXPECT_TRUE(does_frame_remember(false, true));
}

} // namespace
