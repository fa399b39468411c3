#include "drivers/ray_query.hpp"

#include "ray_query_spirv.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace test {

namespace {

using gpu::check_vk;

constexpr VkBufferUsageFlags kBuildInputUsage =
    VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;

} // namespace

/// An acceleration structure of Vulkan and its memory.
struct DriverRayQuery::AccelerationStructure {
    RayQueryMemory memory;
    VkAccelerationStructureKHR handle = VK_NULL_HANDLE;
    VkDeviceAddress address = 0;
};

DriverRayQuery::DriverRayQuery(const RayQueryDevice& device) : device_(device) {
    const std::array types{VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR,
                           VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    std::array<VkDescriptorSetLayoutBinding, types.size()> bindings{};
    for (std::uint32_t i = 0; i < types.size(); ++i)
        bindings[i] = {i, types[i], 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
    VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    set.bindingCount = static_cast<std::uint32_t>(bindings.size());
    set.pBindings = bindings.data();
    VkDescriptorSetLayout set_handle = VK_NULL_HANDLE;
    check_vk(vkCreateDescriptorSetLayout(device_.handle(), &set, nullptr, &set_handle),
             "create a set layout");
    set_layout_ = {device_.handle(), set_handle};

    const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(std::uint32_t)};
    VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    layout.setLayoutCount = 1;
    layout.pSetLayouts = &set_handle;
    layout.pushConstantRangeCount = 1;
    layout.pPushConstantRanges = &push;
    VkPipelineLayout layout_handle = VK_NULL_HANDLE;
    check_vk(vkCreatePipelineLayout(device_.handle(), &layout, nullptr, &layout_handle),
             "create a pipeline layout");
    pipeline_layout_ = {device_.handle(), layout_handle};

    VkShaderModuleCreateInfo module{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    module.codeSize = sizeof(ray_query_spirv);
    module.pCode = ray_query_spirv;
    VkShaderModule module_handle = VK_NULL_HANDLE;
    check_vk(vkCreateShaderModule(device_.handle(), &module, nullptr, &module_handle),
             "create a shader module");
    const gpu::UniqueShaderModule owned(device_.handle(), module_handle);
    VkComputePipelineCreateInfo create{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    create.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    create.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    create.stage.module = module_handle;
    create.stage.pName = "main";
    create.layout = layout_handle;
    VkPipeline handle = VK_NULL_HANDLE;
    check_vk(
        vkCreateComputePipelines(device_.handle(), VK_NULL_HANDLE, 1, &create, nullptr, &handle),
        "create the pipeline of the ray query");
    pipeline_ = {device_.handle(), handle};
}

DriverRayQuery::AccelerationStructure
DriverRayQuery::build(VkAccelerationStructureTypeKHR type,
                      const VkAccelerationStructureGeometryKHR& geometry,
                      std::uint32_t primitives) const {
    VkAccelerationStructureBuildGeometryInfoKHR info{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR};
    info.type = type;
    info.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
    info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
    info.geometryCount = 1;
    info.pGeometries = &geometry;
    VkAccelerationStructureBuildSizesInfoKHR sizes{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
    device_.find_extension_function<PFN_vkGetAccelerationStructureBuildSizesKHR>(
        "vkGetAccelerationStructureBuildSizesKHR")(device_.handle(),
                                                   VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR,
                                                   &info, &primitives, &sizes);

    AccelerationStructure result;
    result.memory = device_.make_ray_query_memory(
        sizes.accelerationStructureSize, VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR);
    VkAccelerationStructureCreateInfoKHR create{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR};
    create.buffer = result.memory.buffer;
    create.size = sizes.accelerationStructureSize;
    create.type = type;
    const auto make = device_.find_extension_function<PFN_vkCreateAccelerationStructureKHR>(
        "vkCreateAccelerationStructureKHR");
    check_vk(make(device_.handle(), &create, nullptr, &result.handle),
             "create an acceleration structure");
    VkPhysicalDeviceAccelerationStructurePropertiesKHR limits{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &limits};
    vkGetPhysicalDeviceProperties2(device_.physical_device(), &properties);
    const std::uint64_t alignment = std::max(1u,
                                             limits.minAccelerationStructureScratchOffsetAlignment);
    const RayQueryMemory scratch = device_.make_ray_query_memory(
        sizes.buildScratchSize + alignment, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    info.dstAccelerationStructure = result.handle;
    info.scratchData.deviceAddress = (scratch.address + alignment - 1) / alignment * alignment;
    const VkAccelerationStructureBuildRangeInfoKHR range{primitives, 0, 0, 0};
    const VkAccelerationStructureBuildRangeInfoKHR* ranges = &range;
    const auto record = device_.find_extension_function<PFN_vkCmdBuildAccelerationStructuresKHR>(
        "vkCmdBuildAccelerationStructuresKHR");
    device_.submit_and_wait([&](VkCommandBuffer commands) { record(commands, 1, &info, &ranges); });
    VkAccelerationStructureDeviceAddressInfoKHR address{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR};
    address.accelerationStructure = result.handle;
    result.address =
        device_.find_extension_function<PFN_vkGetAccelerationStructureDeviceAddressKHR>(
            "vkGetAccelerationStructureDeviceAddressKHR")(device_.handle(), &address);
    return result;
}

DriverRayQuery::AccelerationStructure DriverRayQuery::bottom(const RayQueryMemory& corners,
                                                             std::uint32_t triangles) const {
    VkAccelerationStructureGeometryKHR geometry{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
    geometry.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
    geometry.flags = VK_GEOMETRY_OPAQUE_BIT_KHR;
    auto& data = geometry.geometry.triangles;
    data = {VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR};
    data.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
    data.vertexData.deviceAddress = corners.address;
    data.vertexStride = sizeof(vec3);
    data.maxVertex = 3 * triangles - 1;
    data.indexType = VK_INDEX_TYPE_NONE_KHR;
    return build(VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, geometry, triangles);
}

/// Builds a top-level structure with one instance of `bottom` that is not moved.
DriverRayQuery::AccelerationStructure
DriverRayQuery::top(const AccelerationStructure& bottom) const {
    VkAccelerationStructureInstanceKHR once{};
    for (int i = 0; i < 3; ++i) once.transform.matrix[i][i] = 1;
    once.mask = 0xff;
    once.flags = VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR;
    once.accelerationStructureReference = bottom.address;
    const RayQueryMemory instances = device_.make_ray_query_memory(sizeof once, kBuildInputUsage,
                                                                   &once);
    VkAccelerationStructureGeometryKHR geometry{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
    geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
    geometry.geometry.instances = {
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR};
    geometry.geometry.instances.data.deviceAddress = instances.address;
    return build(VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, geometry, 1);
}

void DriverRayQuery::trace(const AccelerationStructure& triangles, const RayQueryMemory& rays,
                           const RayQueryMemory& hits, std::uint32_t count) const {
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2}};
    VkDescriptorPoolCreateInfo create{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    create.maxSets = 1;
    create.poolSizeCount = 2;
    create.pPoolSizes = sizes;
    VkDescriptorPool handle = VK_NULL_HANDLE;
    check_vk(vkCreateDescriptorPool(device_.handle(), &create, nullptr, &handle),
             "create a descriptor pool");
    const gpu::UniqueDescriptorPool pool(device_.handle(), handle);
    const VkDescriptorSetLayout layout = set_layout_;
    VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    allocate.descriptorPool = handle;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    check_vk(vkAllocateDescriptorSets(device_.handle(), &allocate, &set),
             "allocate a descriptor set");
    VkWriteDescriptorSetAccelerationStructureKHR structure{
        VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR};
    structure.accelerationStructureCount = 1;
    structure.pAccelerationStructures = &triangles.handle;
    const VkDescriptorBufferInfo buffers[] = {{rays.buffer, 0, VK_WHOLE_SIZE},
                                              {hits.buffer, 0, VK_WHOLE_SIZE}};
    std::array<VkWriteDescriptorSet, 2> writes{};
    writes[0] = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,       &structure, set, 0, 0, 1,
                 VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR};
    writes[1] = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, set,    1, 0, 2,
                 VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,      nullptr, buffers};
    vkUpdateDescriptorSets(device_.handle(), static_cast<std::uint32_t>(writes.size()),
                           writes.data(), 0, nullptr);
    device_.submit_and_wait([&](VkCommandBuffer commands) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_layout_, 0, 1,
                                &set, 0, nullptr);
        vkCmdPushConstants(commands, pipeline_layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof count,
                           &count);
        vkCmdDispatch(commands, (count + 63) / 64, 1, 1);
        VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr,
                                VK_ACCESS_SHADER_WRITE_BIT, VK_ACCESS_HOST_READ_BIT};
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                             VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0, nullptr, 0, nullptr);
    });
}

