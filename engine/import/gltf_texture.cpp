#include "import/gltf_texture.hpp"

#include "core/text.hpp"
#include "import/image_file.hpp"
#include "scene/unsupported_feature.hpp"

#include <cmath>
#include <string_view>

namespace catoptric::scene::gltf {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kNearestFilter = 9728, kRepeatWrap = 10497, kClampWrap = 33071,
                        kMirroredWrap = 33648;

Texture::Wrap read_wrap_mode(const JsonObject& sampler, std::string_view key) {
    const std::uint64_t mode = sampler.whole(key, kRepeatWrap);
    sampler.require(mode == kRepeatWrap || mode == kClampWrap || mode == kMirroredWrap, key,
                    ": wanted 10497, 33071 or 33648, found ", mode);
    if (mode == kClampWrap) return Texture::Wrap::clamp;
    return mode == kMirroredWrap ? Texture::Wrap::mirrored : Texture::Wrap::repeat;
}

void read_sampler(const JsonObject& sampler, Texture& texture) {
    texture.wrap_u = read_wrap_mode(sampler, "wrapS"),
    texture.wrap_v = read_wrap_mode(sampler, "wrapT");
    texture.nearest = sampler.whole("magFilter", 0) == kNearestFilter;
}

/// Reads KHR_texture_transform: scale, then rotation, then translation, as in Khronos'
/// TextureTransformTest.
void read_texture_transform(const JsonObject& transform, Texture& texture) {
    const auto pair = [&](std::string_view key, double otherwise) {
        std::vector<double> list = transform.numbers(key, 2);
        return list.empty() ? std::vector<double>(2, otherwise) : list;
    };
    const std::vector<double> offset = pair("offset", 0), scale = pair("scale", 1);
    const double angle = transform.number("rotation", 0);
    const double c = std::cos(angle), s = std::sin(angle);
    texture.u_row = vec3(c * scale[0], s * scale[1], offset[0]);
    texture.v_row = vec3(-s * scale[0], c * scale[1], offset[1]);
    const auto is_finite = [](const vec3& v) {
        return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    transform.require(is_finite(texture.u_row) && is_finite(texture.v_row),
                      "wanted numbers that fit a float, found another");
}

/// Returns the index of a texture's image. The WebP image of EXT_texture_webp is preferred.
std::optional<std::size_t> find_texture_image(const JsonObject& texture, std::size_t count) {
    if (const auto webp = texture.extension("EXT_texture_webp"))
        return webp->index("source", count);
    return texture.index("source", count);
}

} // namespace

std::shared_ptr<const Image> TextureReader::report_missing(const JsonObject& image,
                                                           const std::string& why,
                                                           const JsonObject& use) {
    source_.notes.add("images that are not there or of a kind that is not read, drawn without",
                      image.path() + why);
    add_unsupported(source_.unsupported, "missing-image", use.entry());
    return nullptr;
}

std::shared_ptr<const Image> TextureReader::from_file(const JsonObject& image,
                                                      const JsonObject& use) {
    const std::string name = name_from_uri(image.text("uri"), image.place());
    const fs::path real = source_.files.find(name, image.place());
    if (real.empty()) return report_missing(image, ": " + quote(name) + " is not there", use);
    const auto [entry, is_new] = files_.try_emplace(real.string());
    if (is_new)
        entry->second = decode_image(source_.files.read(real, image.place()), name,
                                     image.place() + ": " + quote(name), source_.account);
    return entry->second ? entry->second : report_missing(image, ": " + quote(name), use);
}

std::shared_ptr<const Image> TextureReader::decoded(const JsonObject& image,
                                                    const JsonObject& use) {
    const std::string kind = image.text("mimeType") == "image/x-tga" ? ".tga" : "";
    const auto decode = [&](const unsigned char* bytes, std::size_t size) {
        auto result = decode_image({reinterpret_cast<const char*>(bytes), size},
                                   image.name() + kind, image.place(), source_.account);
        return result ? result : report_missing(image, "", use);
    };
    if (image.has("uri")) {
        const std::string uri = image.text("uri");
        if (!is_data_uri(uri)) return from_file(image, use);
        const ByteList bytes = decode_data_uri(uri, image.place());
        return decode(bytes.data(), bytes.size());
    }
    const auto number = image.index("bufferView", source_.root.size("bufferViews"));
    if (!number) return report_missing(image, "", use);
    const JsonObject view = source_.root.at("bufferViews", *number);
    const GltfBuffer& buffer =
        source_.container.buffers[view.needed_index("buffer", source_.container.buffers.size())];
    return decode(source_.container.files[buffer.file].data() + view.whole("byteOffset", 0),
                  view.whole("byteLength", 0));
}

std::shared_ptr<const Image> TextureReader::image(std::size_t index, const JsonObject& use) {
    const auto [entry, is_new] = images_.try_emplace(index);
    if (is_new) entry->second = decoded(source_.root.at("images", index), use);
    return entry->second;
}

std::optional<Texture> TextureReader::read(const JsonObject& use, bool srgb) {
    const JsonObject& root = source_.root;
    const JsonObject from = root.at("textures", use.needed_index("index", root.size("textures")));
    Texture texture{.srgb = srgb};
    std::uint64_t set = use.whole("texCoord", 0);
    if (const auto transform = use.extension("KHR_texture_transform")) {
        read_texture_transform(*transform, texture);
        set = transform->whole("texCoord", set);
    }
    if (set > 1) {
        source_.notes.add("textures of a third set of coordinates, drawn without", use.path());
        add_unsupported(source_.unsupported, "material-extension", use.entry());
        return std::nullopt;
    }
    texture.uv_set = static_cast<std::uint32_t>(set);
    if (const auto sampler = from.index("sampler", root.size("samplers")))
        read_sampler(root.at("samplers", *sampler), texture);
    const auto source = find_texture_image(from, root.size("images"));
    texture.image = source ? image(*source, use) : report_missing(from, "", use);
    return texture.image ? std::optional(texture) : std::nullopt;
}

} // namespace catoptric::scene::gltf
