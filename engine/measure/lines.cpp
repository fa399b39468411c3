#include "measure/lines.hpp"

#include "measure/metric.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

namespace catoptric::measure {
namespace {

constexpr int kPatchEdge = 4; ///< edge of the square that makes a patch
/// Pixels dilated by 1 touch if their columns and rows differ by at most this.
constexpr int kPixelBorder = 3;

/// Returns a mask of the lower right corners of squares of kPatchEdge x kPatchEdge pixels that all
/// count.
Mask mask_patch_corners(const Mask& mask, std::size_t width) {
    Mask corners(mask.size());
    const std::size_t height = mask.size() / width;
    if (width < kPatchEdge || height < kPatchEdge) return corners;
    // For each of the last kPatchEdge rows: whether kPatchEdge adjacent pixels count, the last of
    // them at x.
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

/// Pixels that belong to no set yet, with a border of pixels that do not count.
class RemainingPixels {
public:
    RemainingPixels(const Mask& mask, std::size_t width)
        : stride_(width + 2 * kPixelBorder),
          pixels_(stride_ * (mask.size() / width + 2 * kPixelBorder)) {
        for (std::size_t first = 0, y = 0; first < mask.size(); first += width, ++y)
            std::copy_n(mask.begin() + static_cast<std::ptrdiff_t>(first), width,
                        pixels_.begin() +
                            static_cast<std::ptrdiff_t>((y + kPixelBorder) * stride_) +
                            kPixelBorder);
    }

    std::uint8_t& at(int x, int y) { return row(y)[x + kPixelBorder]; }

    /// Removes the pixels that (x, y) touches and calls `found` for each, row by row.
    template <typename Found>
    void take_around(int x, int y, Found&& found) {
        for (int v = y - kPixelBorder; v <= y + kPixelBorder; ++v) {
            // Points to column x - kPixelBorder, because rows have a border.
            std::uint8_t* const around = row(v) + x;
            if ((four(around) | four(around + kPixelBorder)) == 0) continue;
            for (int i = 0; i <= 2 * kPixelBorder; ++i) {
                if (around[i] == 0) continue;
                around[i] = 0;
                found(x - kPixelBorder + i, v);
            }
        }
    }

private:
    std::uint8_t* row(int y) {
        return pixels_.data() + static_cast<std::size_t>(y + kPixelBorder) * stride_;
    }
    static std::uint32_t four(const std::uint8_t* pixels) {
        std::uint32_t result;
        std::memcpy(&result, pixels, sizeof(result));
        return result;
    }

    std::size_t stride_;
    Mask pixels_;
};

/// Bounding box of a set of connected pixels.
struct PixelSetBounds {
    int low_x, high_x, low_y, high_y;
    bool is_patch = false;

    int length() const { return std::max(high_x - low_x, high_y - low_y) + 1; }
};

/// Removes the set of pixel (x, y) from `remaining` and returns it.
PixelSetBounds remove_connected_set(const Mask& corners, std::size_t width,
                                    RemainingPixels& remaining, int x, int y) {
    PixelSetBounds set{x, x, y, y};
    // Breadth first: only as many pixels wait as the set's edge is long. Depth first, most of a
    // large set would wait.
    std::vector<std::pair<int, int>> open{{x, y}}, next;
    remaining.at(x, y) = 0;
    for (std::size_t i = 0; !open.empty(); ++i) {
        if (i == open.size()) {
            open.clear(), std::swap(open, next), i = 0;
            if (open.empty()) break;
        }
        const auto [at_x, at_y] = open[i];
        set.low_x = std::min(set.low_x, at_x), set.high_x = std::max(set.high_x, at_x);
        set.low_y = std::min(set.low_y, at_y), set.high_y = std::max(set.high_y, at_y);
        set.is_patch =
            set.is_patch ||
            corners[static_cast<std::size_t>(at_y) * width + static_cast<std::size_t>(at_x)] != 0;
        remaining.take_around(at_x, at_y, [&](int u, int v) { next.emplace_back(u, v); });
    }
    return set;
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
    const int height = static_cast<int>(off.size() / columns);
    const Mask corners = mask_patch_corners(off, columns);
    RemainingPixels remaining(off, columns);
    int longest = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            if (remaining.at(x, y) == 0) continue;
            const PixelSetBounds set = remove_connected_set(corners, columns, remaining, x, y);
            if (!set.is_patch) longest = std::max(longest, set.length());
        }
    return longest;
}

} // namespace catoptric::measure
