#pragma once

#include "../core/export.hpp"
#include "../core/setting.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace catoptric::gpu {
struct GivenDevice; // internal
} // namespace catoptric::gpu

/// The engine as a program or a library uses it. No Vulkan name is needed to include this.
namespace catoptric::app {

/// Choices among builds of shaders that change no byte of a picture, by name: {"groups", "in
/// order"}.
using Variants = std::vector<std::pair<std::string, std::string>>;

struct EngineOptions {
    std::string device;    ///< index or part of a name; empty = discrete, else integrated, else cpu
    bool validate = false; ///< the validation layer watches; any message makes the run fail
    bool layered = true;   ///< false: render captures face by face even where the device can do six
    /// Shader builds to use in place of others, for benchmarks: "raytrace.comp" ->
    /// "raytrace.comp#naive".
    std::map<std::string, std::string> shader_variants = {};
    /// The profile of the device (docs/performance.md), as `catoptric bench --tune` writes it: a
    /// file of this device and driver, else the engine throws `bad_data` or `missing_input`.
    std::filesystem::path profile = {};
    /// A folder with profiles, where none is named: that of this device and driver is used if it is
    /// there; DeviceInfo::warning says where it is no good. Empty: all is as by default.
    std::filesystem::path profiles = {};
    /// What would be in a profile, in place of one.
    Variants variants = {};
    /// A folder where compiled pipelines are kept from process to process; empty: nowhere.
    std::filesystem::path cache = {};
    /// For a window (app/screen.hpp): the instance extensions that its system wants, and what makes
    /// the window's surface: it is handed Vulkan's instance and returns the handle of a surface,
    /// which is the engine's from then on. The device is one that can show pictures there.
    std::vector<std::string> instance_extensions = {};
    std::function<std::uint64_t(void* instance)> make_surface = {};
};

/// XDG_CACHE_HOME/catoptric, or HOME/.cache/catoptric; empty where neither is an absolute path.
CATOPTRIC_API std::filesystem::path cache_folder();
/// XDG_CONFIG_HOME/catoptric/devices, or below HOME/.config; empty where neither is an absolute
/// path.
CATOPTRIC_API std::filesystem::path profile_folder();

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
/// Every technique in the table's order.
CATOPTRIC_API std::vector<TechniqueInfo> techniques();

/// Checks "name[:knob=value,...]"; throws `Failure::usage` with the nearest name.
struct TechniqueChoice {
    std::string technique, label, file_name;
    std::vector<Setting> settings; ///< all knobs
};
CATOPTRIC_API TechniqueChoice parse_technique(const std::string& text);

struct DeviceInfo {
    std::string name, driver, api, type;
    int threads = 0;
    std::string missing;    ///< what the engine needs and it lacks; empty = usable
    std::string id;         ///< vendor and device in hexadecimal: "10de-2330"
    std::string profile;    ///< file name of the profile that holds; empty: none
    Variants variants = {}; ///< that hold, all
    std::string warning;    ///< why a profile that is there does not hold; empty: it does
};
/// `profiles`: see EngineOptions.
CATOPTRIC_API std::vector<DeviceInfo> devices(const std::filesystem::path& profiles = {});

CATOPTRIC_API std::string version(); ///< "0.1.0"
CATOPTRIC_API std::string commit();  ///< abbreviated, "unknown" outside a checkout

/// Whether an Engine of this process had to give up its device (Engine::usable). Its driver's
/// threads may still be at work, and to take the program down under them can crash: such a program
/// ends with std::_Exit.
CATOPTRIC_API bool any_abandoned();

/// What an engine has compiled so far. A software driver compiles more of a pipeline within the
/// frame that first uses it.
struct Compiled {
    std::size_t pipelines = 0;
    double ms = 0; ///< of the host, from the shader's words to the driver's pipeline
};

/// What became of the cache on disk: there is none; it is new or was not whole; the driver was
/// given what it holds.
enum class CacheUse { none, made, used };

/// A device with what has been compiled for it. One thread at a time.
///
/// Making one sets variables of this process's environment, before threads of the program should
/// read it: NODEVICE_SELECT, unless somebody chose a device by Mesa's, and with `validate` what the
/// validation layer is to watch.
class Engine {
public:
    CATOPTRIC_API explicit Engine(const EngineOptions& options);
    CATOPTRIC_API ~Engine();

    /// False once the device was lost or could not be waited for, which threw `device_lost` or
    /// `exhausted`. Then all that needs the device throws the same again, and what the driver may
    /// still use is never freed. Another Engine can be made.
    CATOPTRIC_API bool usable() const;

    CATOPTRIC_API const DeviceInfo& device() const;
    /// What its user should know: a cache that cannot be used. Empty where all is well.
    CATOPTRIC_API const std::string& warning() const;
    CATOPTRIC_API Compiled compiled() const;
    CATOPTRIC_API CacheUse cache_use() const;
    /// Throws `internal` with the first message of the validation layer, when there is any.
    CATOPTRIC_API void check_validation() const;

private:
    friend class Screen;
    friend class Session;
    friend struct Embedding;
    struct Impl;
    Engine(const EngineOptions& options, const gpu::GivenDevice& given);
    std::unique_ptr<Impl> impl_;
};

} // namespace catoptric::app
