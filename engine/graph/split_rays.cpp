// Splits the dispatches of passes that trace rays into pieces of the frame.
#include "graph/commands.hpp"
#include "graph/frame_recorder.hpp"

#include <algorithm>

namespace catoptric::graph {

namespace {

/// Most work groups in one row of a dispatch. Every device allows 65535.
constexpr std::uint32_t kMaxGroupsPerRow = 32768;

/// Returns the numbers of work groups along x and y, which are at least `groups` in all.
uvec2 arrange_groups(std::uint32_t groups) {
    const std::uint32_t rows = (groups + kMaxGroupsPerRow - 1) / kMaxGroupsPerRow;
    return {(groups + rows - 1) / rows, rows};
}

} // namespace

void PassCommands::run_piece() {
    check(!pass_.is_raster(), Failure::internal, "pass '", pass_.name,
          "' has attachments and cannot run in pieces");
    recorder_.run_piece();
    if (pipeline_) vkCmdBindPipeline(commands_, pipeline_->bind_point, pipeline_->pipeline);
    dirty_ = true, is_pushed_ = false;
}

std::uint64_t PassCommands::rays_per_piece() const { return recorder_.frame_pieces().most_rays(); }

void PassCommands::add_rays(std::uint64_t rays) {
    FramePieces& pieces = recorder_.frame_pieces();
    if (rays > pieces.room() && pieces.room() < pieces.most_rays()) run_piece();
    pieces.add_rays(rays);
}

PassCommands::WorkGroupRange PassCommands::begin_range(std::uint32_t first, std::uint32_t groups,
                                                       std::uint64_t rays_per_group) {
    FramePieces& pieces = recorder_.frame_pieces();
    if (groups * rays_per_group <= pieces.most_rays()) {
        add_rays(groups * rays_per_group);
        return {arrange_groups(groups), groups};
    }
    if (pieces.room() < rays_per_group && pieces.room() < pieces.most_rays()) run_piece();
    const std::uint64_t fit = std::max<std::uint64_t>(pieces.room() / rays_per_group, 1);
    // The range is one row, because a second row could hold groups beyond it.
    const auto count = static_cast<std::uint32_t>(
        std::min<std::uint64_t>({fit, groups - first, kMaxGroupsPerRow}));
    pieces.add_rays(count * rays_per_group);
    return {{count, 1}, first + count};
}

std::uint32_t PassCommands::read_word(BufferHandle buffer, std::uint64_t offset) {
    check_declared(buffer, "source of a word");
    check(!pass_.is_raster(), Failure::internal, "pass '", pass_.name,
          "' has attachments and cannot read a word");
    const std::uint32_t word = recorder_.read_word(buffer, offset);
    if (pipeline_) vkCmdBindPipeline(commands_, pipeline_->bind_point, pipeline_->pipeline);
    dirty_ = true, is_pushed_ = false;
    return word;
}

} // namespace catoptric::graph
