// Filtered levels of captures. `mips` takes the mean of each square of texels: level m has faces of
// edge / 2^m texels. `prefilter` filters the capture by the GGX lobe of each level's width
// (shaders/lib/math/rough.glsl), with samples that read the box-filtered chain. A lobe reaches over
// many texels, so a level m with faces of edge / 2^(m + 1) texels shows it. `fast` takes few
// samples, with fitted places and weights, in the levels of narrow lobes, which have most of the
// texels.
#include "reflect/rough.hpp"

#include "core/content_hash.hpp"
#include "core/shader_math.hpp"
#include "reflect/captures.hpp"
#include "render/box_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace catoptric::reflect {

namespace {

using graph::ImageHandle;
using graph::ResourceUse;
using RoughLookup = RoughKnobs::Lookup;

/// Returns the face edge of a level, from 1, in texels.
std::uint32_t face_edge(RoughLookup rough, std::uint32_t face, std::uint32_t level) {
    return graph::mip_size(face, rough == RoughLookup::mips ? level : level + 1);
}

/// Returns the number of filtered levels of a capture, without the capture itself. The last
/// box-filtered level has one texel per face. The last prefiltered level is the first whose lobe
/// has an alpha of at least 1.
std::uint32_t count_levels(RoughLookup rough, std::uint32_t face) {
    std::uint32_t level = 1;
    while (face_edge(rough, face, level) > 1 &&
           (rough == RoughLookup::mips ||
            f32::alpha_of_capture_level(static_cast<float>(level), static_cast<float>(face)) < 1))
        ++level;
    return level;
}

/// Consecutive cubes of one array, and the levels that are computed from them.
struct LevelRange {
    ImageHandle captured, boxes, levels;
    std::uint32_t face = 0;
};

/// Returns an image for the levels of an array of captures.
graph::ImageDesc make_level_desc(std::string name, const render::CubeCaptureArray& cubes,
                                 RoughLookup rough) {
    const std::uint32_t edge = face_edge(rough, cubes.face, 1);
    return {std::move(name),
            TexelFormat::rgba16f,
            edge,
            edge,
            cubes.colour.layer_count,
            true,
            count_levels(rough, cubes.face)};
}

/// Returns the number of compute work groups along an edge of a level's faces.
std::uint32_t count_edge_groups(std::uint32_t edge) { return (edge + 7) / 8; }

/// Push constants of rough/prefilter.comp.
struct PrefilterParameters {
    float alpha;
    std::uint32_t rings; ///< number of rings of four samples each
};

/// Samples of rough/fast.comp, for a lobe of width alpha 1. Angles are in alphas, and levels are
/// relative to the level of the box-filtered chain whose texels are as wide as alpha. The four
/// samples of a ring share its weight.
struct FittedLobeRing {
    float angle, level, weight;
};
struct FittedLobe {
    float middle_level, middle_weight;
    std::array<FittedLobeRing, 3> rings;
    std::uint32_t ring_count;
};
/// Fitted by bench/rough/fit_rings.py to six pictures of edges, noise and bright lamps, filtered by
/// lobes of 4 and 8 texels. The rms of the error, relative to the value plus .2, is .032 and .019.
/// Samples of rough/prefilter.comp have .053 (8 samples), .035 (16), .020 (32).
constexpr FittedLobe kFiveSamples{1, .572F, {{{2.745F, 2, .428F}, {}, {}}}, 1},
    kThirteenSamples{0, .109F, {{{1.358F, 1, .61F}, {3.55F, 2, .198F}, {8.139F, 3, .083F}}}, 3};
constexpr float kLargestFittedAlpha = .15F; ///< wider lobes are not round in the tangent plane

/// Push constants of rough/fast.comp.
struct FastFilterParameters {
    struct Ring {
        float sine, cosine, from, weight;
    };
    std::array<Ring, 3> rings;
    float middle_from, middle_weight;
    std::uint32_t ring_count;
};

/// Returns the samples of a level, from 1, of a lobe of width `alpha`. Each sample is also weighted
/// by its cosine to the lobe's axis, as in rough/prefilter.comp.
FastFilterParameters make_fast_filter(float alpha, std::uint32_t level) {
    const FittedLobe& lobe = level == 1 ? kFiveSamples : kThirteenSamples;
    // The texels of box-filtered level m + 1 are as wide as the lobe of level m. Level 1 is mip 0.
    const auto mip_of_wide_texels = static_cast<float>(level);
    FastFilterParameters samples{.rings = {},
                                 .middle_from = mip_of_wide_texels + lobe.middle_level,
                                 .middle_weight = lobe.middle_weight,
                                 .ring_count = lobe.ring_count};
    float sum = lobe.middle_weight;
    for (std::size_t i = 0; i < lobe.ring_count; ++i) {
        const FittedLobeRing& ring = lobe.rings[i];
        const float angle = 2 * std::atan(alpha * ring.angle / 2), cosine = std::cos(angle);
        samples.rings[i] = {std::sin(angle), cosine, mip_of_wide_texels + ring.level,
                            ring.weight * cosine / 4};
        sum += ring.weight * cosine;
    }
    samples.middle_weight /= sum;
    for (FastFilterParameters::Ring& ring : samples.rings) ring.weight /= sum;
    return samples;
}

void add_prefilter_pass(graph::Graph& graph, const std::string& name,
                        const std::vector<LevelRange>& runs, RoughLookup rough,
                        std::uint32_t taps) {
    graph::PassBuilder pass = graph.add_pass(name);
    for (const LevelRange& run : runs) {
        pass.reads(run.boxes, ResourceUse::sampled);
        render::declare_mip_writes(pass, run.levels);
    }
    pass.record([runs, rough, taps](graph::PassCommands& commands) {
        for (const LevelRange& run : runs) {
            for (std::uint32_t level = 1; level <= run.levels.mip_count; ++level) {
                const float alpha = f32::alpha_of_capture_level(static_cast<float>(level),
                                                                static_cast<float>(run.face));
                const bool is_fast = rough == RoughLookup::fast && alpha <= kLargestFittedAlpha;
                commands.bind_pipeline(
                    gpu::ComputeState{is_fast ? "rough/fast.comp" : "rough/prefilter.comp", {}});
                commands.bind("boxes", run.boxes, graph::TextureFilter::mipmapped);
                commands.bind("level", run.levels.mip(level - 1));
                if (is_fast)
                    commands.push_constants(make_fast_filter(alpha, level));
                else
                    commands.push_constants(PrefilterParameters{alpha, (taps + 3) / 4});
                const std::uint32_t groups = count_edge_groups(face_edge(rough, run.face, level));
                commands.dispatch(groups, groups, run.levels.layer_count);
            }
        }
    });
}

/// Returns the name of the filtered levels, and of the passes that compute them, for one way of
/// filtering.
std::string levels_name(const render::FrameInputs& inputs, RoughLookup rough, std::uint32_t taps) {
    return inputs.prefix + "rough/" +
           (rough == RoughLookup::mips
                ? std::string("mips")
                : std::string(kRoughChoices[static_cast<std::size_t>(rough)]) +
                      std::to_string(taps));
}

std::string array_suffix(std::size_t array) { return array ? "." + std::to_string(array + 1) : ""; }

} // namespace

