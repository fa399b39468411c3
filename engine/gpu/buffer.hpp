#pragma once

#include "gpu/device.hpp"
#include "gpu/uploads.hpp"

#include <cstring>
#include <span>

namespace catoptric::gpu {

/// What a buffer is for, beside being a storage buffer and a source and target of copies.
/// `read_back`: filled by the device for the host, and so in the host's memory.
enum class BufferUse : std::uint32_t {
    plain = 0,
    vertex = 1,
    index = 2,
    uniform = 4,
    texels = 8, ///< of four floats
    read_back = 16,
    words = 32,   ///< texels of a whole number
    quads = 64,   ///< texels of four whole numbers
    staging = 128 ///< filled by the host for copies, and so in the host's memory
};
constexpr BufferUse operator|(BufferUse a, BufferUse b) {
    return static_cast<BufferUse>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
constexpr bool has(BufferUse set, BufferUse bit) {
    return static_cast<std::uint32_t>(set) & static_cast<std::uint32_t>(bit);
}

/// Memory that the device reads and the host may write between frames.
class Buffer {
public:
    Buffer() = default;
    /// At least 16 bytes are made, so that an empty list can still be bound.
    /// Throws `exhausted` naming the bytes, or the limit for texel buffers.
    Buffer(Device& device, std::string name, std::uint64_t bytes, BufferUse use);

    /// Copies `data` to `offset`. Where device memory cannot be mapped, the bytes are there for all
    /// that is submitted from now on (Uploads).
    /// Not while a frame that reads the buffer is in flight.
    void write(std::uint64_t offset, std::span<const std::byte> data);
    template <typename T>
    void write(std::span<const T> data) {
        write(0, std::as_bytes(data));
    }
    /// Contents, after the device has finished.
    std::vector<std::byte> read() const;

    const std::string& name() const { return name_; }
    std::uint64_t bytes() const { return bytes_; }
    VkBuffer handle() const { return buffer_; }
    VkBufferView texels() const { return view_; }

private:
    Device* device_ = nullptr;
    std::string name_;
    std::uint64_t bytes_ = 0;
    UniqueMemory memory_; // before the buffer: destroyed after it
    UniqueBuffer buffer_;
    UniqueBufferView view_;
    PendingUpload upload_; // after the buffer: destroyed before it
    void* mapped_ = nullptr;
};

/// Grows `buffer` (a new one with the same name) when `data` does not fit, then writes it.
template <typename T>
void upload(Device& device, Buffer& buffer, const std::string& name, const std::vector<T>& data,
            BufferUse use) {
    const std::uint64_t bytes = data.size() * sizeof(T);
    if (buffer.bytes() < bytes || !buffer.handle()) buffer = Buffer(device, name, bytes, use);
    buffer.write(std::span<const T>(data));
}

} // namespace catoptric::gpu
