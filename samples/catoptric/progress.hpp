#pragma once

#include "app/watcher.hpp"
#include "output.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

namespace catoptric::cli {

/// Writes "[3/14] reuse  frame 12/28  about 0:35 left" to stderr, rewritten in place on a terminal.
/// With --progress always elsewhere (or TERM=dumb): one line a row. No colours, no escape
/// sequences.
class Progress {
public:
    /// What is written where stderr is no terminal and --progress is auto.
    enum class OffTerminal : std::uint8_t {
        nothing,
        tenths, ///< a line each time that another tenth of the rows is done: "30 % done, ..."
    };
    explicit Progress(const Manners& manners, OffTerminal off_terminal = OffTerminal::nothing);
    /// Removes the line.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Row `index` (from 0) of `count` begins.
    void row(const std::string& label, std::size_t index, std::size_t count);
    /// Frame `number` (from 1) of `total` of this row is done.
    void frame(int number, int total);
    /// Removes the line until the next frame, so that other text can be written.
    void clear();

private:
    using Clock = std::chrono::steady_clock;
    void show(const std::string& text);
    /// Writes a line when another tenth is done since the last one.
    void show_tenth();
    /// Returns a guess from the time so far: "0:35".
    std::string time_left(double done) const;

    bool active_ = false;
    bool rewrites_ = false;
    bool in_tenths_ = false;
    std::size_t tenths_ = 0; ///< that were said
    std::string label_;
    std::size_t index_ = 0, count_ = 1;
    std::size_t shown_width_ = 0;
    Clock::time_point start_ = Clock::now();
    Clock::time_point shown_at_{};
};

/// Shows every row and frame, and stops the work at the first signal (signals.hpp). `progress` must
/// outlive it.
app::Watcher watcher_of(Progress& progress);

/// "0:07", "12:40", "3:02:10".
std::string duration_text(double seconds);

} // namespace catoptric::cli
