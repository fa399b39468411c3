#include "measure/lines.hpp"

#include "measure/quantity.hpp"

#include <algorithm>

namespace catoptric::measure {
namespace {

constexpr int kPatch = 4; ///< edge of the square that makes a patch
constexpr int kReach =
    3; ///< two pixels dilated by 1 touch where their columns and rows are so near

/// A mask as columns and rows; outside nothing counts.
struct Grid {
    const Mask& mask;
    int width, height;

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    }
    bool counts(int x, int y) const { return mask[index(x, y)] != 0; }
};

/// Where a square of kPatch x kPatch pixels that count ends, at its lower right.
Mask patch_corners(const Grid& grid) {
    Mask corners(grid.mask.size());
    std::vector<int> edge(grid.mask.size()); // of the largest square that ends there, up to kPatch
    for (int y = 0; y < grid.height; ++y)
        for (int x = 0; x < grid.width; ++x) {
            if (!grid.counts(x, y)) continue;
            int before = 0;
            if (x > 0 && y > 0)
                before = std::min({edge[grid.index(x - 1, y)], edge[grid.index(x, y - 1)],
                                   edge[grid.index(x - 1, y - 1)]});
            edge[grid.index(x, y)] = std::min(before + 1, kPatch);
            corners[grid.index(x, y)] = edge[grid.index(x, y)] == kPatch;
        }
    return corners;
}

/// Pixels that belong together.
struct Set {
    int low_x, high_x, low_y, high_y;
    bool is_patch = false;

    int length() const { return std::max(high_x - low_x, high_y - low_y) + 1; }
};

/// The set of pixel (x, y), which is taken out of `left`.
Set take_set(const Grid& grid, const Mask& corners, Mask& left, int x, int y) {
    Set set{x, x, y, y};
    std::vector<std::pair<int, int>> open{{x, y}};
    left[grid.index(x, y)] = 0;
    while (!open.empty()) {
        const auto [at_x, at_y] = open.back();
        open.pop_back();
        set.low_x = std::min(set.low_x, at_x), set.high_x = std::max(set.high_x, at_x);
        set.low_y = std::min(set.low_y, at_y), set.high_y = std::max(set.high_y, at_y);
        set.is_patch = set.is_patch || corners[grid.index(at_x, at_y)] != 0;
        for (int v = std::max(at_y - kReach, 0); v <= std::min(at_y + kReach, grid.height - 1); ++v)
            for (int u = std::max(at_x - kReach, 0); u <= std::min(at_x + kReach, grid.width - 1);
                 ++u) {
                if (left[grid.index(u, v)] == 0) continue;
                left[grid.index(u, v)] = 0;
                open.emplace_back(u, v);
            }
    }
    return set;
}

const Registered kLongestLine{
    {.name = "longest_line",
     .unit = "pixels",
     .help =
         "length of the longest line of pixels that are off: of sets that touch when dilated by "
         "1, among those without a 4x4 square",
     .better = Better::less,
     .order = 105,
     .columns = {{"Longest line", Style::fixed, 0}},
     .get = [](const Difference& error) -> Value { return error.longest_line; }}};

} // namespace

int longest_line(const Mask& off, int width) {
    if (off.empty()) return 0;
    const Grid grid{off, width, static_cast<int>(off.size()) / width};
    const Mask corners = patch_corners(grid);
    Mask left = off;
    int longest = 0;
    for (int y = 0; y < grid.height; ++y)
        for (int x = 0; x < grid.width; ++x) {
            if (left[grid.index(x, y)] == 0) continue;
            const Set set = take_set(grid, corners, left, x, y);
            if (!set.is_patch) longest = std::max(longest, set.length());
        }
    return longest;
}

} // namespace catoptric::measure
