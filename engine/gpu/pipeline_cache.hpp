#pragma once

#include "gpu/device.hpp"

#include <filesystem>
#include <string>

namespace catoptric::gpu {

/// The driver's pipeline cache, stored in a file from one process to the next. Each device and
/// driver has a file of its own. A driver with its own cache stores almost nothing here.
class PipelineCache {
public:
    /// Loads the cache from `folder`, which is created if missing; empty: nothing is stored. A file
    /// that is unreadable, incomplete or another driver's is ignored. A folder that cannot be
    /// written to counts as empty. `warning` reports both.
    PipelineCache(Device& device, const std::filesystem::path& folder);
    /// Writes the file if the cache has changed. Errors are ignored, because it is only a cache.
    ~PipelineCache();
    PipelineCache(const PipelineCache&) = delete;
    PipelineCache& operator=(const PipelineCache&) = delete;

    VkPipelineCache handle() const { return cache_; }
    /// Returns whether the cache is stored in a file. `loaded_bytes` is the size of the data
    /// loaded from it.
    bool is_stored() const { return !file_.empty(); }
    /// Empty: nothing is stored.
    std::filesystem::path folder() const { return file_.parent_path(); }
    std::size_t loaded_bytes() const { return known_.size(); }
    /// Returns a sentence for the user; empty if there was no problem.
    const std::string& warning() const { return warning_; }

private:
    std::string loaded();
    void save() const;

    Device& device_;
    std::filesystem::path file_; ///< empty: nothing is stored
    std::string known_;          ///< data of the file
    std::string warning_;
    UniquePipelineCache cache_;
};

} // namespace catoptric::gpu
