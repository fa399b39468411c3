#include "import/budget.hpp"

#include <algorithm>
#include <fstream>
#include <string>
#include <system_error>

#include <sys/resource.h>

namespace catoptric::scene {

LoadBudget choose_budget(const std::filesystem::path& scene, const BudgetOverride& wish,
                         std::uint64_t free_bytes) {
    constexpr std::uint64_t kFreeMemoryShareDivisor = 8, kMinFileBytesPerTriangle = 6;
    LoadBudget budget;
    std::error_code none;
    const std::uintmax_t size = std::filesystem::file_size(scene, none);
    const std::uint64_t stored = none ? 0 : size / kMinFileBytesPerTriangle;
    const std::uint64_t fitting = std::min(stored, free_bytes / kRenderBytesPerTriangle);
    budget.file_bytes = wish.bytes.value_or(
        std::max(budget.file_bytes, free_bytes / kFreeMemoryShareDivisor));
    const std::uint64_t triangles = wish.triangles.value_or(std::max(budget.triangles, fitting));
    if (triangles > budget.triangles) {
        budget.vertices = std::max(budget.vertices, 3 * triangles);
        budget.shown = std::max(budget.shown, 3 * triangles);
    }
    budget.triangles = triangles;
    return budget;
}

std::uint64_t read_free_memory() {
    constexpr std::uint64_t kAssumedFreeMemory = std::uint64_t{1} << 32;
    std::uint64_t bytes = kAssumedFreeMemory;
    std::ifstream facts("/proc/meminfo");
    for (std::string line; std::getline(facts, line);)
        if (line.starts_with("MemAvailable:"))
            bytes = std::stoull(line.substr(line.find(':') + 1)) * 1024;
    rlimit limit{};
    if (::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        bytes = std::min<std::uint64_t>(bytes, limit.rlim_cur);
    return bytes;
}

} // namespace catoptric::scene
