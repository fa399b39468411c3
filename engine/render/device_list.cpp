#include "render/device_list.hpp"

#include <algorithm>
#include <cstring>

namespace catoptric::render {

namespace {

constexpr std::size_t kPageBytes = 16384; // size of a block that is compared and written as
                                          // a whole

std::size_t count_pages(std::size_t bytes) { return (bytes + kPageBytes - 1) / kPageBytes; }

} // namespace

bool DeviceList::set(std::span<const std::byte> data, std::size_t from, std::size_t to) {
    const std::size_t kept = std::min(data.size(), data_.size());
    const std::uint64_t next = version_ + 1;
    bool changed = data.size() != data_.size();
    data_.resize(data.size());
    pages_.resize(count_pages(data.size()), next);
    if (changed) from = 0, to = data.size();
    for (std::size_t page = from / kPageBytes; page < count_pages(to); ++page) {
        const std::size_t first = page * kPageBytes,
                          end = std::min(first + kPageBytes, data.size());
        if (end <= kept && std::memcmp(&data_[first], &data[first], end - first) == 0) continue;
        std::memcpy(&data_[first], &data[first], end - first);
        pages_[page] = next;
        changed = true;
    }
    if (changed) version_ = next;
    return changed;
}

/// Returns the index of a copy of the list that no other slot (frame in flight) reads.
std::size_t DeviceList::find_free_copy(std::size_t slot) {
    const auto is_free = [&](std::size_t copy) {
        for (std::size_t other = 0; other < bound_.size(); ++other)
            if (other != slot && bound_[other] == copy) return false;
        return true;
    };
    if (bound_[slot] && is_free(*bound_[slot])) return *bound_[slot];
    for (std::size_t copy = 0; copy < copies_.size(); ++copy)
        if (is_free(copy)) return copy;
    copies_.emplace_back();
    return copies_.size() - 1;
}

std::size_t DeviceList::write(gpu::Device& device, std::size_t slot) {
    const auto current = std::ranges::find(copies_, version_, &Copy::version);
    if (current != copies_.end()) {
        bound_[slot] = static_cast<std::size_t>(current - copies_.begin());
        return 0;
    }
    const std::size_t place = find_free_copy(slot);
    Copy& copy = copies_[place];
    if (!copy.buffer.handle() || copy.buffer.bytes() < data_.size()) {
        copy = {};
        copy.buffer = gpu::Buffer(device, name_, data_.size(), use_);
    }
    std::size_t writes = 0;
    for (std::size_t page = 0; page < pages_.size();) {
        const std::size_t first = page;
        while (page < pages_.size() && pages_[page] > copy.version) ++page;
        if (page == first) {
            ++page;
            continue;
        }
        const std::size_t end = std::min(page * kPageBytes, data_.size());
        copy.buffer.write(first * kPageBytes,
                          std::span(data_).subspan(first * kPageBytes, end - first * kPageBytes));
        ++writes;
    }
    copy.version = version_;
    bound_[slot] = place;
    return writes;
}

} // namespace catoptric::render
