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
    // Edges of the largest squares that end in this row and the one above, up to kPatch.
    std::vector<int> edges(static_cast<std::size_t>(grid.width)), above(edges.size());
    for (int y = 0; y < grid.height; ++y) {
        std::swap(edges, above);
        for (int x = 0; x < grid.width; ++x) {
            const auto i = static_cast<std::size_t>(x);
            edges[i] = 0;
            if (!grid.counts(x, y)) continue;
            const int before = x > 0 && y > 0 ? std::min({edges[i - 1], above[i], above[i - 1]})
                                              : 0;
            edges[i] = std::min(before + 1, kPatch);
            corners[grid.index(x, y)] = edges[i] == kPatch;
        }
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
    // From the outline inwards: as many wait as the set's edge is long, where the last found first
    // would let most of a large set wait.
    std::vector<std::pair<int, int>> open{{x, y}}, next;
    left[grid.index(x, y)] = 0;
    for (std::size_t i = 0; !open.empty(); ++i) {
        if (i == open.size()) {
            open.clear(), std::swap(open, next), i = 0;
            if (open.empty()) break;
        }
        const auto [at_x, at_y] = open[i];
        set.low_x = std::min(set.low_x, at_x), set.high_x = std::max(set.high_x, at_x);
        set.low_y = std::min(set.low_y, at_y), set.high_y = std::max(set.high_y, at_y);
        set.is_patch = set.is_patch || corners[grid.index(at_x, at_y)] != 0;
        for (int v = std::max(at_y - kReach, 0); v <= std::min(at_y + kReach, grid.height - 1); ++v)
            for (int u = std::max(at_x - kReach, 0); u <= std::min(at_x + kReach, grid.width - 1);
                 ++u) {
                if (left[grid.index(u, v)] == 0) continue;
                left[grid.index(u, v)] = 0;
                next.emplace_back(u, v);
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
