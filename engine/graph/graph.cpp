#include "graph/graph.hpp"

#include "core/error.hpp"
#include "graph/access.hpp"

#include <algorithm>
#include <utility>

namespace catoptric::graph {

std::string_view use_name(ResourceUse use) {
    switch (use) {
    case ResourceUse::sampled: return "sampled";
    case ResourceUse::storage_read: return "storage_read";
    case ResourceUse::storage_write: return "storage_write";
    case ResourceUse::storage: return "storage";
    case ResourceUse::colour: return "colour";
    case ResourceUse::depth: return "depth";
    case ResourceUse::copy_from: return "copy_from";
    case ResourceUse::copy_to: return "copy_to";
    case ResourceUse::indirect: return "indirect";
    case ResourceUse::present: return "present";
    }
    return "";
}

namespace {

ImageHandle whole_handle(std::uint32_t id, const ImageDesc& desc) {
    return {.id = id, .layer_count = desc.layers, .mip_count = desc.mips};
}

} // namespace

bool Pass::is_raster() const {
    return std::ranges::any_of(images, [](const ImageUse& use) {
        return use.use == ResourceUse::colour || use.use == ResourceUse::depth;
    });
}

PassBuilder& PassBuilder::reads(ImageHandle image, ResourceUse use) {
    pass_.images.push_back({.image = image, .use = use, .write = false, .clear = {}});
    return *this;
}

PassBuilder& PassBuilder::reads(BufferHandle buffer, ResourceUse use) {
    pass_.buffers.push_back({.buffer = buffer, .use = use, .write = false});
    return *this;
}

PassBuilder& PassBuilder::writes(ImageHandle image, ResourceUse use,
                                 std::optional<ClearValue> clear) {
    pass_.images.push_back({.image = image, .use = use, .write = true, .clear = clear});
    return *this;
}

PassBuilder& PassBuilder::writes(BufferHandle buffer, ResourceUse use) {
    pass_.buffers.push_back({.buffer = buffer, .use = use, .write = true});
    return *this;
}

PassBuilder& PassBuilder::updates(ImageHandle image, ResourceUse use, const ClearValue& clear) {
    pass_.images.push_back(
        {.image = image, .use = use, .write = true, .clear = clear, .stays = true});
    return *this;
}

PassBuilder& PassBuilder::layers(std::uint32_t count) {
    pass_.layer_count = count;
    return *this;
}

PassBuilder& PassBuilder::render_area(const PixelRectangle& area) {
    pass_.area = area;
    return *this;
}

PassBuilder& PassBuilder::most_rays(std::uint64_t rays) {
    pass_.most_rays = rays;
    return *this;
}

void PassBuilder::record(std::function<void(PassCommands&)> body) { pass_.body = std::move(body); }

ImageHandle Graph::add_image(ImageDesc desc) {
    const auto id = static_cast<std::uint32_t>(images_.size());
    images_.push_back(std::move(desc));
    lives_.emplace_back();
    return whole_handle(id, images_.back());
}

BufferHandle Graph::add_buffer(BufferDesc desc) {
    buffers_.push_back(std::move(desc));
    buffer_lives_.push_back(Lifetime::frame);
    outside_buffers_.push_back(nullptr);
    return {static_cast<std::uint32_t>(buffers_.size() - 1)};
}

ImageHandle Graph::add_persistent(ImageDesc desc) {
    const auto found = history_.persistent.find(desc.name);
    LayerHashes held(desc.layers * desc.mips);
    if (found != history_.persistent.end() && found->second.desc == desc)
        held = found->second.stamps;
    const ImageHandle handle = add_image(std::move(desc));
    lives_.back().lifetime = Lifetime::persistent;
    lives_.back().held = std::move(held);
    return handle;
}

const ImageDesc& Graph::image_desc(ImageHandle image, const char* asked) const {
    check(image.id < images_.size(), Failure::internal, asked, " of image number ", image.id,
          ", but the graph has ", images_.size(), " images");
    return images_[image.id];
}

const BufferDesc& Graph::buffer_desc(BufferHandle buffer, const char* asked) const {
    check(buffer.id < buffers_.size(), Failure::internal, asked, " of buffer number ", buffer.id,
          ", but the graph has ", buffers_.size(), " buffers");
    return buffers_[buffer.id];
}

bool Graph::has_content_hash(ImageHandle part, std::uint64_t content_hash) const {
    const ImageDesc& desc = image_desc(part, "has_content_hash()");
    check(image_lifetime(part.id) == Lifetime::persistent, Failure::internal,
          "has_content_hash() of image '", desc.name, "', which is not persistent");
    bool all = true;
    for_each_range(part, desc.layers, [&](std::uint32_t first, std::uint32_t end) {
        hashes_at_start(part.id).for_each_run(
            first, end, [&](std::uint32_t, std::uint32_t, const std::optional<std::uint64_t>& s) {
                all = all && s == content_hash;
            });
    });
    return all;
}

void Graph::set_content_hash(ImageHandle part, std::uint64_t content_hash) {
    const ImageDesc& desc = image_desc(part, "set_content_hash()");
    check(image_lifetime(part.id) == Lifetime::persistent, Failure::internal,
          "set_content_hash() of image '", desc.name, "', which is not persistent");
    content_hashes_.push_back({part, content_hash});
}

ImageHandle Graph::import_resource(ImageDesc desc, PhysicalImage* outside,
                                   std::optional<ResourceUse> arrives, ResourceUse leaves) {
    const ImageHandle handle = add_image(std::move(desc));
    lives_.back() = {.lifetime = Lifetime::imported,
                     .arrives = arrives,
                     .leaves = leaves,
                     .outside = outside,
                     .held = LayerHashes()};
    return handle;
}

BufferHandle Graph::import_resource(BufferDesc desc, const gpu::Buffer* outside) {
    const BufferHandle handle = add_buffer(std::move(desc));
    buffer_lives_.back() = Lifetime::imported;
    outside_buffers_.back() = outside;
    return handle;
}

PassBuilder Graph::add_pass(std::string name, PassPurpose tag) {
    Pass& pass = passes_.emplace_back();
    pass.name = std::move(name);
    pass.tag = tag;
    return PassBuilder(pass);
}

ImageHandle Graph::previous(ImageHandle image) {
    const ImageDesc& desc = image_desc(image, "previous()");
    Lifetime& lifetime = lives_[image.id].lifetime;
    check(lifetime == Lifetime::frame || lifetime == Lifetime::previous, Failure::internal,
          "previous() of image '", desc.name, "', which is ",
          lifetime == Lifetime::persistent ? "persistent" : "imported", " and has one copy");
    lifetime = Lifetime::previous;
    image.previous = true;
    return image;
}

bool Graph::has_history(ImageHandle image) const {
    return history_.previous.contains(image_desc(image, "has_history()").name);
}

BufferHandle Graph::previous(BufferHandle buffer) {
    const BufferDesc& desc = buffer_desc(buffer, "previous()");
    check(!is_imported(buffer), Failure::internal, "previous() of buffer '", desc.name,
          "', which is imported and has one copy");
    buffer_lives_[buffer.id] = Lifetime::previous;
    buffer.previous = true;
    return buffer;
}

bool Graph::has_history(BufferHandle buffer) const {
    return history_.previous.contains(buffer_desc(buffer, "has_history()").name);
}

void Graph::output(ImageHandle image) { output_images_.push_back(image); }
void Graph::output(BufferHandle buffer) { output_buffers_.push_back(buffer); }

GraphHistory Graph::next_history() const {
    GraphHistory left = history_;
    for (std::uint32_t i = 0; i < images_.size(); ++i) {
        if (lives_[i].lifetime == Lifetime::previous) left.previous.insert(images_[i].name);
        if (lives_[i].lifetime == Lifetime::persistent)
            left.persistent.insert_or_assign(
                images_[i].name, GraphHistory::PersistentImage{images_[i], lives_[i].held});
    }
    for (std::uint32_t b = 0; b < buffers_.size(); ++b)
        if (buffer_lives_[b] == Lifetime::previous) left.previous.insert(buffers_[b].name);
    for (const auto& [part, content_hash] : content_hashes_)
        for_each_range(part, images_[part.id].layers, [&](std::uint32_t first, std::uint32_t end) {
            left.persistent.at(images_[part.id].name).stamps.fill(first, end, content_hash);
        });
    return left;
}

Graph Graph::copy_declarations() const {
    Graph outline = *this;
    outline.history_ = {};
    for (Pass& pass : outline.passes_) pass.body = nullptr;
    for (ImageState& life : outline.lives_) life.outside = nullptr;
    for (const gpu::Buffer*& outside : outline.outside_buffers_) outside = nullptr;
    return outline;
}

} // namespace catoptric::graph
