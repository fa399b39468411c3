#include "scene/gltf_model.hpp"

#include "core/text.hpp"

#include <utility>

namespace catoptric::scene::gltf {

namespace {

/// tinygltf's only way to bytes: our files, which are called by their numbers. Each is asked for
/// once and given away.
tinygltf::FsCallbacks callbacks_of(std::vector<Bytes>& files) {
    return {.FileExists = [](const std::string&, void*) { return true; },
            .ExpandFilePath = [](const std::string& name, void*) { return name; },
            .ReadWholeFile =
                [](Bytes* bytes, std::string*, const std::string& name, void* its_files) {
                    *bytes = std::move(
                        (*static_cast<std::vector<Bytes>*>(its_files))[std::stoul(name)]);
                    return true;
                },
            .WriteWholeFile = nullptr,
            .user_data = &files};
}

/// The text of what is read of a checked document. Its buffers become whole files.
std::string text_of(Container& container) {
    Json document = what_is_read(std::move(container.document));
    for (Json& view : document["bufferViews"])
        view["buffer"] = container.buffers[view["buffer"].get<std::size_t>()].file;
    Json& buffers = document["buffers"] = Json::array();
    for (std::size_t i = 0; i < container.files.size(); ++i)
        buffers.push_back({{"uri", std::to_string(i)}, {"byteLength", container.files[i].size()}});
    return document.dump();
}

/// Of the scene that is shown: {"exposure": stops}.
std::optional<double> read_exposure(const Item& root) {
    const std::size_t count = root.size("scenes");
    if (count == 0) return std::nullopt;
    const Item scene = root.at("scenes", root.index("scene", count).value_or(0));
    const Json* extras = scene.find("extras"); // of any kind; ours is an object
    if (extras == nullptr || !extras->is_object()) return std::nullopt;
    const std::optional<Item> ours = scene.object("extras")->object("catoptric");
    if (!ours || !ours->has("exposure")) return std::nullopt;
    return ours->number("exposure", 0);
}

tinygltf::Model parse(const std::string& file, Container& container) {
    const std::string text = text_of(container);
    tinygltf::TinyGLTF parser;
    parser.SetFsCallbacks(callbacks_of(container.files));
    tinygltf::Model model;
    std::string error, warning;
    const bool is_read = parser.LoadASCIIFromString(&model, &error, &warning, text.data(),
                                                    static_cast<unsigned>(text.size()), "");
    check(is_read, Failure::bad_data, file, ": cannot be read: ", printable(error));
    return model;
}

} // namespace

std::string Document::label(std::size_t node) const {
    return label_of("nodes", node, model.nodes[node].name);
}

Document read(const std::string& file, Files& files, Account& account, Notes& notes) {
    Container container = read_container(file, files, account);
    std::vector<Marks> marks;
    std::optional<double> exposure;
    {
        const Item root(container.document, file);
        check_members(root, account, notes);
        check_bounds(root, container.buffers);
        check_uses(root, files, notes);
        marks = read_marks(root);
        exposure = read_exposure(root);
    }
    return {.file = file,
            .model = parse(file, container),
            .marks = std::move(marks),
            .exposure = exposure};
}

} // namespace catoptric::scene::gltf
