#pragma once

#include "scene/files.hpp"
#include "scene/gltf_container.hpp"
#include "scene/notes.hpp"
#include "scene/scene.hpp"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace catoptric::scene::gltf {

/// What a document's materials and lights are read with, before tinygltf has it.
struct Source {
    const Item& root;
    const Container& container;
    Files& files;
    Account& account;
    Notes& notes;
    std::vector<UnsupportedFeature>& unsupported;
};

/// The pictures and textures of a document whose members and views have been checked.
class Textures {
public:
    explicit Textures(const Source& source) : source_(source) {}

    /// The texture that `use`, one of a material's, names. None where there is no such picture, or
    /// not one of a kind that is read: a note and a gap say so. Throws `bad_data` for one that
    /// cannot be decoded, or a sampler that cannot be.
    std::optional<Texture> of(const Item& use, bool srgb);

private:
    std::shared_ptr<const Image> image(std::size_t index, const Item& use);
    std::shared_ptr<const Image> decoded(const Item& image, const Item& use);
    std::shared_ptr<const Image> from_file(const Item& image, const Item& use);
    std::shared_ptr<const Image> missing(const Item& image, const std::string& why,
                                         const Item& use);

    const Source& source_;
    std::map<std::size_t, std::shared_ptr<const Image>> images_;
    std::map<std::string, std::shared_ptr<const Image>> files_; ///< by real path
};

/// All materials. `bad_data` as `Textures`, and for factors that cannot be.
std::vector<Material> read_materials(const Source& source);

/// The lights of KHR_lights_punctual, in the space of a node, and each node's, if it has one.
struct Lights {
    std::vector<Punctual> lights;
    std::vector<std::optional<std::size_t>> of_node;
};
Lights read_lights(const Source& source);

} // namespace catoptric::scene::gltf
