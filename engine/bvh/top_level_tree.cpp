#include "bvh/top_level_tree.hpp"

#include "core/large_pages.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <numeric>

namespace catoptric::bvh {

namespace {

// The most references in the subtree that one task builds.
constexpr std::size_t kMaxSubtreeTriangleReferences = 8192;
constexpr std::size_t kMaxTaskReferences = 4096; // the most references that one task bins or moves

/// A node of the top-level tree, or a subtree below it.
struct ParallelBvhBranch {
    TriangleReferenceSpanRange part;
    std::uint32_t depth = 0;
    std::size_t sides = 0; ///< index of the first of two branches; 0: a subtree
    BvhSubtree subtree{};
    std::size_t first_node = 0;               ///< index of the first node in the whole tree
    std::size_t copies = 0;                   ///< copies left out before its first triangle
    std::uint32_t word = f32::kBvhEmptyChild; ///< word of the node in the whole tree
};

/// The division of a branch.
struct ParallelBranchSplitPlan {
    std::size_t branch;
    CentroidToBinMapping binning;
    SahSplitBins bins{};
    std::optional<BinnedSahSplit> split{};
};

/// A share of a branch's references, for one task.
struct ParallelBranchWorkChunk {
    std::size_t cut;
    TriangleReferences references;
    SahSplitBins bins{};
    std::array<TriangleReference*, 2> to{};
    std::array<SimdBox, 2> centres{};
};

class ParallelBvhBuilder {
public:
    ParallelBvhBuilder(const BvhBuildWorkspace& work, unsigned threads)
        : build_workspace_(work), threads_(threads) {}

    void build_bvh_from_root(std::span<const TriangleReferenceSpanRange> parts) {
        std::vector<std::size_t> level{0};
        if (parts.size() == 2) {
            branches_.push_back({{}, 0, 1});
            level = {1, 2};
        }
        for (const TriangleReferenceSpanRange& part : parts)
            branches_.push_back({part, static_cast<std::uint32_t>(parts.size() - 1)});
        while (!level.empty()) level = split_bvh_branches_of_level(level);
        build_branch_subtrees_in_parallel();
    }

    std::size_t append_bvh_nodes_to(std::vector<vec4>& nodes) {
        node_count_ = nodes.size() / 4;
        number_bvh_nodes_depth_first(0);
        const bool is_node = f32::is_bvh_word_inner_node(branches_[0].word);
        nodes.reserve(4 * (node_count_ + (is_node ? 0 : 1)));
        advise_large_pages(nodes.data(), nodes.capacity() * sizeof(vec4));
        nodes.resize(nodes.capacity(), vec4(0));
        if (!is_node) write_bvh_node_texels(&nodes[4], branches_[0], ParallelBvhBranch{});
        parallel_for(branches_.size(), threads_, [&](std::size_t i) {
            const ParallelBvhBranch& branch = branches_[i];
            vec4* texel = nodes.data() + 4 * branch.first_node;
            if (branch.sides != 0)
                write_bvh_node_texels(texel, branches_[branch.sides], branches_[branch.sides + 1]);
            else
                copy_branch_nodes(texel, branch);
        });
        return triangle_count_;
    }

private:
    /// Divides all branches of a level. Returns the branches one level deeper.
    std::vector<std::size_t> split_bvh_branches_of_level(const std::vector<std::size_t>& level) {
        std::vector<ParallelBranchSplitPlan> cuts;
        std::vector<ParallelBranchWorkChunk> pieces;
        for (const std::size_t i : level) {
            const TriangleReferenceSpanRange& part = branches_[i].part;
            if (part.count <= kMaxSubtreeTriangleReferences || part.centres.is_single_point())
                continue;
            for (TriangleReferences rest = build_workspace_.references_of_range(part);
                 !rest.empty();) {
                const std::size_t count = std::min(kMaxTaskReferences, rest.size());
                pieces.push_back({cuts.size(), rest.first(count)});
                rest = rest.subspan(count);
            }
            cuts.push_back({i, CentroidToBinMapping(part.centres)});
        }
        parallel_for(pieces.size(), threads_, [&](std::size_t i) {
            pieces[i].bins.add_references(pieces[i].references, cuts[pieces[i].cut].binning);
        });
        choose_branch_split_planes(cuts, pieces);
        parallel_for(pieces.size(), threads_, [&](std::size_t i) {
            const ParallelBranchSplitPlan& cut = cuts[pieces[i].cut];
            if (cut.split)
                cut.split->scatter_references_to_sides(pieces[i].references, cut.binning,
                                                       pieces[i].to, pieces[i].centres);
        });
        return create_child_bvh_branches(cuts, pieces);
    }

    void choose_branch_split_planes(std::vector<ParallelBranchSplitPlan>& cuts,
                                    std::vector<ParallelBranchWorkChunk>& pieces) const {
        for (const ParallelBranchWorkChunk& piece : pieces)
            cuts[piece.cut].bins.add_bins(piece.bins);
        std::vector<std::array<TriangleReference*, 2>> to;
        for (ParallelBranchSplitPlan& cut : cuts) {
            const ParallelBvhBranch& branch = branches_[cut.branch];
            cut.split = find_best_binned_sah_split(
                cut.bins, max_triangles_below_tree_depth(build_workspace_, branch.depth + 1));
            TriangleReference* into = build_workspace_.scratch_buffer_of_range(branch.part).data();
            to.push_back(
                {into, into + (cut.split ? cut.bins.left_triangle_count_of_split(*cut.split) : 0)});
        }
        for (ParallelBranchWorkChunk& piece : pieces) {
            const ParallelBranchSplitPlan& cut = cuts[piece.cut];
            if (!cut.split) continue;
            const std::size_t left = piece.bins.left_triangle_count_of_split(*cut.split);
            piece.to = to[piece.cut];
            to[piece.cut][0] += left, to[piece.cut][1] += piece.references.size() - left;
        }
    }

