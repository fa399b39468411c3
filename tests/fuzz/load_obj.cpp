// Fuzz target for the OBJ loader. The input is an .obj file and, after a line "%%", the file m.mtl
// that the .obj may name.
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::fuzz_input_to_text(data, size);
    const std::size_t cut = text.find("\n%%\n");
    fuzz::write_input_file("x.obj", text.substr(0, cut));
    fuzz::write_input_file("m.mtl", cut == text.npos ? std::string_view() : text.substr(cut + 4));
    fuzz::load_and_use_scene_file("x.obj");
    return 0;
}
