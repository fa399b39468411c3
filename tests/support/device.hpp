#pragma once

#include "app/run.hpp"
#include "graph/run.hpp"
#include "support/refusal.hpp"
#include "support/wanted_device.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

/// The validated devices of a test program. Any message of the validation layer fails the test
/// during which it came.
namespace test {

using namespace catoptric;

/// A device with its pipelines, for tests that fill graphs of their own.
struct Bench {
    explicit Bench(const gpu::DeviceOptions& options) : device(options), pipelines(device) {}
    gpu::Device device;
    gpu::Pipelines pipelines;
};

namespace detail {

struct Devices {
    std::map<bool, std::unique_ptr<Bench>> benches;       ///< by `staged`
    std::map<bool, std::unique_ptr<app::Engine>> engines; ///< by `layered`
};
inline Devices devices;

inline std::string what_of(const std::function<void()>& check) {
    try {
        check();
    } catch (const std::exception& error) {
        return error.what();
    }
    return "";
}

/// Devices go before main ends: drivers do not like to be called while the program is unloaded.
class CloseDevices : public testing::Environment {
    void TearDown() override { devices = {}; }
};

class WatchValidation : public testing::EmptyTestEventListener {
    void OnTestEnd(const testing::TestInfo&) override {
        for (const auto& [staged, bench] : devices.benches)
            EXPECT_EQ(what_of([&] { bench->device.check_validation(); }), "");
        for (const auto& [layered, engine] : devices.engines)
            EXPECT_EQ(what_of([&] { engine->check_validation(); }), "");
    }
};

inline const bool watched = [] {
    testing::AddGlobalTestEnvironment(new CloseDevices);
    testing::UnitTest::GetInstance()->listeners().Append(new WatchValidation);
    return true;
}();

} // namespace detail

/// Made at first use, one for the whole program. `staged`: as if device memory could not be mapped.
inline Bench& bench(bool staged = false) {
    auto& made = detail::devices.benches[staged];
    if (!made)
        made = std::make_unique<Bench>(
            gpu::DeviceOptions{.wanted = wanted_device(), .validate = true, .staged = staged});
    return *made;
}

/// The same with the whole engine on top. `layered` false: captures face by face.
inline app::Engine& engine(bool layered = true) {
    auto& made = detail::devices.engines[layered];
    if (!made)
        made = std::make_unique<app::Engine>(
            app::EngineOptions{.device = wanted_device(), .validate = true, .layered = layered});
    return *made;
}

/// Whether the device draws with `colour=float`, which filters images of 32-bit floats. Tests of
/// devices that do not (limits/limits_test.cpp) look at the refusal.
inline bool has_float_colour() { return bench().device.filters_floats(); }

/// One frame of a graph; the runner keeps what the frame after it may ask for.
inline graph::FrameTimes run(graph::Runner& runner, const graph::Graph& graph,
                             graph::Timing timing = graph::Timing::isolated) {
    return runner.run(graph, timing);
}

/// Texels of an image as numbers of the type T, channel after channel.
template <typename T, typename Resource>
std::vector<T> read_as(graph::Runner& runner, Resource resource) {
    const std::vector<std::byte> bytes = runner.read(resource);
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

} // namespace test
