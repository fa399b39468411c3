#pragma once

#include "core/format.hpp"

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// A frame as data: images, buffers and passes in the order in which they run.
/// declare (this file) -> plan (plan.hpp, pure) -> run (run.hpp, the device).
namespace catoptric::graph {

class Commands; // what a pass body records with: graph/commands.hpp

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
    bool cube = false; ///< layers are cube faces, 6 each; may be viewed as a cube array
    friend bool operator==(const ImageDesc&, const ImageDesc&) = default;
};

struct BufferDesc {
    std::string name; ///< unique in the graph
    std::uint64_t bytes = 0;
    friend bool operator==(const BufferDesc&, const BufferDesc&) = default;
};

/// Names an image of one graph, or some of its layers, or its contents of the frame before.
/// Valid only with the graph that made it.
struct Image {
    std::uint32_t id = 0;
    std::uint32_t first_layer = 0;
    std::uint32_t layer_count = 0;
    bool previous = false;
    /// A part of the layers, counted from this handle's first.
    Image layers(std::uint32_t first, std::uint32_t count) const {
        return {id, first_layer + first, count, previous};
    }
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
};

struct BufferUse {
    Buffer buffer;
    Use use = Use::sampled;
    bool write = false;
    friend bool operator==(const BufferUse&, const BufferUse&) = default;
};

struct Pass {
    std::string name; ///< unique in the graph
    Tag tag = Tag::none;
    std::vector<ImageUse> images; ///< in order of declaration
    std::vector<BufferUse> buffers;
    std::uint32_t layer_count = 1; ///< layers rendered at once
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
    PassBuilder& layers(std::uint32_t count);
    void record(std::function<void(Commands&)> body);

private:
    Pass& pass_;
};

/// Names of images whose contents of the last frame exist.
using History = std::set<std::string>;

class Graph {
public:
    Graph() = default;
    /// `history`: what the runner kept of the last frame (Runner::history()); empty = first frame.
    explicit Graph(History history) : history_(std::move(history)) {}

    Image image(ImageDesc desc);
    Buffer buffer(BufferDesc desc);
    PassBuilder pass(std::string name, Tag tag = Tag::none);

    /// The image's contents at the end of the last frame (black on the first). Costs a second copy
    /// of the image that nothing else may share.
    Image previous(Image image);
    /// False on the first frame, when `previous` would show black.
    bool has_history(Image image) const;
    /// The result of the frame: passes that no wanted image depends on are left out.
    void want(Image image);
    void want(Buffer buffer);

    const std::vector<ImageDesc>& images() const { return images_; }
    const std::vector<BufferDesc>& buffers() const { return buffers_; }
    const std::deque<Pass>& passes() const { return passes_; }
    const std::vector<Image>& wanted_images() const { return wanted_images_; }
    const std::vector<Buffer>& wanted_buffers() const { return wanted_buffers_; }
    bool is_kept(std::uint32_t image) const; ///< someone asked for its `previous`
    /// The declarations alone, to compare other graphs with.
    Graph without_bodies() const;

private:
    History history_;
    std::vector<ImageDesc> images_;
    std::vector<BufferDesc> buffers_;
    std::deque<Pass> passes_; // builders hold references
    std::vector<Image> wanted_images_;
    std::vector<Buffer> wanted_buffers_;
    std::set<std::uint32_t> kept_;
};

} // namespace catoptric::graph
