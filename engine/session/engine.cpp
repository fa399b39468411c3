#include "session/engine.hpp"

#include "session/access.hpp"
#include "session/calibration.hpp"
#include "session/engine_impl.hpp"
#include "session/folders.hpp"
#include "session/profile.hpp"
#include "session/version.hpp"

#include <cstdlib>

namespace catoptric::session {

std::string version() { return CATOPTRIC_VERSION; }
std::string commit() { return CATOPTRIC_COMMIT; }

namespace {

DeviceInfo to_device_info(const gpu::DeviceProperties& info) {
    return {.name = info.name,
            .driver = info.driver,
            .api = info.api,
            .type = info.type,
            .threads = info.threads,
            .missing = info.missing,
            .id = info.id,
            .profile = {},
            .warning = {}};
}

gpu::DeviceOptions to_device_options(const EngineOptions& options, const EngineHooks& hooks) {
    gpu::DeviceOptions wanted{options.device, options.validate, hooks.layered, false,
                              hooks.instance_extensions};
    if (hooks.given) wanted.given = *hooks.given;
    if (hooks.make_surface)
        wanted.make_surface = [make = hooks.make_surface](auto instance) {
            return gpu::to_surface(make(instance));
        };
    return wanted;
}

/// Returns catoptric's folder within the folder that `variable` names, or within a folder of HOME.
/// Returns an empty path if neither is absolute.
std::filesystem::path find_user_folder(const char* variable, const char* in_home) {
    const auto absolute = [](const char* name) {
        const char* text = std::getenv(name);
        const std::filesystem::path path = text ? text : "";
        return path.is_absolute() ? path : std::filesystem::path();
    };
    const std::filesystem::path home = absolute("HOME"), folder = absolute(variable);
    if (!folder.empty()) return folder / "catoptric";
    return home.empty() ? home : home / in_home / "catoptric";
}

} // namespace

namespace {

std::filesystem::path shader_cache_folder(const EngineOptions& options, const EngineHooks& hooks) {
    return options.cache.empty() ? hooks.shader_cache : options.cache / "shaders";
}

} // namespace

Engine::Impl::Impl(const EngineOptions& options, const EngineHooks& hooks)
    : device(to_device_options(options, hooks)),
      pipelines(device, hooks.shader_variants, options.cache, shader_cache_folder(options, hooks)),
      info(to_device_info(device.info())) {
    device.set_variant_choices(choose_variants(options, info));
    unit_costs = choose_unit_costs(options.calibrations, info);
}

Engine::Engine(const EngineOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Engine::Engine(const EngineOptions& options, const EngineHooks& hooks)
    : impl_(std::make_unique<Impl>(options, hooks)) {}
Engine::~Engine() = default;

const DeviceInfo& Engine::device() const { return impl_->info; }
const std::string& Engine::warning() const { return impl_->pipelines.pipeline_cache().warning(); }
bool Engine::usable() const { return !impl_->device.is_abandoned(); }
void Engine::check_validation() const { impl_->device.check_validation(); }

Engine Access::make_engine(const EngineOptions& options, const EngineHooks& hooks) {
    return Engine(options, hooks);
}
CompiledPipelines Access::compiled_pipelines(const Engine& engine) {
    const gpu::PipelineStore& pipelines = engine.impl_->pipelines;
    return {pipelines.pipeline_count(), pipelines.compile_ms()};
}
PipelineCacheState Access::pipeline_cache_state(const Engine& engine) {
    const gpu::PipelineCache& cache = engine.impl_->pipelines.pipeline_cache();
    if (!cache.is_stored()) return PipelineCacheState::none;
    return cache.loaded_bytes() > 0 ? PipelineCacheState::used : PipelineCacheState::made;
}

std::filesystem::path Access::cache_folder(const Engine& engine) {
    return engine.impl_->pipelines.pipeline_cache().folder();
}

const require::DeviceUnitCosts& Access::unit_costs(const Engine& engine) {
    return engine.impl_->unit_costs;
}

bool has_abandoned_device() { return gpu::has_abandoned_device(); }

std::filesystem::path find_cache_folder() { return find_user_folder("XDG_CACHE_HOME", ".cache"); }

std::filesystem::path find_config_folder() {
    return find_user_folder("XDG_CONFIG_HOME", ".config");
}

std::filesystem::path find_profile_folder() {
    const std::filesystem::path folder = find_config_folder();
    return folder.empty() ? folder : folder / "devices";
}

std::filesystem::path find_calibration_folder() {
    const std::filesystem::path folder = find_config_folder();
    return folder.empty() ? folder : folder / "costs";
}

std::vector<DeviceInfo> devices(const std::filesystem::path& profiles,
                                const std::filesystem::path& calibrations) {
    std::vector<DeviceInfo> list;
    for (const gpu::DeviceProperties& info : gpu::list_devices()) {
        list.push_back(to_device_info(info));
        choose_variants({.profiles = profiles}, list.back());
        choose_unit_costs(calibrations, list.back());
    }
    return list;
}

} // namespace catoptric::session
