// Fuzz target for the OBJ loader. The input is an .obj file and, after a line "%%", the file m.mtl
// that the .obj may name.
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::text_of(data, size);
    const std::size_t cut = text.find("\n%%\n");
    fuzz::put("x.obj", text.substr(0, cut));
    fuzz::put("m.mtl", cut == text.npos ? std::string_view() : text.substr(cut + 4));
    fuzz::load("x.obj");
    return 0;
}
