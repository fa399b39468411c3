// Tests of buffers in memory that the host cannot map. Written through staging buffers, they must
// hold the same data as mapped buffers.
#include "gpu/buffer.hpp"
#include "render/passes.hpp"
#include "support/device.hpp"
#include "support/scenes.hpp"

#include <algorithm>
#include <numeric>

namespace {

using namespace catoptric;

class StagedUploadTest : public testing::TestWithParam<bool> {
protected:
    gpu::Device& staging_device() { return test::get_test_device(GetParam()).device; }
};
INSTANTIATE_TEST_SUITE_P(Buffers, StagedUploadTest, testing::Values(false, true),
                         [](const auto& instance) { return instance.param ? "staged" : "mapped"; });

TEST_P(StagedUploadTest, BufferReturnsTheWrittenData) {
    ASSERT_EQ(staging_device().needs_staging(), GetParam());
    std::vector<std::uint32_t> words(1000);
    std::iota(words.begin(), words.end(), 17u);
    gpu::Buffer buffer(staging_device(), "words", 4 * words.size(), gpu::BufferUsage::plain);
    buffer.write(std::span<const std::uint32_t>(words));
    const std::vector<std::uint32_t> part{1, 2, 3};
    buffer.write(4 * 100, std::as_bytes(std::span(part)));
    std::ranges::copy(part, words.begin() + 100);
    const std::vector<std::byte> read = buffer.read();
    ASSERT_EQ(read.size(), 4 * words.size());
    EXPECT_EQ(std::memcmp(read.data(), words.data(), read.size()), 0);
}

TEST_P(StagedUploadTest, WriteBeyondTheEndIsRefused) {
    gpu::Buffer buffer(staging_device(), "short", 32, gpu::BufferUsage::plain);
    const std::vector<std::uint32_t> words(5);
    test::expect_error([&] { buffer.write(16, std::as_bytes(std::span(words))); },
                       Failure::internal, {"buffer 'short' has 32 bytes", "[16, 36)"});
    buffer.write(12, std::as_bytes(std::span(words)));
}

/// Tests the limit on texels, which is checked before memory is allocated. The limit counts texels,
/// whether a texel is one word or four floats.
TEST_P(StagedUploadTest, MoreTexelsThanTheDeviceAllowsAreRefused) {
    for (const auto& [use, bytes] : {std::pair{gpu::BufferUsage::words, 4u},
                                     {gpu::BufferUsage::quads, 16u},
                                     {gpu::BufferUsage::texels, 16u}}) {
        const std::uint64_t most = staging_device().max_texels(bytes);
        test::expect_error([&] { gpu::Buffer(staging_device(), "list", (most + 1) * bytes, use); },
                           Failure::exhausted,
                           {"buffer 'list' wants " + std::to_string(most + 1) +
                            " texels, the device allows " + std::to_string(most)});
    }
}

TEST_P(StagedUploadTest, EmptyBufferCanBeMadeAndWritten) {
    gpu::Buffer buffer;
    gpu::upload(staging_device(), buffer, "empty", std::vector<float>{}, gpu::BufferUsage::plain);
    EXPECT_TRUE(buffer.handle());
    EXPECT_GE(buffer.bytes(), 16u);
}

TEST_P(StagedUploadTest, UploadGrowsTheBuffer) {
    gpu::Buffer buffer;
    gpu::upload(staging_device(), buffer, "list", std::vector<std::uint32_t>(10, 5u),
                gpu::BufferUsage::plain);
    std::vector<std::uint32_t> longer(100, 9u);
    gpu::upload(staging_device(), buffer, "list", longer, gpu::BufferUsage::plain);
    ASSERT_EQ(buffer.bytes(), 400u);
    EXPECT_EQ(std::memcmp(buffer.read().data(), longer.data(), 400), 0);
}

/// The write of 40 MB is larger than the staging ring.
TEST_P(StagedUploadTest, LargeWritesArriveWhole) {
    std::vector<std::uint32_t> words(10'000'003);
    std::iota(words.begin(), words.end(), 3u);
    gpu::Buffer buffer(staging_device(), "large", 4 * words.size(), gpu::BufferUsage::plain);
    buffer.write(std::span<const std::uint32_t>(words));
    EXPECT_EQ(std::memcmp(buffer.read().data(), words.data(), 4 * words.size()), 0);
}

TEST_P(StagedUploadTest, OverlappingWritesHappenInOrder) {
    std::vector<std::uint32_t> expected(1000, 0u);
    gpu::Buffer buffer(staging_device(), "list", 4 * expected.size(), gpu::BufferUsage::plain);
    buffer.write(std::span<const std::uint32_t>(expected));
    for (std::uint32_t k = 0; k < 200; ++k) {
        const std::size_t first = 3 * k, count = 400 - 2 * k;
        const std::vector<std::uint32_t> part(count, k + 1);
        buffer.write(4 * first, std::as_bytes(std::span(part)));
        std::ranges::fill_n(expected.begin() + static_cast<std::ptrdiff_t>(first),
                            static_cast<std::ptrdiff_t>(count), k + 1);
    }
    const std::vector<std::byte> read = buffer.read();
    EXPECT_EQ(std::memcmp(read.data(), expected.data(), read.size()), 0);
}

/// Tests that a buffer can be destroyed or replaced right after a write. Its pending copies on the
/// device are finished first.
TEST_P(StagedUploadTest, BufferCanBeDestroyedRightAfterAWrite) {
    const std::vector<std::uint32_t> words(50'000, 7u);
    gpu::Buffer kept(staging_device(), "kept", 4 * words.size(), gpu::BufferUsage::plain);
    for (int k = 0; k < 5; ++k) {
        gpu::Buffer gone(staging_device(), "gone", 4 * words.size(), gpu::BufferUsage::plain);
        gone.write(std::span<const std::uint32_t>(words));
        if (k % 2) staging_device().submit_uploads();
        gpu::Buffer other = std::move(gone);
        other = {};
        other = gpu::Buffer(staging_device(), "other", 4 * words.size(), gpu::BufferUsage::plain);
        other.write(std::span<const std::uint32_t>(words));
    }
    kept.write(std::span<const std::uint32_t>(words));
    EXPECT_EQ(std::memcmp(kept.read().data(), words.data(), 4 * words.size()), 0);
    staging_device().check_validation();
}

/// Renders a whole picture with staged and mapped buffers, which covers vertices, texel buffers and
/// read-back.
TEST(StagedScene, PictureEqualsThatOfMappedBuffers) {
    const auto picture = [](bool staged) {
        auto& [device, pipelines] = test::get_test_device(staged);
        const scene::Scene room = test::make_lit_room(0, 1);
        render::GpuScene gpu_scene(device, room);
        gpu_scene.update(room, room.cameras.front(), {48, 32}, 0.05);
        graph::GraphRunner runner(device, pipelines);
        graph::Graph graph;
        render::FrameRequests requests(gpu_scene.next_view());
        const render::FrameInputs inputs{gpu_scene, requests, {48, 32}, ""};
        const render::ShadingLights lighting{render::add_shadows(graph, inputs, 64)};
        const graph::ImageHandle hdr = render::add_camera_view(graph, inputs, lighting, {}).hdr;
        graph.output(hdr);
        gpu_scene.fulfil(requests, [] {});
        test::run_graph(runner, graph);
        return test::read_resource_values<float>(runner, hdr);
    };
    const std::vector<float> mapped = picture(false);
    EXPECT_GT(*std::ranges::max_element(mapped), 0.0f);
    EXPECT_EQ(mapped, picture(true));
}

} // namespace
