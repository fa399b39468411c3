#include "graph/frame_slot.hpp"

namespace catoptric::graph {

namespace {

constexpr std::uint32_t kSetsPerPool = 256;

gpu::UniqueDescriptorPool make_descriptor_pool(const gpu::Device& device) {
    const VkDescriptorPoolSize sizes[] = {
        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 2 * kSetsPerPool},
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 8 * kSetsPerPool},
        {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, 4 * kSetsPerPool},
        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 8 * kSetsPerPool},
        {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 32 * kSetsPerPool},
        {VK_DESCRIPTOR_TYPE_SAMPLER, 2 * kSetsPerPool},
        {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 4 * kSetsPerPool}};
    VkDescriptorPoolCreateInfo create{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    create.maxSets = kSetsPerPool;
    create.poolSizeCount = static_cast<std::uint32_t>(std::size(sizes));
    create.pPoolSizes = sizes;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    gpu::check_vk(vkCreateDescriptorPool(device.handle(), &create, nullptr, &pool),
                  "create a descriptor pool");
    return {device.handle(), pool};
}

} // namespace

FrameSlot::FrameSlot(const gpu::Device& device) : device_(device) {
    VkCommandPoolCreateInfo create{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    create.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    create.queueFamilyIndex = device.queue_family();
    VkCommandPool handle = VK_NULL_HANDLE;
    gpu::check_vk(vkCreateCommandPool(device.handle(), &create, nullptr, &handle),
                  "create a command pool");
    pool_ = {device.handle(), handle};
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = handle;
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    gpu::check_vk(vkAllocateCommandBuffers(device.handle(), &allocate, &commands),
                  "allocate a command buffer");
}

void FrameSlot::reset_commands() {
    gpu::check_vk(vkResetCommandBuffer(commands, 0), "reset a command buffer");
}

void FrameSlot::reset(std::uint32_t most_stamps) {
    if (query_count_ < most_stamps) {
        VkQueryPoolCreateInfo create{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
        create.queryType = VK_QUERY_TYPE_TIMESTAMP;
        create.queryCount = most_stamps;
        VkQueryPool pool = VK_NULL_HANDLE;
        gpu::check_vk(vkCreateQueryPool(device_.handle(), &create, nullptr, &pool),
                      "create time stamps");
        queries = {device_.handle(), pool};
        query_count_ = most_stamps;
    }
    vkResetQueryPool(device_.handle(), queries, 0, query_count_);
    reset_descriptors();
    next_query = 0;
    stamps.clear(), piece_begins.clear();
}

void FrameSlot::reset_descriptors() {
    for (const auto& pool : descriptor_pools_) vkResetDescriptorPool(device_.handle(), pool, 0);
    next_pool_ = 0;
}

void FrameSlot::end_piece() {
    gpu::check_vk(read_stamps(), "read the time stamps of a piece of a frame");
    piece_begins.push_back(stamps.size());
    vkResetQueryPool(device_.handle(), queries, 0, query_count_);
    next_query = 0;
    reset_descriptors();
    reset_commands();
}

VkResult FrameSlot::read_stamps() {
    if (next_query == 0) return VK_SUCCESS;
    const std::size_t before = stamps.size();
    stamps.resize(before + next_query);
    return vkGetQueryPoolResults(device_.handle(), queries, 0, next_query,
                                 8 * std::size_t{next_query}, &stamps[before], 8,
                                 VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
}

VkDescriptorSet FrameSlot::allocate_descriptor_set(VkDescriptorSetLayout layout) {
    for (;; ++next_pool_) {
        const bool fresh = next_pool_ == descriptor_pools_.size();
        if (fresh) descriptor_pools_.push_back(make_descriptor_pool(device_));
        VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
        allocate.descriptorPool = descriptor_pools_[next_pool_];
        allocate.descriptorSetCount = 1;
        allocate.pSetLayouts = &layout;
        VkDescriptorSet set = VK_NULL_HANDLE;
        const VkResult result = vkAllocateDescriptorSets(device_.handle(), &allocate, &set);
        if (result == VK_SUCCESS) return set;
        const bool full = result == VK_ERROR_OUT_OF_POOL_MEMORY ||
                          result == VK_ERROR_FRAGMENTED_POOL;
        if (fresh || !full) gpu::check_vk(result, "allocate a descriptor set");
    }
}

} // namespace catoptric::graph
