#include "import/gltf_writer.hpp"
#include "scene/motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace catoptric::scene::gltf {

namespace {

/// Returns one period as 64 Hermite pieces with the exact derivative at each key. The error is
/// below (2 pi / 64)^4 / 384 = 2.5e-7 of the amplitude.
TranslationTrack motion_to_keys(const HarmonicMotion& motion) {
    constexpr int kHarmonicMotionKeyCount = 64;
    TranslationTrack keys{.interpolation = Interpolation::cubic};
    for (int i = 0; i <= kHarmonicMotionKeyCount; ++i) {
        const double angle = 2 * std::numbers::pi * i / kHarmonicMotionKeyCount;
        keys.times.push_back(motion.period * i / kHarmonicMotionKeyCount);
        keys.values.push_back(motion.amplitude * (1 - std::cos(angle)));
        keys.in_tangents.push_back(motion.amplitude * std::sin(angle) *
                                   (2 * std::numbers::pi / motion.period));
    }
    keys.out_tangents = keys.in_tangents;
    return keys;
}

int write_times(Writer& writer, const std::vector<double>& list) {
    const std::vector<float> times(list.begin(), list.end());
    tinygltf::Accessor& accessor = writer.append_accessor(times, TINYGLTF_TYPE_SCALAR,
                                                          TINYGLTF_COMPONENT_TYPE_FLOAT);
    accessor.minValues = {times.front()}, accessor.maxValues = {times.back()};
    return int_size(writer.model.accessors) - 1;
}

int write_values(Writer& writer, const std::vector<vec3>& list) { return writer.vectors(list); }
int write_values(Writer& writer, const std::vector<vec4>& list) {
    writer.append_accessor(list, TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_FLOAT);
    return int_size(writer.model.accessors) - 1;
}

bool is_repeating(const Motion& motion) {
    if (const auto* frames = std::get_if<Keyframes>(&motion)) return frames->repeats;
    if (const auto* follows = std::get_if<RigAttachment>(&motion))
        return follows->rig && follows->rig->repeats;
    return true;
}

} // namespace

std::optional<TranslationTrack> motion_to_keys(const Motion& motion) {
    if (const auto* harmonic = std::get_if<HarmonicMotion>(&motion))
        return motion_to_keys(*harmonic);
    if (const auto* frames = std::get_if<Keyframes>(&motion))
        if (TranslationTrack keys = keys_in_world(*frames); !keys.times.empty()) return keys;
    return std::nullopt;
}

template <typename Value>
void Writer::add_track(const Track<Value>& track, int node, const std::string& path) {
    using enum Interpolation;
    if (track.times.empty()) return;
    const bool is_cubic = track.interpolation == cubic;
    std::vector<glm::vec<Value::length(), float>> output;
    for (std::size_t i = 0; i < track.times.size(); ++i) {
        if (is_cubic) output.emplace_back(track.in_tangents[i]);
        output.emplace_back(track.values[i]);
        if (is_cubic) output.emplace_back(track.out_tangents[i]);
    }
    tinygltf::AnimationSampler sampler;
    sampler.input = write_times(*this, track.times);
    sampler.output = write_values(*this, output);
    sampler.interpolation = is_cubic                      ? "CUBICSPLINE"
                            : track.interpolation == step ? "STEP"
                                                          : "LINEAR";
    tinygltf::AnimationChannel channel;
    channel.sampler = int_size(motion.samplers);
    channel.target_node = node, channel.target_path = path;
    motion.samplers.push_back(std::move(sampler));
    motion.channels.push_back(std::move(channel));
}

void Writer::add_motion(const TranslationTrack& keys, const dvec3& rest, int node) {
    TranslationTrack there = keys;
    for (dvec3& value : there.values) value += rest;
    add_track(there, node, "translation");
}

int Writer::add_rig_node(const NodeRig::RigNode& node, int parent) {
    const auto add = [&](tinygltf::Node to) {
        const int index = int_size(model.nodes);
        model.nodes.push_back(std::move(to));
        if (parent < 0)
            model.scenes[0].nodes.push_back(index);
        else
            model.nodes[std::size_t(parent)].children.push_back(index);
        return index;
    };
    if (node.parent_from_space != dmat4(1)) {
        tinygltf::Node still;
        still.matrix = to_numbers(node.parent_from_space);
        parent = add(std::move(still));
    }
    tinygltf::Node moving;
    moving.translation = to_numbers(node.translation), moving.scale = to_numbers(node.scale);
    moving.rotation = {node.rotation.x, node.rotation.y, node.rotation.z, node.rotation.w};
    const int index = add(std::move(moving));
    if (node.translations) add_track(*node.translations, index, "translation");
    if (node.rotations) add_track(*node.rotations, index, "rotation");
    if (node.scales) add_track(*node.scales, index, "scale");
    return index;
}

int Writer::node_of(const RigAttachment& follows) {
    const auto [entry, is_new] = rigs.try_emplace(follows.rig.get());
    if (is_new) {
        std::vector<int> nodes;
        for (const NodeRig::RigNode& node : follows.rig->nodes)
            nodes.push_back(add_rig_node(node, node.parent ? nodes[*node.parent] : -1));
        rigs[follows.rig.get()] = std::move(nodes);
    }
    return rigs[follows.rig.get()][follows.node];
}

void Writer::finish_motion() {
    if (motion.channels.empty()) return;
    const auto goes_on = [](const auto& thing) { return is_repeating(thing.motion); };
    const auto camera_goes_on = [](const Camera& camera) {
        return !camera.follows.rig || camera.follows.rig->repeats;
    };
    const bool all = std::ranges::all_of(scene.objects, goes_on) &&
                     std::ranges::all_of(scene.punctual, goes_on) &&
                     std::ranges::all_of(scene.cameras, camera_goes_on);
    if (all) motion.extras = make_extras({{"repeats", tinygltf::Value(true)}});
    model.animations = {std::move(motion)};
}

} // namespace catoptric::scene::gltf
