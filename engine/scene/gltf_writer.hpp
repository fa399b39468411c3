#pragma once

#include "scene/gltf_container.hpp"
#include "scene/scene.hpp"

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include <tiny_gltf.h>

namespace catoptric::scene::gltf {

int size_of(const auto& list) { return static_cast<int>(list.size()); }

template <typename Vector>
std::vector<double> numbers(const Vector& v) {
    return {v.x + 0.0, v.y + 0.0, v.z + 0.0}; // + 0: no "-0.0"
}
std::vector<double> numbers(const dmat4& matrix);

/// `extras` of ours.
tinygltf::Value marked(tinygltf::Value::Object ours);
tinygltf::Value listed(const std::vector<double>& list);

/// A model and its one buffer, growing together.
struct Writer {
    const Scene& scene;
    tinygltf::Model model;
    Bytes bytes;
    tinygltf::Animation motion;
    std::map<std::tuple<std::size_t, std::size_t, bool>, int> meshes;
    std::map<const Image*, int> images;
    std::map<std::tuple<int, int, int>, int> samplers; ///< by filter and wraps
    std::map<const Rig*, std::vector<int>> rigs;       ///< the node of each of its nodes

    /// Puts the bytes into the buffer, with a view of them, the last one.
    tinygltf::BufferView& view(const void* first, std::size_t size);
    /// Puts the elements into the buffer, with a view and an accessor for them, the last one.
    template <typename Element>
    tinygltf::Accessor& append(const std::vector<Element>& list, int type, int component) {
        view(list.data(), list.size() * sizeof(Element));
        tinygltf::Accessor& accessor = model.accessors.emplace_back();
        accessor.bufferView = size_of(model.bufferViews) - 1, accessor.count = list.size();
        accessor.type = type, accessor.componentType = component;
        return accessor;
    }
    int vectors(const std::vector<vec3>& list); ///< with their bounds
    /// Names an extension that is used, once.
    void use(const std::string& extension);

    // gltf_save_material.cpp
    void add_material(const Material& material);
    tinygltf::TextureInfo texture(const Texture& texture);
    int image(const Image& image);
    int sampler(const Texture& texture);

    // gltf_save_motion.cpp: animates `node`, whose own translation at rest is `rest`
    void add_motion(const Keys& keys, const dvec3& rest, int node);
    template <typename Value>
    void add_track(const Track<Value>& track, int node, const std::string& path);
    /// The node that stands for one of a rig; all of the rig are there then.
    int node_of(const Follows& follows);
    int add_rig_node(const Rig::Node& node, int parent);
    void finish_motion();
};

/// A motion's keys, relative to the place at rest; none of what stands still or follows a rig.
std::optional<Keys> keys_of(const Motion& motion);

} // namespace catoptric::scene::gltf