    std::vector<std::size_t>
    create_child_bvh_branches(const std::vector<ParallelBranchSplitPlan>& cuts,
                              const std::vector<ParallelBranchWorkChunk>& pieces) {
        std::vector<std::array<SimdBox, 2>> centres(cuts.size());
        for (const ParallelBranchWorkChunk& piece : pieces)
            for (std::size_t side = 0; side < 2; ++side)
                centres[piece.cut][side].add_box(piece.centres[side]);
        std::vector<std::size_t> next;
        for (std::size_t i = 0; i < cuts.size(); ++i) {
            if (!cuts[i].split) continue;
            const std::size_t sides = branches_.size();
            const ParallelBvhBranch& branch = branches_[cuts[i].branch];
            const std::uint32_t depth = branch.depth + 1;
            const SplitTriangleRanges parts = make_split_ranges(branch.part, cuts[i].bins,
                                                                *cuts[i].split, centres[i]);
            branches_[cuts[i].branch].sides = sides;
            for (const TriangleReferenceSpanRange& part : parts) branches_.push_back({part, depth});
            next.insert(next.end(), {sides, sides + 1});
        }
        return next;
    }

    void build_branch_subtrees_in_parallel() {
        std::vector<std::size_t> order(branches_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::erase_if(order, [&](std::size_t i) { return branches_[i].sides != 0; });
        // Large subtrees are built first, so that no thread begins a large subtree when the others
        // have finished.
        std::ranges::stable_sort(order, std::greater(),
                                 [&](std::size_t i) { return branches_[i].part.count; });
        parallel_for(order.size(), threads_, [&](std::size_t i) {
            ParallelBvhBranch& branch = branches_[order[i]];
            branch.subtree = build_subtree(build_workspace_, branch.part, branch.depth);
        });
    }

    /// Numbers nodes and triangles in the order of a depth-first walk, left side first.
    void number_bvh_nodes_depth_first(std::size_t i) {
        ParallelBvhBranch& branch = branches_[i];
        branch.first_node = node_count_;
        if (branch.sides != 0) {
            branch.word = f32::kBvhNormalFloatBit | static_cast<std::uint32_t>(node_count_++);
            number_bvh_nodes_depth_first(branch.sides),
                number_bvh_nodes_depth_first(branch.sides + 1);
            return;
        }
        branch.copies = branch.part.first - triangle_count_;
        branch.word = convert_to_whole_bvh_child_word(branch, branch.subtree.root);
        if (branch.copies > 0)
            std::copy_n(build_workspace_.triangles + 3 * branch.part.first,
                        3 * branch.subtree.triangles,
                        build_workspace_.triangles + 3 * triangle_count_);
        node_count_ += branch.subtree.nodes.size() / 4;
        triangle_count_ += branch.subtree.triangles;
    }

    /// Converts a word of the branch's subtree to a word of the whole tree.
    static std::uint32_t convert_to_whole_bvh_child_word(const ParallelBvhBranch& branch,
                                                         std::uint32_t word) {
        if (word == f32::kBvhEmptyChild) return word;
        return word + static_cast<std::uint32_t>(f32::is_bvh_word_inner_node(word)
                                                     ? branch.first_node - 1
                                                     : -branch.copies);
    }

    static void write_bvh_node_texels(vec4* texel, const ParallelBvhBranch& left,
                                      const ParallelBvhBranch& right) {
        const std::array sides{&left, &right};
        for (std::size_t i = 0; i < 2; ++i) {
            const BoundingBox box = sides[i]->part.box.to_bounding_box();
            texel[i].w = std::bit_cast<float>(sides[i]->word);
            texel[2 * i] = vec4(box.lo, texel[2 * i].w);
            texel[2 * i + 1] = vec4(box.hi, texel[2 * i + 1].w);
        }
    }

    static void copy_branch_nodes(vec4* texel, const ParallelBvhBranch& branch) {
        for (std::size_t i = 0; i < branch.subtree.nodes.size(); ++i) {
            texel[i] = branch.subtree.nodes[i];
            if (i % 4 < 2)
                texel[i].w = std::bit_cast<float>(
                    convert_to_whole_bvh_child_word(branch, float_to_bits(texel[i].w)));
        }
    }

    const BvhBuildWorkspace& build_workspace_;
    unsigned threads_;
    std::vector<ParallelBvhBranch> branches_{}; ///< branches of the tree; the first is the root
    std::size_t node_count_ = 0, triangle_count_ = 0;
};

} // namespace

std::size_t build_bvh_in_parallel(const BvhBuildWorkspace& work,
                                  std::span<const TriangleReferenceSpanRange> parts,
                                  unsigned threads, std::vector<vec4>& nodes) {
    ParallelBvhBuilder builder(work, threads);
    builder.build_bvh_from_root(parts);
    return builder.append_bvh_nodes_to(nodes);
}

} // namespace catoptric::bvh
