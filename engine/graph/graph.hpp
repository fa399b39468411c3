#pragma once

#include "core/format.hpp"
#include "graph/run_length_array.hpp"

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// A frame as data: images, buffers and passes in the order in which they run. A frame is declared
/// (this file), planned (plan.hpp, without a device) and run (graph_runner.hpp, on the device).
namespace catoptric::gpu {
class Buffer;
}

namespace catoptric::graph {

class PassCommands;   // records the commands of a pass: graph/commands.hpp
struct PhysicalImage; // an image on the device: graph/physical.hpp

/// How a pass accesses an image or a buffer.
enum class ResourceUse {
    sampled,       ///< texture fetch, or a read-only buffer in a shader
    storage_read,  ///< imageLoad, or a storage buffer that is only read
    storage_write, ///< imageStore: earlier contents are discarded
    storage,       ///< read-modify-write: needs earlier contents
    colour,        ///< colour attachment; order of declaration = shader location
    depth,         ///< depth attachment
    copy_from,
    copy_to,
    indirect, ///< buffer of draw or dispatch arguments
    present,  ///< how an imported image is left for the window; no pass uses it
};
std::string_view use_name(ResourceUse use);

/// Purpose of a pass. `scene` passes are the scene passes that the seed report counts as R.
enum class PassPurpose { none, scene };

struct ImageDesc {
    std::string name; ///< unique in the graph
    TexelFormat format = TexelFormat::rgba16f;
    std::uint32_t width = 1;
    std::uint32_t height = 1;
    std::uint32_t layers = 1;
    bool cube = false;      ///< layers are cube faces, 6 each; may be viewed as a cube array
    std::uint32_t mips = 1; ///< each half the size of the one before, rounded down, at least 1
    friend bool operator==(const ImageDesc&, const ImageDesc&) = default;
};

/// Returns the texels along a side of a mip of an image whose side has `size` texels.
constexpr std::uint32_t mip_size(std::uint32_t size, std::uint32_t mip) {
    return std::max(size >> mip, 1u);
}

struct BufferDesc {
    std::string name; ///< unique in the graph
    std::uint64_t bytes = 0;
    friend bool operator==(const BufferDesc&, const BufferDesc&) = default;
};

/// How long the contents of an image or a buffer live.
enum class Lifetime {
    frame, ///< the contents live until the last pass of the frame that uses them
    /// Until the end of the next frame, which can read both this frame's and its own contents.
    previous,
    persistent, ///< contents last until a pass writes them again; images only
    imported,   ///< contents last as long as the owner outside the graph says
};

/// Handle of an image of one graph: of all or some of its layers and mips, or of its contents in
/// the previous frame. Valid only with the graph that made it.
struct ImageHandle {
    std::uint32_t id = 0;
    std::uint32_t first_layer = 0;
    std::uint32_t layer_count = 0;
    bool previous = false;
    std::uint32_t first_mip = 0;
    std::uint32_t mip_count = 1;
    /// `first` counts from the first layer of this handle.
    ImageHandle layers(std::uint32_t first, std::uint32_t count) const {
        return {id, first_layer + first, count, previous, first_mip, mip_count};
    }
    /// `first` counts from the first mip of this handle.
    ImageHandle mips(std::uint32_t first, std::uint32_t count) const {
        return {id, first_layer, layer_count, previous, first_mip + first, count};
    }
    ImageHandle mip(std::uint32_t number) const { return mips(number, 1); }
    friend bool operator==(const ImageHandle&, const ImageHandle&) = default;
};

/// Handle of a buffer of one graph, or of its contents in the previous frame.
struct BufferHandle {
    std::uint32_t id = 0;
    bool previous = false;
    friend bool operator==(const BufferHandle&, const BufferHandle&) = default;
};

/// Attachment contents before the pass. Colour: r, g, b, a. Depth: the first value.
using ClearValue = std::array<float, 4>;

struct ImageUse {
    ImageHandle image;
    ResourceUse use = ResourceUse::sampled;
    bool write = false;
    /// Value to which the attachment is cleared. An attachment without this value needs and keeps
    /// its earlier contents.
    std::optional<ClearValue> clear;
    bool stays = false; ///< whether a clear keeps the contents outside the pass's area
};

struct BufferUse {
    BufferHandle buffer;
    ResourceUse use = ResourceUse::sampled;
    bool write = false;
    friend bool operator==(const BufferUse&, const BufferUse&) = default;
};

/// A rectangle of a picture, in pixels from its upper left corner.
struct PixelRectangle {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
    bool operator==(const PixelRectangle&) const = default;
};

struct Pass {
    std::string name; ///< unique in the graph
    PassPurpose tag = PassPurpose::none;
    std::vector<ImageUse> images; ///< in order of declaration
    std::vector<BufferUse> buffers;
    std::uint32_t layer_count = 1; ///< layers rendered at once
    /// The area of the attachments that is cleared and drawn; without a value, the whole
    /// attachments. Contents outside the area are undefined unless ImageUse::stays is set. The area
    /// is no part of the shape and may change from frame to frame.
    std::optional<PixelRectangle> area;
    /// Most rays that the pass traces, for the progress of a frame in pieces. No part of the shape.
    std::uint64_t most_rays = 0;
    std::function<void(PassCommands&)> body;

