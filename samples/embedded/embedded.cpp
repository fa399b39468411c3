// Sample: Catoptric renders on a Vulkan device that this program made, into an image of this
// program. A program with its own renderer can use Catoptric in this way. The sample then reads the
// image back.
#include <catoptric/embed.hpp>
#include <catoptric/picture.hpp>
#include <catoptric/scene.hpp>

#include <cstdio>
#include <stdexcept>

using namespace catoptric;

namespace {

constexpr std::uint32_t kSide = 160;

void check_vk(VkResult result) {
    if (result != VK_SUCCESS) throw std::runtime_error("Vulkan: " + std::to_string(result));
}

embed::Device make_device() {
    embed::Device made; // made with queue family 0, which has all needed features on the drivers
                        // tested so far
    const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                        .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo instance{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                        .pApplicationInfo = &application};
    check_vk(vkCreateInstance(&instance, nullptr, &made.instance));
    std::uint32_t one = 1;
    if (vkEnumeratePhysicalDevices(made.instance, &one, &made.physical) < 0 || one == 0)
        throw std::runtime_error("no Vulkan device");
    const embed::RequiredFeatures features(made.physical);
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                        .queueCount = 1,
                                        .pQueuePriorities = &priority};
    const VkDeviceCreateInfo device{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                    .pNext = &features.core,
                                    .queueCreateInfoCount = 1,
                                    .pQueueCreateInfos = &queue};
    check_vk(vkCreateDevice(made.physical, &device, nullptr, &made.device));
    vkGetDeviceQueue(made.device, 0, 0, &made.queue);
    return made;
}

VkDeviceMemory allocate_memory(const embed::Device& own, const VkMemoryRequirements& wants,
                               bool host) {
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(own.physical, &memory);
    const VkMemoryPropertyFlags flags = host ? VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                                   VK_MEMORY_PROPERTY_HOST_COHERENT_BIT
                                             : 0;
    for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i)
        if ((wants.memoryTypeBits >> i & 1) &&
            (memory.memoryTypes[i].propertyFlags & flags) == flags) {
            const VkMemoryAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                                .allocationSize = wants.size,
                                                .memoryTypeIndex = i};
            VkDeviceMemory made = VK_NULL_HANDLE;
            check_vk(vkAllocateMemory(own.device, &allocate, nullptr, &made));
            return made;
        }
    throw std::runtime_error("no memory of this kind");
}

/// Reads back the contents of the image, which is in the layout TRANSFER_SRC_OPTIMAL.
measure::Picture read_back_image(const embed::Device& own, VkImage image) {
    const VkBufferCreateInfo wanted{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                    .size = 4 * kSide * kSide,
                                    .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    VkBuffer buffer = VK_NULL_HANDLE;
    check_vk(vkCreateBuffer(own.device, &wanted, nullptr, &buffer));
    VkMemoryRequirements wants;
    vkGetBufferMemoryRequirements(own.device, buffer, &wants);
    const VkDeviceMemory memory = allocate_memory(own, wants, true);
    check_vk(vkBindBufferMemory(own.device, buffer, memory, 0));

    const VkCommandPoolCreateInfo pools{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    VkCommandPool pool = VK_NULL_HANDLE;
    check_vk(vkCreateCommandPool(own.device, &pools, nullptr, &pool));
    const VkCommandBufferAllocateInfo allocate{
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = pool,
        .commandBufferCount = 1};
    VkCommandBuffer commands = VK_NULL_HANDLE;
    check_vk(vkAllocateCommandBuffers(own.device, &allocate, &commands));
    const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    check_vk(vkBeginCommandBuffer(commands, &begin));
    const VkBufferImageCopy all{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                .imageExtent = {kSide, kSide, 1}};
    vkCmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &all);
    const VkMemoryBarrier to_host{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                  .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                  .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                         &to_host, 0, nullptr, 0, nullptr);
    check_vk(vkEndCommandBuffer(commands));
    const VkSubmitInfo submit{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                              .commandBufferCount = 1,
                              .pCommandBuffers = &commands};
    check_vk(vkQueueSubmit(own.queue, 1, &submit, VK_NULL_HANDLE));
    check_vk(vkQueueWaitIdle(own.queue));

    void* bytes = nullptr;
    check_vk(vkMapMemory(own.device, memory, 0, VK_WHOLE_SIZE, 0, &bytes));
    measure::Picture picture(kSide, kSide);
    const auto* texel = static_cast<const unsigned char*>(bytes);
    for (vec3& pixel : picture.pixels) {
        pixel = vec3(texel[0], texel[1], texel[2]) / 255.f;
        texel += 4;
    }
    vkDestroyCommandPool(own.device, pool, nullptr);
    vkDestroyBuffer(own.device, buffer, nullptr);
    vkFreeMemory(own.device, memory, nullptr);
    return picture;
}

} // namespace

int main() try {
    const embed::Device own = make_device();
    const VkImageCreateInfo wanted{.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                   .imageType = VK_IMAGE_TYPE_2D,
                                   .format = VK_FORMAT_R8G8B8A8_SRGB,
                                   .extent = {kSide, kSide, 1},
                                   .mipLevels = 1,
                                   .arrayLayers = 1,
                                   .samples = VK_SAMPLE_COUNT_1_BIT,
                                   .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                            VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
    VkImage image = VK_NULL_HANDLE;
    check_vk(vkCreateImage(own.device, &wanted, nullptr, &image));
    VkMemoryRequirements wants;
    vkGetImageMemoryRequirements(own.device, image, &wants);
    const VkDeviceMemory memory = allocate_memory(own, wants, false);
    check_vk(vkBindImageMemory(own.device, image, memory, 0));
    {
        session::Engine engine = embed::make_engine(own);
        session::Session session(engine, scene::load("cornell-mirrors"), 2);
        const session::FrameSpec spec{.techniques = {"parallax:face=64"},
                                      .camera = session.scene().cameras.front(),
                                      .size = {kSide, kSide}};
        const embed::Target target{image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
        for (int k = 0; k < 5; ++k) embed::render_into(session, spec, target);
        const session::Frame last = embed::render_into(session, spec, target);
        const measure::Picture shown = read_back_image(own,
                                                       image); // the queue runs this copy after the
                                                               // frame
        const bool same = shown.pixels == last.read().display.pixels;
        std::printf("our image %s the frame\n", same ? "holds" : "does NOT hold");
        measure::write_png(shown, "embedded.png");
        if (!same) return 1;
    }
    vkDestroyImage(own.device, image, nullptr);
    vkFreeMemory(own.device, memory, nullptr);
    vkDestroyDevice(own.device, nullptr);
    vkDestroyInstance(own.instance, nullptr);
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "embedded: %s\n", error.what());
    return 1;
}
