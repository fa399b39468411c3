#include "scene/gltf_document.hpp"

#include <cmath>

#include <glm/gtc/quaternion.hpp>

namespace catoptric::scene::gltf {

namespace {

constexpr std::size_t kDeepest = 4096; // nodes above one another

double positive(const Item& item, const Json& value, std::string_view what) {
    item.require(value.is_number() && value.get<double>() > 0, what,
                 ": wanted a number above 0, found ", shown(value));
    return value.get<double>();
}

std::optional<Sphere> sphere(const Item& ours) {
    const Json* value = ours.find("sphere");
    if (value == nullptr || *value == false) return std::nullopt;
    if (*value == true) return Sphere{.radius = 1};
    ours.require(value->is_array() && value->size() == 4,
                 "sphere: wanted true, false or [x, y, z, r], found ", shown(*value));
    const std::vector<double> numbers = ours.numbers("sphere", 4);
    return Sphere{.centre = {numbers[0], numbers[1], numbers[2]},
                  .radius = positive(ours, (*value)[3], "sphere")};
}

Marks marks_of(const Item& node) {
    Marks marks;
    const Json* extras = node.find("extras"); // of any kind; ours is an object
    if (extras == nullptr || !extras->is_object()) return marks;
    const std::optional<Item> ours = node.object("extras")->object("catoptric");
    if (!ours) return marks;
    marks.sphere = sphere(*ours);
    if (const Json* distance = ours->find("distance"))
        marks.distance = positive(*ours, *distance, "distance");
    marks.seen_by_camera = ours->flag("seen_by_camera", true);
    return marks;
}

dmat4 matrix_of(const Item& node) {
    dmat4 result(1);
    if (const std::vector<double> matrix = node.numbers("matrix", 16); !matrix.empty()) {
        for (int i = 0; i < 16; ++i) result[i / 4][i % 4] = matrix[std::size_t(i)];
        return result;
    }
    if (const std::vector<double> r = node.numbers("rotation", 4); !r.empty()) {
        const glm::dquat rotation(r[3], r[0], r[1], r[2]);
        const double length = glm::length(rotation);
        node.require(length > 0 && std::isfinite(length),
                     "rotation: wanted a quaternion with a length, found ", length);
        result = dmat4(glm::mat3_cast(glm::normalize(rotation)));
    }
    const std::vector<double> scale = node.numbers("scale", 3),
                              translation = node.numbers("translation", 3);
    for (int i = 0; i < 3 && !scale.empty(); ++i) result[i] *= scale[std::size_t(i)];
    if (const auto& t = translation; !t.empty()) result[3] = dvec4(t[0], t[1], t[2], 1);
    return result;
}

} // namespace

std::vector<Node> read_nodes(const Item& root, Context& context) {
    std::vector<Node> nodes;
    const std::size_t node_count = root.size("nodes"), mesh_count = root.size("meshes"),
                      camera_count = root.size("cameras");
    root.each("nodes", [&](const Item& item) {
        context.account.nodes.add(1, item.place());
        nodes.push_back({.name = item.name(),
                         .label = item.label(),
                         .parent_from_node = matrix_of(item),
                         .mesh = item.index("mesh", mesh_count),
                         .camera = item.index("camera", camera_count),
                         .children = item.indices("children", node_count),
                         .marks = marks_of(item)});
    });
    return nodes;
}

void check_forest(const Item& root, const std::vector<Node>& nodes) {
    constexpr std::size_t kNone = ~std::size_t(0);
    std::vector<std::size_t> parent(nodes.size(), kNone), depth(nodes.size(), 0);
    for (std::size_t i = 0; i < nodes.size(); ++i)
        for (const std::size_t child : nodes[i].children) {
            root.require(parent[child] == kNone, nodes[child].label,
                         ": wanted one parent at most, found ",
                         nodes[parent[child] % nodes.size()].label, " and ", nodes[i].label);
            parent[child] = i;
        }
    std::vector<std::size_t> waiting; // with their depth known
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (parent[i] == kNone) depth[i] = 1, waiting.push_back(i);
    while (!waiting.empty()) {
        const std::size_t i = waiting.back();
        waiting.pop_back();
        root.require(depth[i] <= kDeepest, nodes[i].label, ": wanted at most ", kDeepest,
                     " nodes one in another, found more");
        for (const std::size_t child : nodes[i].children)
            depth[child] = depth[i] + 1, waiting.push_back(child);
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) // who has no first ancestor is its own
        root.require(depth[i] > 0, nodes[i].label, ": wanted a tree, found a node within itself");
}

std::vector<std::size_t> read_roots(const Item& root, const std::vector<Node>& nodes) {
    const std::size_t scene_count = root.size("scenes");
    const std::size_t chosen = root.index("scene", scene_count).value_or(0);
    std::vector<std::size_t> roots;
    root.each("scenes", [&](const Item& item) {
        std::vector<std::size_t> listed = item.indices("nodes", nodes.size());
        if (item.number_in_list() == chosen) roots = std::move(listed);
    });
    if (scene_count > 0) return roots;
    std::vector<bool> is_child(nodes.size(), false);
    for (const Node& node : nodes)
        for (const std::size_t child : node.children) is_child[child] = true;
    for (std::size_t i = 0; i < is_child.size(); ++i)
        if (!is_child[i]) roots.push_back(i);
    return roots;
}

} // namespace catoptric::scene::gltf
