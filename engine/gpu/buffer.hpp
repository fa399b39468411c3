#pragma once

#include "gpu/device.hpp"
#include "gpu/uploads.hpp"

#include <cstring>
#include <span>

namespace catoptric::gpu {

/// Uses of a buffer. Every buffer is also a storage buffer and a source and target of copies.
/// `read_back`: the device writes and the host reads, so it lies in the host's memory.
enum class BufferUsage : std::uint32_t {
    plain = 0,
    vertex = 1,
    index = 2,
    uniform = 4,
    texels = 8, ///< texel buffer of four floats per texel
    read_back = 16,
    words = 32,   ///< texel buffer of one unsigned integer per texel
    quads = 64,   ///< texel buffer of four unsigned integers per texel
    staging = 128 ///< the host writes and copies read, so it lies in the host's memory
};
constexpr BufferUsage operator|(BufferUsage a, BufferUsage b) {
    return static_cast<BufferUsage>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
constexpr bool has_usage(BufferUsage set, BufferUsage bit) {
    return static_cast<std::uint32_t>(set) & static_cast<std::uint32_t>(bit);
}

/// A buffer that the device reads and the host may write between frames.
class Buffer {
public:
    Buffer() = default;
    /// Allocates at least 16 bytes, so that an empty list can still be bound. Throws `exhausted`,
    /// naming the bytes or the device's limit for texel buffers.
    Buffer(Device& device, std::string name, std::uint64_t bytes, BufferUsage use);

    /// Copies `data` to `offset`, in bytes. Must not be called while a frame that reads the buffer
    /// is in flight. If device memory cannot be mapped, the copy goes through Uploads. Work
    /// submitted from now on sees the data.
    void write(std::uint64_t offset, std::span<const std::byte> data);
    template <typename T>
    void write(std::span<const T> data) {
        write(0, std::as_bytes(data));
    }
    /// The device must have finished writing.
    std::vector<std::byte> read() const;

    const std::string& name() const { return name_; }
    std::uint64_t bytes() const { return bytes_; }
    VkBuffer handle() const { return buffer_; }
    VkBufferView texel_view() const { return view_; }

private:
    Device* device_ = nullptr;
    std::string name_;
    std::uint64_t bytes_ = 0;
    UniqueMemory memory_; // declared before the buffer, so destroyed after the buffer
    UniqueBuffer buffer_;
    UniqueBufferView view_;
    PendingUpload upload_; // declared after the buffer, so destroyed before the buffer
    void* mapped_ = nullptr;
};

/// If `data` does not fit, a new buffer of the same name replaces `buffer`.
template <typename T>
void upload(Device& device, Buffer& buffer, const std::string& name, const std::vector<T>& data,
            BufferUsage use) {
    const std::uint64_t bytes = data.size() * sizeof(T);
    if (buffer.bytes() < bytes || !buffer.handle()) buffer = Buffer(device, name, bytes, use);
    buffer.write(std::span<const T>(data));
}

} // namespace catoptric::gpu
