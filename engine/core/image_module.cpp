#include "core/image_module.hpp"

#include "core/address_space.hpp"
#include "core/error.hpp"

#include <filesystem>

#include <dlfcn.h>
#include <link.h>

namespace catoptric {

namespace {

namespace fs = std::filesystem;

constexpr const char* kImageModuleFileName = "catoptric-images.so";
// Bytes of address space for all its libraries.
constexpr std::size_t kCodecModuleAddressSpace = std::size_t{512} << 20;
constexpr const char* kImageModuleRequirementText =
    "It comes with catoptric and wants OpenImageIO 2.4 (Debian: "
    "libopenimageio2.4)";

/// Returns the folder of the library or program that contains this function.
fs::path find_folder_of_loaded_library() {
    static const char kOwnAddress = 0;
    Dl_info info{};
    link_map* own = nullptr;
    const bool is_found = dladdr1(&kOwnAddress, &info, reinterpret_cast<void**>(&own),
                                  RTLD_DL_LINKMAP) != 0;
    check(is_found, Failure::internal, "this library's own file cannot be found");
    const bool is_program = own->l_name[0] == '\0';
    std::error_code error;
    const fs::path file = fs::canonical(is_program ? "/proc/self/exe" : own->l_name, error);
    check(!error, Failure::internal, is_program ? "/proc/self/exe" : own->l_name,
          ": its folder cannot be found: ", error.message());
    return file.parent_path();
}

/// Returns the module's file. In a build tree it is beside the programs and the library. Installed,
/// it is in its own folder beside the library.
fs::path find_image_codec_plugin_file() {
    const fs::path own = find_folder_of_loaded_library();
    const fs::path folders[] = {own, own / "catoptric",
                                (own / CATOPTRIC_MODULES_FROM_PROGRAMS).lexically_normal()};
    for (const fs::path& folder : folders)
        if (fs::exists(folder / kImageModuleFileName)) return folder / kImageModuleFileName;
    fail(Failure::internal, "pictures cannot be read or written: ", kImageModuleFileName,
         " is in none of ", folders[0].string(), ", ", folders[1].string(), ", ",
         folders[2].string(), ". ", kImageModuleRequirementText);
}

const ImageCodecs* load_image_module() {
    const fs::path file = find_image_codec_plugin_file();
    check_address_space(kCodecModuleAddressSpace, "OpenImageIO");
    void* const module = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL); // never closed
    check(module != nullptr, Failure::internal,
          "pictures cannot be read or written: ", file.string(),
          " cannot be loaded: ", module ? "" : dlerror(), ". ", kImageModuleRequirementText);
    const auto codecs = reinterpret_cast<ImageCodecsFunction>(dlsym(module, kImageCodecsSymbol));
    check(codecs != nullptr, Failure::internal,
          "pictures cannot be read or written: ", file.string(), " is of another version: wanted ",
          kImageCodecsSymbol, " in it, found none");
    return codecs();
}

} // namespace

const ImageCodecs& get_image_codecs() {
    static const ImageCodecs* const kCodecs = load_image_module();
    return *kCodecs;
}

} // namespace catoptric
