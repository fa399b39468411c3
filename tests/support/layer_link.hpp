#pragma once

#include <vulkan/vk_layer.h>

/// Code that both Vulkan layers of the tests use (faults/layer, limits/layer).
namespace test {

/// Returns the loader's link to the next layer or the driver, from the chain of a create call; null
/// if the chain has no such link.
template <typename Link, typename Info>
Link* find_next_layer_link(const Info* create, VkStructureType type) {
    for (auto* next = static_cast<const VkBaseInStructure*>(create->pNext); next;
         next = next->pNext) {
        auto* link = const_cast<Link*>(reinterpret_cast<const Link*>(next));
        if (next->sType == type && link->function == VK_LAYER_LINK_INFO) return link;
    }
    return nullptr;
}

} // namespace test
