#pragma once

#include "core/math.hpp"
#include "core/work.hpp"
#include "gpu/buffer.hpp"
#include "gpu/pipeline.hpp"
#include "graph/graph.hpp"

#include <array>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace catoptric::graph {

class FrameRecorder;

/// The largest number of images that can be bound to one name of a shader, as an array of textures.
inline constexpr std::size_t kMaxBoundImages = 8;

/// How a sampled image is looked up. Coordinates clamp to the edge, and cubes are filtered across
/// faces.
enum class TextureFilter {
    nearest,
    linear,
    compare,  ///< reference >= depth, 2x2 PCF
    mipmapped ///< linear, also between mips
};

/// Records the commands of one pass. Valid only while the pass body runs.
/// Resources are bound by their names in the shaders and stay bound until the pass ends. A name
/// that the current pipeline does not use is ignored. A name that the pipeline uses and that is not
/// bound throws `internal`.
class PassCommands {
public:
    PassCommands(FrameRecorder& recorder, const Graph& graph, const Pass& pass,
                 VkCommandBuffer commands, std::uint32_t first_layer, std::uint32_t layer_count)
        : recorder_(recorder), graph_(graph), pass_(pass), commands_(commands),
          first_layer_(first_layer), layer_count_(layer_count) {}

    /// Selects a raster pipeline. A pass of several layers uses the vertex shader's "#layered"
    /// build where the device can write gl_Layer from a vertex shader. On other devices the body is
    /// called once for each layer. In both cases gl_InstanceIndex tells the layer (see `draw`).
    void bind_pipeline(gpu::RasterState state);
    void bind_pipeline(const gpu::ComputeState& state);
    /// The pass must declare the image.
    void bind(std::string_view name, ImageHandle image,
              TextureFilter filter = TextureFilter::nearest) {
        bind(name, std::span(&image, 1), filter);
    }
    /// Binds 1 to kMaxBoundImages images to an array. If the shader's array is longer, the first
    /// image fills its other entries.
    void bind(std::string_view name, std::span<const ImageHandle> images,
              TextureFilter filter = TextureFilter::nearest);
    void bind(std::string_view name, TextureFilter sampler);
    void bind(std::string_view name, BufferHandle buffer);
    void bind(std::string_view name, const gpu::Buffer& buffer);
    /// Sets the push constants for all later draws and dispatches of the pass.
    template <typename T>
    void push_constants(const T& value) {
        push_.assign(reinterpret_cast<const std::byte*>(&value),
                     reinterpret_cast<const std::byte*>(&value) + sizeof value);
        is_pushed_ = false;
    }
    /// Draws three vertices without attributes. screen.vert makes them a triangle that covers the
    /// whole picture.
    void draw_fullscreen();
    /// Sets the vertex buffer (vertices as in shaders/shared.h) and the buffer of 32-bit indices
    /// for all later draws of the pass.
    void bind_geometry(const gpu::Buffer& vertices, const gpu::Buffer& indices);
    /// Draws indexed triangles into layers [first_layer, first_layer + layer_count) of the pass.
    /// gl_InstanceIndex is `first_instance` plus the layer.
    void draw(std::uint32_t first_index, std::uint32_t index_count, std::uint32_t first_layer = 0,
              std::uint32_t layer_count = 1, std::uint32_t first_instance = 0);
    /// Limits all later draws of the pass to the area, in pixels. The area must lie within the
    /// attachments.
    void set_scissor(const PixelRectangle& area);
    void dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z = 1);
    /// Dispatches with the group counts x, y, z read from `offset` bytes into the buffer, which the
    /// pass declares as indirect, or as storage if the pass itself writes the counts.
    void dispatch_indirect(BufferHandle arguments, std::uint64_t offset = 0);
    /// Dispatches work groups that trace rays: all at once, or in ranges where they exceed what a
    /// piece of the frame may still hold. `dispatch` gets the first group of the range and the
    /// numbers of groups along x and y. Only for compute passes.
    template <typename Dispatch>
    void split_rays(std::uint32_t groups, std::uint64_t rays_per_group, const Dispatch& dispatch) {
        for (std::uint32_t first = 0; first < groups;) {
            const WorkGroupRange range = begin_range(first, groups, rays_per_group);
            dispatch(first, range.along);
            first = range.end;
        }
    }
    /// As above, for at most this many rays in a dispatch that cannot be split.
    void add_rays(std::uint64_t rays);
    std::uint64_t rays_per_piece() const;
    /// Returns a word of a buffer that the pass declares, as the passes and dispatches before left
    /// it. The host waits for them, so call it only if the frame is in pieces anyway.
    std::uint32_t read_word(BufferHandle buffer, std::uint64_t offset);
    /// Makes the writes of earlier dispatches of this pass visible to later ones, and to the counts
    /// of indirect ones.
    void storage_barrier();
    /// Copies an image to an image of the same size and format, in all layers of the handles. The
    /// pass must declare both images.
    void copy_image(ImageHandle from, ImageHandle to);
    /// Copies one mip of an image to a buffer: rows from the top down, one layer after another. The
    /// pass declares both.
    void copy_image(ImageHandle from, BufferHandle to);
    /// Sets every 32-bit word of a buffer that the pass declares as copy_to.
    void fill_buffer(BufferHandle buffer, std::uint32_t word);
    /// Writes bytes to the start of a buffer that the pass declares as copy_to: whole words, at
    /// most 65536 bytes.
    void update_buffer(BufferHandle buffer, std::span<const std::byte> bytes);

