#pragma once

#include "app/causes.hpp"
#include "app/oracle.hpp"
#include "app/reference_cache.hpp"
#include "report/comparison.hpp"

#include <optional>
#include <string>
#include <vector>

namespace catoptric::app {

/// Says what rows of a comparison get wrong.
class RowJudge {
public:
    /// All must outlive this; `base` shows the session's scene, `truths` are of both.
    RowJudge(Session& session, ReferenceCache& truths, const Request& base, const Watcher& watcher)
        : session_(session), truths_(truths), base_(base), watcher_(watcher) {}

    /// Fills the row's picture and all that is said of it, from its frame `number`, which `part`
    /// is; returns what its user should know. The session begins another sequence. Costs a frame
    /// that says where mirrors looked, and nine rays a mirror pixel.
    std::vector<std::string> judge(report::Row& row, const std::string& text, const Part& part,
                                   int number);
    /// Splits the error of a technique that looks into captures by cause.
    report::Causes causes_of(const std::string& text);

private:
    Request still(int number) const;
    Part looked_up(const std::string& text, int number);
    const Oracle& oracle_of(int number);

    Session& session_;
    ReferenceCache& truths_;
    const Request& base_;
    const Watcher& watcher_;
    std::optional<Oracle> oracle_;
    int oracle_frame_ = 0; ///< of whose instant it speaks
    std::optional<CauseFinder> finder_;
};

} // namespace catoptric::app