    bool is_raster() const; ///< returns whether the pass has an attachment
};

/// Fills one pass. Every call returns the builder, and `record` is the last call.
class PassBuilder {
public:
    explicit PassBuilder(Pass& pass) : pass_(pass) {}
    PassBuilder& reads(ImageHandle image, ResourceUse use);
    PassBuilder& reads(BufferHandle buffer, ResourceUse use);
    PassBuilder& writes(ImageHandle image, ResourceUse use,
                        std::optional<ClearValue> clear = std::nullopt);
    PassBuilder& writes(BufferHandle buffer, ResourceUse use);
    /// Declares an attachment that is cleared within the pass's area and keeps its contents
    /// elsewhere.
    PassBuilder& updates(ImageHandle image, ResourceUse use, const ClearValue& clear);
    PassBuilder& layers(std::uint32_t count);
    PassBuilder& render_area(const PixelRectangle& area);
    PassBuilder& most_rays(std::uint64_t rays);
    void record(std::function<void(PassCommands&)> body);

private:
    Pass& pass_;
};

/// The content hash of each layer of each mip; no value if the layer was never written. Layer l of
/// mip m has the number m * layers + l.
using LayerHashes = RunLengthArray<std::optional<std::uint64_t>>;

/// The contents that a runner has from earlier frames.
struct GraphHistory {
    struct PersistentImage {
        ImageDesc desc;
        LayerHashes stamps;
    };
    /// Names of images and buffers whose contents in the last frame exist.
    std::set<std::string> previous;
    std::map<std::string, PersistentImage> persistent; ///< persistent images by name
};

/// The content hash of a part of a persistent image after this frame has written it.
struct ImageHash {
    ImageHandle part;
    std::uint64_t content_hash = 0;
};

class Graph {
public:
    Graph() = default;
    /// `history`: the runner's record of the last frame (GraphRunner::make_history()); empty =
    /// first frame.
    explicit Graph(GraphHistory history) : history_(std::move(history)) {}

