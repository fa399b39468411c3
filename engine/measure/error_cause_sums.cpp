#include "core/error.hpp"
#include "measure/causes.hpp"
#include "measure/masks.hpp"

#include <algorithm>

namespace catoptric::measure {

namespace {

/// Sums of a value over the pixels of each class.
struct BounceSums {
    double first_order = 0, mirror_in_mirror = 0;
    std::vector<double> per_mirror;
    double total() const { return first_order + mirror_in_mirror; }
};

/// The mirror pixels of a picture, and which of them are counted.
struct FiniteMirrorPixels {
    std::span<const std::uint32_t> hits; ///< first hits of the whole picture
    std::vector<std::size_t> places;     ///< indices of mirror pixels in the picture
    std::vector<bool> counts;            ///< whether each pixel of `places` is counted
    std::size_t mirrors = 0;

    BounceSums sum_by_bounce(std::span<const double> values) const {
        BounceSums sums;
        sums.per_mirror.resize(mirrors);
        for (std::size_t i = 0; i < places.size(); ++i) {
            if (!counts[i]) continue;
            const std::uint32_t hit = hits[places[i]];
            (second_mirror(hit) ? sums.mirror_in_mirror : sums.first_order) += values[i];
            sums.per_mirror[first_mirror(hit).index()] += values[i];
        }
        return sums;
    }
};

FiniteMirrorPixels counted_pixels(std::span<const std::uint32_t> hits,
                                  std::span<const double> whole,
                                  const std::vector<PixelCause>& causes) {
    FiniteMirrorPixels pixels{hits, mirror_pixels(hits), {}, 0};
    const auto check_size = [&](std::size_t size, const std::string& what) {
        check(size == pixels.places.size(), Failure::internal, what, ": wanted values of ",
              pixels.places.size(), " mirror pixels, found ", size);
    };
    check_size(whole.size(), "squared errors");
    for (const PixelCause& cause : causes) {
        check_size(cause.part.size(), cause.name);
        if (!cause.alone.empty()) check_size(cause.alone.size(), cause.name + " alone");
    }
    for (std::size_t i = 0; i < pixels.places.size(); ++i) {
        pixels.mirrors = std::max<std::size_t>(pixels.mirrors,
                                               first_mirror(hits[pixels.places[i]]).number());
        pixels.counts.push_back(std::isfinite(whole[i]) &&
                                std::ranges::all_of(causes, [i](const PixelCause& cause) {
                                    return std::isfinite(cause.part[i]) &&
                                           (cause.alone.empty() || std::isfinite(cause.alone[i]));
                                }));
    }
    return pixels;
}

/// Returns the mean over the pixels of each mirror, 0 for a mirror without pixels.
std::vector<double> mean_per_mirror(const std::vector<double>& sums,
                                    const std::vector<double>& counts) {
    std::vector<double> means(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i)
        if (counts[i] > 0) means[i] = sums[i] / counts[i];
    return means;
}

std::vector<std::uint8_t> mark_largest_cause(const FiniteMirrorPixels& pixels, const Mask& off,
                                             const std::vector<PixelCause>& causes) {
    std::vector<std::uint8_t> largest(pixels.hits.size());
    for (std::size_t i = 0; i < pixels.places.size(); ++i) {
        if (!pixels.counts[i] || off[pixels.places[i]] == 0) continue;
        const auto most = std::ranges::max_element(
            causes, {}, [i](const PixelCause& cause) { return cause.part[i]; });
        largest[pixels.places[i]] = static_cast<std::uint8_t>(most - causes.begin() + 1);
    }
    return largest;
}

} // namespace

std::vector<std::size_t> mirror_pixels(std::span<const std::uint32_t> hits) {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < hits.size(); ++i)
        if (first_mirror(hits[i])) places.push_back(i);
    return places;
}

Causes summarise_causes(std::span<const std::uint32_t> hits, const Mask& off,
                        std::span<const double> whole, const std::vector<PixelCause>& causes) {
    const FiniteMirrorPixels pixels = counted_pixels(hits, whole, causes);
    const BounceSums counts = pixels.sum_by_bounce(std::vector<double>(whole.size(), 1.0)),
                     row = pixels.sum_by_bounce(whole);
    if (counts.total() == 0) return {};
    const auto mean = [&](const BounceSums& sums) { return sums.total() / counts.total(); };
    Causes result{.squared_error = mean(row),
                  .squared_error_per_mirror = mean_per_mirror(row.per_mirror, counts.per_mirror),
                  .largest = mark_largest_cause(pixels, off, causes)};
    for (const PixelCause& cause : causes) {
        const BounceSums part = pixels.sum_by_bounce(cause.part);
        CauseShare& summed = result.list.emplace_back(CauseShare{.name = cause.name});
        summed.squared_error = mean(part);
        const auto share = [&](double sum) { return row.total() > 0 ? sum / row.total() : NAN; };
        summed.share = share(part.total());
        summed.share_first_order = share(part.first_order);
        summed.share_mirror_in_mirror = share(part.mirror_in_mirror);
        for (const double sum : part.per_mirror) summed.share_per_mirror.push_back(share(sum));
        if (cause.alone.empty()) continue;
        const BounceSums alone = pixels.sum_by_bounce(cause.alone);
        summed.alone = mean(alone);
        summed.alone_per_mirror = mean_per_mirror(alone.per_mirror, counts.per_mirror);
    }
    // By rounding, a rest of 0 may be slightly negative.
    result.rest_rmse = std::sqrt(std::max(result.list.back().squared_error, 0.0));
    return result;
}

} // namespace catoptric::measure
