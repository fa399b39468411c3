// Tests of sessions on a Vulkan device that the calling program made. A frame must leave the right
// content and layout in the caller's image, and unusable devices and images must be refused. The
// device is that of the other tests, so the validation layer checks it. samples/embedded is an
// example of such a program.
#include "core/error.hpp"
#include "embed.hpp"
#include "gpu/buffer.hpp"
#include "graph/physical.hpp"
#include "import/load.hpp"
#include "scene/built_in.hpp"
#include "session/access.hpp"
#include "session/session.hpp"
#include "support/device.hpp"

#include <gmock/gmock.h>

namespace {

using namespace catoptric;
using testing::HasSubstr;

template <typename Call>
std::string usage_error_text(Call&& call) {
    try {
        call();
    } catch (const UsageError& error) {
        return error.what();
    }
    return "nothing was thrown";
}

/// Returns the handles of the device that the other tests use. The instance is a placeholder,
/// because no function reads it.
embed::Device list_handles_of_test_device() {
    const gpu::Device& own = test::get_test_device().device;
    return {reinterpret_cast<VkInstance>(std::uintptr_t{1}), own.physical_device(), own.handle(),
            own.queue(), own.queue_family()};
}

/// An image that belongs to the caller, as the target of frames. `read` returns its content, given
/// the layout in which the frame left it.
class CallerOwnedImage {
public:
    explicit CallerOwnedImage(uvec2 size)
        : image_size_(size),
          image_(graph::make_physical_image(device_, {.name = "target",
                                                      .format = TexelFormat::rgba8_unorm,
                                                      .width = size.x,
                                                      .height = size.y})) {
        VkMemoryRequirements wants;
        vkGetImageMemoryRequirements(device_.handle(), image_.image, &wants);
        memory_ = device_.allocate(
            wants.size,
            static_cast<std::uint32_t>(device_.find_memory_type(wants.memoryTypeBits, 0)),
            "target");
        gpu::check_vk(vkBindImageMemory(device_.handle(), image_.image, memory_, 0), "bind");
    }
    VkImage image_handle() const { return image_.image; }
    measure::Picture read_image_content(VkImageLayout left_in) {
        gpu::Buffer buffer(device_, "seen", 4 * image_size_.x * image_size_.y,
                           gpu::BufferUsage::read_back);
        device_.run_commands("look at a target", [&](VkCommandBuffer commands) {
            VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
            barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
            barrier.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
            barrier.oldLayout = left_in;
            barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
            barrier.image = image_.image;
            barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
            vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                                 VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 1,
                                 &barrier);
            const VkBufferImageCopy all{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                        .imageExtent = {image_size_.x, image_size_.y, 1}};
            vkCmdCopyImageToBuffer(commands, image_.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                   buffer.handle(), 1, &all);
        });
        const std::vector<std::byte> bytes = buffer.read();
        measure::Picture picture(static_cast<int>(image_size_.x), static_cast<int>(image_size_.y));
        for (std::size_t i = 0; i < 3 * picture.pixels.size(); ++i)
            picture.pixels[i / 3][static_cast<int>(i % 3)] = static_cast<float>(
                                                                 bytes[4 * (i / 3) + i % 3]) /
                                                             255.f;
        return picture;
    }

private:
    gpu::Device& device_ = test::get_test_device().device;
    uvec2 image_size_;
    gpu::UniqueMemory memory_;
    graph::PhysicalImage image_;
};

TEST(Embed, TargetImageHoldsTheFrameInTheRequestedLayout) {
    session::Engine engine = embed::make_engine(list_handles_of_test_device());
    session::Session session(engine, scene::make_cornell(), 2);
    const session::FrameSpec spec{.techniques = {"reuse:face=16,shadow_map=16"},
                                  .camera = session.scene().cameras.front(),
                                  .size = {32, 16}};
    CallerOwnedImage own(spec.size);
    for (const VkImageLayout left_in :
         {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
          VK_IMAGE_LAYOUT_GENERAL}) {
        const session::Frame frame = embed::render_into(session, spec,
                                                        {own.image_handle(), left_in});
        EXPECT_TRUE(own.read_image_content(left_in).pixels == frame.read().display.pixels)
            << left_in;
    }
}

TEST(Embed, UnknownQueueFamilyIsRefused) {
    embed::Device given = list_handles_of_test_device();
    given.queue_family = 7;
    EXPECT_THAT(usage_error_text([&] { embed::make_engine(given); }),
                HasSubstr("queue families, number 7 was given"));
}

TEST(Embed, MissingDeviceHandlesAreRefused) {
    EXPECT_THAT(usage_error_text([] { embed::make_engine({}); }),
                HasSubstr("wants an instance, a physical device, a device and a queue"));
}

TEST(Embed, UnusableTargetIsRefused) {
    session::Session session(test::get_test_engine(), scene::make_flat_room());
    session::FrameSpec spec{
        .techniques = {"reuse"}, .camera = session.scene().cameras.front(), .size = {16, 16}};
    // The image is a placeholder, because the calls are refused before they use it.
    const auto image = reinterpret_cast<VkImage>(std::uintptr_t{1});
    EXPECT_THAT(usage_error_text([&] { embed::render_into(session, spec, {}); }),
                HasSubstr("an image"));
    EXPECT_THAT(usage_error_text([&] {
                    embed::render_into(session, spec, {image, VK_IMAGE_LAYOUT_UNDEFINED});
                }),
                HasSubstr("PRESENT_SRC_KHR, not in number 0"));
    spec.techniques.push_back("parallax");
    EXPECT_THAT(usage_error_text([&] { embed::render_into(session, spec, {image}); }),
                HasSubstr("one technique, not 2"));
    EXPECT_EQ(session::Access::session_counters(session).frames, 0u);
}

} // namespace
