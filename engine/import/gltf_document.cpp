#include "import/gltf_model.hpp"

#include "core/text.hpp"
#include "scene/scene_overrides.hpp"

#include <cmath>
#include <utility>

namespace catoptric::scene::gltf {

namespace {

/// Returns the callbacks through which tinygltf gets all bytes. Files are named by their index, in
/// decimal. tinygltf asks for each file once, so its bytes are moved out.
tinygltf::FsCallbacks make_file_callbacks(std::vector<ByteList>& files) {
    return {.FileExists = [](const std::string&, void*) { return true; },
            .ExpandFilePath = [](const std::string& name, void*) { return name; },
            .ReadWholeFile =
                [](ByteList* bytes, std::string*, const std::string& name, void* its_files) {
                    *bytes = std::move(
                        (*static_cast<std::vector<ByteList>*>(its_files))[std::stoul(name)]);
                    return true;
                },
            .WriteWholeFile = nullptr,
            .user_data = &files};
}

/// Returns the JSON text of the members that are read. Each file of the container becomes one
/// buffer.
std::string serialise_members(Container& container) {
    Json document = keep_known_members(std::move(container.document));
    for (Json& view : document["bufferViews"])
        view["buffer"] = container.buffers[view["buffer"].get<std::size_t>()].file;
    Json& buffers = document["buffers"] = Json::array();
    for (std::size_t i = 0; i < container.files.size(); ++i)
        buffers.push_back({{"uri", std::to_string(i)}, {"byteLength", container.files[i].size()}});
    return document.dump();
}

bool uses_extension(const JsonObject& root, std::string_view extension) {
    for (const char* key : {"extensionsUsed", "extensionsRequired"})
        if (const Json* list = root.find(key); list && list->is_array())
            for (const Json& name : *list)
                if (name == extension) return true;
    return false;
}

/// Reads the morph target weights of each object in the list `things`: "meshes" or "nodes".
std::vector<std::vector<double>> read_morph_weights(const JsonObject& root,
                                                    std::string_view things) {
    std::vector<std::vector<double>> weights;
    root.each(things, [&](const JsonObject& thing) {
        const Json* list = thing.find("weights");
        weights.push_back(thing.numbers("weights", list && list->is_array() ? list->size() : 0));
    });
    return weights;
}

/// Reads the exposure of the scene that is shown, from its `extras`: {"exposure": stops}.
std::optional<double> read_exposure(const JsonObject& root) {
    const std::size_t count = root.size("scenes");
    if (count == 0) return std::nullopt;
    const std::optional<JsonObject> ours = find_extras(
        root.at("scenes", root.index("scene", count).value_or(0)));
    if (!ours || !ours->has("exposure")) return std::nullopt;
    const double stops = ours->number("exposure", 0);
    ours->require(std::abs(stops) <= kMaxExposureStops, "exposure: wanted ", -kMaxExposureStops,
                  " to ", kMaxExposureStops, ", found ", stops);
    return stops;
}

/// Reads whether each animation repeats, from its `extras`: {"repeats": true}.
std::vector<bool> read_repeats(const JsonObject& root) {
    std::vector<bool> repeats;
    root.each("animations", [&](const JsonObject& animation) {
        const std::optional<JsonObject> ours = find_extras(animation);
        repeats.push_back(ours && ours->flag("repeats", false));
    });
    return repeats;
}

tinygltf::Model parse_gltf(const std::string& file, Container& container) {
    const std::string text = serialise_members(container);
    tinygltf::TinyGLTF parser;
    parser.SetFsCallbacks(make_file_callbacks(container.files));
    tinygltf::Model model;
    std::string error, warning;
    const bool is_read = parser.LoadASCIIFromString(&model, &error, &warning, text.data(),
                                                    static_cast<unsigned>(text.size()), "");
    check(is_read, Failure::bad_data, file, ": cannot be read: ", escape(error));
    return model;
}

} // namespace

std::string Document::describe_node(std::size_t node) const {
    return item_label("nodes", node, model.nodes[node].name);
}

Document read_document(const std::string& file, FileOpener& files, LoadAccount& account,
                       LoaderNotes& notes, std::vector<UnsupportedFeature>& unsupported) {
    Container container = read_container(file, files, account, notes);
    Document document{.file = file};
    check_known_members(JsonObject(container.document, file), account);
    decode_geometry(container, file, account);
    check_view_bounds(JsonObject(container.document, file), container.buffers);
    expand_sparse(container, file, account);
    expand_instances(container, file, account, notes);
    {
        const JsonObject root(container.document, file);
        check_cross_references(root, files, notes);
        document.extras = read_all_extras(root);
        document.exposure = read_exposure(root);
        document.weights = read_morph_weights(root, "meshes");
        document.node_weights = read_morph_weights(root, "nodes");
        document.is_quantised = uses_extension(root, "KHR_mesh_quantization");
        const MaterialContext source{root, container, files, account, notes, unsupported};
        document.materials = read_materials(source);
        document.lights = read_lights(source);
        document.repeats = read_repeats(root);
    }
    document.model = parse_gltf(file, container);
    return document;
}

} // namespace catoptric::scene::gltf
