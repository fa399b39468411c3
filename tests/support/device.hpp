#pragma once

#include "graph/graph_runner.hpp"
#include "session/access.hpp"
#include "session/run.hpp"
#include "support/refusal.hpp"
#include "support/wanted_device.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

/// The devices of a test program, with the validation layer. Any message of the validation layer
/// fails the test during which it occurs.
namespace test {

using namespace catoptric;

/// A device with its pipelines, for tests that build their own render graphs.
struct TestDevice {
    explicit TestDevice(const gpu::DeviceOptions& options) : device(options), pipelines(device) {}
    gpu::Device device;
    gpu::PipelineStore pipelines;
};

namespace detail {

struct AllTestDevices {
    std::map<bool, std::unique_ptr<TestDevice>>
        benches; ///< devices, by the argument of get_test_device()
    std::map<bool, std::unique_ptr<session::Engine>>
        engines; ///< engines, by the argument of get_test_engine()
};
inline AllTestDevices devices;

inline std::string catch_error_message(const std::function<void()>& check) {
    try {
        check();
    } catch (const std::exception& error) {
        return error.what();
    }
    return "";
}

/// Destroys the devices before main ends, because drivers can crash if they are called while the
/// program is unloaded.
class DestroyDevicesAtEnd : public testing::Environment {
    void TearDown() override { devices = {}; }
};

class CheckValidationAfterTest : public testing::EmptyTestEventListener {
    void OnTestEnd(const testing::TestInfo&) override {
        for (const auto& [staged, bench] : devices.benches)
            EXPECT_EQ(catch_error_message([&] { bench->device.check_validation(); }), "");
        for (const auto& [layered, engine] : devices.engines)
            EXPECT_EQ(catch_error_message([&] { engine->check_validation(); }), "");
    }
};

inline const bool watched = [] {
    testing::AddGlobalTestEnvironment(new DestroyDevicesAtEnd);
    testing::UnitTest::GetInstance()->listeners().Append(new CheckValidationAfterTest);
    return true;
}();

} // namespace detail

/// Returns the device of the test program and creates it at first use. With `staged`, the device
/// behaves as if its memory could not be mapped.
inline TestDevice& get_test_device(bool staged = false) {
    auto& made = detail::devices.benches[staged];
    if (!made)
        made = std::make_unique<TestDevice>(gpu::DeviceOptions{
            .wanted = read_wanted_device_name(), .validate = true, .staged = staged});
    return *made;
}

/// Returns the folder in which all test programs keep specialised shaders. CTest gives it. Empty:
/// none.
inline std::filesystem::path find_shader_cache_of_tests() {
    const char* folder = std::getenv("CATOPTRIC_TEST_SHADERS");
    return folder ? folder : "";
}

/// Returns the engine of the test program and creates it at first use. Without `layered`, the
/// engine draws captures face by face.
inline session::Engine& get_test_engine(bool layered = true) {
    auto& made = detail::devices.engines[layered];
    if (!made)
        made.reset(new session::Engine(session::Access::make_engine(
            {.device = read_wanted_device_name(), .validate = true},
            {.layered = layered, .shader_cache = find_shader_cache_of_tests()})));
    return *made;
}

/// Returns whether shaders and fixed functions compute as the same expressions do in C++: divisions
/// are correctly rounded, values are interpolated between unrounded vertices, and textures are
/// filtered with weights of full precision. Mesa's software driver does so. Vulkan asks for less:
/// divisions within 2.5 units in the last place, and as many bits of positions in a pixel and of
/// weights as `subPixelPrecisionBits` and `subTexelPrecisionBits` say (8 on most graphics cards).
inline bool computes_like_cpp() { return get_test_device().device.is_cpu(); }

/// Returns whether the device supports `colour=float`, which filters images of 32-bit floats.
/// limits/limits_test.cpp tests the error on devices that do not support it.
inline bool has_float_colour() { return get_test_device().device.filters_floats(); }
/// Returns whether the device draws blended surfaces. Others draw them opaque, and cut them out
/// where their alpha is below the cutoff.
inline bool has_blended_surfaces() { return get_test_device().device.blends_floats(); }

/// Runs one frame of a graph. The runner keeps the contents that the next frame may read.
inline graph::GraphFrameTimes run_graph(graph::GraphRunner& runner, const graph::Graph& graph,
                                        graph::PassTiming timing = graph::PassTiming::isolated) {
    return runner.run_and_wait(graph, timing);
}

/// Returns the texels of an image, or the contents of a buffer, as numbers of type T.
template <typename T, typename Resource>
std::vector<T> read_resource_values(graph::GraphRunner& runner, Resource resource) {
    const std::vector<std::byte> bytes = runner.read_back(resource);
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

} // namespace test
