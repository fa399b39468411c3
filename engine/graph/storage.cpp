// The runner's memory: what lives for a frame (placed by the plan), what is kept, read-back.
#include "graph/run.hpp"
#include "graph/sync.hpp"

#include <algorithm>

namespace catoptric::graph {

namespace {

constexpr std::uint32_t kSetsPerPool = 256;

VkMemoryRequirements requirements(const gpu::Device& device, const ImageDesc& desc) {
    const VkImageCreateInfo create = image_create_info(desc);
    VkDeviceImageMemoryRequirements info{VK_STRUCTURE_TYPE_DEVICE_IMAGE_MEMORY_REQUIREMENTS};
    info.pCreateInfo = &create;
    VkMemoryRequirements2 needs{VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2};
    vkGetDeviceImageMemoryRequirements(device.handle(), &info, &needs);
    return needs.memoryRequirements;
}

VkBufferCreateInfo buffer_create_info(const BufferDesc& desc) {
    VkBufferCreateInfo create{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    create.size = desc.bytes;
    create.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
                   VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    return create;
}

Requirements placed(const gpu::Device& device, const VkMemoryRequirements& needs,
                    const std::string& name) {
    const int type = device.memory_type(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    check(type >= 0, Failure::internal, "no memory type for '", name, "'");
    // Linear buffers and optimal images share heaps: the granularity keeps them on pages of their
    // own.
    const auto granularity = device.limits().bufferImageGranularity;
    return {needs.size, std::max<std::uint64_t>(needs.alignment, granularity),
            static_cast<std::uint32_t>(type)};
}

} // namespace

Limits Runner::limits() const {
    const VkPhysicalDeviceLimits& limits = device_.limits();
    return {limits.maxImageDimension2D,  limits.maxImageDimensionCube, limits.maxImageArrayLayers,
            limits.maxFramebufferLayers, device_.memory_budget(),      device_.max_allocation()};
}

Sizer Runner::sizer() const {
    return {[this](const ImageDesc& desc) {
                return placed(device_, requirements(device_, desc), desc.name);
            },
            [this](const BufferDesc& desc) {
                const VkBufferCreateInfo create = buffer_create_info(desc);
                VkDeviceBufferMemoryRequirements info{
                    VK_STRUCTURE_TYPE_DEVICE_BUFFER_MEMORY_REQUIREMENTS};
                info.pCreateInfo = &create;
                VkMemoryRequirements2 needs{VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2};
                vkGetDeviceBufferMemoryRequirements(device_.handle(), &info, &needs);
                return placed(device_, needs.memoryRequirements, desc.name);
            }};
}

History Runner::history() const {
    History names;
    for (const auto& [name, kept] : kept_)
        if (kept.valid) names.insert(name);
    return names;
}

void Runner::forget() {
    kept_.clear(), kept_ids_.clear();
    image_descs_.clear(), buffer_descs_.clear(), offsets_.clear();
}

Physical& Runner::physical(Image image) {
    if (!kept_ids_.contains(image.id)) return images_[image.id];
    Kept& kept = kept_.at(image_descs_[image.id].name);
    return kept.copies[static_cast<std::size_t>(image.previous ? kept.last : 1 - kept.last)];
}

/// Reuses everything when the frame has the shape of the last one.
void Runner::prepare(const Graph& graph, const Plan& plan) {
    const auto queries = static_cast<std::uint32_t>(2 * plan.passes.size() + 2);
    if (query_count_ < queries) {
        VkQueryPoolCreateInfo create{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
        create.queryType = VK_QUERY_TYPE_TIMESTAMP;
        create.queryCount = query_count_ = queries;
        VkQueryPool pool = VK_NULL_HANDLE;
        gpu::check_vk(vkCreateQueryPool(device_.handle(), &create, nullptr, &pool),
                      "create time stamps");
        queries_ = {device_.handle(), pool};
    }
    vkResetQueryPool(device_.handle(), queries_, 0, query_count_);
    for (const auto& pool : descriptor_pools_) vkResetDescriptorPool(device_.handle(), pool, 0);
    next_pool_ = 0;

    std::vector<std::uint64_t> offsets;
    std::set<std::uint32_t> kept_ids;
    for (std::size_t i = 0; i < plan.images.size(); ++i) {
        const bool kept = plan.images[i].used && graph.is_kept(static_cast<std::uint32_t>(i));
        if (kept) kept_ids.insert(static_cast<std::uint32_t>(i));
        offsets.push_back(!plan.images[i].used ? ~std::uint64_t{0}
                          : kept               ? ~std::uint64_t{1}
                                               : plan.images[i].offset);
    }
    for (const Placement& placement : plan.buffers)
        offsets.push_back(placement.used ? placement.offset : ~std::uint64_t{0});
    if (graph.images() == image_descs_ && graph.buffers() == buffer_descs_ && offsets == offsets_)
        return;
    image_descs_ = graph.images(), buffer_descs_ = graph.buffers();
    offsets_ = std::move(offsets), kept_ids_ = std::move(kept_ids);
    images_.clear(), owned_buffers_.clear(), buffers_.clear(), heaps_.clear();

    std::vector<std::uint64_t> heap_bytes(plan.heap_bytes.size(), 0);
    const auto grow = [&](const Placement& p) {
        heap_bytes[p.heap] = std::max(heap_bytes[p.heap], p.offset + p.bytes);
    };
    for (std::size_t i = 0; i < plan.images.size(); ++i)
        if (plan.images[i].used && !kept_ids_.contains(static_cast<std::uint32_t>(i)))
            grow(plan.images[i]);
    for (const Placement& placement : plan.buffers)
        if (placement.used) grow(placement);
    for (std::size_t type = 0; type < heap_bytes.size(); ++type)
        heaps_.push_back(heap_bytes[type]
                             ? device_.allocate(heap_bytes[type], static_cast<std::uint32_t>(type),
                                                "images of the frame")
                             : gpu::UniqueMemory());
    for (std::size_t i = 0; i < plan.images.size(); ++i) {
        const Placement& placement = plan.images[i];
        images_.emplace_back();
        if (!placement.used) continue;
        if (kept_ids_.contains(static_cast<std::uint32_t>(i))) {
            make_kept(image_descs_[i]);
            continue;
        }
        images_.back() = make_physical(device_, image_descs_[i]);
        gpu::check_vk(vkBindImageMemory(device_.handle(), images_.back().image,
                                        heaps_[placement.heap], placement.offset),
                      "place image '" + image_descs_[i].name + "'");
    }
    for (std::size_t i = 0; i < plan.buffers.size(); ++i) {
        const Placement& placement = plan.buffers[i];
        owned_buffers_.emplace_back();
        buffers_.push_back(VK_NULL_HANDLE);
        if (!placement.used) continue;
        const VkBufferCreateInfo create = buffer_create_info(buffer_descs_[i]);
        gpu::check_vk(vkCreateBuffer(device_.handle(), &create, nullptr, &buffers_.back()),
                      "create buffer '" + buffer_descs_[i].name + "'");
        owned_buffers_.back() = {device_.handle(), buffers_.back()};
        device_.set_name(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<std::uint64_t>(buffers_.back()),
                         buffer_descs_[i].name);
        gpu::check_vk(vkBindBufferMemory(device_.handle(), buffers_.back(), heaps_[placement.heap],
                                         placement.offset),
                      "place buffer '" + buffer_descs_[i].name + "'");
    }
}

/// Both copies of an image that has a `previous`, black and readable.
void Runner::make_kept(const ImageDesc& desc) {
    if (const auto found = kept_.find(desc.name); found != kept_.end()) {
        if (found->second.copies[0].desc == desc) return;
        kept_.erase(found);
    }
    Kept kept;
    const Requirements needs = sizer().image(desc);
    const std::uint64_t second = (needs.bytes + needs.alignment - 1) / needs.alignment *
                                 needs.alignment;
    kept.memory = device_.allocate(second + needs.bytes, needs.heap, desc.name);
    for (std::size_t i = 0; i < 2; ++i) {
        kept.copies[i] = make_physical(device_, desc);
        gpu::check_vk(
            vkBindImageMemory(device_.handle(), kept.copies[i].image, kept.memory, i * second),
            "place image '" + desc.name + "'");
    }
    device_.submit_now("clear image '" + desc.name + "'", [&](VkCommandBuffer commands) {
        for (const Physical& copy : kept.copies) {
            const VkImageSubresourceRange range{aspect_of(desc.format), 0, 1, 0, desc.layers};
            VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
            barrier.image = copy.image;
            barrier.subresourceRange = range;
            barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
            barrier.dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
            barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
            VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
            dependency.imageMemoryBarrierCount = 1;
            dependency.pImageMemoryBarriers = &barrier;
            vkCmdPipelineBarrier2(commands, &dependency);
            const VkClearColorValue black{};
            vkCmdClearColorImage(commands, copy.image, barrier.newLayout, &black, 1, &range);
            barrier.srcStageMask = barrier.dstStageMask,
            barrier.srcAccessMask = barrier.dstAccessMask;
            barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
            barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT;
            barrier.oldLayout = barrier.newLayout, barrier.newLayout = layout_of(Use::sampled);
            vkCmdPipelineBarrier2(commands, &dependency);
        }
    });
    kept_.emplace(desc.name, std::move(kept));
}

VkDescriptorSet Runner::descriptor_set(VkDescriptorSetLayout layout) {
    for (;; ++next_pool_) {
        const bool fresh = next_pool_ == descriptor_pools_.size();
        if (fresh) {
            const VkDescriptorPoolSize sizes[] = {
                {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 2 * kSetsPerPool},
                {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 8 * kSetsPerPool},
                {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, 4 * kSetsPerPool},
                {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 8 * kSetsPerPool},
                {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 4 * kSetsPerPool}};
            VkDescriptorPoolCreateInfo create{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
            create.maxSets = kSetsPerPool;
            create.poolSizeCount = static_cast<std::uint32_t>(std::size(sizes));
            create.pPoolSizes = sizes;
            VkDescriptorPool pool = VK_NULL_HANDLE;
            gpu::check_vk(vkCreateDescriptorPool(device_.handle(), &create, nullptr, &pool),
                          "create a descriptor pool");
            descriptor_pools_.emplace_back(device_.handle(), pool);
        }
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

std::vector<std::byte> Runner::read(Image image) {
    const bool kept = kept_ids_.contains(image.id);
    image.previous = kept; // the frame is over: what it wrote is the "last frame" now
    const ImageDesc& desc = image_descs_[image.id];
    Physical& source = physical(image);
    const std::uint64_t bytes = std::uint64_t{desc.width} * desc.height * image.layer_count *
                                bytes_per_texel(desc.format);
    gpu::Buffer target(device_, "read-back of " + desc.name, bytes, gpu::BufferUse::read_back);
    device_.submit_now("read back image '" + desc.name + "'", [&](VkCommandBuffer commands) {
        VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
        barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT;
        barrier.oldLayout = layout_of(Use::sampled), barrier.newLayout = layout_of(Use::copy_from);
        barrier.image = source.image;
        barrier.subresourceRange = {aspect_of(desc.format), 0, 1, image.first_layer,
                                    image.layer_count};
        VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
        dependency.imageMemoryBarrierCount = 1;
        dependency.pImageMemoryBarriers = &barrier;
        if (kept) vkCmdPipelineBarrier2(commands, &dependency);
        VkBufferImageCopy region{};
        region.imageSubresource = {aspect_of(desc.format), 0, image.first_layer, image.layer_count};
        region.imageExtent = {desc.width, desc.height, 1};
        vkCmdCopyImageToBuffer(commands, source.image, layout_of(Use::copy_from), target.handle(),
                               1, &region);
        std::swap(barrier.oldLayout, barrier.newLayout);
        if (kept) vkCmdPipelineBarrier2(commands, &dependency);
    });
    std::vector<std::byte> data = target.read();
    data.resize(bytes);
    return data;
}

std::vector<std::byte> Runner::read_history() {
    std::vector<std::byte> history;
    for (const std::uint32_t id : kept_ids_) {
        const std::vector<std::byte> image = read(Image{id, 0, image_descs_[id].layers});
        history.insert(history.end(), image.begin(), image.end());
    }
    return history;
}

std::vector<std::byte> Runner::read(Buffer buffer) {
    const auto& [name, bytes] = buffer_descs_[buffer.id];
    gpu::Buffer target(device_, "read-back of " + name, bytes, gpu::BufferUse::read_back);
    device_.submit_now("read back buffer '" + name + "'", [&](VkCommandBuffer commands) {
        const VkBufferCopy region{0, 0, bytes};
        vkCmdCopyBuffer(commands, buffers_[buffer.id], target.handle(), 1, &region);
    });
    std::vector<std::byte> data = target.read();
    data.resize(bytes);
    return data;
}

} // namespace catoptric::graph
