#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string_view>
#include <vector>

namespace catoptric::gpu {

/// Specialised shaders (specialise_shader), stored in files from one process to the next. A file is
/// found by the contents of the shader, its constants, the version of SPIRV-Tools and the passes
/// that specialise_shader runs. Files that are incomplete are made again. A folder that cannot be
/// written to has no effect.
class ShaderCache {
public:
    /// `folder` is created when the first file is written; empty: nothing is stored.
    /// `largest_bytes`: if all files take more when this object ends, the files that were written
    /// first are removed until they take half of it.
    explicit ShaderCache(std::filesystem::path folder,
                         std::uintmax_t largest_bytes = std::uintmax_t{128} << 20);
    ~ShaderCache();
    ShaderCache(const ShaderCache&) = delete;
    ShaderCache& operator=(const ShaderCache&) = delete;

    /// Returns the same words as specialise_shader(). Takes less than a millisecond if the words
    /// are in a file.
    std::vector<std::uint32_t> specialised(std::string_view name,
                                           std::span<const std::uint32_t> words,
                                           const std::map<std::uint32_t, std::uint32_t>& constants);
    std::size_t count_loaded() const { return loaded_; } ///< shaders read from files
    std::size_t count_stored() const { return stored_; } ///< shaders written to files

private:
    void remove_oldest() const;

    std::filesystem::path folder_;
    std::uintmax_t largest_bytes_;
    bool can_write_ = true; ///< false after a write has failed
    std::size_t loaded_ = 0, stored_ = 0;
};

} // namespace catoptric::gpu
