#pragma once

#include "core/format.hpp"
#include "graph/runs.hpp"

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

/// A frame as data: images, buffers and passes in the order in which they run.
/// declare (this file) -> plan (plan.hpp, pure) -> run (run.hpp, the device).
namespace catoptric::gpu {
class Buffer;
}

namespace catoptric::graph {

class Commands;  // what a pass body records with: graph/commands.hpp
struct Physical; // an image on the device: graph/physical.hpp

/// How a pass touches an image or a buffer.
enum class Use {
    sampled,       ///< texture fetch, or a read-only buffer in a shader
    storage_read,  ///< imageLoad, or a storage buffer that is only read
    storage_write, ///< imageStore: contents before are discarded
    storage,       ///< read and written (read-modify-write): needs contents
    colour,        ///< colour attachment, in order of declaration = shader location
    depth,         ///< depth attachment
    copy_from,
    copy_to,
    indirect, ///< buffer of draw or dispatch arguments
    present,  ///< what the window wants of an imported image; no pass uses it so
};
std::string_view name_of(Use use);

/// What a pass is for; `scene` passes are counted as the report counts its R.
enum class Tag { none, scene };

struct ImageDesc {
    std::string name; ///< unique in the graph
    Format format = Format::rgba16f;
    std::uint32_t width = 1;
    std::uint32_t height = 1;
    std::uint32_t layers = 1;
    bool cube = false;      ///< layers are cube faces, 6 each; may be viewed as a cube array
    std::uint32_t mips = 1; ///< each half as large as the one before, rounded down, at least 1
    friend bool operator==(const ImageDesc&, const ImageDesc&) = default;
};

/// Texels along a side of a mip of an image that is so large.
constexpr std::uint32_t at_mip(std::uint32_t size, std::uint32_t mip) {
    return std::max(size >> mip, 1u);
}

struct BufferDesc {
    std::string name; ///< unique in the graph
    std::uint64_t bytes = 0;
    friend bool operator==(const BufferDesc&, const BufferDesc&) = default;
};

/// How long contents live.
enum class Lifetime {
    frame,      ///< between the passes of a frame
    previous,   ///< and in the next frame, which reads them beside its own
    persistent, ///< until a pass writes them again
    imported,   ///< as long as somebody else says
};

/// Names an image of one graph, or some of its layers and mips, or its contents of the frame
/// before. Valid only with the graph that made it.
struct Image {
    std::uint32_t id = 0;
    std::uint32_t first_layer = 0;
    std::uint32_t layer_count = 0;
    bool previous = false;
    std::uint32_t first_mip = 0;
    std::uint32_t mip_count = 1;
    /// A part of the layers, counted from this handle's first.
    Image layers(std::uint32_t first, std::uint32_t count) const {
        return {id, first_layer + first, count, previous, first_mip, mip_count};
    }
    /// A part of the mips, likewise.
    Image mips(std::uint32_t first, std::uint32_t count) const {
        return {id, first_layer, layer_count, previous, first_mip + first, count};
    }
    Image mip(std::uint32_t number) const { return mips(number, 1); }
    friend bool operator==(const Image&, const Image&) = default;
};

struct Buffer {
    std::uint32_t id = 0;
    friend bool operator==(const Buffer&, const Buffer&) = default;
};

/// Attachment contents before the pass. Colour: r, g, b, a. Depth: the first value.
using Clear = std::array<float, 4>;

struct ImageUse {
    Image image;
    Use use = Use::sampled;
    bool write = false;
    std::optional<Clear> clear; ///< an attachment without it keeps (and needs) what was there
    bool stays = false;         ///< ... and outside of the pass's area one with it does
};

struct BufferUse {
    Buffer buffer;
    Use use = Use::sampled;
    bool write = false;
    friend bool operator==(const BufferUse&, const BufferUse&) = default;
};

/// Of a picture, in pixels from its upper left corner.
struct Area {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
    bool operator==(const Area&) const = default;
};

struct Pass {
    std::string name; ///< unique in the graph
    Tag tag = Tag::none;
    std::vector<ImageUse> images; ///< in order of declaration
    std::vector<BufferUse> buffers;
    std::uint32_t layer_count = 1; ///< layers rendered at once
    /// All that is cleared and drawn of attachments; what they hold elsewhere is nobody's, unless
    /// it stays. Nothing: the whole. No part of the shape: it may differ from frame to frame.
    std::optional<Area> area;
    std::function<void(Commands&)> body;

