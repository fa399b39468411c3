#include "graph/graph.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <utility>

namespace catoptric::graph {

std::string_view name_of(Use use) {
    switch (use) {
    case Use::sampled: return "sampled";
    case Use::storage_read: return "storage_read";
    case Use::storage_write: return "storage_write";
    case Use::storage: return "storage";
    case Use::colour: return "colour";
    case Use::depth: return "depth";
    case Use::copy_from: return "copy_from";
    case Use::copy_to: return "copy_to";
    case Use::indirect: return "indirect";
    }
    return "";
}

bool Pass::is_raster() const {
    return std::ranges::any_of(images, [](const ImageUse& use) {
        return use.use == Use::colour || use.use == Use::depth;
    });
}

PassBuilder& PassBuilder::reads(Image image, Use use) {
    pass_.images.push_back({.image = image, .use = use, .write = false, .clear = {}});
    return *this;
}

PassBuilder& PassBuilder::reads(Buffer buffer, Use use) {
    pass_.buffers.push_back({.buffer = buffer, .use = use, .write = false});
    return *this;
}

PassBuilder& PassBuilder::writes(Image image, Use use, std::optional<Clear> clear) {
    pass_.images.push_back({.image = image, .use = use, .write = true, .clear = clear});
    return *this;
}

PassBuilder& PassBuilder::writes(Buffer buffer, Use use) {
    pass_.buffers.push_back({.buffer = buffer, .use = use, .write = true});
    return *this;
}

PassBuilder& PassBuilder::layers(std::uint32_t count) {
    pass_.layer_count = count;
    return *this;
}

void PassBuilder::record(std::function<void(Commands&)> body) { pass_.body = std::move(body); }

Image Graph::image(ImageDesc desc) {
    const auto id = static_cast<std::uint32_t>(images_.size());
    images_.push_back(std::move(desc));
    return {.id = id, .first_layer = 0, .layer_count = images_.back().layers, .previous = false};
}

Buffer Graph::buffer(BufferDesc desc) {
    buffers_.push_back(std::move(desc));
    return {static_cast<std::uint32_t>(buffers_.size() - 1)};
}

PassBuilder Graph::pass(std::string name, Tag tag) {
    Pass& pass = passes_.emplace_back();
    pass.name = std::move(name);
    pass.tag = tag;
    return PassBuilder(pass);
}

Image Graph::previous(Image image) {
    check(image.id < images_.size(), Failure::internal, "previous() of image number ", image.id,
          ", but the graph has ", images_.size(), " images");
    kept_.insert(image.id);
    image.previous = true;
    return image;
}

bool Graph::has_history(Image image) const {
    check(image.id < images_.size(), Failure::internal, "has_history() of image number ", image.id,
          ", but the graph has ", images_.size(), " images");
    return history_.contains(images_[image.id].name);
}

void Graph::want(Image image) { wanted_images_.push_back(image); }
void Graph::want(Buffer buffer) { wanted_buffers_.push_back(buffer); }
bool Graph::is_kept(std::uint32_t image) const { return kept_.contains(image); }

Graph Graph::without_bodies() const {
    Graph outline = *this;
    for (Pass& pass : outline.passes_) pass.body = nullptr;
    return outline;
}

} // namespace catoptric::graph
