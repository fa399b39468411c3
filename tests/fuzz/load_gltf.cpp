// Fuzz target for the glTF loader. The input is a .gltf or .glb file, or text for a .glb. Such text
// is a line "glb", JSON, a line "---" and the binary chunk.
#include "fuzz.hpp"

namespace {

std::string encode_little_endian_word(std::size_t value) {
    const auto number = static_cast<std::uint32_t>(value);
    return {reinterpret_cast<const char*>(&number), 4};
}

std::string make_glb_of_input(std::string_view text) {
    const std::size_t cut = text.find("\n---\n");
    std::string json(text.substr(0, cut));
    std::string binary(cut == text.npos ? std::string_view() : text.substr(cut + 5));
    json.resize((json.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    return "glTF" + encode_little_endian_word(2) +
           encode_little_endian_word(28 + json.size() + binary.size()) +
           encode_little_endian_word(json.size()) + "JSON" + json +
           encode_little_endian_word(binary.size()) + std::string("BIN\0", 4) + binary;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::fuzz_input_to_text(data, size);
    const bool is_made = text.starts_with("glb\n");
    fuzz::write_input_file("x.gltf",
                           is_made ? make_glb_of_input(text.substr(4)) : std::string(text));
    fuzz::load_and_use_scene_file("x.gltf");
    return 0;
}