RoughLevels::LevelFilter RoughLevels::filter_of(const SharedKnobs& knobs) {
    return {knobs.rough.lookup, knobs.rough.filters_by_lobe() ? knobs.rough.taps : 0};
}

RoughLevels::RoughLevels(graph::Graph& graph, const render::FrameInputs& inputs,
                         std::shared_ptr<const render::MirrorCaptures> captures,
                         const std::vector<SharedKnobs>& knobs)
    : inputs_(inputs), captures_(std::move(captures)) {
    for (std::uint32_t mirror = 0; captures_ && mirror < knobs.size(); ++mirror) {
        if (!knobs[mirror].rough.uses_levels() || !inputs.scene.is_rough_mirror(mirror)) continue;
        FilteredCaptures& filtered = filtered_[filter_of(knobs[mirror])];
        filtered.is_read.resize(knobs.size());
        filtered.is_read[mirror] = true;
        if (knobs[mirror].search.asks_all) filtered.is_read.assign(knobs.size(), true);
    }
    for (auto& [filter, filtered] : filtered_)
        for (std::size_t array = 0; array < captures_->arrays.size(); ++array) {
            const render::CubeCaptureArray& cubes = captures_->arrays[array];
            graph::ImageDesc desc = make_level_desc(levels_name(inputs, filter.rough, filter.taps) +
                                                        array_suffix(array),
                                                    cubes, filter.rough);
            filtered.levels.push_back(captures_->drawings.empty()
                                          ? graph.add_image(std::move(desc))
                                          : graph.add_persistent(std::move(desc)));
        }
}

