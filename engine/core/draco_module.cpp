#include "core/draco_module.hpp"

#include "core/module.hpp"

namespace catoptric {

namespace {

constexpr Module kDracoModule{
    .file_name = "catoptric-draco.so",
    .address_space = std::size_t{32} << 20,
    .library = "Draco",
    .without = "meshes compressed by Draco cannot be read",
    .requirement =
        "this module comes with catoptric and wants Draco 1.5: apt-get install libdraco7",
    .symbol = kDracoCodecSymbol};

} // namespace

const DracoCodec& draco_codec() {
    static const DracoCodec* const kCodec = reinterpret_cast<DracoCodecFunction>(
        load_symbol(kDracoModule))();
    return *kCodec;
}

} // namespace catoptric
