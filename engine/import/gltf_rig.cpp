#include "import/gltf_model.hpp"
#include "scene/motion.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <utility>

#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace catoptric::scene::gltf {

namespace {

/// How a node moves, given its own tracks and those of the nodes above it.
enum class MotionKind {
    still,
    slides, ///< moved only by one track of translations, on this node or one above it
    turns   ///< moved in any other way
};

/// The state of a node that its children continue from.
struct ParentState {
    PlacedNode placed;
    MotionKind going = MotionKind::still;
    std::optional<std::size_t> rig_node; ///< the nearest animated node, itself or above it
    dmat4 below{1};                      ///< transform from this node to the rig node
};

/// Visits the nodes from the roots down, without recursion. The nodes form a forest, but a scene
/// may list a node twice, or list both a node and its parent.
class NodePlacer {
public:
    NodePlacer(const Document& document, const NodeAnimation& animation)
        : document_(document), animation_(animation), placed_(document.model.nodes.size()) {
        for (std::size_t i = 0; i < placed_.size(); ++i) // unreached nodes are checked, too
            rest_.push_back(parent_from_node(document, i));
    }

    std::vector<PlacedNode> place_all() {
        std::vector<std::pair<std::size_t, ParentState>> waiting; // node, and state of its parent
        for (const int root : root_nodes(document_.model))
            waiting.push_back({std::size_t(root), {}});
        while (!waiting.empty()) {
            const auto [index, parent] = std::move(waiting.back());
            waiting.pop_back();
            check(!placed_[index].reached, Failure::bad_data, document_.file, ": ",
                  document_.describe_node(index),
                  ": wanted one parent at most, found a second way to it");
            const ParentState way = node_state(index, parent);
            placed_[index] = way.placed;
            for (const int child : document_.model.nodes[index].children)
                waiting.push_back({std::size_t(child), way});
        }
        finish();
        return std::move(placed_);
    }

private:
    ParentState node_state(std::size_t index, const ParentState& parent);
    std::size_t add_to_rig(std::size_t index, const ParentState& parent);
    void finish();

    const Document& document_;
    const NodeAnimation& animation_;
    std::vector<PlacedNode> placed_;
    std::vector<dmat4> rest_;
    NodeRig rig_;
};

/// Adds an animated node to the rig and returns its index. Parts of its transform without a track
/// keep their values at rest.
std::size_t NodePlacer::add_to_rig(std::size_t index, const ParentState& parent) {
    const tinygltf::Node& node = document_.model.nodes[index];
    const NodeTracks& tracks = animation_.nodes[index];
    NodeRig::RigNode to{.parent = parent.rig_node,
                        .parent_from_space = parent.rig_node ? parent.below
                                                             : parent.placed.world_from_node};
    to.translations = tracks.translations, to.scales = tracks.scales;
    to.rotations = tracks.rotations;
    if (!node.translation.empty()) to.translation = glm::make_vec3(node.translation.data());
    if (!node.scale.empty()) to.scale = glm::make_vec3(node.scale.data());
    if (!node.rotation.empty())
        to.rotation = glm::normalize(dvec4(glm::make_vec4(node.rotation.data())));
    rig_.nodes.push_back(std::move(to));
    return rig_.nodes.size() - 1;
}

ParentState NodePlacer::node_state(std::size_t index, const ParentState& parent) {
    ParentState way = parent;
    way.placed.reached = true;
    way.placed.world_from_node = parent.placed.world_from_node * rest_[index];
    const NodeTracks& tracks = animation_.nodes[index];
    if (!tracks.has_track()) {
        way.below = parent.below * rest_[index];
        if (auto* follows = std::get_if<RigAttachment>(&way.placed.motion))
            follows->node_from_object = way.below;
        return way;
    }
    const bool slides = tracks.translations && !tracks.rotations && !tracks.scales;
    way.rig_node = add_to_rig(index, parent);
    way.below = dmat4(1);
    if (slides && parent.going == MotionKind::still) {
        way.going = MotionKind::slides;
        way.placed.motion = Keyframes{.keys = tracks.translations,
                                      .world_from_keys = dmat3(parent.placed.world_from_node),
                                      .rest = dvec3(rest_[index][3]),
                                      .repeats = animation_.repeats};
        return way;
    }
    way.going = MotionKind::turns;
    way.placed.motion = RigAttachment{.node = *way.rig_node};
    return way;
}

/// Gives the rig to all nodes that follow it, and sets their transforms at time 0.
void NodePlacer::finish() {
    const bool is_used = std::ranges::any_of(placed_, [](const PlacedNode& placed) {
        return std::holds_alternative<RigAttachment>(placed.motion);
    });
    if (!is_used) return;
    rig_.repeats = animation_.repeats;
    const auto rig = std::make_shared<const NodeRig>(std::move(rig_));
    const std::vector<dmat4> first = node_transforms(*rig, 0);
    for (PlacedNode& placed : placed_)
        if (auto* follows = std::get_if<RigAttachment>(&placed.motion)) {
            follows->rig = rig;
            placed.world_from_node = first[follows->node] * follows->node_from_object;
        }
}

} // namespace

std::vector<PlacedNode> place_nodes(const Document& document, const NodeAnimation& animation) {
    return NodePlacer(document, animation).place_all();
}

std::vector<dmat4> rest_transforms(const Document& document) {
    const NodeAnimation still{.nodes = std::vector<NodeTracks>(document.model.nodes.size())};
    std::vector<dmat4> rest;
    for (const PlacedNode& placed : place_nodes(document, still))
        rest.push_back(placed.world_from_node);
    return rest;
}

std::vector<dmat4> joint_transforms(int index, const std::vector<dmat4>& at_rest,
                                    ReadContext& context) {
    const Document& document = context.document;
    const tinygltf::Skin& skin = document.model.skins[std::size_t(index)];
    const std::string place = document.file + ": " +
                              item_label("skins", std::size_t(index), skin.name);
    std::vector<dmat4> joints;
    for (const int joint : skin.joints) joints.push_back(at_rest[std::size_t(joint)]);
    if (skin.inverseBindMatrices < 0) return joints;
    const AccessorElements inverse = context.floats(skin.inverseBindMatrices, TINYGLTF_TYPE_MAT4,
                                                    context.account.attributes,
                                                    place + ": inverseBindMatrices");
    check(inverse.count >= joints.size(), Failure::bad_data, place,
          ": inverseBindMatrices: wanted one for each of ", joints.size(), " joints, found ",
          inverse.count);
    for (std::size_t i = 0; i < joints.size(); ++i) {
        dmat4 bound;
        for (int j = 0; j < 16; ++j) bound[j / 4][j % 4] = read_number(inverse, i, j);
        joints[i] = joints[i] * bound;
    }
    return joints;
}

} // namespace catoptric::scene::gltf
