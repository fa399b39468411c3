#include "scene/gltf_document.hpp"

#include <utility>

namespace catoptric::scene::gltf {

namespace {

std::vector<double> times_of(const Accessor& input, const Item& sampler) {
    std::vector<double> times(input.count);
    for (std::size_t i = 0; i < times.size(); ++i) {
        times[i] = scalar_at(input, i);
        sampler.require(times[i] >= 0 && (i == 0 || times[i] > times[i - 1]),
                        "input: wanted increasing times from 0 on, found ", times[i]);
    }
    return times;
}

/// Cubic ones come as in-tangent, value, out-tangent.
Keys keys_of(const Item& sampler, Context& context) {
    using enum Keys::Interpolation;
    const std::string kind = sampler.text("interpolation", "LINEAR");
    sampler.require(kind == "LINEAR" || kind == "STEP" || kind == "CUBICSPLINE",
                    "interpolation: wanted LINEAR, STEP or CUBICSPLINE, found ", shown(Json(kind)));
    Keys keys{.interpolation = kind == "CUBICSPLINE" ? cubic : kind == "STEP" ? step : linear};
    const bool is_cubic = keys.interpolation == cubic;
    const std::size_t each = is_cubic ? 3 : 1, count = context.accessors.size();
    const Accessor& input = context.accessors.floats(sampler.needed_index("input", count), "SCALAR",
                                                     context.account.key_times,
                                                     sampler.place() + ": input");
    const Accessor& output = context.accessors.floats(sampler.needed_index("output", count), "VEC3",
                                                      context.account.key_values,
                                                      sampler.place() + ": output");
    sampler.require(output.count == each * input.count, "output: wanted ", each,
                    " values for each of ", input.count, " keys, found ", output.count);
    context.account.keys.add(input.count, sampler.place());
    keys.times = times_of(input, sampler);
    for (std::size_t i = 0; i < input.count; ++i) {
        keys.values.push_back(vector_at(output, each * i + each / 2));
        if (!is_cubic) continue;
        keys.in_tangents.push_back(vector_at(output, 3 * i));
        keys.out_tangents.push_back(vector_at(output, 3 * i + 2));
    }
    return keys;
}

void read_animation(const Item& animation, std::vector<Node>& nodes, Context& context) {
    std::vector<std::shared_ptr<const Keys>> samplers(animation.size("samplers"));
    animation.each("channels", [&](const Item& channel) {
        context.account.channels.add(1, channel.place());
        const std::size_t sampler = channel.needed_index("sampler", samplers.size());
        const std::optional<Item> target = channel.object("target");
        channel.require(target.has_value(), "wanted a target, found none");
        const std::optional<std::size_t> node = target->index("node", nodes.size());
        if (!node) return;
        if (const std::string path = target->text("path"); path != "translation") {
            context.notes.add("animation channels of '" + path + "', left out", channel.label());
            return;
        }
        if (!samplers[sampler])
            samplers[sampler] = std::make_shared<const Keys>(
                keys_of(animation.at("samplers", sampler), context));
        nodes[*node].motion = samplers[sampler];
    });
}

} // namespace

void read_animations(const Item& root, std::vector<Node>& nodes, Context& context) {
    root.each("animations",
              [&](const Item& animation) { read_animation(animation, nodes, context); });
}

} // namespace catoptric::scene::gltf