    /// Returns a handle of all its layers and mips.
    ImageHandle add_image(ImageDesc desc);
    BufferHandle add_buffer(BufferDesc desc);
    /// Adds a persistent image: its contents stay, under its name, until a pass writes them again.
    /// They also stay through frames that do not declare the image. The memory is held as long as
    /// the runner lives. Another description under the same name discards the contents.
    ImageHandle add_persistent(ImageDesc desc);
    /// Returns whether all of a part of a persistent image has this content hash, so that no pass
    /// needs to write it. The caller defines the hash, for example of scene and settings.
    bool has_content_hash(ImageHandle part, std::uint64_t content_hash) const;
    /// Sets the content hash of a part of a persistent image that passes of this frame write. Every
    /// written layer of a persistent image must get a hash.
    void set_content_hash(ImageHandle part, std::uint64_t content_hash);
    /// Adds an image that is owned outside the graph. It is used like any other image and counts as
    /// an output. It arrives in the layout of the use `arrives`; none means that its
    /// contents do not matter. It is left in the layout of `leaves`. `outside` may change
    /// from frame to frame, must match `desc` and must live until the frame has ended.
    ImageHandle import_resource(ImageDesc desc, PhysicalImage* outside,
                                std::optional<ResourceUse> arrives, ResourceUse leaves);
    /// Adds a buffer that is owned outside the graph. Writes to it are visible to the host once the
    /// frame has ended.
    BufferHandle import_resource(BufferDesc desc, const gpu::Buffer* outside);
    PassBuilder add_pass(std::string name, PassPurpose tag = PassPurpose::none);

    /// Returns a handle of the contents at the end of the last frame: in the first frame, a black
    /// image or a buffer of zeros. Costs a second copy, whose memory is not shared.
    ImageHandle previous(ImageHandle image);
    BufferHandle previous(BufferHandle buffer);
    /// Returns whether the last frame left contents of the resource. If not, `previous`
    /// shows zeros.
    bool has_history(ImageHandle image) const;
    bool has_history(BufferHandle buffer) const;
    /// Marks an image as an output of the frame. Passes that no output depends on are culled.
    void output(ImageHandle image);
    void output(BufferHandle buffer);

    const std::vector<ImageDesc>& images() const { return images_; }
    const std::vector<BufferDesc>& buffers() const { return buffers_; }
    const std::deque<Pass>& passes() const { return passes_; }
    const std::vector<ImageHandle>& output_images() const { return output_images_; }
    const std::vector<BufferHandle>& output_buffers() const { return output_buffers_; }
    const std::vector<ImageHash>& content_hashes() const { return content_hashes_; }
    Lifetime image_lifetime(std::uint32_t image) const { return lives_[image].lifetime; }
    Lifetime buffer_lifetime(std::uint32_t buffer) const { return buffer_lives_[buffer]; }
    bool is_imported(BufferHandle buffer) const {
        return buffer_lives_[buffer.id] == Lifetime::imported;
    }
    /// Returns the use in whose layout an imported image arrives.
    std::optional<ResourceUse> use_on_import(std::uint32_t image) const {
        return lives_[image].arrives;
    }
    ResourceUse use_on_release(std::uint32_t image) const { return lives_[image].leaves; }
    PhysicalImage* imported(std::uint32_t image) const { return lives_[image].outside; }
    const gpu::Buffer* imported(BufferHandle buffer) const { return outside_buffers_[buffer.id]; }
    /// Returns the content hashes of a persistent image at the start of the frame.
    const LayerHashes& hashes_at_start(std::uint32_t image) const { return lives_[image].held; }
    /// Returns the history for the next frame once this frame has run.
    GraphHistory next_history() const;
    /// Returns a copy with declarations only, to compare other graphs with.
    Graph copy_declarations() const;

private:
    struct ImageState {
        Lifetime lifetime = Lifetime::frame;
        std::optional<ResourceUse> arrives;
        ResourceUse leaves = ResourceUse::sampled;
        PhysicalImage* outside = nullptr;
        LayerHashes held;
    };
    const ImageDesc& image_desc(ImageHandle image, const char* asked) const;
    const BufferDesc& buffer_desc(BufferHandle buffer, const char* asked) const;

    GraphHistory history_;
    std::vector<ImageDesc> images_;
    std::vector<ImageState> lives_; // one per entry of `images_`
    std::vector<BufferDesc> buffers_;
    std::vector<Lifetime> buffer_lives_; // one per entry of `buffers_`
    std::vector<const gpu::Buffer*> outside_buffers_;
    std::deque<Pass> passes_; // a deque, because builders hold references
    std::vector<ImageHandle> output_images_;
    std::vector<BufferHandle> output_buffers_;
    std::vector<ImageHash> content_hashes_;
};

} // namespace catoptric::graph
