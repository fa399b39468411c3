#include "gpu/buffer.hpp"

#include <algorithm>

namespace catoptric::gpu {

namespace {

constexpr std::uint64_t kMinBufferBytes = 16; // one texel of the largest format

struct TexelBufferFormat {
    VkFormat format = VK_FORMAT_UNDEFINED; ///< undefined: no texel buffer
    std::uint64_t bytes = 0;
};

TexelBufferFormat texel_format_of_usage(BufferUsage use) {
    if (has_buffer_usage(use, BufferUsage::texels)) return {VK_FORMAT_R32G32B32A32_SFLOAT, 16};
    if (has_buffer_usage(use, BufferUsage::quads)) return {VK_FORMAT_R32G32B32A32_UINT, 16};
    if (has_buffer_usage(use, BufferUsage::words)) return {VK_FORMAT_R32_UINT, 4};
    return {};
}

VkBufferUsageFlags to_vulkan_buffer_usage(BufferUsage use) {
    VkBufferUsageFlags flags = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                               VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    if (has_buffer_usage(use, BufferUsage::vertex)) flags |= VK_BUFFER_USAGE_VERTEX_BUFFER_BIT;
    if (has_buffer_usage(use, BufferUsage::index)) flags |= VK_BUFFER_USAGE_INDEX_BUFFER_BIT;
    if (has_buffer_usage(use, BufferUsage::uniform)) flags |= VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
    if (texel_format_of_usage(use).bytes > 0) flags |= VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    return flags;
}

UniqueBuffer make_vulkan_buffer(const GpuDevice& device, std::uint64_t bytes,
                                VkBufferUsageFlags flags, const std::string& name) {
    VkBufferCreateInfo create{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    create.size = bytes;
    create.usage = flags;
    VkBuffer buffer = VK_NULL_HANDLE;
    throw_unless_vk_success(vkCreateBuffer(device.device_handle(), &create, nullptr, &buffer),
                            "create buffer '" + name + "'");
    device.set_debug_name_of_vulkan_object(VK_OBJECT_TYPE_BUFFER,
                                           reinterpret_cast<std::uint64_t>(buffer), name);
    return {device.device_handle(), buffer};
}

/// The side that uses a buffer most.
enum class BufferMemoryPreference { device, host_writes, host_reads };

/// A memory type and whether the memory is to be mapped.
struct ChosenMemoryType {
    int index = -1;
    bool mapped = false;
};

ChosenMemoryType choose_memory_type(const GpuDevice& device, const VkMemoryRequirements& needs,
                                    BufferMemoryPreference home) {
    constexpr VkMemoryPropertyFlags kHostMemoryFlags = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                                       VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const auto find = [&](VkMemoryPropertyFlags properties) {
        return device.find_memory_type_index(needs.memoryTypeBits, properties);
    };
    if (home == BufferMemoryPreference::device) {
        // If the host sees only a part of the device's memory, large buffers stay outside this
        // part.
        constexpr std::uint64_t kHostVisibleHeapDivisor = 16;
        const int seen = find(VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | kHostMemoryFlags);
        const std::uint64_t window = seen < 0 ? 0
                                              : device.heap_bytes_of_memory_type(
                                                    static_cast<std::uint32_t>(seen));
        if (!device.needs_staged_uploads() &&
            (window == device.memory_budget() || needs.size <= window / kHostVisibleHeapDivisor))
            return {seen, true};
        return {find(VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT), false};
    }
    const int cached = home == BufferMemoryPreference::host_reads
                           ? find(kHostMemoryFlags | VK_MEMORY_PROPERTY_HOST_CACHED_BIT)
                           : -1;
    return {cached >= 0 ? cached : find(kHostMemoryFlags), true};
}

/// Allocates memory for `buffer` and binds it. `mapped` is null if the host cannot see the memory.
UniqueMemory allocate_buffer_memory(const GpuDevice& device, VkBuffer buffer,
                                    BufferMemoryPreference home, const std::string& name,
                                    void*& mapped) {
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device.device_handle(), buffer, &needs);
    const ChosenMemoryType type = choose_memory_type(device, needs, home);
    check(type.index >= 0, Failure::internal, "no memory type for buffer '", name, "'");
    UniqueMemory memory = device.allocate(needs.size, static_cast<std::uint32_t>(type.index), name);
    throw_unless_vk_success(vkBindBufferMemory(device.device_handle(), buffer, memory, 0),
                            "bind buffer '" + name + "'");
    if (type.mapped)
        throw_unless_vk_success(
            vkMapMemory(device.device_handle(), memory, 0, VK_WHOLE_SIZE, 0, &mapped),
            "map buffer '" + name + "'");
    return memory;
}

void copy_buffer_and_wait(GpuDevice& device, const std::string& doing, VkBuffer from, VkBuffer to,
                          std::uint64_t bytes) {
    device.submit_one_time_commands(doing, [&](VkCommandBuffer commands) {
        const VkBufferCopy region{0, 0, bytes};
        vkCmdCopyBuffer(commands, from, to, 1, &region);
    });
}

} // namespace

GpuBuffer::GpuBuffer(GpuDevice& device, std::string name, std::uint64_t bytes, BufferUsage use)
    : buffer_device_(&device), name_(std::move(name)),
      bytes_(std::max<std::uint64_t>(bytes, kMinBufferBytes)) {
    const auto [format, texel_bytes] = texel_format_of_usage(use);
    if (texel_bytes > 0) {
        const std::uint64_t texels = bytes_ / texel_bytes,
                            most = device.max_texel_count(texel_bytes);
        check(texels <= most, Failure::exhausted, "buffer '", name_, "' wants ", texels,
              " texels, the device allows ", most);
    }
    buffer_ = make_vulkan_buffer(device, bytes_, to_vulkan_buffer_usage(use), name_);
    memory_ = allocate_buffer_memory(
        device, buffer_,
        has_buffer_usage(use, BufferUsage::read_back) ? BufferMemoryPreference::host_reads
        : has_buffer_usage(use, BufferUsage::staging) ? BufferMemoryPreference::host_writes
                                                      : BufferMemoryPreference::device,
        name_, mapped_);
    if (texel_bytes == 0 || device.needs_storage_buffers_for_texels()) return;
    VkBufferViewCreateInfo view{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
    view.buffer = buffer_;
    view.format = format;
    view.range = bytes_ / texel_bytes * texel_bytes;
    VkBufferView handle = VK_NULL_HANDLE;
    throw_unless_vk_success(vkCreateBufferView(device.device_handle(), &view, nullptr, &handle),
                            "view buffer '" + name_ + "'");
    view_ = {device.device_handle(), handle};
}

void GpuBuffer::write_contents(std::uint64_t offset, std::span<const std::byte> data) {
    if (data.empty()) return;
    check(offset + data.size() <= bytes_, Failure::internal, "buffer '", name_, "' has ", bytes_,
          " bytes, a write wants [", offset, ", ", offset + data.size(), ")");
    if (mapped_) {
        std::memcpy(static_cast<std::byte*>(mapped_) + offset, data.data(), data.size());
        return;
    }
    upload_.set_ticket(*buffer_device_,
                       buffer_device_->uploads().stage_write(buffer_, offset, data));
}

std::vector<std::byte> GpuBuffer::read_contents() const {
    std::vector<std::byte> data(bytes_);
    if (mapped_) {
        std::memcpy(data.data(), mapped_, bytes_);
        return data;
    }
    void* mapped = nullptr;
    const UniqueBuffer staging = make_vulkan_buffer(*buffer_device_, bytes_,
                                                    VK_BUFFER_USAGE_TRANSFER_DST_BIT, "read-back");
    const UniqueMemory memory = allocate_buffer_memory(
        *buffer_device_, staging, BufferMemoryPreference::host_reads, "read-back", mapped);
    copy_buffer_and_wait(*buffer_device_, "read back buffer '" + name_ + "'", buffer_, staging,
                         bytes_);
    std::memcpy(data.data(), mapped, bytes_);
    return data;
}

} // namespace catoptric::gpu
