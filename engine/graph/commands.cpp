#include "graph/commands.hpp"

#include "graph/frame_recorder.hpp"

#include <algorithm>
#include <utility>

namespace catoptric::graph {

namespace {

// Names of the specialisation constant and the buffer by which shaders/lib/work.glsl counts work.
constexpr const char* kCountWorkConstant = "count_work";
constexpr std::string_view kWorkBufferName = "WorkBuffer";

/// Returns the bytes of the part's first mip.
std::uint64_t first_mip_bytes(const ImageDesc& desc, const ImageHandle& part) {
    return std::uint64_t{mip_size(desc.width, part.first_mip)} *
           mip_size(desc.height, part.first_mip) * part.layer_count * bytes_per_texel(desc.format);
}

} // namespace

void PassCommands::add_work(WorkKind kind, std::uint64_t count) {
    if (WorkCounter* const work = recorder_.work_counter()) work->add(kind, count);
}

void PassCommands::bind_pipeline(gpu::RasterState state) {
    gpu::AttachmentFormats attachments;
    for (const ImageUse& use : pass_.images) {
        if (use.use == ResourceUse::colour)
            attachments.colour.push_back(graph_.images()[use.image.id].format);
        if (use.use == ResourceUse::depth) attachments.depth = true;
    }
    if (layer_count_ > 1) state.vertex += "#layered";
    if (recorder_.work_counter()) state.features.emplace_back(kCountWorkConstant, 1u);
    pipeline_name_ = state.vertex + "+" + state.fragment;
    pipeline_ = &recorder_.pipeline_store().raster_pipeline(state, attachments);
    vkCmdBindPipeline(commands_, pipeline_->bind_point, pipeline_->pipeline);
    dirty_ = true, is_pushed_ = false;
}

void PassCommands::bind_pipeline(const gpu::ComputeState& state) {
    pipeline_name_ = state.shader;
    gpu::ComputeState counting;
    if (recorder_.work_counter()) {
        counting = state;
        counting.features.emplace_back(kCountWorkConstant, 1u);
    }
    pipeline_ = &recorder_.pipeline_store().compute_pipeline(recorder_.work_counter() ? counting
                                                                                      : state);
    vkCmdBindPipeline(commands_, pipeline_->bind_point, pipeline_->pipeline);
    dirty_ = true, is_pushed_ = false;
}

void PassCommands::check_declared(ImageHandle image, std::string_view name) const {
    const auto same = [&](const ImageUse& use) {
        return use.image.id == image.id && use.image.previous == image.previous &&
               use.image.first_mip <= image.first_mip &&
               image.first_mip + image.mip_count <= use.image.first_mip + use.image.mip_count &&
               use.image.first_layer <= image.first_layer &&
               image.first_layer + image.layer_count <=
                   use.image.first_layer + use.image.layer_count;
    };
    check(std::ranges::any_of(pass_.images, same), Failure::internal, "pass '", pass_.name,
          "' uses image '", graph_.images()[image.id].name, "' as '", name,
          "' but does not declare it");
}

void PassCommands::bind(std::string_view name, std::span<const ImageHandle> images,
                        TextureFilter filter) {
    check(!images.empty() && images.size() <= kMaxBoundImages, Failure::internal, "pass '",
          pass_.name, "': '", name, "' wants 1 to ", kMaxBoundImages, " images, found ",
          images.size());
    BoundImages bound{{}, images.size(), filter};
    std::ranges::copy(images, bound.images.begin());
    for (const ImageHandle& image : images) check_declared(image, name);
    bound_.insert_or_assign(std::string(name), bound);
    dirty_ = true;
}

void PassCommands::bind(std::string_view name, TextureFilter sampler) {
    bound_.insert_or_assign(std::string(name), sampler);
    dirty_ = true;
}

void PassCommands::check_declared(BufferHandle buffer, std::string_view name) const {
    check(std::ranges::any_of(pass_.buffers,
                              [&](const BufferUse& use) { return use.buffer == buffer; }),
          Failure::internal, "pass '", pass_.name, "' uses buffer '",
          graph_.buffers()[buffer.id].name, "' as '", name, "' but does not declare it");
}

void PassCommands::bind(std::string_view name, BufferHandle buffer) {
    check_declared(buffer, name);
    bound_.insert_or_assign(std::string(name), recorder_.vulkan_buffer(buffer));
    dirty_ = true;
}

void PassCommands::bind(std::string_view name, const gpu::Buffer& buffer) {
    bound_.insert_or_assign(std::string(name), &buffer);
    dirty_ = true;
}

void PassCommands::bind_geometry(const gpu::Buffer& vertices, const gpu::Buffer& indices) {
    const VkDeviceSize offset = 0;
    if (const VkBuffer buffer = vertices.handle(); std::exchange(vertices_, buffer) != buffer)
        vkCmdBindVertexBuffers(commands_, 0, 1, &buffer, &offset);
    if (const VkBuffer buffer = indices.handle(); std::exchange(indices_, buffer) != buffer)
        vkCmdBindIndexBuffer(commands_, buffer, 0, VK_INDEX_TYPE_UINT32);
}

void PassCommands::draw(std::uint32_t first_index, std::uint32_t index_count,
                        std::uint32_t first_layer, std::uint32_t layer_count,
                        std::uint32_t first_instance) {
    const std::uint32_t first = std::max(first_layer, first_layer_);
    const std::uint32_t end = std::min(first_layer + layer_count, first_layer_ + layer_count_);
    if (first >= end || index_count == 0) return;
    write_descriptors();
    add_work(WorkKind::draws);
    vkCmdDrawIndexed(commands_, index_count, end - first, first_index, 0, first_instance + first);
}

void PassCommands::draw_fullscreen() {
    write_descriptors();
    add_work(WorkKind::draws);
    vkCmdDraw(commands_, 3, 1, 0, 0);
}

void PassCommands::set_scissor(const PixelRectangle& area) {
    const VkRect2D scissor{{static_cast<std::int32_t>(area.x), static_cast<std::int32_t>(area.y)},
                           {area.width, area.height}};
    vkCmdSetScissor(commands_, 0, 1, &scissor);
}

void PassCommands::dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    write_descriptors();
    add_work(WorkKind::dispatches);
    vkCmdDispatch(commands_, x, y, z);
}