private:
    struct BoundImages {
        std::array<ImageHandle, kMaxBoundImages> images{};
        std::size_t count = 1;
        TextureFilter filter = TextureFilter::nearest;
    };
    using BoundResource = std::variant<BoundImages, TextureFilter, VkBuffer, const gpu::Buffer*>;
    void write_descriptors();
    void run_piece();
    struct WorkGroupRange {
        uvec2 along{0};        ///< work groups along x and y
        std::uint32_t end = 0; ///< first group after the range
    };
    /// Returns the next range of split_rays, for which the piece of the frame has room.
    WorkGroupRange begin_range(std::uint32_t first, std::uint32_t groups,
                               std::uint64_t rays_per_group);
    /// Adds to the counted work of the pass, if the frame counts work.
    void add_work(WorkKind kind, std::uint64_t count = 1);
    void check_declared(ImageHandle image, std::string_view name) const;
    void check_declared(BufferHandle buffer, std::string_view name) const;
    void check_kind(const gpu::ShaderBinding& binding, const BoundResource& bound) const;
    void write_image_descriptors(const gpu::ShaderBinding& binding, const BoundResource& bound,
                                 std::vector<VkDescriptorImageInfo>& infos);
    static std::string_view bound_name(const gpu::ShaderBinding& binding);
    TextureFilter sampler_filter(ImageHandle image, TextureFilter filter) const;
    void write_buffer_descriptor(const gpu::ShaderBinding& binding, const BoundResource& bound,
                                 VkDescriptorBufferInfo& buffer, VkBufferView& texels);

    FrameRecorder& recorder_;
    const Graph& graph_;
    const Pass& pass_;
    VkCommandBuffer commands_;
    std::uint32_t first_layer_, layer_count_;
    const gpu::Pipeline* pipeline_ = nullptr;
    std::string pipeline_name_;
    std::map<std::string, BoundResource, std::less<>> bound_;
    bool dirty_ = true;
    VkBuffer vertices_ = VK_NULL_HANDLE, indices_ = VK_NULL_HANDLE; ///< bound by this pass
    std::vector<std::byte> push_;
    bool is_pushed_ = false; ///< whether `push_` was recorded for the current pipeline
};

} // namespace catoptric::graph
