#include "import/gltf_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace catoptric::scene::gltf {

namespace {

constexpr std::size_t kMaxNodeDepth = 4096;

double read_positive(const JsonObject& item, const Json& value, std::string_view what) {
    item.require(value.is_number() && value.get<double>() > 0, what,
                 ": wanted a number above 0, found ", describe(value));
    return value.get<double>();
}

std::optional<Sphere> read_sphere(const JsonObject& ours) {
    const Json* value = ours.find("sphere");
    if (value == nullptr || *value == false) return std::nullopt;
    if (*value == true) return Sphere{.radius = 1};
    ours.require(value->is_array() && value->size() == 4,
                 "sphere: wanted true, false or [x, y, z, r], found ", describe(*value));
    const std::vector<double> numbers = ours.numbers("sphere", 4);
    return Sphere{.centre = {numbers[0], numbers[1], numbers[2]},
                  .radius = read_positive(ours, (*value)[3], "sphere")};
}

NodeExtras read_node_extras(const JsonObject& node) {
    NodeExtras extras;
    const Json* found = node.find("extras"); // any type; only objects are ours
    if (found == nullptr || !found->is_object()) return extras;
    const std::optional<JsonObject> ours = node.object("extras")->object("catoptric");
    if (!ours) return extras;
    extras.sphere = read_sphere(*ours);
    if (const Json* distance = ours->find("distance"))
        extras.distance = read_positive(*ours, *distance, "distance");
    extras.seen_by_camera = ours->flag("seen_by_camera", true);
    return extras;
}

} // namespace

std::vector<NodeExtras> read_all_extras(const JsonObject& root) {
    std::vector<NodeExtras> extras;
    root.each("nodes", [&](const JsonObject& node) { extras.push_back(read_node_extras(node)); });
    return extras;
}

std::vector<Camera> read_cameras(const Document& document) {
    std::vector<Camera> cameras;
    for (const tinygltf::Camera& from : document.model.cameras) {
        const auto require = [&](bool ok, const auto&... parts) {
            check(ok, Failure::bad_data, document.file, ": ",
                  item_label("cameras", cameras.size(), from.name), parts...);
        };
        Camera camera{.name = from.name};
        if (from.type == "orthographic") {
            // Some exporters write a negative ymag for a picture that is turned around.
            camera.orthographic_height = 2 * std::abs(from.orthographic.ymag);
            require(camera.orthographic_height > 0 && std::isfinite(camera.orthographic_height),
                    ": orthographic: ymag: wanted a number above 0, found ",
                    from.orthographic.ymag);
        } else {
            const double fov = from.perspective.yfov;
            require(fov > 0 && fov < std::numbers::pi,
                    ": perspective: yfov: wanted an angle between 0 and pi, found ", fov);
            camera.vertical_fov_degrees = glm::degrees(fov);
        }
        cameras.push_back(std::move(camera));
    }
    return cameras;
}

dmat4 parent_from_node(const Document& document, std::size_t index) {
    const tinygltf::Node& node = document.model.nodes[index];
    const std::vector<double>&r = node.rotation, &scale = node.scale, &t = node.translation;
    dmat4 result(1);
    if (!node.matrix.empty()) return glm::make_mat4(node.matrix.data());
    if (!r.empty()) {
        const glm::dquat rotation(r[3], r[0], r[1], r[2]);
        const double length = glm::length(rotation);
        check(length > 0 && std::isfinite(length), Failure::bad_data, document.file, ": ",
              document.describe_node(index),
              ": rotation: wanted a quaternion with a length, found ", length);
        result = dmat4(glm::mat3_cast(glm::normalize(rotation)));
    }
    for (int i = 0; i < 3 && !scale.empty(); ++i) result[i] *= scale[std::size_t(i)];
    if (!t.empty()) result[3] = dvec4(t[0], t[1], t[2], 1);
    return result;
}

void check_forest(const Document& document) {
    const std::vector<tinygltf::Node>& nodes = document.model.nodes;
    const auto require = [&](bool ok, std::size_t node, const auto&... parts) {
        if (!ok)
            fail(Failure::bad_data, document.file, ": ", document.describe_node(node), parts...);
    };
    constexpr std::size_t kNoParentNode = ~std::size_t(0);
    std::vector<std::size_t> parent(nodes.size(), kNoParentNode), depth(nodes.size(), 0);
    for (std::size_t i = 0; i < nodes.size(); ++i)
        for (const int child : nodes[i].children) {
            std::size_t& its = parent[std::size_t(child)];
            if (its != kNoParentNode)
                require(false, std::size_t(child), ": wanted one parent at most, found ",
                        document.describe_node(its), " and ", document.describe_node(i));
            its = i;
        }
    std::vector<std::size_t> waiting; // nodes with known depth, children not yet visited
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (parent[i] == kNoParentNode) depth[i] = 1, waiting.push_back(i);
    while (!waiting.empty()) {
        const std::size_t i = waiting.back();
        waiting.pop_back();
        require(depth[i] <= kMaxNodeDepth, i, ": wanted at most ", kMaxNodeDepth,
                " nodes one in another, found more");
        for (const int child : nodes[i].children)
            depth[std::size_t(child)] = depth[i] + 1, waiting.push_back(std::size_t(child));
    }
    // A node that no root reaches is part of a cycle or below one.
    for (std::size_t i = 0; i < nodes.size(); ++i)
        require(depth[i] > 0, i, ": wanted a tree, found a node within itself");
}

std::vector<int> root_nodes(const tinygltf::Model& model) {
    if (!model.scenes.empty())
        return model.scenes[std::size_t(std::max(model.defaultScene, 0))].nodes;
    std::vector<bool> is_child(model.nodes.size(), false);
    for (const tinygltf::Node& node : model.nodes)
        for (const int child : node.children) is_child[std::size_t(child)] = true;
    std::vector<int> roots;
    for (std::size_t i = 0; i < is_child.size(); ++i)
        if (!is_child[i]) roots.push_back(static_cast<int>(i));
    return roots;
}

} // namespace catoptric::scene::gltf
