#include "core/image_module.hpp"

#include "core/module.hpp"

namespace catoptric {

namespace {

constexpr Module kImageModule{
    .file_name = "catoptric-images.so",
    .address_space = std::size_t{512} << 20,
    .library = "OpenImageIO",
    .without = "pictures other than PNG and usual OpenEXR files cannot be read",
    .requirement = "this module comes with catoptric and wants OpenImageIO 2.4: apt-get install "
                   "libopenimageio2.4",
    .symbol = kImageCodecsSymbol};

} // namespace

const ImageCodecs& image_codecs() {
    static const ImageCodecs* const kCodecs = reinterpret_cast<ImageCodecsFunction>(
        load_symbol(kImageModule))();
    return *kCodecs;
}

} // namespace catoptric
