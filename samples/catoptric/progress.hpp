#pragma once

#include "core/stopwatch.hpp"
#include "output.hpp"
#include "session/watcher.hpp"

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

namespace catoptric::cli {

/// Writes progress to stderr, such as "[3/14] reuse  frame 12/28  about 0:35 left". On a terminal,
/// the line is rewritten in place. Elsewhere, or with TERM=dumb, --progress always writes one line
/// per row. A thread of its own says what is done and how long it will take, also while the work
/// calls nothing: on a terminal each second, elsewhere after 1 s and then at doubled times. Uses no
/// colours and no escape sequences.
class ProgressPrinter {
public:
    /// Output if stderr is no terminal and --progress is automatic.
    enum class OffTerminal : std::uint8_t {
        nothing,
        tenths, ///< a line per finished tenth of the rows: "30 % done, ..."
    };
    /// `phase`: what is done until the first row.
    explicit ProgressPrinter(const OutputOptions& output_options,
                             OffTerminal off_terminal = OffTerminal::nothing,
                             std::string phase = "preparing");
    /// Removes the progress line from the terminal.
    ~ProgressPrinter();
    ProgressPrinter(const ProgressPrinter&) = delete;
    ProgressPrinter& operator=(const ProgressPrinter&) = delete;

    /// Reports that row `index` (from 0) of `count` begins.
    void row(const std::string& label, std::size_t index, std::size_t count);
    /// Reports that frame `number` (from 1) of `total` of this row is done.
    void frame(int number, int total);
    /// Reports that this many rays of `all` are traced in the frame that is being rendered.
    void piece(std::uint64_t done, std::uint64_t all);
    /// Removes the progress line until the next frame, to make room for other text.
    void clear();

private:
    void remove_line();
    void tell_while_working(const std::stop_token& ended);
    /// Returns what is done now and how long it will take: "reference  12 % done, about 0:09 left
    /// of it (from 3 s so far)".
    std::string describe_phase() const;
    void show(const std::string& text);
    /// Writes a line if another tenth of the work is done since the last line.
    void show_tenths();
    /// Returns the estimated remaining time from the time so far: "0:35".
    std::string format_time_left(double done) const;

    mutable std::mutex mutex_; ///< of all members below
    bool is_active_ = false;
    bool rewrites_ = false;
    bool in_tenths_ = false;
    std::size_t tenths_ = 0; ///< number of tenths for which a line was written
    std::string label_;
    std::size_t index_ = 0, count_ = 1;
    int frame_ = 0, frames_ = 1; ///< frames of the row
    double share_ = 0;           ///< of the frame that is being rendered
    bool is_cleared_ = false;    ///< other text is being written
    std::size_t shown_width_ = 0;
    SteadyClock::time_point start_ = SteadyClock::now();
    SteadyClock::time_point shown_at_{};
    SteadyClock::time_point phase_start_ = SteadyClock::now();
    std::jthread teller_; ///< declared last, so that it ends first
};

/// Returns a watcher that shows every row and frame, and stops the work at the first signal
/// (signals.hpp). `progress` must outlive it.
session::Watcher make_watcher(ProgressPrinter& progress);

/// Returns a duration as text: "0:07", "12:40", "3:02:10".
std::string format_duration(double seconds);

} // namespace catoptric::cli
