#pragma once

#include "import/files.hpp"
#include "import/gltf_container.hpp"
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
struct MaterialContext {
    const JsonObject& root;
    const Container& container;
    FileOpener& files;
    LoadAccount& account;
    LoaderNotes& notes;
    std::vector<UnsupportedFeature>& unsupported;
};

/// Reads the images and textures of a document whose members and views have been checked. Decodes
/// each image once.
class TextureReader {
public:
    explicit TextureReader(const MaterialContext& source) : source_(source) {}

    /// Returns the texture that `use`, a texture reference of a material, names. Returns none if
    /// the image is missing or has an unsupported format, or if `use` names a third set of texture
    /// coordinates. Then adds a note and an unsupported feature. Throws `bad_data` for an image
    /// that cannot be decoded, or for an invalid sampler.
    std::optional<Texture> read(const JsonObject& use, bool srgb);

private:
    std::shared_ptr<const Image> image(std::size_t index, const JsonObject& use);
    std::shared_ptr<const Image> decoded(const JsonObject& image, const JsonObject& use);
    std::shared_ptr<const Image> from_file(const JsonObject& image, const JsonObject& use);
    std::shared_ptr<const Image> report_missing(const JsonObject& image, const std::string& why,
                                                const JsonObject& use);

    const MaterialContext& source_;
    std::map<std::size_t, std::shared_ptr<const Image>> images_;
    std::map<std::string, std::shared_ptr<const Image>> files_; ///< by real path
};

/// Throws the same errors as `TextureReader`, and `bad_data` for invalid factors.
std::vector<Material> read_materials(const MaterialContext& source);

/// The lights of KHR_lights_punctual in the space of their nodes, and the light of each node, if
/// any.
struct PunctualLights {
    std::vector<PunctualLight> lights;
    std::vector<std::optional<std::size_t>> of_node; ///< for each node, the index into `lights`
};
/// Throws `bad_data`.
PunctualLights read_lights(const MaterialContext& source);

} // namespace catoptric::scene::gltf
