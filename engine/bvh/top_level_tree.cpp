#include "bvh/top_level_tree.hpp"

#include "core/large_pages.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <numeric>

namespace catoptric::bvh {

namespace {

// The most references in the subtree that one task builds.
constexpr std::size_t kMaxSubtreeReferences = 8192;
constexpr std::size_t kMaxTaskReferences = 4096; // the most references that one task bins or moves

/// A node of the top-level tree, or a subtree below it.
struct Branch {
    ReferenceRange part;
    std::uint32_t depth = 0;
    std::size_t sides = 0; ///< index of the first of two branches; 0: a subtree
    Subtree subtree{};
    std::size_t first_node = 0;               ///< index of the first node in the whole tree
    std::size_t copies = 0;                   ///< copies left out before its first triangle
    std::uint32_t word = f32::kBvhEmptyChild; ///< word of the node in the whole tree
};

struct BranchSplit {
    std::size_t branch;
    Binning binning;
    SplitBins bins{};
    std::optional<BinnedSplit> split{};
};

/// A share of a branch's references, for one task.
struct BranchChunk {
    std::size_t cut;
    TriangleReferences references;
    SplitBins bins{};
    std::array<TriangleReference*, 2> to{};
    std::array<SimdBox, 2> centres{};
};

class ParallelBuilder {
public:
    ParallelBuilder(const BuildWorkspace& work, unsigned threads)
        : work_(work), threads_(threads) {}

    void build(std::span<const ReferenceRange> parts) {
        std::vector<std::size_t> level{0};
        if (parts.size() == 2) {
            branches_.push_back({{}, 0, 1});
            level = {1, 2};
        }
        for (const ReferenceRange& part : parts)
            branches_.push_back({part, static_cast<std::uint32_t>(parts.size() - 1)});
        while (!level.empty()) level = split_level(level);
        build_subtrees();
    }

    std::size_t append_nodes(std::vector<vec4>& nodes) {
        node_count_ = nodes.size() / 4;
        number_nodes(0);
        const bool is_node = f32::is_bvh_word_inner_node(branches_[0].word);
        nodes.reserve(4 * (node_count_ + (is_node ? 0 : 1)));
        advise_large_pages(nodes.data(), nodes.capacity() * sizeof(vec4));
        nodes.resize(nodes.capacity(), vec4(0));
        if (!is_node) write_node(&nodes[4], branches_[0], Branch{});
        parallel_for(branches_.size(), threads_, [&](std::size_t i) {
            const Branch& branch = branches_[i];
            vec4* texel = nodes.data() + 4 * branch.first_node;
            if (branch.sides != 0)
                write_node(texel, branches_[branch.sides], branches_[branch.sides + 1]);
            else
                copy_nodes(texel, branch);
        });
        return triangle_count_;
    }

private:
    /// Divides all branches of a level. Returns the branches one level deeper.
    std::vector<std::size_t> split_level(const std::vector<std::size_t>& level) {
        std::vector<BranchSplit> cuts;
        std::vector<BranchChunk> pieces;
        for (const std::size_t i : level) {
            const ReferenceRange& part = branches_[i].part;
            if (part.count <= kMaxSubtreeReferences || part.centres.is_point()) continue;
            for (TriangleReferences rest = work_.references(part); !rest.empty();) {
                const std::size_t count = std::min(kMaxTaskReferences, rest.size());
                pieces.push_back({cuts.size(), rest.first(count)});
                rest = rest.subspan(count);
            }
            cuts.push_back({i, Binning(part.centres)});
        }
        parallel_for(pieces.size(), threads_, [&](std::size_t i) {
            pieces[i].bins.add(pieces[i].references, cuts[pieces[i].cut].binning);
        });
        choose_splits(cuts, pieces);
        parallel_for(pieces.size(), threads_, [&](std::size_t i) {
            const BranchSplit& cut = cuts[pieces[i].cut];
            if (cut.split)
                cut.split->scatter(pieces[i].references, cut.binning, pieces[i].to,
                                   pieces[i].centres);
        });
        return add_branches(cuts, pieces);
    }

    void choose_splits(std::vector<BranchSplit>& cuts, std::vector<BranchChunk>& pieces) const {
        for (const BranchChunk& piece : pieces) cuts[piece.cut].bins.add(piece.bins);
        std::vector<std::array<TriangleReference*, 2>> to;
        for (BranchSplit& cut : cuts) {
            const Branch& branch = branches_[cut.branch];
            cut.split = find_binned_split(cut.bins, max_triangles_below(work_, branch.depth + 1));
            TriangleReference* into = work_.scratch(branch.part).data();
            to.push_back({into, into + (cut.split ? cut.bins.left_count(*cut.split) : 0)});
        }
        for (BranchChunk& piece : pieces) {
            const BranchSplit& cut = cuts[piece.cut];
            if (!cut.split) continue;
            const std::size_t left = piece.bins.left_count(*cut.split);
            piece.to = to[piece.cut];
            to[piece.cut][0] += left, to[piece.cut][1] += piece.references.size() - left;
        }
    }

