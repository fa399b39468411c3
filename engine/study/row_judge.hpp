#pragma once

#include "report/comparison.hpp"
#include "study/oracle.hpp"
#include "study/reference_cache.hpp"

#include <optional>
#include <string>
#include <vector>

namespace catoptric::study {

using namespace session;

class RowErrorJudge {
public:
    /// All objects passed by reference must outlive the judge. `base` shows the session's scene.
    /// `truths` uses the same session and base.
    RowErrorJudge(Session& session, ReferenceCache& truths, const Request& base,
                  const Watcher& watcher)
        : session_(session), truths_(truths), base_(base), watcher_(watcher) {}

    /// Fills the row's picture and all its figures from `part`, the row's frame `number`. Returns
    /// warnings for the user. The session begins another sequence. Costs a frame that records where
    /// mirrors looked, and nine rays per mirror pixel.
    std::vector<std::string> fill(report::Row& row, const std::string& text,
                                  const TechniqueResult& part, int number);

private:
    Request still_request(int number) const;
    TechniqueResult render_lookups(const std::string& text, int number);
    const TrueHitFinder& hit_finder(int number);

    Session& session_;
    ReferenceCache& truths_;
    const Request& base_;
    const Watcher& watcher_;
    std::optional<TrueHitFinder> finder_;
    int finder_frame_ = 0; ///< frame whose instant `finder_` describes
};

} // namespace catoptric::study
