#include "gpu/shader_cache.hpp"

#include "core/content_hash.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "gpu/cache_file.hpp"
#include "gpu/specialise.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>
#include <system_error>

#include <spirv-tools/libspirv.h>

namespace catoptric::gpu {

namespace fs = std::filesystem;

namespace {

/// Increase the number at the end of the signature if specialise_shader() returns other words for
/// the same arguments and passes.
constexpr std::string_view kShaderFileSignature = "catoptric shader 1\n";

/// Returns a file name of 128 bits of hash, which includes everything that the result depends on.
std::string shader_file_name(std::span<const std::uint32_t> words,
                             const std::map<std::uint32_t, std::uint32_t>& constants) {
    const std::string tools = spvSoftwareVersionDetailsString() + specialisation_passes();
    std::string name;
    for (const std::uint64_t seed : {1u, 2u}) {
        ContentHash hash(seed);
        hash.add_values(std::span(kShaderFileSignature)).add_values(std::span(tools));
        hash.add_values(words).add(constants.size());
        for (const auto& [id, bits] : constants) hash.add(id).add(bits);
        char text[17];
        std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash.sum()));
        name += text;
    }
    return name;
}

/// Returns the words of the file; empty if there is no such file or if it is not complete.
std::vector<std::uint32_t> read_shader_file(const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) return {};
    try {
        const std::string data = strip_header(kShaderFileSignature, read_file(path));
        std::vector<std::uint32_t> words(data.size() / sizeof(std::uint32_t));
        std::memcpy(words.data(), data.data(), words.size() * sizeof(std::uint32_t));
        return words;
    } catch (const Error&) { // for example unreadable, or removed by another process
        return {};
    }
}

} // namespace

ShaderCache::ShaderCache(fs::path folder, std::uintmax_t largest_bytes)
    : folder_(std::move(folder)), largest_bytes_(largest_bytes) {}

ShaderCache::~ShaderCache() {
    try {
        if (stored_ > 0) remove_oldest();
    } catch (const std::exception&) { // ignored: it is only a cache
    }
}

std::vector<std::uint32_t>
ShaderCache::specialised(std::string_view name, std::span<const std::uint32_t> words,
                         const std::map<std::uint32_t, std::uint32_t>& constants) {
    if (folder_.empty()) return specialise_shader(name, words, constants);
    const fs::path file = folder_ / shader_file_name(words, constants);
    std::vector<std::uint32_t> result = read_shader_file(file);
    if (!result.empty()) {
        ++loaded_;
        return result;
    }
    result = specialise_shader(name, words, constants);
    if (!can_write_) return result;
    try {
        std::error_code error;
        fs::create_directories(folder_, error);
        const std::string_view data(reinterpret_cast<const char*>(result.data()),
                                    result.size() * sizeof(std::uint32_t));
        write_file(file, add_header(kShaderFileSignature, data));
        ++stored_;
    } catch (const std::exception&) { // ignored: it is only a cache
        can_write_ = false;
    }
    return result;
}

void ShaderCache::remove_oldest() const {
    struct StoredFile {
        fs::file_time_type written;
        std::uintmax_t bytes;
        fs::path path;
    };
    std::error_code error;
    std::vector<StoredFile> files;
    std::uintmax_t total = 0;
    for (const auto& entry : fs::directory_iterator(folder_, error)) {
        std::error_code gone; // another process may remove files at the same time
        const StoredFile file{entry.last_write_time(gone), entry.file_size(gone), entry.path()};
        if (gone) continue;
        total += file.bytes;
        files.push_back(file);
    }
    if (total <= largest_bytes_) return;
    std::ranges::sort(files, {}, &StoredFile::written);
    for (const StoredFile& file : files) {
        if (total <= largest_bytes_ / 2) return;
        fs::remove(file.path, error);
        total -= file.bytes;
    }
}

} // namespace catoptric::gpu