void DriverRayQuery::destroy(const AccelerationStructure& structure) const {
    device_.find_extension_function<PFN_vkDestroyAccelerationStructureKHR>(
        "vkDestroyAccelerationStructureKHR")(device_.handle(), structure.handle, nullptr);
}

std::vector<DeviceHit> DriverRayQuery::find_closest_hits(std::span<const bvh::Triangle> triangles,
                                                         const std::vector<DeviceRay>& rays) const {
    std::vector<vec3> corners;
    for (const bvh::Triangle& t : triangles) corners.insert(corners.end(), {t.a, t.b, t.c});
    const RayQueryMemory vertices = device_.make_ray_query_memory(corners.size() * sizeof(vec3),
                                                                  kBuildInputUsage, corners.data());
    const AccelerationStructure lower = bottom(vertices,
                                               static_cast<std::uint32_t>(triangles.size()));
    const AccelerationStructure upper = top(lower);
    const RayQueryMemory in = device_.make_ray_query_memory(
        rays.size() * sizeof(DeviceRay), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, rays.data());
    const RayQueryMemory out = device_.make_ray_query_memory(rays.size() * sizeof(DeviceHit),
                                                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    trace(upper, in, out, static_cast<std::uint32_t>(rays.size()));
    std::vector<DeviceHit> hits(rays.size());
    std::memcpy(hits.data(), out.mapped, hits.size() * sizeof(DeviceHit));
    destroy(upper);
    destroy(lower);
    return hits;
}

} // namespace test
