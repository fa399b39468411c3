#include "embed.hpp"

#include "core/error.hpp"
#include "gpu/instance.hpp"
#include "graph/physical.hpp"
#include "session/embedding.hpp"

namespace catoptric::embed {

namespace {

graph::ResourceUse use_of_layout(VkImageLayout layout) {
    switch (layout) {
    case VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL: return graph::ResourceUse::sampled;
    case VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL: return graph::ResourceUse::copy_from;
    case VK_IMAGE_LAYOUT_GENERAL: return graph::ResourceUse::storage_read;
    case VK_IMAGE_LAYOUT_PRESENT_SRC_KHR: return graph::ResourceUse::present;
    default:
        fail(Failure::usage,
             "a target is left in the layout SHADER_READ_ONLY_OPTIMAL, "
             "TRANSFER_SRC_OPTIMAL, GENERAL or PRESENT_SRC_KHR, not in number ",
             static_cast<int>(layout));
    }
}

/// Adds the frame's last pass, which copies the displayed picture byte for byte.
void add_copy_pass(session::FrameGraph& frame, const Target& target, uvec2 size) {
    const graph::ImageDesc desc{
        .name = "target", .format = TexelFormat::rgba8_unorm, .width = size.x, .height = size.y};
    frame.target = std::make_shared<graph::PhysicalImage>(graph::wrap_image(desc, target.image));
    const graph::ImageHandle display = frame.parts.front().outputs.display;
    const graph::ImageHandle image = frame.graph.import_resource(
        desc, frame.target.get(), std::nullopt, use_of_layout(target.leaves));
    frame.graph.add_pass("target")
        .reads(display, graph::ResourceUse::copy_from)
        .writes(image, graph::ResourceUse::copy_to)
        .record([=](graph::PassCommands& commands) { commands.copy_image(display, image); });
}

} // namespace

RequiredFeatures::RequiredFeatures(VkPhysicalDevice device) {
    const gpu::DeviceProperties info = gpu::describe_device(device);
    check(info.missing.empty(), Failure::no_device, "device '", info.name, "' lacks ",
          info.missing);
    gpu::DeviceFeatures wanted;
    wanted.enable(device);
    core = wanted.core, v11 = wanted.v11, v12 = wanted.v12, v13 = wanted.v13;
    core.pNext = &v11, v11.pNext = &v12, v12.pNext = &v13, v13.pNext = nullptr;
}

session::Engine make_engine(const Device& device, const session::EngineOptions& options) {
    const gpu::ExternalDevice given{device.instance, device.physical, device.device, device.queue,
                                    device.queue_family};
    return session::Access::make_engine(options, {.given = &given});
}

session::Frame render_into(session::Session& session, const session::FrameSpec& spec,
                           const Target& target) {
    check(spec.techniques.size() == 1, Failure::usage, "a target shows one technique, not ",
          spec.techniques.size());
    check(target.image != VK_NULL_HANDLE, Failure::usage, "a target wants an image");
    static_cast<void>(use_of_layout(target.leaves)); // throws before any work
    return session::EmbedAccess::submit(session, spec, [&](session::FrameGraph& frame) {
        add_copy_pass(frame, target, spec.size);
    });
}

} // namespace catoptric::embed
