#include "graph/work_counter.hpp"

#include <cstring>

namespace catoptric::graph {

namespace {

// The results of the pipeline-statistics query have the order of these bits.
constexpr VkQueryPipelineStatisticFlags kStatisticFlags =
    VK_QUERY_PIPELINE_STATISTIC_VERTEX_SHADER_INVOCATIONS_BIT |
    VK_QUERY_PIPELINE_STATISTIC_CLIPPING_PRIMITIVES_BIT |
    VK_QUERY_PIPELINE_STATISTIC_FRAGMENT_SHADER_INVOCATIONS_BIT |
    VK_QUERY_PIPELINE_STATISTIC_COMPUTE_SHADER_INVOCATIONS_BIT;
constexpr WorkKind kStatisticKinds[] = {WorkKind::vertices, WorkKind::primitives,
                                        WorkKind::fragments, WorkKind::invocations};
constexpr std::size_t kStatisticCount = std::size(kStatisticKinds);
constexpr std::uint64_t kShaderCounterBytes = shared::kShaderWorkKindCount * 2 *
                                              sizeof(std::uint32_t);

} // namespace

WorkCounter::WorkCounter(gpu::Device& device, std::vector<std::string> passes) : device_(device) {
    for (std::string& name : passes) passes_.push_back({std::move(name), {}});
    paused_.resize(passes_.size());
    const std::uint64_t alignment = device.limits().minStorageBufferOffsetAlignment;
    stride_ = (kShaderCounterBytes + alignment - 1) / alignment * alignment;
    buffer_ = gpu::Buffer(device, "counted work", stride_ * passes_.size(),
                          gpu::BufferUsage::read_back);
    if (!device.has_pipeline_statistics() || passes_.empty()) return;
    VkQueryPoolCreateInfo create{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    create.queryType = VK_QUERY_TYPE_PIPELINE_STATISTICS;
    create.queryCount = static_cast<std::uint32_t>(passes_.size());
    create.pipelineStatistics = kStatisticFlags;
    VkQueryPool pool = VK_NULL_HANDLE;
    gpu::check_vk(vkCreateQueryPool(device.handle(), &create, nullptr, &pool),
                  "create pipeline statistics");
    statistics_ = {device.handle(), pool};
    vkResetQueryPool(device.handle(), pool, 0, create.queryCount);
}

void WorkCounter::begin_pass(VkCommandBuffer commands) {
    if (pass_ == 0) {
        vkCmdFillBuffer(commands, buffer_.handle(), 0, VK_WHOLE_SIZE, 0);
        gpu::memory_barrier(
            commands, gpu::kTransferWrite,
            {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
             VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT});
    }
    for (const WorkKind kind : {WorkKind::draws, WorkKind::dispatches, WorkKind::bytes})
        add(kind, 0);
    add(WorkKind::frames, pass_ == 0 ? 1 : 0);
    add(WorkKind::passes, 1);
    if (statistics_) vkCmdBeginQuery(commands, statistics_, static_cast<std::uint32_t>(pass_), 0);
}

void WorkCounter::pause_pass(VkCommandBuffer commands) {
    if (statistics_) vkCmdEndQuery(commands, statistics_, static_cast<std::uint32_t>(pass_));
}

void WorkCounter::resume_pass(VkCommandBuffer commands) {
    if (!statistics_) return;
    const auto query = static_cast<std::uint32_t>(pass_);
    const std::vector<std::uint64_t> results = read_statistics(query, 1);
    for (std::size_t k = 0; k < kStatisticCount; ++k) paused_[pass_][k] += results[k];
    vkResetQueryPool(device_.handle(), statistics_, query, 1);
    vkCmdBeginQuery(commands, statistics_, query, 0);
}

std::vector<std::uint64_t> WorkCounter::read_statistics(std::uint32_t first,
                                                        std::uint32_t count) const {
    std::vector<std::uint64_t> results(kStatisticCount * count);
    gpu::check_vk(vkGetQueryPoolResults(device_.handle(), statistics_, first, count,
                                        results.size() * sizeof results[0], results.data(),
                                        kStatisticCount * sizeof results[0],
                                        VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                  "read pipeline statistics");
    return results;
}

void WorkCounter::end_pass(VkCommandBuffer commands) {
    if (statistics_) vkCmdEndQuery(commands, statistics_, static_cast<std::uint32_t>(pass_));
    if (++pass_ < passes_.size()) return;
    gpu::memory_barrier(commands,
                        {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT |
                             VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT |
                             VK_PIPELINE_STAGE_2_TRANSFER_BIT,
                         VK_ACCESS_2_MEMORY_WRITE_BIT},
                        {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
}

VkDescriptorBufferInfo WorkCounter::shader_counts() const {
    return {buffer_.handle(), pass_ * stride_, kShaderCounterBytes};
}

std::vector<PassWork> WorkCounter::read() {
    const std::vector<std::byte> bytes = buffer_.read();
    std::vector<std::uint64_t> results;
    if (statistics_) results = read_statistics(0, static_cast<std::uint32_t>(passes_.size()));
    for (std::size_t i = 0; i < passes_.size(); ++i) {
        WorkCounts& counts = passes_[i].counts;
        // Of each count, the low word comes first.
        std::uint32_t words[shared::kShaderWorkKindCount][2];
        std::memcpy(words, bytes.data() + i * stride_, kShaderCounterBytes);
        for (std::size_t kind = 0; kind < shared::kShaderWorkKindCount; ++kind)
            counts.values[kind] = std::uint64_t{words[kind][1]} << 32 | words[kind][0];
        for (std::size_t k = 0; statistics_ && k < kStatisticCount; ++k)
            counts[kStatisticKinds[k]] = paused_[i][k] + results[kStatisticCount * i + k];
    }
    return passes_;
}

} // namespace catoptric::graph