void RoughLevels::add_lookup(graph::Graph& graph, std::span<const std::uint32_t> mirrors,
                             const SharedKnobs& knobs, render::MirrorShader& look,
                             bool before) const {
    const auto is_rough = [&](std::uint32_t mirror) {
        return inputs_.scene.is_rough_mirror(mirror);
    };
    if (knobs.rough.lookup == RoughLookup::none || !look.captures ||
        !std::ranges::any_of(mirrors, is_rough))
        return;
    const RoughLookup shown = knobs.rough.lookup == RoughLookup::fast ? RoughLookup::prefilter
                                                                      : knobs.rough.lookup;
    look.constants.emplace_back("rough", static_cast<std::uint32_t>(shown));
    if (knobs.rough.lookup == RoughLookup::rays) {
        look.constants.emplace_back("lobe_rays", knobs.rough.rays);
        return;
    }
    look.constants.emplace_back("distance_law", static_cast<std::uint32_t>(knobs.rough.law));
    std::vector<ImageHandle> levels = filtered_.at(filter_of(knobs)).levels;
    if (before && captures_->drawings.empty())
        for (ImageHandle& image : levels) image = graph.previous(image);
    look.images.emplace_back("rough_cubes", std::move(levels));
}

void RoughLevels::add_passes(graph::Graph& graph) const {
    for (const auto& [filter, filtered] : filtered_) add_filter_passes(graph, filter, filtered);
}

void RoughLevels::add_filter_passes(graph::Graph& graph, const LevelFilter& filter,
                                    const FilteredCaptures& filtered) const {
    const auto hash_of = [&](std::uint32_t mirror) {
        if (!filtered.is_read[mirror]) return ContentHash().add(std::uint64_t{0}).sum();
        return ContentHash()
            .add(captures_->drawings[mirror])
            .add(captures_->options[mirror].colour)
            .sum();
    };
    const std::string name = levels_name(inputs_, filter.rough, filter.taps);
    std::vector<LevelRange> runs;
    for (std::uint32_t array = 0; array < captures_->arrays.size(); ++array) {
        const render::CubeCaptureArray& cubes = captures_->arrays[array];
        const ImageHandle levels = filtered.levels[array];
        const std::vector<CubeRange> outdated = find_outdated_cubes(graph, *captures_, array,
                                                                    levels, hash_of);
        if (outdated.empty()) continue;
        ImageHandle boxes = levels;
        if (filter.rough != RoughLookup::mips)
            boxes = graph.add_image(
                make_level_desc(name + "/boxes" + array_suffix(array), cubes, RoughLookup::mips));
        for (const CubeRange& run : outdated)
            runs.push_back({cubes.colour.layers(run.first, run.count),
                            boxes.layers(run.first, run.count), levels.layers(run.first, run.count),
                            cubes.face});
    }
    if (runs.empty()) return;
    std::vector<render::BoxFilteredLayers> filtered_layers;
    for (const LevelRange& run : runs) filtered_layers.push_back({run.captured, run.boxes});
    render::add_box_filter(graph, name + "/boxes", filtered_layers);
    if (filter.rough != RoughLookup::mips)
        add_prefilter_pass(graph, name, runs, filter.rough, filter.taps);
}

} // namespace catoptric::reflect
