#pragma once

#include "import/gltf_container.hpp"
#include "scene/motion.hpp"
#include "scene/scene.hpp"

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include <tiny_gltf.h>

namespace catoptric::scene::gltf {

int int_size(const auto& list) { return static_cast<int>(list.size()); }

template <typename Vector>
std::vector<double> to_numbers(const Vector& v) {
    return {v.x + 0.0, v.y + 0.0, v.z + 0.0}; // adding 0 turns -0.0 into 0.0
}
/// Returns the 16 numbers of a matrix, column by column.
std::vector<double> to_numbers(const dmat4& matrix);

/// Returns `extras` that hold `ours` under the key "catoptric".
tinygltf::Value make_extras(tinygltf::Value::Object ours);
tinygltf::Value number_list(const std::vector<double>& list);

/// Builds a tinygltf model and the bytes of its single buffer.
struct Writer {
    const Scene& scene;
    tinygltf::Model model;
    ByteList bytes;
    tinygltf::Animation motion;
    /// Index of the glTF mesh for each combination of mesh, material and reversed winding.
    std::map<std::tuple<std::size_t, std::size_t, bool>, int> meshes;
    std::map<const Image*, int> images;
    /// Index of each sampler, by filter and wrap modes.
    std::map<std::tuple<int, int, int>, int> samplers;
    std::map<const NodeRig*, std::vector<int>> rigs; ///< glTF node of each node of the rig

    /// Appends the bytes to the buffer, pads it to a multiple of 4 bytes, and returns a new view of
    /// them.
    tinygltf::BufferView& view(const void* first, std::size_t size);
    /// Appends the elements to the buffer, with a new view, and returns a new accessor of them.
    template <typename Element>
    tinygltf::Accessor& append_accessor(const std::vector<Element>& list, int type, int component) {
        view(list.data(), list.size() * sizeof(Element));
        tinygltf::Accessor& accessor = model.accessors.emplace_back();
        accessor.bufferView = int_size(model.bufferViews) - 1, accessor.count = list.size();
        accessor.type = type, accessor.componentType = component;
        return accessor;
    }
    /// Appends the vectors and returns the index of their accessor, which holds their bounds.
    int vectors(const std::vector<vec3>& list);
    /// Adds an extension to `extensionsUsed`, unless it is listed already.
    void use(const std::string& extension);

    // gltf_save_material.cpp
    void add_material(const Material& material);
    tinygltf::TextureInfo texture_info(const Texture& texture);
    int image(const Image& image);
    int sampler(const Texture& texture);

    // gltf_save_motion.cpp

    /// Animates the translation of `node`. `keys` are relative to `rest`, its translation at rest.
    void add_motion(const TranslationTrack& keys, const dvec3& rest, int node);
    template <typename Value>
    void add_track(const Track<Value>& track, int node, const std::string& path);
    /// Returns the glTF node of the rig node that `follows` names. The first call for a rig adds
    /// all of its nodes.
    int node_of(const RigAttachment& follows);
    int add_rig_node(const NodeRig::RigNode& node, int parent);
    /// Moves the animation into the model, if it has channels.
    void finish_motion();
};

/// Returns a motion's keys, relative to the place at rest. Returns none if the motion stands still
/// or follows a rig.
std::optional<TranslationTrack> motion_to_keys(const Motion& motion);

} // namespace catoptric::scene::gltf