void PassCommands::dispatch_indirect(BufferHandle arguments, std::uint64_t offset) {
    const auto same = [&](const BufferUse& use) {
        return use.buffer.id == arguments.id &&
               (use.use == ResourceUse::indirect || use.use == ResourceUse::storage);
    };
    check(std::ranges::any_of(pass_.buffers, same), Failure::internal, "pass '", pass_.name,
          "' dispatches what buffer '", graph_.buffers()[arguments.id].name,
          "' says but does not declare it as indirect or storage");
    write_descriptors();
    add_work(WorkKind::dispatches);
    vkCmdDispatchIndirect(commands_, recorder_.vulkan_buffer(arguments), offset);
}

void PassCommands::storage_barrier() {
    gpu::memory_barrier(
        commands_, {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_WRITE_BIT},
        {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
         VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT |
             VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT});
}

void PassCommands::copy_image(ImageHandle from, ImageHandle to) {
    check_declared(from, "source of a copy");
    check_declared(to, "target of a copy");
    const ImageDesc& desc = graph_.images()[from.id];
    const VkImageAspectFlags aspect = is_depth(desc.format) ? VK_IMAGE_ASPECT_DEPTH_BIT
                                                            : VK_IMAGE_ASPECT_COLOR_BIT;
    VkImageCopy region{};
    region.srcSubresource = {aspect, from.first_mip, from.first_layer, from.layer_count};
    region.dstSubresource = {aspect, to.first_mip, to.first_layer, to.layer_count};
    region.extent = {mip_size(desc.width, from.first_mip), mip_size(desc.height, from.first_mip),
                     1};
    add_work(WorkKind::bytes, first_mip_bytes(desc, from));
    vkCmdCopyImage(commands_, recorder_.physical_image(from).image,
                   VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, recorder_.physical_image(to).image,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
}

void PassCommands::copy_image(ImageHandle from, BufferHandle to) {
    check_declared(from, "source of a copy");
    check_declared(to, "target of a copy");
    const VkBufferImageCopy region = copy_region(graph_.images()[from.id], from);
    add_work(WorkKind::bytes, first_mip_bytes(graph_.images()[from.id], from));
    vkCmdCopyImageToBuffer(commands_, recorder_.physical_image(from).image,
                           VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, recorder_.vulkan_buffer(to), 1,
                           &region);
}

void PassCommands::fill_buffer(BufferHandle buffer, std::uint32_t word) {
    check_declared(buffer, "target of a fill");
    add_work(WorkKind::bytes, graph_.buffers()[buffer.id].bytes);
    vkCmdFillBuffer(commands_, recorder_.vulkan_buffer(buffer), 0, VK_WHOLE_SIZE, word);
}

void PassCommands::update_buffer(BufferHandle buffer, std::span<const std::byte> bytes) {
    check_declared(buffer, "target of an update");
    add_work(WorkKind::bytes, bytes.size());
    vkCmdUpdateBuffer(commands_, recorder_.vulkan_buffer(buffer), 0, bytes.size(), bytes.data());
}

namespace {

bool is_image_binding(gpu::BindingKind kind) {
    using gpu::BindingKind;
    return kind == BindingKind::sampled_image || kind == BindingKind::texture ||
           kind == BindingKind::storage_image;
}

const char* kind_name(bool image, bool sampler) {
    return image ? "an image" : sampler ? "a sampler" : "a buffer";
}

} // namespace

void PassCommands::check_kind(const gpu::ShaderBinding& binding, const BoundResource& bound) const {
    const bool wants_image = is_image_binding(binding.kind),
               wants_sampler = binding.kind == gpu::BindingKind::sampler,
               image = std::holds_alternative<BoundImages>(bound),
               sampler = std::holds_alternative<TextureFilter>(bound);
    check(wants_image == image && wants_sampler == sampler, Failure::internal, "pass '", pass_.name,
          "': '", binding.name, "' of ", pipeline_name_, " is ",
          kind_name(wants_image, wants_sampler), ", bound is ", kind_name(image, sampler));
}

void PassCommands::write_image_descriptors(const gpu::ShaderBinding& binding,
                                           const BoundResource& bound,
                                           std::vector<VkDescriptorImageInfo>& infos) {
    using gpu::BindingKind;
    if (const auto* filter = std::get_if<TextureFilter>(&bound)) {
        infos.push_back({recorder_.sampler(*filter), VK_NULL_HANDLE, VK_IMAGE_LAYOUT_UNDEFINED});
        return;
    }
    const auto& [images, count, filter] = std::get<BoundImages>(bound);
    const bool stored = binding.kind == BindingKind::storage_image;
    for (std::size_t i = 0; i < binding.count; ++i) {
        const ImageHandle image = images[i < count ? i : 0];
        infos.push_back(
            {binding.kind == BindingKind::sampled_image
                 ? recorder_.sampler(sampler_filter(image, filter))
                 : VK_NULL_HANDLE,
             recorder_.physical_image(image).view(recorder_.recording_device(), binding.shape,
                                                  image),
             stored ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    }
}

void PassCommands::write_buffer_descriptor(const gpu::ShaderBinding& binding,
                                           const BoundResource& bound,
                                           VkDescriptorBufferInfo& buffer, VkBufferView& texels) {
    const auto* owned = std::get_if<const gpu::Buffer*>(&bound);
    buffer = {owned ? (*owned)->handle() : std::get<VkBuffer>(bound), 0, VK_WHOLE_SIZE};
    if (binding.kind != gpu::BindingKind::texel_buffer) return;
    check(owned && (*owned)->texel_view(), Failure::internal, "pass '", pass_.name, "': '",
          binding.name, "' wants a buffer of texels");
    texels = (*owned)->texel_view();
}

/// Returns the name under which a pass binds the resource of this binding. A list of texels has two
/// bindings, a texel buffer and a storage buffer, with one name (shaders/lib/texels.glsl).
std::string_view PassCommands::bound_name(const gpu::ShaderBinding& binding) {
    constexpr std::string_view kStorageBufferNameSuffix = "_in_storage";
    std::string_view name = binding.name;
    if (name.ends_with(kStorageBufferNameSuffix))
        name.remove_suffix(kStorageBufferNameSuffix.size());
    return name;
}

/// Returns the filter of the sampler for an image. On devices that do not filter 32-bit floats,
/// images of distances use the nearest texel. There the shader interpolates them itself
/// (`distances_by_gather`).
TextureFilter PassCommands::sampler_filter(ImageHandle image, TextureFilter filter) const {
    const ImageDesc& desc = graph_.images()[image.id];
    const bool is_float = desc.format == TexelFormat::r32f || desc.format == TexelFormat::rgba32f;
    if (!is_float || filter == TextureFilter::nearest ||
        recorder_.recording_device().filters_floats())
        return filter;
    check(desc.format == TexelFormat::r32f && filter == TextureFilter::linear, Failure::no_device,
          "pass '", pass_.name, "' filters '", desc.name,
          "', an image of 32-bit floats, which device '", recorder_.recording_device().info().name,
          "' cannot");
    return TextureFilter::nearest;
}

/// Writes a fresh descriptor set when pipeline or bindings changed, then the push constants.
void PassCommands::write_descriptors() {
    check(pipeline_, Failure::internal, "pass '", pass_.name,
          "' draws or dispatches without a pipeline");
    if (dirty_ && !pipeline_->bindings.empty()) {
        const VkDescriptorSet set = recorder_.allocate_descriptor_set(pipeline_->set_layout);
        const std::size_t count = pipeline_->bindings.size();
        std::size_t image_count = 0;
        for (const gpu::ShaderBinding& binding : pipeline_->bindings) image_count += binding.count;
        std::vector<VkDescriptorImageInfo> images; // the descriptor writes point into these lists
        images.reserve(image_count);
        std::vector<VkDescriptorBufferInfo> buffers(count);
        std::vector<VkBufferView> texels(count);
        std::vector<VkWriteDescriptorSet> writes;
        writes.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            const gpu::ShaderBinding& binding = pipeline_->bindings[i];
            const bool is_work = binding.name == kWorkBufferName && recorder_.work_counter();
            const auto bound = bound_.find(bound_name(binding));
            check(is_work || bound != bound_.end(), Failure::internal, "pass '", pass_.name,
                  "': nothing is bound to '", binding.name, "' of ", pipeline_name_);
            if (!is_work) check_kind(binding, bound->second);
            VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
            write.dstSet = set;
            write.dstBinding = binding.binding;
            write.descriptorCount = binding.count;
            write.descriptorType = gpu::descriptor_type(binding.kind);
            write.pImageInfo = images.data() + images.size();
            write.pBufferInfo = &buffers[i];
            write.pTexelBufferView = &texels[i];
            if (is_work)
                buffers[i] = recorder_.work_counter()->shader_counts();
            else if (is_image_binding(binding.kind) || binding.kind == gpu::BindingKind::sampler)
                write_image_descriptors(binding, bound->second, images);
            else
                write_buffer_descriptor(binding, bound->second, buffers[i], texels[i]);
            writes.push_back(write);
        }
        vkUpdateDescriptorSets(recorder_.recording_device().handle(),
                               static_cast<std::uint32_t>(writes.size()), writes.data(), 0,
                               nullptr);
        vkCmdBindDescriptorSets(commands_, pipeline_->bind_point, pipeline_->layout, 0, 1, &set, 0,
                                nullptr);
    }
    dirty_ = false;
    if (pipeline_->push_bytes && !std::exchange(is_pushed_, true)) {
        check(push_.size() == pipeline_->push_bytes, Failure::internal, "pass '", pass_.name,
              "': ", pipeline_name_, " wants ", pipeline_->push_bytes,
              " bytes of push constants, got ", push_.size());
        vkCmdPushConstants(commands_, pipeline_->layout, pipeline_->stages, 0,
                           pipeline_->push_bytes, push_.data());
    }
}

} // namespace catoptric::graph
