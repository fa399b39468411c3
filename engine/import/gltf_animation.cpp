#include "core/knob.hpp"
#include "core/text.hpp"
#include "import/gltf_model.hpp"
#include "scene/motion.hpp"
#include "scene/unsupported_feature.hpp"

#include <cmath>

namespace catoptric::scene::gltf {

namespace {

std::vector<double> read_key_times(const AccessorElements& input, const std::string& place) {
    std::vector<double> times(input.count);
    for (std::size_t i = 0; i < times.size(); ++i) {
        times[i] = read_number(input, i, 0);
        check(times[i] >= 0 && (i == 0 || times[i] > times[i - 1]), Failure::bad_data, place,
              ": input: wanted increasing times from 0 on, found ", times[i]);
    }
    return times;
}

Interpolation read_interpolation(const tinygltf::AnimationSampler& sampler,
                                 const std::string& place) {
    using enum Interpolation;
    const std::string& kind = sampler.interpolation; // tinygltf's default is "LINEAR"
    if (kind == "LINEAR") return linear;
    if (kind == "STEP") return step;
    check(kind == "CUBICSPLINE", Failure::bad_data, place,
          ": interpolation: wanted LINEAR, STEP or CUBICSPLINE, found ", describe(Json(kind)));
    return cubic;
}

dvec3 read_track_value(const AccessorElements& output, std::size_t index, const dvec3&) {
    return read_vector(output, index);
}
dvec4 read_track_value(const AccessorElements& output, std::size_t index, const dvec4&) {
    return dvec4(read_vector(output, index), read_number(output, index, 3));
}

/// A cubic track stores in-tangent, value and out-tangent for each key. Throws `bad_data`.
template <typename Value>
Track<Value> read_track(const tinygltf::AnimationSampler& sampler, const std::string& place,
                        ReadContext& context) {
    Track<Value> track{.interpolation = read_interpolation(sampler, place)};
    const bool is_cubic = track.interpolation == Interpolation::cubic;
    const std::size_t each = is_cubic ? 3 : 1;
    check(sampler.input >= 0, Failure::bad_data, place, ": input: wanted an index, found none");
    check(sampler.output >= 0, Failure::bad_data, place, ": output: wanted an index, found none");
    LoadAccount& account = context.account;
    constexpr bool kIsRotationTrack = std::is_same_v<Value, dvec4>;
    const AccessorElements input = context.floats(sampler.input, TINYGLTF_TYPE_SCALAR,
                                                  account.key_times, place + ": input");
    const AccessorElements output = context.floats(
        sampler.output, kIsRotationTrack ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3,
        account.key_values, place + ": output",
        kIsRotationTrack ? ReadContext::AllowedIntegers::normalised
                         : ReadContext::AllowedIntegers::nothing);
    check(output.count == each * input.count, Failure::bad_data, place, ": output: wanted ", each,
          " values for each of ", input.count, " keys, found ", output.count);
    account.keys.add(input.count, place);
    track.times = read_key_times(input, place);
    const auto value = [&](std::size_t index) { return read_track_value(output, index, Value()); };
    for (std::size_t i = 0; i < input.count; ++i) {
        track.values.push_back(value(each * i + each / 2));
        if (!is_cubic) continue;
        track.in_tangents.push_back(value(3 * i));
        track.out_tangents.push_back(value(3 * i + 2));
    }
    return track;
}

/// Quaternions of step and linear tracks are normalised, since files may be a little off unit
/// length. Throws `bad_data` for zero or infinite length.
RotationTrack read_rotation_track(const tinygltf::AnimationSampler& sampler,
                                  const std::string& place, ReadContext& context) {
    RotationTrack turns = read_track<dvec4>(sampler, place, context);
    for (dvec4& turn : turns.values) {
        const double length = glm::length(turn);
        check(length > 0 && std::isfinite(length), Failure::bad_data, place,
              ": output: wanted quaternions with a length, found ", length);
        if (turns.interpolation != RotationTrack::Interpolation::cubic) turn /= length;
    }
    return turns;
}

/// Reads each sampler once for vectors and once for rotations.
class AnimationReader {
public:
    AnimationReader(const tinygltf::Animation& from, std::string place, ReadContext& context)
        : animation_(from), place_(std::move(place)), context_(context),
          keys_(from.samplers.size()), turns_(from.samplers.size()) {}

