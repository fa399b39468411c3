#include "gpu/pipeline.hpp"

#include "core/stopwatch.hpp"
#include "gpu/stage.hpp"
#include "shared.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>

namespace catoptric::gpu {

VkDescriptorType descriptor_type(BindingKind kind) {
    switch (kind) {
    case BindingKind::uniform_buffer: return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    case BindingKind::storage_buffer: return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    case BindingKind::texel_buffer: return VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    case BindingKind::sampled_image: return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    case BindingKind::texture: return VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    case BindingKind::sampler: return VK_DESCRIPTOR_TYPE_SAMPLER;
    case BindingKind::storage_image: return VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    }
    return VK_DESCRIPTOR_TYPE_MAX_ENUM;
}

namespace {

std::string format_constants(const ShaderConstants& constants) {
    std::string name;
    for (const auto& [constant, value] : constants)
        name += ";" + constant + "=" + std::to_string(to_bits(value));
    return name;
}

std::string raster_name(const RasterState& state, const AttachmentFormats& attachments) {
    std::string name = state.vertex + "+" + state.fragment + format_constants(state.constants) +
                       format_constants(state.features);
    for (TexelFormat format : attachments.colour)
        name += "/" + std::string(catoptric::format_name(format));
    if (attachments.depth) name += "/depth";
    if (state.blending != Blending::none)
        name += state.blending == Blending::sum ? "/summed" : "/blended";
    if (state.keeps_colour) name += "/keeps colour";
    if (state.hidden != TriangleWinding::none)
        name += state.hidden == TriangleWinding::clockwise ? "/no clockwise"
                                                           : "/no counterclockwise";
    return name;
}

/// Orders constants by name, then by the bits of the value, so that NaN compares equal to itself.
bool constants_less(const ShaderConstants& a, const ShaderConstants& b) {
    return std::ranges::lexicographical_compare(a, b, [](const auto& x, const auto& y) {
        return x.first != y.first ? x.first < y.first : to_bits(x.second) < to_bits(y.second);
    });
}

template <typename State>
bool state_less(const State& a, const State& b) {
    if (constants_less(a.constants, b.constants)) return true;
    return !constants_less(b.constants, a.constants) && constants_less(a.features, b.features);
}

void check_image_bindings(const Device& device, const std::string& name,
                          const std::vector<ShaderBinding>& bindings) {
    std::uint32_t images = 0;
    for (const ShaderBinding& binding : bindings)
        if (binding.kind == BindingKind::sampled_image || binding.kind == BindingKind::texture ||
            binding.kind == BindingKind::texel_buffer)
            images += binding.count;
    const std::uint32_t most = device.limits().maxPerStageDescriptorSampledImages;
    check(images <= most, Failure::exhausted, "pipeline '", name, "' samples ", images,
          " images, the device allows ", most);
}

/// Checks that every constant is known to a stage, merges the bindings and creates the layouts.
void make_pipeline_layout(const Device& device, const std::string& name,
                          std::span<const ShaderStage* const> stages,
                          const ShaderConstants& constants, Pipeline& pipeline) {
    for (const auto& [constant, value] : constants)
        check(std::ranges::any_of(stages,
                                  [&](const ShaderStage* s) { return s->find_constant(constant); }),
              Failure::internal, "pipeline '", name, "' has no constant '", constant, "'");
    for (const ShaderStage* stage : stages) {
        pipeline.stages |= stage->bit;
        pipeline.push_bytes = std::max(pipeline.push_bytes, stage->reflection.push_bytes);
        for (const ShaderBinding& binding : stage->reflection.bindings) {
            const auto same = std::ranges::find(pipeline.bindings, binding.binding,
                                                &ShaderBinding::binding);
            if (same == pipeline.bindings.end())
                pipeline.bindings.push_back(binding);
            else
                check(same->name == binding.name && same->kind == binding.kind &&
                          same->count == binding.count,
                      Failure::internal, "pipeline '", name, "': binding ", binding.binding,
                      " is '", same->name, "' and '", binding.name, "'");
        }
    }
    check_image_bindings(device, name, pipeline.bindings);
    std::vector<VkDescriptorSetLayoutBinding> slots;
    for (const ShaderBinding& binding : pipeline.bindings)
        slots.push_back({binding.binding, descriptor_type(binding.kind), binding.count,
                         pipeline.stages, nullptr});
    VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    set.bindingCount = static_cast<std::uint32_t>(slots.size());
    set.pBindings = slots.data();
    VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
    check_vk(vkCreateDescriptorSetLayout(device.handle(), &set, nullptr, &set_layout),
             "lay out '" + name + "'");
    pipeline.set_layout = {device.handle(), set_layout};

    const VkPushConstantRange push{pipeline.stages, 0, pipeline.push_bytes};
    VkPipelineLayoutCreateInfo create{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    create.setLayoutCount = 1;
    create.pSetLayouts = &set_layout;
    create.pushConstantRangeCount = pipeline.push_bytes ? 1 : 0;
    create.pPushConstantRanges = &push;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    check_vk(vkCreatePipelineLayout(device.handle(), &create, nullptr, &layout),
             "lay out '" + name + "'");
    pipeline.layout = {device.handle(), layout};
}

constexpr VkVertexInputBindingDescription kVertexBinding{0, sizeof(shared::Vertex),
                                                         VK_VERTEX_INPUT_RATE_VERTEX};
constexpr std::array<VkVertexInputAttributeDescription, 2> kVertexAttributes{
    {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(shared::Vertex, position)},
     {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(shared::Vertex, normal)}}};

VkPipelineRasterizationStateCreateInfo make_raster_state(TriangleWinding hidden) {
    VkPipelineRasterizationStateCreateInfo raster{
        VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.polygonMode = VK_POLYGON_MODE_FILL;
    raster.cullMode = hidden == TriangleWinding::none ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT;
    raster.frontFace = hidden == TriangleWinding::counterclockwise
                           ? VK_FRONT_FACE_CLOCKWISE
                           : VK_FRONT_FACE_COUNTER_CLOCKWISE;
    raster.lineWidth = 1;
    return raster;
}

VkPipelineDepthStencilStateCreateInfo make_depth_state(bool is_tested, Blending blending) {
    VkPipelineDepthStencilStateCreateInfo depth{
        VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    depth.depthTestEnable = is_tested;
    depth.depthWriteEnable = is_tested && blending == Blending::none;
    depth.depthCompareOp = VK_COMPARE_OP_GREATER;
    return depth;
}

std::vector<VkFormat> colour_formats(const AttachmentFormats& attachments) {
    std::vector<VkFormat> formats;
    for (const TexelFormat format : attachments.colour) formats.push_back(to_vk_format(format));
    return formats;
}

/// Returns how each of `count` colour attachments is written. Only the first is blended.
std::vector<VkPipelineColorBlendAttachmentState> blend_states(const RasterState& state,
                                                              std::size_t count) {
    VkPipelineColorBlendAttachmentState write{};
    write.colorWriteMask = 0xf;
    write.blendEnable = state.blending != Blending::none;
    write.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
    write.dstColorBlendFactor = write.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    write.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    if (state.blending == Blending::sum)
        write.srcColorBlendFactor = write.dstColorBlendFactor = write.dstAlphaBlendFactor =
            VK_BLEND_FACTOR_ONE;
    std::vector<VkPipelineColorBlendAttachmentState> writes(count, write);
    if (state.blending != Blending::none && !writes.empty())
        std::fill(writes.begin() + 1, writes.end(), decltype(write){});
    if (state.keeps_colour && !writes.empty()) writes.front() = {};
    return writes;
}

VkPipeline make_raster_pipeline(const Device& device, VkPipelineCache cache,
                                std::span<const VkPipelineShaderStageCreateInfo> stages,
                                const AttachmentFormats& attachments, const RasterState& state,
                                bool reads_vertices, VkPipelineLayout layout,
                                const std::string& name) {
    VkPipelineVertexInputStateCreateInfo vertices{
        VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    if (reads_vertices) {
        vertices.vertexBindingDescriptionCount = 1;
        vertices.vertexAttributeDescriptionCount = kVertexAttributes.size();
    }
    vertices.pVertexBindingDescriptions = &kVertexBinding;
    vertices.pVertexAttributeDescriptions = kVertexAttributes.data();
    VkPipelineInputAssemblyStateCreateInfo assembly{
        VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport{
        VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = viewport.scissorCount = 1;
    const VkPipelineRasterizationStateCreateInfo raster = make_raster_state(state.hidden);
    VkPipelineMultisampleStateCreateInfo samples{
        VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    const VkPipelineDepthStencilStateCreateInfo depth = make_depth_state(attachments.depth,
                                                                         state.blending);
    const std::vector<VkPipelineColorBlendAttachmentState> writes = blend_states(
        state, attachments.colour.size());
    VkPipelineColorBlendStateCreateInfo blend{
        VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = static_cast<std::uint32_t>(writes.size());
    blend.pAttachments = writes.data();
    const std::array dynamic_states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    dynamic.dynamicStateCount = static_cast<std::uint32_t>(dynamic_states.size());
    dynamic.pDynamicStates = dynamic_states.data();
    const std::vector<VkFormat> formats = colour_formats(attachments);
    VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    rendering.colorAttachmentCount = static_cast<std::uint32_t>(formats.size());
    rendering.pColorAttachmentFormats = formats.data();
    if (attachments.depth) rendering.depthAttachmentFormat = to_vk_format(TexelFormat::d32f);

    VkGraphicsPipelineCreateInfo create{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                        &rendering};
    create.stageCount = static_cast<std::uint32_t>(stages.size());
    create.pStages = stages.data();
    create.pVertexInputState = &vertices;
    create.pInputAssemblyState = &assembly;
    create.pViewportState = &viewport;
    create.pRasterizationState = &raster;
    create.pMultisampleState = &samples;
    create.pDepthStencilState = &depth;
    create.pColorBlendState = &blend;
    create.pDynamicState = &dynamic;
    create.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    check_vk(vkCreateGraphicsPipelines(device.handle(), cache, 1, &create, nullptr, &pipeline),
             "create pipeline '" + name + "'");
    return pipeline;
}

} // namespace

PipelineStore::PipelineStore(Device& device, std::map<std::string, std::string> variants,
                             const std::filesystem::path& cache,
                             const std::filesystem::path& shaders)
    : device_(device), variants_(std::move(variants)), cache_(device, cache), shaders_(shaders) {}

PipelineStore::~PipelineStore() = default;

const ShaderStage& PipelineStore::shader_stage(const std::string& shader, VkShaderStageFlagBits bit,
                                               const ShaderConstants& constants,
                                               const ShaderConstants& features) {
    const auto variant = variants_.find(shader);
    const std::string& name = variant == variants_.end() ? shader : variant->second;
    ShaderReflection whole = reflect_spirv(name, find_shader(name).words);
    std::pair key(name, constant_bits(device_, whole, constants, features));
    const auto found = stages_.find(key);
    if (found != stages_.end()) return *found->second;
    auto stage = std::make_unique<ShaderStage>(device_, shaders_, name, bit, std::move(whole),
                                               key.second);
    return *stages_.emplace(std::move(key), std::move(stage)).first->second;
}

bool PipelineStore::RequestLess::operator()(const RasterKeyView& a, const RasterKeyView& b) const {
    const auto first = [](const RasterKeyView& view) {
        const auto& [state, attachments] = view;
        return std::tie(state.hidden, state.blending, attachments.depth, attachments.colour,
                        state.fragment, state.vertex);
    };
    const auto order = first(a) <=> first(b);
    return order != 0 ? order < 0 : state_less(a.first, b.first);
}

bool PipelineStore::RequestLess::operator()(const ComputeState& a, const ComputeState& b) const {
    return a.shader != b.shader ? a.shader < b.shader : state_less(a, b);
}

const Pipeline& PipelineStore::raster_pipeline(const RasterState& state,
                                               const AttachmentFormats& attachments) {
    const auto found = rasters_.find(RasterKeyView(state, attachments));
    if (found != rasters_.end()) return found->second;

    const Stopwatch watch(ms_);
    const std::string name = raster_name(state, attachments);
    Pipeline pipeline;
    std::vector<const ShaderStage*> stages{
        &shader_stage(state.vertex, VK_SHADER_STAGE_VERTEX_BIT, state.constants, state.features)};
    if (!state.fragment.empty())
        stages.push_back(&shader_stage(state.fragment, VK_SHADER_STAGE_FRAGMENT_BIT,
                                       state.constants, state.features));
    make_pipeline_layout(device_, name, stages, state.constants, pipeline);
    std::vector<VkPipelineShaderStageCreateInfo> infos;
    for (const ShaderStage* stage : stages) infos.push_back(stage->create_info());
    pipeline.pipeline = {device_.handle(),
                         make_raster_pipeline(device_, cache_.handle(), infos, attachments, state,
                                              stages.front()->reflection.has_inputs,
                                              pipeline.layout, name)};
    device_.set_debug_name(VK_OBJECT_TYPE_PIPELINE,
                           reinterpret_cast<std::uint64_t>(VkPipeline(pipeline.pipeline)), name);
    return rasters_.emplace(RasterKey(state, attachments), std::move(pipeline)).first->second;
}

const Pipeline& PipelineStore::compute_pipeline(const ComputeState& state) {
    if (const auto found = computes_.find(state); found != computes_.end()) return found->second;

    const Stopwatch watch(ms_);
    const std::string name = state.shader + format_constants(state.constants) +
                             format_constants(state.features);
    Pipeline pipeline;
    pipeline.bind_point = VK_PIPELINE_BIND_POINT_COMPUTE;
    const ShaderStage* stage = &shader_stage(state.shader, VK_SHADER_STAGE_COMPUTE_BIT,
                                             state.constants, state.features);
    make_pipeline_layout(device_, name, {&stage, 1}, state.constants, pipeline);
    VkComputePipelineCreateInfo create{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    create.stage = stage->create_info();
    create.layout = pipeline.layout;
    VkPipeline handle = VK_NULL_HANDLE;
    check_vk(
        vkCreateComputePipelines(device_.handle(), cache_.handle(), 1, &create, nullptr, &handle),
        "create pipeline '" + name + "'");
    pipeline.pipeline = {device_.handle(), handle};
    device_.set_debug_name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(handle), name);
    return computes_.emplace(state, std::move(pipeline)).first->second;
}

} // namespace catoptric::gpu
