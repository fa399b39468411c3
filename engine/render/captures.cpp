#include "render/captures.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <map>
#include <tuple>

namespace catoptric::render {

namespace {

/// The properties that captures of one array share, except the edge.
using CaptureContents = std::tuple<TexelFormat, std::optional<TexelFormat>, bool, bool, float>;

CaptureContents contents_of(const CaptureOptions& options) {
    return {options.colour, options.distance, options.second_layer, options.surfaces,
            options.stored_unit};
}

/// Mirrors, grouped by the format and the edge of their captures.
using CaptureGroups =
    std::map<std::pair<CaptureContents, std::uint32_t>, std::vector<std::uint32_t>>;

CaptureGroups group_mirrors(const std::vector<CaptureOptions>& options) {
    CaptureGroups kinds;
    for (std::uint32_t mirror = 0; mirror < options.size(); ++mirror)
        if (options[mirror].face > 0)
            kinds[{contents_of(options[mirror]), options[mirror].face}].push_back(mirror);
    return kinds;
}

std::size_t count_arrays(const CaptureGroups& kinds, std::size_t most_cubes) {
    std::size_t arrays = 0;
    for (const auto& [kind, mirrors] : kinds)
        arrays += (mirrors.size() + most_cubes - 1) / most_cubes;
    return arrays;
}

/// Enlarges the captures of one group to the next larger edge of the same format. Chooses the group
/// for which this adds the fewest texels. Returns false if no format has two edges.
bool merge_groups(CaptureGroups& kinds, std::vector<std::string>& notes) {
    auto cheapest = kinds.end();
    double least = 0;
    for (auto kind = kinds.begin(); kind != kinds.end(); ++kind) {
        const auto next = std::next(kind);
        if (next == kinds.end() || next->first.first != kind->first.first) continue;
        const auto edge = [](const auto& entry) { return static_cast<double>(entry.first.second); };
        const double more = static_cast<double>(kind->second.size()) *
                            (edge(*next) * edge(*next) - edge(*kind) * edge(*kind));
        if (cheapest == kinds.end() || more < least) cheapest = kind, least = more;
    }
    if (cheapest == kinds.end()) return false;
    const auto next = std::next(cheapest);
    const std::size_t count = cheapest->second.size();
    notes.push_back(std::to_string(count) + (count == 1 ? " mirror is" : " mirrors are") +
                    " captured with " + std::to_string(next->first.second) +
                    " texels an edge instead of " + std::to_string(cheapest->first.second) +
                    ": a frame has at most " + std::to_string(shared::kMaxCubeArrays) +
                    " arrays of captures");
    next->second.insert(next->second.end(), cheapest->second.begin(), cheapest->second.end());
    std::ranges::sort(next->second);
    kinds.erase(cheapest);
    return true;
}

/// Declares one cube array for captures with the same format and edge.
CubeCaptureArray declare_cube_array(graph::Graph& graph, const std::string& name,
                                    const CaptureOptions& options, std::size_t cubes, bool stay) {
    const auto image = [&](const char* what, TexelFormat format) {
        graph::ImageDesc desc{
            name + what, format, options.face, options.face, static_cast<std::uint32_t>(6 * cubes),
            true};
        return stay ? graph.add_persistent(std::move(desc)) : graph.add_image(std::move(desc));
    };
    check(options.distance || !(options.surfaces || options.second_layer), Failure::internal,
          "captures '", name, "' want surfaces or a second layer, which need the distance");
    CubeCaptureArray made;
    made.face = options.face;
    made.colour = image("colour", options.colour);
    if (options.distance) made.distance = image("distance", *options.distance);
    if (options.surfaces) made.surfaces = image("surfaces", TexelFormat::rgba16f);
    if (options.second_layer) {
        made.colour2 = image("colour2", options.colour);
        made.distance2 = image("distance2", *options.distance);
    }
    return made;
}

/// Declares a buffer with the place of each mirror's capture, and the pass that fills it.
graph::BufferHandle add_capture_table(graph::Graph& graph, const std::string& name,
                                      const MirrorCaptures& captures) {
    shared::CaptureLookupTable places{};
    for (std::size_t i = 0; i < captures.places.size(); ++i) {
        const auto& [array, cube] = captures.places[i];
        places.places[i] = array << 16 | cube;
        if (!captures.places[i].has_capture()) continue;
        const CaptureOptions& options = captures.options[i];
        places.arrays[array] = {options.stored_unit,
                                options.distance == TexelFormat::r8_unorm ? 1u : 0u};
    }
    const graph::BufferHandle table = graph.add_buffer({name + ".table", sizeof places});
    graph.add_pass(name + ".table")
        .writes(table, graph::ResourceUse::copy_to)
        .record([table, places](graph::PassCommands& commands) {
            commands.update_buffer(table, std::as_bytes(std::span(&places, 1)));
        });
    return table;
}

} // namespace

CubeCaptureArray select_layers(const CubeCaptureArray& cubes, std::uint32_t first,
                               std::uint32_t count) {
    const auto part = [&](const std::optional<graph::ImageHandle>& image) {
        return image ? std::optional(image->layers(first, count)) : image;
    };
    return {cubes.face,
            cubes.colour.layers(first, count),
            part(cubes.distance),
            part(cubes.colour2),
            part(cubes.distance2),
            part(cubes.surfaces)};
}

bool have_equal_contents(const CaptureOptions& a, const CaptureOptions& b) {
    return a.face == b.face && contents_of(a) == contents_of(b) && a.saturates == b.saturates &&
           a.blended_alpha == b.blended_alpha && a.leaves_out_spheres == b.leaves_out_spheres;
}

MirrorCaptures declare_capture_images(graph::Graph& graph, const FrameInputs& inputs,
                                      std::string name, std::vector<CaptureOptions> options,
                                      const std::string& set) {
    MirrorCaptures captures;
    captures.name = std::move(name);
    CaptureGroups kinds = group_mirrors(options);
    const std::size_t most_cubes = inputs.scene.max_cubes();
    bool merged = true;
    while (merged && count_arrays(kinds, most_cubes) > shared::kMaxCubeArrays)
        merged = merge_groups(kinds, captures.notes);
    const std::size_t count = count_arrays(kinds, most_cubes);
    check(count <= shared::kMaxCubeArrays && options.size() <= shared::kMaxCapturedMirrors,
          Failure::exhausted, "captures of ", options.size(), " mirrors in ", kinds.size(),
          " sizes and formats want ", count, " arrays of at most ", most_cubes,
          " cubes; a frame has at most ", shared::kMaxCubeArrays, " arrays and ",
          shared::kMaxCapturedMirrors,
          " mirrors: wanted the same knobs face, colour and distance for more mirrors");
    captures.places.resize(options.size());
    const std::string dot_set = set.empty() ? "" : "." + set;
    for (const auto& [kind, mirrors] : kinds) {
        for (std::size_t first = 0; first < mirrors.size(); first += most_cubes) {
            const std::size_t cubes = std::min(most_cubes, mirrors.size() - first);
            const auto array = static_cast<std::uint32_t>(captures.arrays.size());
            for (std::uint32_t cube = 0; cube < cubes; ++cube) {
                const std::uint32_t mirror = mirrors[first + cube];
                options[mirror].face = kind.second;
                captures.places[mirror] = {array, cube};
            }
            const std::string number = array == 0 ? "" : std::to_string(array + 1);
            captures.arrays.push_back(declare_cube_array(
                graph, inputs.prefix + captures.name + "/cubes" + number + dot_set + ".",
                options[mirrors[first]], cubes, !set.empty()));
        }
    }
    captures.options = std::move(options);
    std::vector<CubeSlot> in_order;
    for (std::uint32_t mirror = 0; mirror < captures.places.size(); ++mirror)
        in_order.push_back({0, mirror});
    if (captures.places != in_order)
        captures.table = add_capture_table(graph, inputs.prefix + captures.name + dot_set,
                                           captures);
    return captures;
}

MirrorCaptures declare_previous_captures(graph::Graph& graph, const MirrorCaptures& captures) {
    MirrorCaptures last = captures;
    for (CubeCaptureArray& cubes : last.arrays) {
        cubes = {cubes.face, graph.previous(cubes.colour), cubes.distance, {}, {}, {}};
        if (cubes.distance) cubes.distance = graph.previous(*cubes.distance);
    }
    return last;
}

} // namespace catoptric::render
