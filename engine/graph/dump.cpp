#include "graph/dump.hpp"

#include "graph/access.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>

namespace catoptric::graph {

namespace {

using Json = nlohmann::ordered_json;

std::string_view purpose_name(PassPurpose tag) {
    return tag == PassPurpose::scene ? "scene" : "none";
}

/// Returns a count with its noun: "1 pass", "2 passes".
std::string format_count(std::size_t count, const std::string& thing, const std::string& plural) {
    return std::to_string(count) + " " + (count == 1 ? thing : thing + plural);
}

const Pass& pass_of(const Graph& graph, const PlannedPass& planned) {
    return graph.passes()[planned.pass];
}

/// Finds which images and buffers of a plan share memory.
class MemorySharers {
public:
    MemorySharers(const Graph& graph, const GraphPlan& plan) {
        for (std::size_t i = 0; i < plan.images.size(); ++i)
            add(plan.images[i], graph.images()[i].name);
        for (std::size_t b = 0; b < plan.buffers.size(); ++b)
            add(plan.buffers[b], graph.buffers()[b].name);
        for (HeapRanges& heap : heaps_) {
            std::ranges::sort(heap.begins);
            std::ranges::sort(heap.ends);
        }
    }
    /// Returns the number of other resources whose memory overlaps that of `mine`.
    std::size_t count(const MemoryPlacement& mine) const {
        if (!mine.used || mine.bytes == 0) return 0;
        const HeapRanges& heap = heaps_[mine.heap];
        const auto begun = std::ranges::lower_bound(heap.begins, mine.offset + mine.bytes);
        const auto ended = std::ranges::upper_bound(heap.ends, mine.offset);
        return static_cast<std::size_t>(begun - heap.begins.begin()) -
               static_cast<std::size_t>(ended - heap.ends.begin()) - 1; // `mine` itself
    }
    /// Returns the names of the first `limit` resources that share memory with `mine`.
    std::vector<std::string_view> first_names(const MemoryPlacement& mine,
                                              std::size_t limit) const {
        const std::size_t wanted = std::min(limit, count(mine));
        std::vector<std::string_view> names;
        for (std::size_t i = 0; i < all_.size() && names.size() < wanted; ++i) {
            const auto& [other, name] = all_[i];
            if (other != &mine && other->used && other->heap == mine.heap &&
                other->offset < mine.offset + mine.bytes &&
                mine.offset < other->offset + other->bytes)
                names.push_back(name);
        }
        return names;
    }

private:
    struct HeapRanges {
        std::vector<std::uint64_t> begins, ends; // sorted
    };
    void add(const MemoryPlacement& placement, std::string_view name) {
        all_.emplace_back(&placement, name);
        if (!placement.used || placement.bytes == 0) return;
        if (heaps_.size() <= placement.heap) heaps_.resize(placement.heap + 1);
        heaps_[placement.heap].begins.push_back(placement.offset);
        heaps_[placement.heap].ends.push_back(placement.offset + placement.bytes);
    }
    std::vector<std::pair<const MemoryPlacement*, std::string_view>> all_;
    std::vector<HeapRanges> heaps_;
};

void write_uses(std::ostream& out, const Graph& graph, const Pass& pass) {
    for (const ResourceAccess& a : pass_accesses(pass)) {
        out << "      " << (a.write ? "writes " : "reads  ") << describe_access(graph, a) << " as "
            << graph::use_name(a.use);
        if (a.clears) out << ", cleared";
        if (a.write && a.needs && is_attachment(a.use)) out << ", loaded";
        out << "\n";
    }
}

void write_placement(std::ostream& out, const MemorySharers& sharers,
                     const MemoryPlacement& placement) {
    constexpr std::size_t kMaxNamedResources =
        32; // most names listed for one resource; in a large frame hundreds may share its memory
    if (!placement.used) {
        out << ", not used\n";
        return;
    }
    out << ", passes " << placement.first + 1 << " to " << placement.last + 1 << ", heap "
        << placement.heap << " at " << placement.offset << ", " << placement.bytes << " bytes";
    if (placement.alone) out << ", alone";
    const std::vector<std::string_view> others = sharers.first_names(placement, kMaxNamedResources);
    for (std::size_t i = 0; i < others.size(); ++i)
        out << (i == 0 ? ", shares with '" : ", '") << others[i] << "'";
    const std::size_t count = sharers.count(placement);
    if (count > others.size()) out << " and " << count - others.size() << " more";
    out << "\n";
}

Json access_json(const Graph& graph, const ResourceAccess& a) {
    if (a.is_buffer) {
        Json json{{"buffer", graph.buffers()[a.id].name}, {"use", graph::use_name(a.use)}};
        if (a.previous) json["previous"] = true;
        return json;
    }
    Json json{{"image", graph.images()[a.id].name},
              {"layers", {a.first_layer, a.layer_count}},
              {"use", graph::use_name(a.use)}};
    if (graph.images()[a.id].mips > 1) json["mips"] = {a.first_mip, a.mip_count};
    if (a.write)
        json["clear"] = a.clears;
    else
        json["previous"] = a.previous;
    return json;
}

Json pass_json(const Graph& graph, const PlannedPass& planned) {
    const Pass& pass = pass_of(graph, planned);
    Json reads = Json::array(), writes = Json::array();
    for (const ResourceAccess& a : pass_accesses(pass))
        (a.write ? writes : reads).push_back(access_json(graph, a));
    return {{"name", pass.name},
            {"tag", purpose_name(pass.tag)},
            {"reads", reads},
            {"writes", writes},
            {"barriers", planned.barriers.size()}};
}

void add_placement(Json& json, const MemoryPlacement& placement) {
    json["used"] = placement.used;
    json["first"] = placement.first;
    json["last"] = placement.last;
    json["heap"] = placement.heap;
    json["offset"] = placement.offset;
    json["bytes"] = placement.bytes;
    json["alone"] = placement.alone;
}

Json image_json(const ImageDesc& desc, Lifetime lifetime, const MemoryPlacement& placement) {
    Json json{{"name", desc.name},
              {"format", catoptric::format_name(desc.format)},
              {"size", {desc.width, desc.height}},
              {"layers", desc.layers},
              {"cube", desc.cube}};
    if (desc.mips > 1) json["mips"] = desc.mips;
    if (lifetime == Lifetime::persistent) json["kept"] = true;
    if (lifetime == Lifetime::imported) json["imported"] = true;
    add_placement(json, placement);
    return json;
}

/// Escapes text for quotation marks of the dot language.
std::string escape_for_dot(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    return out;
}

void write_dot_pass(std::ostream& out, const Graph& graph, std::uint32_t index, bool culled) {
    const Pass& pass = graph.passes()[index];
    const std::string style = culled ? "dashed" : "solid";
    out << "  p" << index << " [shape=box, style=" << style << ", label=\""
        << escape_for_dot(pass.name) << (pass.tag == PassPurpose::scene ? "\\n(scene)" : "")
        << "\"];\n";
    for (const ResourceAccess& a : pass_accesses(pass)) {
        const std::string resource = (a.is_buffer ? "b" : "i") + std::to_string(a.id);
        const std::string node = "p" + std::to_string(index);
        out << "  " << (a.write ? node : resource) << " -> " << (a.write ? resource : node)
            << " [style=" << (a.previous ? "dotted" : style) << ", label=\""
            << (a.previous ? "previous, " : "") << graph::use_name(a.use);
        if (!a.is_buffer && a.layer_count != graph.images()[a.id].layers)
            out << " [" << a.first_layer << "," << a.end_layer() << ")";
        out << "\"];\n";
    }
}

} // namespace

std::string plan_to_text(const Graph& graph, const GraphPlan& plan) {
    std::ostringstream out;
    out << format_count(plan.passes.size(), "pass", "es") << ", scene_passes " << plan.scene_passes
        << ", " << plan.bytes << " bytes (" << plan.bytes_unshared
        << " without sharing)\n\npasses\n";
    for (std::size_t p = 0; p < plan.passes.size(); ++p) {
        const Pass& pass = pass_of(graph, plan.passes[p]);
        out << "  " << p + 1 << " '" << pass.name << "'"
            << (pass.tag == PassPurpose::scene ? " (scene)" : "") << ", "
            << format_count(plan.passes[p].barriers.size(), "barrier", "s") << "\n";
        write_uses(out, graph, pass);
    }
    if (!plan.culled.empty()) out << "\nculled\n";
    for (const CulledPass& culled : plan.culled)
        out << "  '" << graph.passes()[culled.pass].name << "': " << culled.reason << "\n";
    const MemorySharers sharers(graph, plan);
    if (!plan.images.empty()) out << "\nimages\n";
    for (std::uint32_t i = 0; i < plan.images.size(); ++i) {
        const ImageDesc& desc = graph.images()[i];
        out << "  '" << desc.name << "' " << catoptric::format_name(desc.format) << " "
            << desc.width << "x" << desc.height << ", " << format_count(desc.layers, "layer", "s")
            << (desc.cube ? " (cube)" : "");
        if (desc.mips > 1) out << ", " << format_count(desc.mips, "mip", "s");
        if (graph.image_lifetime(i) == Lifetime::persistent) out << ", kept";
        if (graph.image_lifetime(i) == Lifetime::imported) out << ", imported";
        write_placement(out, sharers, plan.images[i]);
    }
    if (!plan.buffers.empty()) out << "\nbuffers\n";
    for (std::size_t b = 0; b < plan.buffers.size(); ++b) {
        out << "  '" << graph.buffers()[b].name << "'";
        write_placement(out, sharers, plan.buffers[b]);
    }
    return out.str();
}

std::string plan_to_dot(const Graph& graph, const GraphPlan& plan) {
    std::ostringstream out;
    out << "digraph frame {\n  rankdir=LR;\n";
    for (std::size_t i = 0; i < graph.images().size(); ++i)
        out << "  i" << i << " [shape=ellipse, label=\"" << escape_for_dot(graph.images()[i].name)
            << "\"];\n";
    for (std::size_t b = 0; b < graph.buffers().size(); ++b)
        out << "  b" << b << " [shape=cylinder, label=\"" << escape_for_dot(graph.buffers()[b].name)
            << "\"];\n";
    for (const PlannedPass& planned : plan.passes) write_dot_pass(out, graph, planned.pass, false);
    for (const CulledPass& culled : plan.culled) write_dot_pass(out, graph, culled.pass, true);
    out << "}\n";
    return out.str();
}

std::string plan_to_json(const Graph& graph, const GraphPlan& plan) {
    Json json{{"passes", Json::array()},
              {"culled", Json::array()},
              {"images", Json::array()},
              {"buffers", Json::array()}};
    for (const PlannedPass& planned : plan.passes)
        json["passes"].push_back(pass_json(graph, planned));
    for (const CulledPass& culled : plan.culled)
        json["culled"].push_back(
            {{"name", graph.passes()[culled.pass].name}, {"reason", culled.reason}});
    for (std::size_t i = 0; i < plan.images.size(); ++i)
        json["images"].push_back(image_json(graph.images()[i],
                                            graph.image_lifetime(static_cast<std::uint32_t>(i)),
                                            plan.images[i]));
    for (std::size_t b = 0; b < plan.buffers.size(); ++b) {
        Json buffer{{"name", graph.buffers()[b].name}};
        add_placement(buffer, plan.buffers[b]);
        json["buffers"].push_back(buffer);
    }
    json["scene_passes"] = plan.scene_passes;
    json["bytes"] = plan.bytes;
    json["bytes_unshared"] = plan.bytes_unshared;
    return json.dump(2, ' ', true, Json::error_handler_t::replace) + "\n";
}

} // namespace catoptric::graph
