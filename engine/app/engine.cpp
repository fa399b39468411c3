#include "app/engine.hpp"

#include "app/engine_impl.hpp"
#include "app/version.hpp"

#include <cstdlib>

namespace catoptric::app {

std::string version() { return CATOPTRIC_VERSION; }
std::string commit() { return CATOPTRIC_COMMIT; }

namespace {

DeviceInfo to_info(const gpu::DeviceInfo& info) {
    return {info.name, info.driver, info.api, info.type, info.threads, info.missing};
}

} // namespace

Engine::Impl::Impl(const EngineOptions& options, const std::optional<gpu::GivenDevice>& given)
    : device({options.device, options.validate, options.layered, false, given}),
      pipelines(device, options.shader_variants, options.cache), info(to_info(device.info())) {}

Engine::Engine(const EngineOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Engine::Engine(const EngineOptions& options, const gpu::GivenDevice& given)
    : impl_(std::make_unique<Impl>(options, given)) {}
Engine::~Engine() = default;

const DeviceInfo& Engine::device() const { return impl_->info; }
const std::string& Engine::warning() const { return impl_->pipelines.cache().warning(); }
Compiled Engine::compiled() const { return {impl_->pipelines.made(), impl_->pipelines.ms()}; }
CacheUse Engine::cache_use() const {
    const gpu::PipelineCache& cache = impl_->pipelines.cache();
    if (!cache.is_kept()) return CacheUse::none;
    return cache.loaded_bytes() > 0 ? CacheUse::used : CacheUse::made;
}
bool Engine::usable() const { return !impl_->device.abandoned(); }
void Engine::check_validation() const { impl_->device.check_validation(); }

bool any_abandoned() { return gpu::any_abandoned(); }

std::filesystem::path cache_folder() {
    const auto absolute = [](const char* variable) {
        const char* text = std::getenv(variable);
        const std::filesystem::path path = text ? text : "";
        return path.is_absolute() ? path : std::filesystem::path();
    };
    const std::filesystem::path home = absolute("HOME"), cache = absolute("XDG_CACHE_HOME");
    if (!cache.empty()) return cache / "catoptric";
    return home.empty() ? home : home / ".cache" / "catoptric";
}

std::vector<DeviceInfo> devices() {
    std::vector<DeviceInfo> list;
    for (const gpu::DeviceInfo& info : gpu::list_devices()) list.push_back(to_info(info));
    return list;
}

} // namespace catoptric::app
