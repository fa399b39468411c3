// Fuzz target for picture files. The input is the bytes of a picture, or "hex " and the bytes as
// hexadecimal digits.
#include "fuzz.hpp"

#include "import/image_file.hpp"

namespace {

std::string decode_picture_input(std::string_view text) {
    if (!text.starts_with("hex ")) return std::string(text);
    std::string bytes;
    int digits = 0, value = 0;
    for (const char c : text.substr(4)) {
        const int digit = c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
        if (digit < 0) continue;
        value = value * 16 + digit;
        if (++digits % 2 == 0) bytes += static_cast<char>(value), value = 0;
    }
    return bytes;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace catoptric::scene;
    const std::string bytes = decode_picture_input(fuzz::fuzz_input_to_text(data, size));
    for (const char* name : {"x", "x.tga"})
        fuzz::expect_only_bad_data([&] {
            LoadAccount account({.texels = 1 << 18});
            decode_image(bytes, name, "x", account);
        });
    return 0;
}
