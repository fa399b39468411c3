#include "measure/lines.hpp"

#include "measure/metric.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace catoptric::measure {
namespace {

constexpr int kPatchEdge = 4; ///< edge of the square that makes a patch
/// Pixels dilated by 1 touch if their columns and rows differ by at most this.
constexpr int kTouchDistance = 3;

/// Returns a mask of the lower right corners of squares of kPatchEdge x
/// kPatchEdge pixels that all count.
Mask mask_patch_corners(const Mask& mask, std::size_t width) {
    Mask corners(mask.size());
    const std::size_t height = mask.size() / width;
    if (width < kPatchEdge || height < kPatchEdge) return corners;
    // For each of the last kPatchEdge rows: whether kPatchEdge adjacent
    // pixels count, the last of them at x.
    std::array<Mask, kPatchEdge> runs;
    runs.fill(Mask(width));
    for (std::size_t y = 0; y < height; ++y) {
        const std::uint8_t* const row = mask.data() + y * width;
        std::uint8_t* const run = runs[y % kPatchEdge].data();
        for (std::size_t x = kPatchEdge - 1; x < width; ++x)
            run[x] = (row[x] != 0) & (row[x - 1] != 0) & (row[x - 2] != 0) & (row[x - 3] != 0);
        std::uint8_t* const corner = corners.data() + y * width;
        if (y + 1 >= kPatchEdge)
            for (std::size_t x = 0; x < width; ++x)
                corner[x] = runs[0][x] & runs[1][x] & runs[2][x] & runs[3][x];
    }
    return corners;
}

/// Set of connected pixels: its bounding box, and its parent in a forest of merged sets.
struct PixelSet {
    int parent;
    int low_x, high_x, low_y, high_y;
    bool is_patch;

    int longest_side() const { return std::max(high_x - low_x, high_y - low_y) + 1; }
};

/// Disjoint sets of pixels, numbered from 0.
class PixelSets {
public:
    /// Adds a set of pixels of row `y` and returns its number.
    int add(int low_x, int high_x, int y, bool is_patch) {
        const int number = static_cast<int>(sets_.size());
        sets_.push_back({number, low_x, high_x, y, y, is_patch});
        return number;
    }

    void merge(int one, int other) {
        one = find_root(one), other = find_root(other);
        if (one == other) return;
        PixelSet &to = at(one), &from = at(other);
        to.low_x = std::min(to.low_x, from.low_x), to.high_x = std::max(to.high_x, from.high_x);
        to.low_y = std::min(to.low_y, from.low_y), to.high_y = std::max(to.high_y, from.high_y);
        to.is_patch = to.is_patch || from.is_patch;
        from.parent = one;
    }

    /// Returns the length of the longest set that is no patch, or 0.
    int find_longest_line() const {
        int longest = 0;
        for (std::size_t i = 0; i < sets_.size(); ++i)
            if (sets_[i].parent == static_cast<int>(i) && !sets_[i].is_patch)
                longest = std::max(longest, sets_[i].longest_side());
        return longest;
    }

private:
    PixelSet& at(int number) { return sets_[static_cast<std::size_t>(number)]; }
    /// Returns the set into which `number` was merged. Shortens the path for the next call.
    int find_root(int number) {
        while (at(number).parent != number)
            number = at(number).parent = at(at(number).parent).parent;
        return number;
    }

    std::vector<PixelSet> sets_;
};

/// Pixels of a row, each of which touches the next.
struct PixelRun {
    int low, high;
    int set;
};

/// Appends the runs of row `y` to `runs`, each as a set of its own.
void find_pixel_runs(const std::uint8_t* row, const std::uint8_t* corners, int width, int y,
                     PixelSets& sets, std::vector<PixelRun>& runs) {
    for (int x = 0; x < width; ++x) {
        if (row[x] == 0) continue;
        int high = x;
        for (int next = x + 1; next < width && next - high <= kTouchDistance; ++next)
            if (row[next] != 0) high = next;
        const bool is_patch = std::memchr(corners + x, 1, static_cast<std::size_t>(high - x + 1));
        runs.push_back({x, high, sets.add(x, high, y, is_patch)});
        x = high;
    }
}

/// Merges the sets of runs that touch. `one` and `other` are runs of two rows that are at most
/// kTouchDistance apart, from left to right.
void merge_touching_runs(const std::vector<PixelRun>& one, const std::vector<PixelRun>& other,
                         PixelSets& sets) {
    for (auto a = one.begin(), b = other.begin(); a != one.end() && b != other.end();) {
        // Pixels of a run are at most kTouchDistance apart, so no gap of a run holds a
        // pixel of another row that touches none of it.
        if (a->low <= b->high + kTouchDistance && b->low <= a->high + kTouchDistance)
            sets.merge(a->set, b->set);
        if (a->high < b->high)
            ++a;
        else
            ++b;
    }
}

const RegisteredMetric kLongestLineMetric{
    {.name = "longest_line",
     .unit = "pixels",
     .help = "length of the longest connected set of pixels that are off; sets that contain a 4x4 "
             "square do not count",
     .better = BetterDirection::less,
     .order = 105,
     .columns = {{"Longest line", ValueFormat::fixed, 0}},
     .get = [](const Difference& error) -> MetricValue { return error.longest_line; }}};

} // namespace

int longest_line_length(const Mask& off, int width) {
    if (off.empty()) return 0;
    const auto columns = static_cast<std::size_t>(width);
    const std::size_t height = off.size() / columns;
    const Mask corners = mask_patch_corners(off, columns);
    PixelSets sets;
    std::array<std::vector<PixelRun>, kTouchDistance + 1> last_rows;
    for (std::size_t y = 0; y < height; ++y) {
        std::vector<PixelRun>& runs = last_rows[y % last_rows.size()];
        runs.clear();
        find_pixel_runs(off.data() + y * columns, corners.data() + y * columns, width,
                        static_cast<int>(y), sets, runs);
        for (const std::vector<PixelRun>& above : last_rows)
            if (&above != &runs) merge_touching_runs(above, runs, sets);
    }
    return sets.find_longest_line();
}

} // namespace catoptric::measure
