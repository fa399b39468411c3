#pragma once

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

class Recorder;

/// Images that one name of a shader can stand for: an array of textures.
inline constexpr std::size_t kMostImages = 8;

/// How a sampled image is looked up. Edges clamp; cubes are seamless.
enum class Filter {
    nearest,
    linear,
    compare,  ///< depth >= reference, 2x2 PCF
    mipmapped ///< linear, also between mips
};

/// What a pass body records with. Bindings have the names they have in the shaders and stay bound
/// until the pass ends; a name that the current pipeline does not use is ignored, one that it uses
/// and nobody bound is refused. Valid only during the call of the body.
class Commands {
public:
    Commands(Recorder& recorder, const Graph& graph, const Pass& pass, VkCommandBuffer commands,
             std::uint32_t first_layer, std::uint32_t layer_count)
        : recorder_(recorder), graph_(graph), pass_(pass), commands_(commands),
          first_layer_(first_layer), layer_count_(layer_count) {}

    /// In a pass of several layers the vertex shader's "#layered" build is used where the device
    /// can; otherwise the body is called once for each layer. Either way gl_InstanceIndex tells the
    /// layer (see draw).
    void use(gpu::RasterState state);
    void use(const gpu::ComputeState& state);
    /// The image must be declared by the pass.
    void bind(std::string_view name, Image image, Filter filter = Filter::nearest) {
        bind(name, std::span(&image, 1), filter);
    }
    /// 1 to kMostImages of them; where the shader's array is longer, its rest is the first.
    void bind(std::string_view name, std::span<const Image> images,
              Filter filter = Filter::nearest);
    /// A sampler by itself.
    void bind(std::string_view name, Filter sampler);
    void bind(std::string_view name, Buffer buffer);
    void bind(std::string_view name, const gpu::Buffer& buffer);
    /// Push constants of the draws and dispatches that follow.
    template <typename T>
    void push(const T& value) {
        push_.assign(reinterpret_cast<const std::byte*>(&value),
                     reinterpret_cast<const std::byte*>(&value) + sizeof value);
        is_pushed_ = false;
    }
    /// 32-bit indices into vertices as shaders/shared.h has them.
    /// Three vertices without attributes: screen.vert makes them a triangle over the whole picture.
    void cover();
    void geometry(const gpu::Buffer& vertices, const gpu::Buffer& indices);
    /// Draws into layers [first_layer, first_layer + layer_count) of the pass. gl_InstanceIndex is
    /// `first_instance` plus the layer.
    void draw(std::uint32_t first_index, std::uint32_t index_count, std::uint32_t first_layer = 0,
              std::uint32_t layer_count = 1, std::uint32_t first_instance = 0);
    /// Draws from here on change no pixel outside the area, which lies within the attachments.
    void scissor(const Area& area);
    void dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z = 1);
    /// Group counts x, y, z are read from the buffer, which the pass declares as indirect, at
    /// `offset` bytes.
    void dispatch_indirect(Buffer arguments, std::uint64_t offset = 0);
    /// Makes what the dispatches so far wrote visible to the following ones of this pass.
    void barrier();
    /// Both declared by the pass; same size and format, all layers of the handles.
    void copy(Image from, Image to);
    /// Both declared by the pass: texels of one mip, rows top down, layers one after the other.
    void copy(Image from, Buffer to);
    /// Sets every word of a buffer that the pass declares as copy_to.
    void fill(Buffer buffer, std::uint32_t word);
    /// Puts bytes, whole words and no more than 65536, at the start of such a buffer.
    void update(Buffer buffer, std::span<const std::byte> bytes);

private:
    struct BoundImages {
        std::array<Image, kMostImages> images{};
        std::size_t count = 1;
        Filter filter = Filter::nearest;
    };
    using Bound = std::variant<BoundImages, Filter, VkBuffer, const gpu::Buffer*>;
    void flush();
    void require_declared(Image image, std::string_view name) const;
    void require_declared(Buffer buffer, std::string_view name) const;
    void require_kind(const gpu::Binding& binding, const Bound& bound) const;
    void write_images(const gpu::Binding& binding, const Bound& bound,
                      std::vector<VkDescriptorImageInfo>& infos);
    static std::string_view list_of(const gpu::Binding& binding);
    Filter filter_of(Image image, Filter filter) const;
    void write_buffer(const gpu::Binding& binding, const Bound& bound,
                      VkDescriptorBufferInfo& buffer, VkBufferView& texels);

    Recorder& recorder_;
    const Graph& graph_;
    const Pass& pass_;
    VkCommandBuffer commands_;
    std::uint32_t first_layer_, layer_count_;
    const gpu::Pipeline* pipeline_ = nullptr;
    std::string pipeline_name_;
    std::map<std::string, Bound, std::less<>> bound_;
    bool dirty_ = true;
    VkBuffer vertices_ = VK_NULL_HANDLE, indices_ = VK_NULL_HANDLE; ///< bound by this pass
    std::vector<std::byte> push_;
    bool is_pushed_ = false; ///< the current pipeline has them
};

} // namespace catoptric::graph
