#pragma once

#include "gpu/buffer.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace catoptric::render {

/// A list that stays on the device. Writes only what changed, and never what a frame in flight
/// reads. Each slot (a frame in flight) binds one of several copies of the list; slots with equal
/// contents bind the same copy. A list that never changes has one copy. A changing list has at most
/// one a slot.
class DeviceList {
public:
    DeviceList(std::string name, gpu::BufferUsage use, std::size_t slots)
        : name_(std::move(name)), use_(use), bound_(slots) {}

    /// Sets the contents for the next `write`. Returns whether they differ from the
    /// last contents; equal contents change nothing. Costs a comparison.
    template <typename T>
    bool set(const std::vector<T>& data) {
        return set(data, 0, data.size());
    }
    /// Sets the contents, of which only entries from `first` up to, not including, `end` may differ
    /// from the last ones. Compares only these entries.
    template <typename T>
    bool set(const std::vector<T>& data, std::size_t first, std::size_t end) {
        return set(std::as_bytes(std::span(data)), first * sizeof(T), end * sizeof(T));
    }
    /// Writes the current contents for slot `slot` (a frame in flight). No frame may be in flight
    /// in this slot. Returns the number of writes to device memory. Throws as gpu::Buffer does.
    std::size_t write(gpu::Device& device, std::size_t slot);
    /// Returns the buffer that `write` chose for the slot.
    const gpu::Buffer& buffer(std::size_t slot) const { return copies_[*bound_[slot]].buffer; }
    std::size_t copy_count() const { return copies_.size(); }

private:
    struct Copy {
        gpu::Buffer buffer;
        std::uint64_t version = 0;
    };

    bool set(std::span<const std::byte> data, std::size_t first, std::size_t end);
    std::size_t find_free_copy(std::size_t slot);

    std::string name_;
    gpu::BufferUsage use_;
    std::vector<std::byte> data_;
    std::vector<std::uint64_t> pages_; ///< version of the last change of each page of `data_`
    std::uint64_t version_ = 1;
    std::vector<Copy> copies_;
    std::vector<std::optional<std::size_t>> bound_; ///< copy, by slot
};

} // namespace catoptric::render
