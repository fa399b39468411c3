#include "core/text.hpp"
#include "scene/gltf_model.hpp"

namespace catoptric::scene::gltf {

namespace {

using KeysOf = std::vector<std::shared_ptr<const Keys>>;

std::vector<double> times_of(const Elements& input, const std::string& place) {
    std::vector<double> times(input.count);
    for (std::size_t i = 0; i < times.size(); ++i) {
        times[i] = scalar_at(input, i);
        check(times[i] >= 0 && (i == 0 || times[i] > times[i - 1]), Failure::bad_data, place,
              ": input: wanted increasing times from 0 on, found ", times[i]);
    }
    return times;
}

Keys::Interpolation interpolation_of(const tinygltf::AnimationSampler& sampler,
                                     const std::string& place) {
    using enum Keys::Interpolation;
    const std::string& kind = sampler.interpolation; // of tinygltf's own accord "LINEAR"
    if (kind == "LINEAR") return linear;
    if (kind == "STEP") return step;
    check(kind == "CUBICSPLINE", Failure::bad_data, place,
          ": interpolation: wanted LINEAR, STEP or CUBICSPLINE, found ", shown(Json(kind)));
    return cubic;
}

/// Cubic ones come as in-tangent, value, out-tangent.
Keys keys_of(const tinygltf::AnimationSampler& sampler, const std::string& place,
             Context& context) {
    Keys keys{.interpolation = interpolation_of(sampler, place)};
    const bool is_cubic = keys.interpolation == Keys::Interpolation::cubic;
    const std::size_t each = is_cubic ? 3 : 1;
    check(sampler.input >= 0, Failure::bad_data, place, ": input: wanted an index, found none");
    check(sampler.output >= 0, Failure::bad_data, place, ": output: wanted an index, found none");
    Account& account = context.account;
    const Elements input = context.floats(sampler.input, TINYGLTF_TYPE_SCALAR, account.key_times,
                                          place + ": input");
    const Elements output = context.floats(sampler.output, TINYGLTF_TYPE_VEC3, account.key_values,
                                           place + ": output");
    check(output.count == each * input.count, Failure::bad_data, place, ": output: wanted ", each,
          " values for each of ", input.count, " keys, found ", output.count);
    account.keys.add(input.count, place);
    keys.times = times_of(input, place);
    for (std::size_t i = 0; i < input.count; ++i) {
        keys.values.push_back(vector_at(output, each * i + each / 2));
        if (!is_cubic) continue;
        keys.in_tangents.push_back(vector_at(output, 3 * i));
        keys.out_tangents.push_back(vector_at(output, 3 * i + 2));
    }
    return keys;
}

void read_animation(const tinygltf::Animation& animation, const std::string& place, KeysOf& motions,
                    Context& context) {
    KeysOf samplers(animation.samplers.size());
    for (const tinygltf::AnimationChannel& channel : animation.channels) {
        if (channel.target_path != "translation") continue; // named by the checks
        const auto index = std::size_t(channel.sampler);
        if (!samplers[index])
            samplers[index] = std::make_shared<const Keys>(keys_of(
                animation.samplers[index], place + ": " + label_of("samplers", index), context));
        // As viewers that play one animation do, the first one counts.
        auto& motion = motions[std::size_t(channel.target_node)];
        if (motion)
            context.notes.add("translations of nodes that move already, left out", place);
        else
            motion = samplers[index];
    }
}

} // namespace

KeysOf read_motions(Context& context) {
    const tinygltf::Model& model = context.document.model;
    KeysOf motions(model.nodes.size());
    for (std::size_t i = 0; i < model.animations.size(); ++i)
        read_animation(model.animations[i],
                       context.document.file + ": " +
                           label_of("animations", i, model.animations[i].name),
                       motions, context);
    return motions;
}

} // namespace catoptric::scene::gltf
