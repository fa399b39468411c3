#include "import/gltf_container.hpp"

#include "core/text.hpp"
#include "import/gltf_check.hpp"

#include <tiny_gltf.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <map>
#include <utility>

namespace catoptric::scene::gltf {

namespace fs = std::filesystem;

namespace {

constexpr std::uint32_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;

/// Extensions that a file may require, besides KHR_materials_*. They are read, or the scene can be
/// shown without them.
constexpr std::string_view kAllowedExtensions[] = {
    "KHR_mesh_quantization",   "KHR_lights_punctual",
    "KHR_texture_transform",   "EXT_texture_webp",
    "KHR_xmp_json_ld",         "KHR_techniques_webgl",
    "KHR_technique_webgl",     "KHR_draco_mesh_compression",
    "EXT_meshopt_compression", "EXT_mesh_gpu_instancing"};
/// Extensions that store images in a form that is not read. A file that requires one is
/// refused, because its scene would be incomplete.
struct UnsupportedCompression {
    std::string_view extension, sentence;
};
constexpr UnsupportedCompression kUnsupportedCompressions[] = {
    {"KHR_texture_basisu", ": textures compressed by Basis Universal are not read: wanted PNG, "
                           "JPEG or WebP; to copy the file with PNG textures: python3 "
                           "samples/scenes/unpack_ktx2.py FILE (installed in "
                           "share/catoptric/scenes; needs npm)"},
    {"EXT_texture_avif", ": AVIF textures are not read: wanted PNG, JPEG or WebP "
                         "(gltf-transform png)"},
    {"MSFT_texture_dds", ": DDS textures are not read: wanted PNG, JPEG or WebP"}};

struct GlbChunks {
    std::string_view json;
    std::string_view binary; ///< the binary part; empty if the file has none
};

std::uint32_t read_word(std::string_view bytes, std::size_t offset) {
    std::uint32_t word = 0; // glTF and all supported machines are little-endian
    std::memcpy(&word, bytes.data() + offset, sizeof word);
    return word;
}

/// Returns the JSON and the first binary chunk of a GLB. Any other file is taken as JSON text.
GlbChunks read_chunks(const std::string& file, std::string_view bytes, LoaderNotes& notes) {
    if (!bytes.starts_with("glTF")) return {bytes, {}};
    check(bytes.size() >= 20, Failure::bad_data, file, ": header: wanted 20 bytes, found ",
          bytes.size());
    check(read_word(bytes, 4) == 2, Failure::bad_data, file,
          ": header: wanted GLB version 2, found ", read_word(bytes, 4));
    const std::uint32_t said = read_word(bytes, 8);
    check(said >= 20 && said <= bytes.size(), Failure::bad_data, file, ": header: wanted ", said,
          " bytes, found ", bytes.size());
    notes.add("bytes after the end that the header gives, left out", std::to_string(said),
              bytes.size() - said);
    bytes = bytes.substr(0, said);
    const std::uint32_t length = read_word(bytes, 12);
    check(read_word(bytes, 16) == kJsonChunk && length <= bytes.size() - 20, Failure::bad_data,
          file, ": first chunk: wanted JSON of at most ", bytes.size() - 20, " bytes, found ",
          length);
    const std::string_view rest = bytes.substr(20 + length);
    if (rest.size() < 8 || read_word(rest, 4) != kBinaryChunk)
        return {bytes.substr(20, length), {}};
    const std::uint32_t binary = read_word(rest, 0);
    check(binary <= rest.size() - 8, Failure::bad_data, file, ": second chunk: wanted at most ",
          rest.size() - 8, " bytes, found ", binary);
    return {bytes.substr(20, length), rest.substr(8, binary)};
}

/// Returns whether the version is a text "MAJOR.MINOR" of at most 2.0.
bool is_read_version(const Json& version) {
    if (!version.is_string()) return false;
    const std::string& text = version.get_ref<const std::string&>();
    const std::size_t dot = text.find('.');
    const auto number = [](const std::string& digits) {
        const bool is_number = !digits.empty() && digits.size() < 4 &&
                               digits.find_first_not_of("0123456789") == digits.npos;
        return is_number ? std::stoi(digits) : -1;
    };
    if (dot == text.npos) return false;
    const int major = number(text.substr(0, dot)), minor = number(text.substr(dot + 1));
    return minor >= 0 && major >= 0 && (major < 2 || (major == 2 && minor == 0));
}

void check_version(const JsonObject& root) {
    const std::optional<JsonObject> asset = root.object("asset");
    const Json* version = asset ? asset->find("version") : nullptr;
    root.require(version && version->is_string() &&
                     version->get_ref<const std::string&>().starts_with("2."),
                 "asset.version: wanted \"2.0\", found ", version ? describe(*version) : "null");
    const Json* least = asset ? asset->find("minVersion") : nullptr;
    root.require(least == nullptr || is_read_version(*least),
                 "asset.minVersion: wanted at most \"2.0\", found ",
                 least ? describe(*least) : "null");
}

void check_required_extensions(const JsonObject& root) {
    const Json* required = root.find("extensionsRequired");
    if (required == nullptr) return;
    root.require(required->is_array(), "extensionsRequired: wanted an array, found ",
                 describe(*required));
    for (const Json& extension : *required) {
        const std::string name = extension.is_string() ? extension.get<std::string>() : "";
        const auto* const squeezed = std::ranges::find(kUnsupportedCompressions, name,
                                                       &UnsupportedCompression::extension);
        root.require(squeezed == std::end(kUnsupportedCompressions),
                     "extensionsRequired: ", describe(extension),
                     squeezed == std::end(kUnsupportedCompressions) ? "" : squeezed->sentence);
        const bool is_drawn = name.starts_with("KHR_materials_") ||
                              std::ranges::find(kAllowedExtensions, name) !=
                                  std::end(kAllowedExtensions);
        root.require(is_drawn,
                     "extensionsRequired: wanted KHR_materials_*, KHR_texture_*, "
                     "KHR_mesh_quantization, KHR_lights_punctual, "
                     "KHR_draco_mesh_compression, EXT_meshopt_compression or "
                     "EXT_mesh_gpu_instancing, found ",
                     describe(extension));
    }
}

class BufferCollector {
public:
    BufferCollector(Container& container, FileOpener& files, std::string_view binary)
        : container_(container), files_(files), binary_(binary) {}

