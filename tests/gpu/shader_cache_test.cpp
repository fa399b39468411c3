// Tests of the disk cache of specialised shaders. Whatever its files contain, the cache must return
// the same code as specialise_shader().
#include "gpu/shader.hpp"
#include "gpu/shader_cache.hpp"
#include "gpu/specialise.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

namespace {

namespace fs = std::filesystem;
using namespace catoptric;
using ShaderWords = std::vector<std::uint32_t>;
using ConstantBits = std::map<std::uint32_t, std::uint32_t>;

class ShaderCache : public testing::Test {
protected:
    ShaderCache() {
        std::string name = fs::temp_directory_path() / "shader_cache_XXXXXX";
        folder = mkdtemp(name.data());
    }
    ~ShaderCache() override { fs::remove_all(folder); }
    std::vector<fs::path> list_stored_files() const {
        std::vector<fs::path> files;
        for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
        return files;
    }
    static std::span<const std::uint32_t> parallax_shader_words() {
        return gpu::find_shader("reflect/parallax.frag").words;
    }
    /// Returns the constant_id of a named switch (a specialisation constant) of
    /// reflect/parallax.frag.
    static std::uint32_t find_constant_id(const char* name) {
        for (const auto& constant :
             gpu::reflect_spirv("reflect/parallax.frag", parallax_shader_words()).constants)
            if (constant.name == name) return constant.id;
        ADD_FAILURE() << "no constant " << name;
        return 0;
    }
    static ShaderWords find_in(gpu::ShaderCache& cache, const ConstantBits& constants) {
        return cache.specialised("reflect/parallax.frag", parallax_shader_words(), constants);
    }
    static ShaderWords specialise_without_cache(const ConstantBits& constants) {
        return gpu::specialise_shader("reflect/parallax.frag", parallax_shader_words(), constants);
    }

    fs::path folder;
};

TEST_F(ShaderCache, NextCacheReadsWhatTheFirstStored) {
    const ConstantBits off{{find_constant_id("peels"), 0}}, on{{find_constant_id("peels"), 1}};
    const ShaderWords without = specialise_without_cache(off), with = specialise_without_cache(on);
    ASSERT_NE(without, with);
    {
        gpu::ShaderCache first(folder);
        EXPECT_EQ(find_in(first, off), without);
        EXPECT_EQ(find_in(first, on), with) << "a key without the values of constants";
        EXPECT_EQ(first.count_stored(), 2u);
        EXPECT_EQ(first.count_loaded(), 0u);
    }
    gpu::ShaderCache next(folder);
    EXPECT_EQ(find_in(next, on), with);
    EXPECT_EQ(find_in(next, off), without);
    EXPECT_EQ(next.count_loaded(), 2u);
    EXPECT_EQ(next.count_stored(), 0u);
    // A different shader with the same constants has its own file in the cache.
    ShaderWords other(parallax_shader_words().begin(), parallax_shader_words().end());
    other[2] ^= 1; // the word of the SPIR-V header that names the generator
    const ShaderWords of_other = next.specialised("other", other, on);
    EXPECT_EQ(of_other, gpu::specialise_shader("other", other, on));
    EXPECT_EQ(next.count_stored(), 1u);
}

TEST_F(ShaderCache, FoldersThatDoNotExistAreMade) {
    const ConstantBits constants{{find_constant_id("peels"), 1}};
    const fs::path inner = folder / "a" / "b";
    EXPECT_EQ(find_in(*std::make_unique<gpu::ShaderCache>(inner), constants),
              specialise_without_cache(constants));
    gpu::ShaderCache next(inner);
    find_in(next, constants);
    EXPECT_EQ(next.count_loaded(), 1u);
}

TEST_F(ShaderCache, BrokenFilesAreMadeAgain) {
    const ConstantBits constants{{find_constant_id("peels"), 1}};
    const ShaderWords wanted = specialise_without_cache(constants);
    find_in(*std::make_unique<gpu::ShaderCache>(folder), constants);
    ASSERT_EQ(list_stored_files().size(), 1u);
    const fs::path file = list_stored_files()[0];
    std::stringstream whole;
    whole << std::ifstream(file, std::ios::binary).rdbuf();
    std::string flipped = whole.str();
    flipped[flipped.size() / 2] ^= 1;
    for (const std::string& broken :
         {std::string(), whole.str().substr(0, 30), whole.str() + "x", flipped}) {
        std::ofstream(file, std::ios::binary) << broken;
        gpu::ShaderCache cache(folder);
        EXPECT_EQ(find_in(cache, constants), wanted);
        EXPECT_EQ(cache.count_loaded(), 0u);
        EXPECT_EQ(cache.count_stored(), 1u);
        EXPECT_EQ(find_in(cache, constants), wanted);
        EXPECT_EQ(cache.count_loaded(), 1u) << "the file was made again";
    }
}

TEST_F(ShaderCache, FolderThatCannotBeWrittenHasNoEffect) {
    std::ofstream(folder / "file") << "not a folder";
    const ConstantBits constants{{find_constant_id("peels"), 1}};
    for (const fs::path& place : {folder / "file", fs::path()}) {
        gpu::ShaderCache cache(place);
        EXPECT_EQ(find_in(cache, constants), specialise_without_cache(constants));
        EXPECT_EQ(cache.count_stored() + cache.count_loaded(), 0u);
    }
    EXPECT_EQ(fs::file_size(folder / "file"), 12u);
}

TEST_F(ShaderCache, FilesThatWereWrittenFirstAreRemoved) {
    const std::uint32_t id = find_constant_id("peels");
    std::uintmax_t bytes_each = 0;
    const auto store = [&](std::uint32_t value, std::uintmax_t largest) {
        gpu::ShaderCache cache(folder, largest);
        find_in(cache, {{id, value}});
        for (const fs::path& file : list_stored_files()) bytes_each = fs::file_size(file);
        return cache.count_stored();
    };
    constexpr std::uintmax_t kNoLimit = std::uintmax_t{1} << 40;
    store(1, kNoLimit);
    const fs::path oldest = list_stored_files()[0];
    // Every value of a switch that counts as true gives a file of the same size.
    for (std::uint32_t value = 2; value < 6; ++value) store(value, kNoLimit);
    ASSERT_EQ(list_stored_files().size(), 5u);
    fs::last_write_time(oldest, fs::file_time_type::clock::now() - std::chrono::hours(1));
    EXPECT_EQ(store(6, bytes_each * 6 + 100), 1u) << "six files fit";
    EXPECT_EQ(list_stored_files().size(), 6u);
    EXPECT_EQ(store(7, bytes_each * 6 + 100), 1u);
    EXPECT_EQ(list_stored_files().size(), 3u) << "down to half";
    EXPECT_FALSE(fs::exists(oldest));
    EXPECT_EQ(store(7, kNoLimit), 0u) << "the newest file was kept";
}

} // namespace