    bool is_raster() const; ///< has an attachment
};

/// Fills one pass; every call returns the builder. `record` ends the sentence.
class PassBuilder {
public:
    explicit PassBuilder(Pass& pass) : pass_(pass) {}
    PassBuilder& reads(Image image, Use use);
    PassBuilder& reads(Buffer buffer, Use use);
    PassBuilder& writes(Image image, Use use, std::optional<Clear> clear = std::nullopt);
    PassBuilder& writes(Buffer buffer, Use use);
    /// An attachment that is cleared within the pass's area and elsewhere keeps what was there.
    PassBuilder& updates(Image image, Use use, const Clear& clear);
    PassBuilder& layers(std::uint32_t count);
    PassBuilder& area(const Area& area);
    void record(std::function<void(Commands&)> body);

private:
    Pass& pass_;
};

/// For each layer of each mip (layer l of mip m has number m * layers + l) what it was made from;
/// nothing: it was never written.
using ContentHashes = Runs<std::optional<std::uint64_t>>;

/// What a runner has of the frames before.
struct History {
    struct PersistentImage {
        ImageDesc desc;
        ContentHashes stamps;
    };
    std::set<std::string> previous; ///< images whose contents of the last frame exist
    std::map<std::string, PersistentImage> persistent; ///< by name
};

/// What this frame writes into a part of a kept image is made from what the number stands for.
struct ContentRecord {
    Image part;
    std::uint64_t content_hash = 0;
};

class Graph {
public:
    Graph() = default;
    /// `history`: what the runner kept of the last frame (Runner::history()); empty = first frame.
    explicit Graph(History history) : history_(std::move(history)) {}

    /// The handle names all layers and mips.
    Image image(ImageDesc desc);
    Buffer buffer(BufferDesc desc);
    /// An image whose contents stay, under its name, until a pass writes them again; also through
    /// frames that do not declare it. Its memory is taken for as long as the runner lives. Another
    /// description under the same name starts anew.
    Image persistent(ImageDesc desc);
    /// Whether all of the part of a kept image holds what was made from `stamp`, so that no pass
    /// needs to write it. What `stamp` stands for is the caller's: a hash of scene and settings.
    bool holds_content(Image part, std::uint64_t content_hash) const;
    /// Says what passes of this frame make the part of a kept image from. Every layer that is
    /// written must be said to be made from something.
    void set_content_hash(Image part, std::uint64_t content_hash);
    /// An image of somebody else's, used like any other; what is written to it is wanted. It comes
    /// in the layout of the use `arrives` (nothing: its contents do not matter) and is left in that
    /// of `leaves`. `outside`, which may differ from frame to frame, must be as `desc` says and
    /// live until the frame has ended.
    Image import(ImageDesc desc, Physical* outside, std::optional<Use> arrives, Use leaves);
    /// Likewise; what is written to it is visible to the host once the frame has ended.
    Buffer import(BufferDesc desc, const gpu::Buffer* outside);
    PassBuilder pass(std::string name, Tag tag = Tag::none);

    /// The image's contents at the end of the last frame (black on the first). Costs a second copy
    /// of the image that nothing else may share.
    Image previous(Image image);
    /// False on the first frame, when `previous` would show black.
    bool has_history(Image image) const;
    /// The result of the frame: passes that no wanted image depends on are left out.
    void mark_output(Image image);
    void mark_output(Buffer buffer);

    const std::vector<ImageDesc>& images() const { return images_; }
    const std::vector<BufferDesc>& buffers() const { return buffers_; }
    const std::deque<Pass>& passes() const { return passes_; }
    const std::vector<Image>& output_images() const { return wanted_images_; }
    const std::vector<Buffer>& output_buffers() const { return wanted_buffers_; }
    const std::vector<ContentRecord>& stamps() const { return stamped_; }
    Lifetime lifetime(std::uint32_t image) const { return lives_[image].lifetime; }
    bool is_imported(Buffer buffer) const { return imported_buffers_[buffer.id]; }
    /// Of an imported image.
    std::optional<Use> arrives(std::uint32_t image) const { return lives_[image].arrives; }
    Use leaves(std::uint32_t image) const { return lives_[image].leaves; }
    Physical* outside(std::uint32_t image) const { return lives_[image].outside; }
    const gpu::Buffer* outside(Buffer buffer) const { return outside_buffers_[buffer.id]; }
    /// Of a kept image: what it holds at the start of the frame.
    const ContentHashes& held(std::uint32_t image) const { return lives_[image].held; }
    /// What there is for the next frame once this one has run.
    History left() const;
    /// The declarations alone, to compare other graphs with.
    Graph without_bodies() const;

private:
    struct ImageLife {
        Lifetime lifetime = Lifetime::frame;
        std::optional<Use> arrives;
        Use leaves = Use::sampled;
        Physical* outside = nullptr;
        ContentHashes held;
    };
    const ImageDesc& described(Image image, const char* asked) const;

    History history_;
    std::vector<ImageDesc> images_;
    std::vector<ImageLife> lives_; // of `images_`
    std::vector<BufferDesc> buffers_;
    std::vector<char> imported_buffers_; // of `buffers_`
    std::vector<const gpu::Buffer*> outside_buffers_;
    std::deque<Pass> passes_; // builders hold references
    std::vector<Image> wanted_images_;
    std::vector<Buffer> wanted_buffers_;
    std::vector<ContentRecord> stamped_;
};

} // namespace catoptric::graph