    void add_buffer(const JsonObject& buffer) {
        if (is_empty_fallback(buffer)) {
            // The compressed views of this buffer hold the data. Uncompressed views do not fit into
            // the single byte, so they are errors.
            container_.buffers.push_back({store_file({0}), 1});
            return;
        }
        const std::size_t file = find_file(buffer);
        const std::uint64_t length = buffer.whole("byteLength", 0),
                            size = container_.files[file].size();
        buffer.require(length >= 1 && length <= size, "byteLength: wanted 1 to ", size,
                       ", the bytes that are there, found ", length);
        container_.buffers.push_back({file, length});
    }

private:
    /// Returns whether a buffer has no data and only stands for the decoded data of compressed
    /// views.
    bool is_empty_fallback(const JsonObject& buffer) const {
        const auto meshopt = buffer.extension(kMeshoptExtension);
        return meshopt && meshopt->flag("fallback", false) && !buffer.has("uri");
    }
    std::size_t find_file(const JsonObject& buffer) {
        if (!buffer.has("uri")) {
            buffer.require(
                buffer.index_in_list() == 0 && !binary_.empty(),
                "wanted a uri, or a GLB's binary chunk and the first place, found neither");
            return store_file({binary_.begin(), binary_.end()});
        }
        const std::string uri = buffer.text("uri");
        if (is_data_uri(uri)) return store_file(decode_data_uri(uri, buffer.place()));
        const fs::path real = files_.find_required(name_from_uri(uri, buffer.place()),
                                                   buffer.place());
        const auto [entry, is_new] = read_.try_emplace(real, container_.files.size());
        if (is_new) {
            const std::string bytes = files_.read(real, buffer.place());
            store_file({bytes.begin(), bytes.end()});
        }
        return entry->second;
    }
    std::size_t store_file(ByteList bytes) {
        container_.files.push_back(std::move(bytes));
        return container_.files.size() - 1;
    }

    Container& container_;
    FileOpener& files_;
    std::string_view binary_;
    std::map<fs::path, std::size_t> read_;
};

} // namespace

Container read_container(const std::string& file, FileOpener& files, LoadAccount& account,
                         LoaderNotes& notes) {
    Container container;
    const std::string bytes = files.read_main();
    const GlbChunks chunks = read_chunks(file, bytes, notes);
    container.document = parse_json(file, chunks.json, account);
    const JsonObject root(container.document, file);
    check(container.document.is_object(), Failure::bad_data, file,
          ": JSON: wanted an object, found ", describe(container.document));
    check_version(root);
    check_required_extensions(root);
    BufferCollector buffers(container, files, chunks.binary);
    root.each("buffers", [&](const JsonObject& buffer) { buffers.add_buffer(buffer); });
    return container;
}

namespace {

constexpr std::string_view kBase64Digits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Decodes percent-encoded bytes such as "%20". A '%' without two hexadecimal digits stays.
std::string decode_percent(std::string_view uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const std::string_view digits = uri.substr(i + 1, 2);
        unsigned char code = 0;
        const auto result = std::from_chars(digits.begin(), digits.end(), code, 16);
        const bool is_code = uri[i] == '%' && digits.size() == 2 && result.ptr == digits.end();
        text += is_code ? static_cast<char>(code) : uri[i];
        if (is_code) i += 2;
    }
    return text;
}

} // namespace

std::string name_from_uri(const std::string& uri, const std::string& place) {
    const auto wanted = [&](bool ok, std::string_view what) {
        check(ok, Failure::bad_data, place, ": uri: wanted a path relative to the scene, found ",
              quote(uri), what);
    };
    wanted(uri.find(':') >= uri.find_first_of("/?#"), ", which has a scheme");
    const std::string name = decode_percent(uri);
    wanted(!name.starts_with('/'), ", which is absolute");
    wanted(name.find('\\') == name.npos, ", which has a backslash");
    wanted(name.find('\0') == name.npos, ", which has a NUL");
    wanted(!name.empty(), "");
    return name;
}

bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }

ByteList decode_data_uri(std::string_view uri, const std::string& place) {
    const std::size_t comma = uri.find(',');
    check(comma != uri.npos && uri.substr(0, comma).ends_with(";base64"), Failure::bad_data, place,
          ": uri: wanted data in base64, found ", quote(uri.substr(0, comma)));
    std::string_view text = uri.substr(comma + 1);
    const int most = text.size() % 4 == 0 ? 2 : 0; // padding characters
    for (int i = 0; i < most && text.ends_with('='); ++i) text.remove_suffix(1);
    const std::size_t wrong = std::min(text.find_first_not_of(kBase64Digits), text.size());
    check(wrong == text.size(), Failure::bad_data, place, ": uri: wanted digits of base64, found ",
          quote(text.substr(wrong, 1)));
    check(text.size() % 4 != 1, Failure::bad_data, place,
          ": uri: wanted four digits of base64 for three bytes, found one more");
    ByteList bytes;
    std::string kind;
    tinygltf::DecodeDataURI(&bytes, kind,
                            "data:application/octet-stream;base64," + std::string(text), 0, false);
    return bytes;
}

} // namespace catoptric::scene::gltf
