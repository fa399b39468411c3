#pragma once

#include "../core/export.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

/// The engine, as programs and libraries use it. Including this header needs no Vulkan header.
namespace catoptric::session {

/// Chosen shader variants by name: {"groups", "in order"}. Variants are builds of shaders that
/// change no byte of a picture.
using NamedVariants = std::vector<std::pair<std::string, std::string>>;

struct EngineOptions {
    std::string device;    ///< index or part of a name; empty = discrete, else integrated, else cpu
    bool validate = false; ///< turn on the validation layer; any message makes the run fail
    /// Device profile to use (docs/performance.md), as `catoptric bench --tune` writes it. The
    /// engine throws `bad_data` or `missing_input` unless it is a file for this device and driver.
    std::filesystem::path profile = {};
    /// Folders of profiles, read if `profile` is empty, and of calibrations, by which `auto`
    /// compares plans (docs/costs.md); empty: none. DeviceInfo::warning says why one is not used.
    std::filesystem::path profiles = {}, calibrations = {};
    NamedVariants variants = {}; ///< variants to use instead of a profile
    /// Folder that keeps compiled pipelines and shaders (about 128 MiB); empty: none is kept.
    std::filesystem::path cache = {};
};

struct KnobInfo {
    std::string name, help;
    double low = 0, high = 1;
    std::string value;                ///< default
    std::vector<std::string> choices; ///< empty for a number
    std::string special;              ///< a word allowed in place of the number; empty: none
};
struct TechniqueInfo {
    std::string name, summary;
    std::vector<KnobInfo> knobs;
};
/// Returns every technique, in the order of the technique table.
CATOPTRIC_API std::vector<TechniqueInfo> techniques();

struct DeviceInfo {
    std::string name, driver, api, type;
    int threads = 0;
    std::string missing; ///< features that the engine needs and the device lacks; empty: usable
    std::string id;      ///< vendor and device in hexadecimal: "10de-2330"
    std::string profile; ///< file name of the profile in effect; empty: none
    NamedVariants variants = {};  ///< all variants in effect
    std::string warning;          ///< why a profile or calibration is not in effect; else empty
    std::string calibration = {}; ///< file name of the calibration in effect; empty: none
};
/// Returns the machine's devices. `profiles`, `calibrations`: see EngineOptions.
CATOPTRIC_API std::vector<DeviceInfo> devices(const std::filesystem::path& profiles = {},
                                              const std::filesystem::path& calibrations = {});

CATOPTRIC_API std::string version(); ///< "0.1.0"
CATOPTRIC_API std::string commit();  ///< abbreviated, "unknown" outside a checkout

/// Returns whether an Engine of this process had to give up its device (Engine::usable). Threads of
/// its driver may still run, and a normal exit can crash: the program must end with std::_Exit.
CATOPTRIC_API bool has_abandoned_device();

/// A device with the pipelines compiled for it. Only one thread may use an engine at a time. The
/// constructor sets environment variables of this process, so call it before other threads read the
/// environment. It sets NODEVICE_SELECT, unless the user chose a device by Mesa's variable. With
/// `validate` it also sets what the validation layer checks.
class Engine {
public:
    CATOPTRIC_API explicit Engine(const EngineOptions& options);
    CATOPTRIC_API ~Engine();

    /// Returns false once the device was lost or could not be waited for, which threw `device_lost`
    /// or `exhausted`. After that, each function that needs the device throws the same failure
    /// again. Memory that the driver may still use is never freed. You can make another Engine.
    CATOPTRIC_API bool usable() const;

    CATOPTRIC_API const DeviceInfo& device() const;
    /// Returns a warning for the user, such as a cache that cannot be used. Empty: none.
    CATOPTRIC_API const std::string& warning() const;
    /// Throws `internal` with the first message of the validation layer, if there is one.
    CATOPTRIC_API void check_validation() const;

private:
    friend struct Access; // internal
    struct Impl;
    Engine(const EngineOptions& options, const struct EngineHooks& hooks);
    std::unique_ptr<Impl> impl_;
};

} // namespace catoptric::session
