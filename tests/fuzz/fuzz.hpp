#pragma once

#include "core/error.hpp"
#include "core/file.hpp"
#include "import/file_options.hpp"
#include "import/load.hpp"
#include "scene/hash.hpp"
#include "scene/light.hpp"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

/// Shared code of the fuzz targets: a folder for each process, and loading with a small budget.
/// Loading may only throw the two errors that blame a file: bad data and a missing input.
namespace fuzz {

inline std::string_view fuzz_input_to_text(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

/// Returns the folder of this process, on a file system in memory if the machine has one.
inline const std::filesystem::path& find_process_folder() {
    static const std::filesystem::path kFolder = [] {
        const char* root = std::filesystem::is_directory("/dev/shm") ? "/dev/shm" : "/tmp";
        std::string name = std::string(root) + "/catoptric-fuzz-XXXXXX";
        if (::mkdtemp(name.data()) == nullptr) std::abort();
        static std::string removed;
        removed = name;
        std::atexit([] { std::filesystem::remove_all(removed); });
        return std::filesystem::path(name);
    }();
    return kFolder;
}

/// Writes the bytes directly to a file of the folder, without the rename and flush of a safe write.
inline void write_input_file(const std::string& name, std::string_view bytes) {
    std::FILE* const file = std::fopen((find_process_folder() / name).c_str(), "wb");
    if (file == nullptr) std::abort();
    std::fwrite(bytes.data(), 1, bytes.size(), file);
    std::fclose(file);
}

template <typename Body>
void expect_only_bad_data(Body&& body) {
    try {
        body();
    } catch (const catoptric::Error& error) {
        using catoptric::Failure;
        if (error.failure == Failure::bad_data || error.failure == Failure::missing_input) return;
        std::fprintf(stderr, "failure %d: %s\n", static_cast<int>(error.failure), error.what());
        std::abort();
    }
}

/// Loads a scene file. A scene that loads is also hashed, advanced to 0.5 s and asked for its
/// lights.
inline void load_and_use_scene_file(const std::string& name) {
    expect_only_bad_data([&] {
        const catoptric::scene::LoadBudget small{.file_bytes = 1 << 20,
                                                 .json_memory = 16 << 20,
                                                 .vertices = 20'000,
                                                 .triangles = 10'000,
                                                 .objects = 1'000,
                                                 .keys = 10'000,
                                                 .texels = 1 << 18,
                                                 .made_bytes = 1 << 20,
                                                 .cuts = 100'000};
        const auto scene = catoptric::scene::load_file((find_process_folder() / name).string(),
                                                       {.budget = small});
        catoptric::scene::hash_scene(scene);
        list_lights(catoptric::scene::scene_at(scene, .5));
    });
}

} // namespace fuzz