    void add_channel(const tinygltf::AnimationChannel& channel, std::vector<NodeTracks>& nodes) {
        NodeTracks none;
        NodeTracks& to = channel.target_node < 0 ? none : nodes[std::size_t(channel.target_node)];
        const auto index = std::size_t(channel.sampler);
        if (channel.target_path == "translation")
            set_once(to.translations, read_vector_track(index));
        if (channel.target_path == "scale") set_once(to.scales, read_vector_track(index));
        if (channel.target_path == "rotation") set_once(to.rotations, read_rotation_once(index));
    }

private:
    std::string place(std::size_t index) const {
        return place_ + ": " + item_label("samplers", index);
    }
    std::shared_ptr<const TranslationTrack> read_vector_track(std::size_t index) {
        if (!keys_[index])
            keys_[index] = std::make_shared<const TranslationTrack>(
                read_track<dvec3>(animation_.samplers[index], place(index), context_));
        return keys_[index];
    }
    std::shared_ptr<const RotationTrack> read_rotation_once(std::size_t index) {
        if (!turns_[index])
            turns_[index] = std::make_shared<const RotationTrack>(
                read_rotation_track(animation_.samplers[index], place(index), context_));
        return turns_[index];
    }
    template <typename Kept>
    void set_once(std::shared_ptr<const Kept>& kept, std::shared_ptr<const Kept> track) {
        if (kept)
            context_.notes.add("animation channels for what an earlier channel moves, left out",
                               place_);
        else
            kept = std::move(track);
    }

    const tinygltf::Animation& animation_;
    std::string place_;
    ReadContext& context_;
    std::vector<std::shared_ptr<const TranslationTrack>> keys_;
    std::vector<std::shared_ptr<const RotationTrack>> turns_;
};

/// Returns the index of the animation that moves the nodes, or none. Throws the failure of
/// `FileOptions::animation_by` for an unknown name.
std::optional<std::size_t> choose_animation(const ReadContext& context) {
    const std::vector<tinygltf::Animation>& all = context.document.model.animations;
    const std::string& name = context.options.animation;
    if (name == "none") return std::nullopt;
    if (name.empty()) return all.empty() ? std::nullopt : std::optional<std::size_t>(0);
    std::vector<std::string> names;
    std::string list;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i].name == name) return i;
        names.push_back(all[i].name);
        list += (list.empty() ? " or one of " : ", ") + quote(all[i].name);
    }
    const SettingOrigin& by = context.options.animation_by;
    fail(by.failure, by.where, ": ", context.document.file, " has no animation ", quote(name),
         ": wanted none", list, suggest_name(name, names));
}

} // namespace

NodeAnimation read_animation(ReadContext& context) {
    const Document& document = context.document;
    const std::vector<tinygltf::Animation>& all = document.model.animations;
    NodeAnimation animation{.nodes = std::vector<NodeTracks>(document.model.nodes.size())};
    const std::optional<std::size_t> shown = choose_animation(context);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const std::string label = item_label("animations", i, all[i].name);
        AnimationReader animation_reader(all[i], document.file + ": " + label, context);
        std::vector<NodeTracks> elsewhere(i == shown ? 0 : document.model.nodes.size());
        // Other animations are read, too, so that an invalid file fails whichever one is shown.
        for (const tinygltf::AnimationChannel& channel : all[i].channels)
            animation_reader.add_channel(channel, i == shown ? animation.nodes : elsewhere);
        if (i == shown)
            animation.repeats = document.repeats[i];
        else
            add_unsupported(context.unsupported, "other-animations", label);
    }
    return animation;
}

} // namespace catoptric::scene::gltf
