#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace catoptric::graph {

/// A value for each of `size` cells, stored as runs: neighbouring cells of equal value are one
/// entry. Queries and changes cost as many steps as they meet runs, however long the runs are. No
/// memory is allocated until the first change.
template <typename T>
class RunLengthArray {
public:
    explicit RunLengthArray(std::uint32_t size = 0, const T& value = {})
        : size_(size), initial_(value) {}

    /// Calls visit(begin, end, value) for each run in cells [first, end), from the lowest.
    template <typename Visit>
    void for_each_run(std::uint32_t first, std::uint32_t end, const Visit& visit) const {
        if (first >= end) return;
        if (runs_.empty()) return visit(first, end, initial_);
        for (std::size_t i = find_run(first); i < runs_.size() && runs_[i].begin < end; ++i)
            visit(std::max(first, runs_[i].begin), std::min(end, run_end(i)), runs_[i].value);
    }
    template <typename Visit>
    void for_each_run(const Visit& visit) const {
        for_each_run(0, size_, visit);
    }

    /// Calls visit(begin, end, value) for each run in cells [first, end), with values that it may
    /// change.
    template <typename Visit>
    void modify_runs(std::uint32_t first, std::uint32_t end, const Visit& visit) {
        if (first >= end) return;
        if (runs_.empty()) runs_.push_back({0, initial_});
        const std::size_t from = split_at(first), to = split_at(end);
        for (std::size_t i = from; i < to; ++i) visit(runs_[i].begin, run_end(i), runs_[i].value);
        merge_runs(from == 0 ? 0 : from - 1, std::min(to + 1, runs_.size()));
    }
    void fill(std::uint32_t first, std::uint32_t end, const T& value) {
        modify_runs(first, end, [&](std::uint32_t, std::uint32_t, T& old) { old = value; });
    }

    bool has_any(std::uint32_t first, std::uint32_t end, const T& value) const {
        bool found = false;
        for_each_run(first, end,
                     [&](std::uint32_t, std::uint32_t, const T& v) { found |= v == value; });
        return found;
    }

    std::uint32_t size() const { return size_; }

private:
    struct ValueRun {
        std::uint32_t begin;
        T value;
    };

    std::uint32_t run_end(std::size_t run) const {
        return run + 1 < runs_.size() ? runs_[run + 1].begin : size_;
    }
    std::size_t find_run(std::uint32_t cell) const {
        const auto after = std::ranges::upper_bound(runs_, cell, {}, &ValueRun::begin);
        return static_cast<std::size_t>(after - runs_.begin()) - 1;
    }
    /// Splits a run so that one begins at the cell, and returns its index.
    std::size_t split_at(std::uint32_t cell) {
        if (cell >= size_) return runs_.size();
        const std::size_t run = find_run(cell);
        if (runs_[run].begin == cell) return run;
        const ValueRun second{cell, runs_[run].value};
        runs_.insert(runs_.begin() + static_cast<std::ptrdiff_t>(run) + 1, second);
        return run + 1;
    }
    void merge_runs(std::size_t from, std::size_t to) {
        const auto first = runs_.begin() + static_cast<std::ptrdiff_t>(from);
        const auto last = runs_.begin() + static_cast<std::ptrdiff_t>(to);
        runs_.erase(
            std::unique(first, last,
                        [](const ValueRun& a, const ValueRun& b) { return a.value == b.value; }),
            last);
    }

    std::uint32_t size_;
    T initial_;
    std::vector<ValueRun> runs_; // the first begins at 0; empty: all cells have the initial value
};

} // namespace catoptric::graph
