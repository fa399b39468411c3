#include "gpu/buffer.hpp"

#include <algorithm>

namespace catoptric::gpu {

namespace {

constexpr std::uint64_t kMinBufferBytes = 16; // one texel of the largest format

struct TexelBufferFormat {
    VkFormat format = VK_FORMAT_UNDEFINED; ///< undefined: no texel buffer
    std::uint64_t bytes = 0;
};

TexelBufferFormat texel_usage_format(BufferUsage use) {
    if (has_usage(use, BufferUsage::texels)) return {VK_FORMAT_R32G32B32A32_SFLOAT, 16};
    if (has_usage(use, BufferUsage::quads)) return {VK_FORMAT_R32G32B32A32_UINT, 16};
    if (has_usage(use, BufferUsage::words)) return {VK_FORMAT_R32_UINT, 4};
    return {};
}

VkBufferUsageFlags to_vk_usage(BufferUsage use) {
    VkBufferUsageFlags flags = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                               VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    if (has_usage(use, BufferUsage::vertex)) flags |= VK_BUFFER_USAGE_VERTEX_BUFFER_BIT;
    if (has_usage(use, BufferUsage::index)) flags |= VK_BUFFER_USAGE_INDEX_BUFFER_BIT;
    if (has_usage(use, BufferUsage::uniform)) flags |= VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
    if (texel_usage_format(use).bytes > 0) flags |= VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    return flags;
}

UniqueBuffer make_buffer(const Device& device, std::uint64_t bytes, VkBufferUsageFlags flags,
                         const std::string& name) {
    VkBufferCreateInfo create{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    create.size = bytes;
    create.usage = flags;
    VkBuffer buffer = VK_NULL_HANDLE;
    check_vk(vkCreateBuffer(device.handle(), &create, nullptr, &buffer),
             "create buffer '" + name + "'");
    device.set_debug_name(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<std::uint64_t>(buffer), name);
    return {device.handle(), buffer};
}

/// The side that uses a buffer most.
enum class MemoryPreference { device, host_writes, host_reads };

/// A memory type and whether the memory is to be mapped.
struct ChosenMemoryType {
    int index = -1;
    bool mapped = false;
};

ChosenMemoryType choose_memory_type(const Device& device, const VkMemoryRequirements& needs,
                                    MemoryPreference home) {
    constexpr VkMemoryPropertyFlags kHostMemoryFlags = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                                       VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const auto find = [&](VkMemoryPropertyFlags properties) {
        return device.find_memory_type(needs.memoryTypeBits, properties);
    };
    if (home == MemoryPreference::device) {
        // If the host sees only a part of the device's memory, large buffers stay outside this
        // part.
        constexpr std::uint64_t kHostVisibleHeapDivisor = 16;
        const int seen = find(VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | kHostMemoryFlags);
        const std::uint64_t window = seen < 0 ? 0
                                              : device.heap_bytes(static_cast<std::uint32_t>(seen));
        if (!device.needs_staging() && (window == device.largest_heap_bytes() ||
                                        needs.size <= window / kHostVisibleHeapDivisor))
            return {seen, true};
        return {find(VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT), false};
    }
    const int cached = home == MemoryPreference::host_reads
                           ? find(kHostMemoryFlags | VK_MEMORY_PROPERTY_HOST_CACHED_BIT)
                           : -1;
    return {cached >= 0 ? cached : find(kHostMemoryFlags), true};
}

/// Allocates memory for `buffer` and binds it. `mapped` is null if the host cannot see the memory.
UniqueMemory allocate_memory(const Device& device, VkBuffer buffer, MemoryPreference home,
                             const std::string& name, void*& mapped) {
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device.handle(), buffer, &needs);
    const ChosenMemoryType type = choose_memory_type(device, needs, home);
    check(type.index >= 0, Failure::internal, "no memory type for buffer '", name, "'");
    UniqueMemory memory = device.allocate(needs.size, static_cast<std::uint32_t>(type.index), name);
    check_vk(vkBindBufferMemory(device.handle(), buffer, memory, 0), "bind buffer '" + name + "'");
    if (type.mapped)
        check_vk(vkMapMemory(device.handle(), memory, 0, VK_WHOLE_SIZE, 0, &mapped),
                 "map buffer '" + name + "'");
    return memory;
}

void copy_buffer(Device& device, const std::string& doing, VkBuffer from, VkBuffer to,
                 std::uint64_t bytes) {
    device.run_commands(doing, [&](VkCommandBuffer commands) {
        const VkBufferCopy region{0, 0, bytes};
        vkCmdCopyBuffer(commands, from, to, 1, &region);
    });
}

} // namespace

Buffer::Buffer(Device& device, std::string name, std::uint64_t bytes, BufferUsage use)
    : device_(&device), name_(std::move(name)),
      bytes_(std::max<std::uint64_t>(bytes, kMinBufferBytes)) {
    const auto [format, texel_bytes] = texel_usage_format(use);
    if (texel_bytes > 0) {
        const std::uint64_t texels = bytes_ / texel_bytes, most = device.max_texels(texel_bytes);
        check(texels <= most, Failure::exhausted, "buffer '", name_, "' wants ", texels,
              " texels, the device allows ", most);
    }
    buffer_ = make_buffer(device, bytes_, to_vk_usage(use), name_);
    memory_ = allocate_memory(device, buffer_,
                              has_usage(use, BufferUsage::read_back) ? MemoryPreference::host_reads
                              : has_usage(use, BufferUsage::staging) ? MemoryPreference::host_writes
                                                                     : MemoryPreference::device,
                              name_, mapped_);
    if (texel_bytes == 0 || device.texels_in_storage()) return;
    VkBufferViewCreateInfo view{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
    view.buffer = buffer_;
    view.format = format;
    view.range = bytes_ / texel_bytes * texel_bytes;
    VkBufferView handle = VK_NULL_HANDLE;
    check_vk(vkCreateBufferView(device.handle(), &view, nullptr, &handle),
             "view buffer '" + name_ + "'");
    view_ = {device.handle(), handle};
}

void Buffer::write(std::uint64_t offset, std::span<const std::byte> data) {
    if (data.empty()) return;
    check(offset + data.size() <= bytes_, Failure::internal, "buffer '", name_, "' has ", bytes_,
          " bytes, a write wants [", offset, ", ", offset + data.size(), ")");
    if (mapped_) {
        std::memcpy(static_cast<std::byte*>(mapped_) + offset, data.data(), data.size());
        return;
    }
    upload_.set_ticket(*device_, device_->uploads().stage_write(buffer_, offset, data));
}

std::vector<std::byte> Buffer::read() const {
    std::vector<std::byte> data(bytes_);
    if (mapped_) {
        std::memcpy(data.data(), mapped_, bytes_);
        return data;
    }
    void* mapped = nullptr;
    const UniqueBuffer staging = make_buffer(*device_, bytes_, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                             "read-back");
    const UniqueMemory memory = allocate_memory(*device_, staging, MemoryPreference::host_reads,
                                                "read-back", mapped);
    copy_buffer(*device_, "read back buffer '" + name_ + "'", buffer_, staging, bytes_);
    std::memcpy(data.data(), mapped, bytes_);
    return data;
}

} // namespace catoptric::gpu
