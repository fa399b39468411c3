#pragma once

#include "core/work.hpp"
#include "gpu/buffer.hpp"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace catoptric::graph {

/// Counts the work of the passes of one frame, in three ways. The recorder adds commands and bytes.
/// A query of pipeline statistics counts vertices, fragments and invocations. Shaders that are
/// built with `count_work` add rays and look-ups to a part of a buffer that belongs to the pass
/// (shaders/lib/work.glsl). Counting makes a frame slower, so such a frame's times mean nothing.
class WorkCounter {
public:
    /// `passes`: names of the frame's passes, in order of execution.
    WorkCounter(gpu::Device& device, std::vector<std::string> passes);

    /// Records the begin and the end of the query for the next pass, outside of a rendering scope.
    void begin_pass(VkCommandBuffer commands);
    void end_pass(VkCommandBuffer commands);
    /// Ends the query of the pass with a piece of the frame, and begins it again with the next,
    /// once the piece has run.
    void pause_pass(VkCommandBuffer commands);
    void resume_pass(VkCommandBuffer commands);
    /// Adds to a count of the pass that is being recorded.
    void add(WorkKind kind, std::uint64_t count) { passes_[pass_].counts.add(kind, count); }
    /// Returns the buffer and the part of it in which the shaders of this pass count.
    VkDescriptorBufferInfo shader_counts() const;
    /// The frame must have ended.
    std::vector<PassWork> read();

private:
    std::vector<std::uint64_t> read_statistics(std::uint32_t first, std::uint32_t count) const;

    gpu::Device& device_;
    std::vector<PassWork> passes_;
    std::size_t pass_ = 0;
    /// Results of the query in ended pieces, for each pass, in the order of its bits.
    std::vector<std::array<std::uint64_t, 4>> paused_;
    std::uint64_t stride_ = 0; ///< bytes between the parts of two passes
    gpu::Buffer buffer_;
    gpu::UniqueQueryPool statistics_; ///< null if the device has no pipeline statistics
};

} // namespace catoptric::graph
