#include "core/module.hpp"

#include "core/address_space.hpp"
#include "core/error.hpp"

#include <filesystem>

#include <dlfcn.h>
#include <link.h>

namespace catoptric {

namespace {

namespace fs = std::filesystem;

/// Returns the folder of the library or program that contains this function.
fs::path find_own_folder() {
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
fs::path find_file(const Module& module) {
    const fs::path own = find_own_folder();
    const fs::path folders[] = {own, own / "catoptric",
                                (own / CATOPTRIC_MODULES_FROM_PROGRAMS).lexically_normal()};
    for (const fs::path& folder : folders)
        if (fs::exists(folder / module.file_name)) return folder / module.file_name;
    fail(Failure::internal, module.without, ": ", module.file_name, " is in none of ",
         folders[0].string(), ", ", folders[1].string(), ", ", folders[2].string(), "; ",
         module.requirement);
}

} // namespace

void* load_symbol(const Module& module) {
    const fs::path file = find_file(module);
    check_address_space(module.address_space, module.library);
    // RTLD_LOCAL hides the module's symbols, because its libraries may define the same symbols as
    // other libraries of the program.
    void* const loaded = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL); // never closed
    check(loaded != nullptr, Failure::internal, module.without, ": ", file.string(),
          " cannot be loaded: ", loaded ? "" : dlerror(), "; ", module.requirement);
    void* const symbol = dlsym(loaded, module.symbol);
    check(symbol != nullptr, Failure::internal, module.without, ": ", file.string(),
          " is of another version: wanted ", module.symbol, " in it, found none");
    return symbol;
}

} // namespace catoptric
