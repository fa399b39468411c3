#include "core/error.hpp"
#include "measure/causes.hpp"
#include "measure/masks.hpp"

#include <algorithm>

namespace catoptric::measure {

namespace {

/// Sums of a value over the pixels of each class.
struct PixelClassSums {
    double first_order = 0, mirror_in_mirror = 0;
    std::vector<double> per_mirror;
    double all() const { return first_order + mirror_in_mirror; }
};

/// Mirror pixels and which of them count.
struct MirrorPixels {
    std::span<const std::uint32_t> hits; ///< first hits of the whole picture
    std::vector<std::size_t> places;     ///< indices of mirror pixels in the picture
    std::vector<bool> counts;            ///< whether each of `places` counts
    std::size_t mirrors = 0;

    PixelClassSums sums(std::span<const double> values) const {
        PixelClassSums sums;
        sums.per_mirror.resize(mirrors);
        for (std::size_t i = 0; i < places.size(); ++i) {
            if (!counts[i]) continue;
            const std::uint32_t hit = hits[places[i]];
            (second_mirror_of_hit(hit) ? sums.mirror_in_mirror : sums.first_order) += values[i];
            sums.per_mirror[first_mirror_of_hit(hit).index()] += values[i];
        }
        return sums;
    }
};

MirrorPixels list_counted_pixels(std::span<const std::uint32_t> hits, std::span<const double> whole,
                                 const std::vector<PixelCause>& causes) {
    MirrorPixels pixels{hits, list_mirror_pixels(hits), {}, 0};
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
        pixels.mirrors = std::max<std::size_t>(
            pixels.mirrors, first_mirror_of_hit(hits[pixels.places[i]]).number());
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

std::vector<std::uint8_t> mark_largest_cause(const MirrorPixels& pixels, const Mask& off,
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

std::vector<std::size_t> list_mirror_pixels(std::span<const std::uint32_t> hits) {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < hits.size(); ++i)
        if (first_mirror_of_hit(hits[i])) places.push_back(i);
    return places;
}

Causes sum_up_error_causes(std::span<const std::uint32_t> hits, const Mask& off,
                           std::span<const double> whole, const std::vector<PixelCause>& causes) {
    const MirrorPixels pixels = list_counted_pixels(hits, whole, causes);
    const PixelClassSums counts = pixels.sums(std::vector<double>(whole.size(), 1.0)),
                         row = pixels.sums(whole);
    if (counts.all() == 0) return {};
    const auto mean = [&](const PixelClassSums& sums) { return sums.all() / counts.all(); };
    Causes result{.squared_error = mean(row),
                  .squared_error_per_mirror = mean_per_mirror(row.per_mirror, counts.per_mirror),
                  .largest = mark_largest_cause(pixels, off, causes)};
    for (const PixelCause& cause : causes) {
        const PixelClassSums part = pixels.sums(cause.part);
        Cause& summed = result.list.emplace_back(Cause{.name = cause.name});
        summed.squared_error = mean(part);
        const auto share = [&](double sum) { return row.all() > 0 ? sum / row.all() : NAN; };
        summed.share = share(part.all());
        summed.share_first_order = share(part.first_order);
        summed.share_mirror_in_mirror = share(part.mirror_in_mirror);
        for (const double sum : part.per_mirror) summed.share_per_mirror.push_back(share(sum));
        if (cause.alone.empty()) continue;
        const PixelClassSums alone = pixels.sums(cause.alone);
        summed.alone = mean(alone);
        summed.alone_per_mirror = mean_per_mirror(alone.per_mirror, counts.per_mirror);
    }
    // Rounding may make a rest of 0 slightly negative.
    result.rest_rmse = std::sqrt(std::max(result.list.back().squared_error, 0.0));
    return result;
}

} // namespace catoptric::measure
