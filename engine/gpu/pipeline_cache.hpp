#pragma once

#include "gpu/device.hpp"

#include <filesystem>
#include <string>

namespace catoptric::gpu {

/// What the driver remembers of pipelines that it compiled, kept in a file from one process to the
/// next. One file for each device and driver; a driver that keeps a cache of its own puts next to
/// nothing into it.
class PipelineCache {
public:
    /// `folder` is made where it is not there; empty: nothing is kept. A file that cannot be read,
    /// is not whole or is another driver's counts as none, and a folder that cannot be written to
    /// as none given: `warning` says so.
    PipelineCache(Device& device, const std::filesystem::path& folder);
    /// Writes the file where there is something new; what goes wrong then is nobody's concern.
    ~PipelineCache();
    PipelineCache(const PipelineCache&) = delete;
    PipelineCache& operator=(const PipelineCache&) = delete;

    VkPipelineCache handle() const { return cache_; }
    /// Whether there is a file to keep pipelines in, and what the driver was given from it.
    bool is_persistent() const { return !file_.empty(); }
    std::size_t loaded_bytes() const { return known_.size(); }
    /// A sentence for the user; empty where all is well.
    const std::string& warning() const { return warning_; }

private:
    std::string loaded();
    void save() const;

    Device& device_;
    std::filesystem::path file_; ///< empty: nothing is kept
    std::string known_;          ///< what the file holds
    std::string warning_;
    UniquePipelineCache cache_;
};

} // namespace catoptric::gpu