    std::vector<std::size_t> add_branches(const std::vector<BranchSplit>& cuts,
                                          const std::vector<BranchChunk>& pieces) {
        std::vector<std::array<SimdBox, 2>> centres(cuts.size());
        for (const BranchChunk& piece : pieces)
            for (std::size_t side = 0; side < 2; ++side)
                centres[piece.cut][side].add_box(piece.centres[side]);
        std::vector<std::size_t> next;
        for (std::size_t i = 0; i < cuts.size(); ++i) {
            if (!cuts[i].split) continue;
            const std::size_t sides = branches_.size();
            const Branch& branch = branches_[cuts[i].branch];
            const std::uint32_t depth = branch.depth + 1;
            const SplitRanges parts = make_split_ranges(branch.part, cuts[i].bins, *cuts[i].split,
                                                        centres[i]);
            branches_[cuts[i].branch].sides = sides;
            for (const ReferenceRange& part : parts) branches_.push_back({part, depth});
            next.insert(next.end(), {sides, sides + 1});
        }
        return next;
    }

    void build_subtrees() {
        std::vector<std::size_t> order(branches_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::erase_if(order, [&](std::size_t i) { return branches_[i].sides != 0; });
        // Large subtrees are built first, so that no thread begins a large subtree when the others
        // have finished.
        std::ranges::stable_sort(order, std::greater(),
                                 [&](std::size_t i) { return branches_[i].part.count; });
        parallel_for(order.size(), threads_, [&](std::size_t i) {
            Branch& branch = branches_[order[i]];
            branch.subtree = build_subtree(work_, branch.part, branch.depth);
        });
    }

    /// Numbers nodes and triangles in the order of a depth-first walk, left side first.
    void number_nodes(std::size_t i) {
        Branch& branch = branches_[i];
        branch.first_node = node_count_;
        if (branch.sides != 0) {
            branch.word = f32::kBvhNormalFloatBit | static_cast<std::uint32_t>(node_count_++);
            number_nodes(branch.sides), number_nodes(branch.sides + 1);
            return;
        }
        branch.copies = branch.part.first - triangle_count_;
        branch.word = whole_tree_word(branch, branch.subtree.root);
        if (branch.copies > 0)
            std::copy_n(work_.triangles + 3 * branch.part.first, 3 * branch.subtree.triangles,
                        work_.triangles + 3 * triangle_count_);
        node_count_ += branch.subtree.nodes.size() / 4;
        triangle_count_ += branch.subtree.triangles;
    }

    /// Converts a word of the branch's subtree to a word of the whole tree.
    static std::uint32_t whole_tree_word(const Branch& branch, std::uint32_t word) {
        if (word == f32::kBvhEmptyChild) return word;
        return word + static_cast<std::uint32_t>(f32::is_bvh_word_inner_node(word)
                                                     ? branch.first_node - 1
                                                     : -branch.copies);
    }

    static void write_node(vec4* texel, const Branch& left, const Branch& right) {
        const std::array sides{&left, &right};
        for (std::size_t i = 0; i < 2; ++i) {
            const BoundingBox box = sides[i]->part.box.to_bounds();
            texel[i].w = std::bit_cast<float>(sides[i]->word);
            texel[2 * i] = vec4(box.lo, texel[2 * i].w);
            texel[2 * i + 1] = vec4(box.hi, texel[2 * i + 1].w);
        }
    }

    static void copy_nodes(vec4* texel, const Branch& branch) {
        for (std::size_t i = 0; i < branch.subtree.nodes.size(); ++i) {
            texel[i] = branch.subtree.nodes[i];
            if (i % 4 < 2)
                texel[i].w = std::bit_cast<float>(
                    whole_tree_word(branch, float_to_bits(texel[i].w)));
        }
    }

    const BuildWorkspace& work_;
    unsigned threads_;
    std::vector<Branch> branches_{}; ///< the first is the root
    std::size_t node_count_ = 0, triangle_count_ = 0;
};

} // namespace

std::size_t build_in_parallel(const BuildWorkspace& work, std::span<const ReferenceRange> parts,
                              unsigned threads, std::vector<vec4>& nodes) {
    ParallelBuilder builder(work, threads);
    builder.build(parts);
    return builder.append_nodes(nodes);
}

} // namespace catoptric::bvh
