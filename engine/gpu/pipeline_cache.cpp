#include "gpu/pipeline_cache.hpp"

#include "core/file.hpp"
#include "gpu/cache_file.hpp"

#include <cstdint>
#include <cstdio>
#include <system_error>
#include <vector>

namespace catoptric::gpu {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kCacheFileSignature = "catoptric pipelines 1\n";

/// Returns a file name for device, driver and driver build. Vulkan does not define pipeline data of
/// one to be valid for another.
std::string cache_file_name(const Device& device) {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(device.physical_device(), &properties);
    char text[64];
    std::snprintf(text, sizeof text, "pipelines-%08x-%08x-%08x-", properties.vendorID,
                  properties.deviceID, properties.driverVersion);
    std::string name = text;
    for (const std::uint8_t byte : properties.pipelineCacheUUID) {
        std::snprintf(text, sizeof text, "%02x", byte);
        name += text;
    }
    return name;
}

} // namespace

PipelineCache::PipelineCache(Device& device, const fs::path& folder) : device_(device) {
    if (!folder.empty()) {
        std::error_code error;
        fs::create_directories(folder, error);
        file_ = folder / cache_file_name(device);
        known_ = loaded();
    }
    VkPipelineCacheCreateInfo create{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    create.initialDataSize = known_.size();
    create.pInitialData = known_.data();
    VkPipelineCache cache = VK_NULL_HANDLE;
    check_vk(vkCreatePipelineCache(device.handle(), &create, nullptr, &cache),
             "create a pipeline cache");
    cache_ = {device.handle(), cache};
}

PipelineCache::~PipelineCache() {
    if (file_.empty() || device_.is_abandoned()) return;
    try {
        save();
    } catch (...) { // ignored: it is only a cache
    }
}

/// Returns the data of the file; empty if there is none. A missing file is created at once, so that
/// a failure is reported now.
std::string PipelineCache::loaded() {
    std::error_code error;
    const bool is_there = fs::exists(file_, error);
    try {
        if (!is_there) {
            write_file(file_, add_header(kCacheFileSignature, {}));
            return {};
        }
        const std::string file = read_file(file_);
        std::string data = strip_header(kCacheFileSignature, file);
        if (data.empty() && file != add_header(kCacheFileSignature, {}))
            warning_ = file_.string() +
                       ": wanted a whole pipeline cache, found something else; a new one is made";
        return data;
    } catch (const Error& failed) {
        warning_ = std::string(failed.what()) +
                   "; every run compiles its pipelines again (XDG_CACHE_HOME says where they "
                   "could be kept)";
        file_.clear();
        return {};
    }
}

void PipelineCache::save() const {
    std::size_t size = 0;
    if (vkGetPipelineCacheData(device_.handle(), cache_, &size, nullptr) != VK_SUCCESS) return;
    std::string data(size, '\0');
    if (vkGetPipelineCacheData(device_.handle(), cache_, &size, data.data()) != VK_SUCCESS) return;
    data.resize(size);
    if (data != known_) write_file(file_, add_header(kCacheFileSignature, data));
}

} // namespace catoptric::gpu
