#pragma once

#include "gpu/buffer.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace catoptric::render {

/// A list that stays on the device. Only what changed is written, and never what a frame in flight
/// reads: each slot (a frame in flight) binds one of the list's copies, those of equal contents the
/// same one. A list that never changes has one copy, one that changes at most as many as slots.
class Resident {
public:
    Resident(std::string name, gpu::BufferUse use, std::size_t slots)
        : name_(std::move(name)), use_(use), bound_(slots) {}

    /// The contents from the next `write` on. Costs a comparison; nothing changes where they equal
    /// those before. Returns whether something did.
    template <typename T>
    bool set(const std::vector<T>& data) {
        return set(data, 0, data.size());
    }
    /// The same, where only entries from `first` to before `end` may be others than those set last:
    /// compares no others.
    template <typename T>
    bool set(const std::vector<T>& data, std::size_t first, std::size_t end) {
        return set(std::as_bytes(std::span(data)), first * sizeof(T), end * sizeof(T));
    }
    /// Makes slot `slot`, of which no frame is in flight, bind the contents. Returns how often the
    /// device's memory was written. Throws as gpu::Buffer does.
    std::size_t write(gpu::Device& device, std::size_t slot);
    /// What `write` made for the slot.
    const gpu::Buffer& at(std::size_t slot) const { return copies_[*bound_[slot]].buffer; }
    std::size_t copy_count() const { return copies_.size(); }

private:
    struct Copy {
        gpu::Buffer buffer;
        std::uint64_t version = 0;
    };

    bool set(std::span<const std::byte> data, std::size_t first, std::size_t end);
    std::size_t free_copy(std::size_t slot);

    std::string name_;
    gpu::BufferUse use_;
    std::vector<std::byte> data_;
    std::vector<std::uint64_t> pages_; ///< version at which each part of `data_` changed last
    std::uint64_t version_ = 1;
    std::vector<Copy> copies_;
    std::vector<std::optional<std::size_t>> bound_; ///< copy, by slot
};

} // namespace catoptric::render
