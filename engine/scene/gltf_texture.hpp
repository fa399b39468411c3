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

/// The inputs and lists that readers of materials and lights use. They run before tinygltf parses
/// the document.
struct Source {
    const Item& root;
    const Container& container;
    Files& files;
    Account& account;
    Notes& notes;
    std::vector<UnsupportedFeature>& unsupported;
};

/// Reads the images and textures of a document whose members and views have been checked. Decodes
/// each image once.
class Textures {
public:
    explicit Textures(const Source& source) : source_(source) {}

    /// Returns the texture that `use`, a texture reference of a material, names. Returns none if
    /// the image is missing or has an unsupported format, or if `use` names a third set of texture
    /// coordinates. Then adds a note and an unsupported feature. Throws `bad_data` for an image
    /// that cannot be decoded, or for an invalid sampler.
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

/// Reads all materials. Throws the same errors as `Textures`, and `bad_data` for invalid factors.
std::vector<Material> read_materials(const Source& source);

/// The lights of KHR_lights_punctual in the space of their nodes, and the light of each node, if
/// any.
struct Lights {
    std::vector<Punctual> lights;
    std::vector<std::optional<std::size_t>> of_node; ///< index into `lights`
};
/// Reads all lights. Throws `bad_data`.
Lights read_lights(const Source& source);

} // namespace catoptric::scene::gltf
