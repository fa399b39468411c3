#include "progress.hpp"

#include "core/text.hpp"
#include "signals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <sys/ioctl.h>
#include <unistd.h>

namespace catoptric::cli {

namespace {

bool is_stderr_terminal() {
    const char* term = std::getenv("TERM");
    return ::isatty(STDERR_FILENO) != 0 && term != nullptr && std::string_view(term) != "dumb";
}

std::size_t terminal_columns() {
    winsize size{};
    const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
    return known ? size.ws_col : 80U;
}

} // namespace

session::Watcher make_watcher(ProgressPrinter& progress) {
    return {.on_row = [&](const std::string& label, std::size_t index,
                          std::size_t count) { progress.row(label, index, count); },
            .on_frame = [&](int number, int total) { progress.frame(number, total); },
            .on_piece = [&](std::uint64_t done, std::uint64_t all) { progress.piece(done, all); },
            .stop = &stop_on_signals()};
}

std::string format_duration(double seconds) {
    const auto whole = std::llround(std::clamp(seconds, 0.0, 3.6e8));
    const long long hours = whole / 3600, minutes = whole / 60 % 60, rest = whole % 60;
    return hours > 0 ? fmt::format("{}:{:02}:{:02}", hours, minutes, rest)
                     : fmt::format("{}:{:02}", minutes, rest);
}

ProgressPrinter::ProgressPrinter(const OutputOptions& output_options, OffTerminal off_terminal,
                                 std::string phase)
    : is_active_(!output_options.quiet &&
                 (output_options.progress == ProgressMode::always ||
                  (output_options.progress == ProgressMode::automatic && is_stderr_terminal()))),
      rewrites_(is_stderr_terminal()),
      in_tenths_(!is_active_ && !output_options.quiet &&
                 output_options.progress == ProgressMode::automatic &&
                 off_terminal == OffTerminal::tenths),
      label_(std::move(phase)) {
    if (output_options.quiet || output_options.progress == ProgressMode::never) return;
    teller_ = std::jthread([this](const std::stop_token& ended) { tell_while_working(ended); });
}

ProgressPrinter::~ProgressPrinter() {
    teller_ = {}; // ends the thread
    clear();
}

void ProgressPrinter::tell_while_working(const std::stop_token& ended) {
    std::condition_variable_any wake;
    std::unique_lock lock(mutex_);
    const SteadyClock::time_point begin = SteadyClock::now();
    for (std::chrono::seconds next{1};;) {
        if (wake.wait_until(lock, ended, begin + next, [] { return false; }) ||
            ended.stop_requested())
            return;
        next = rewrites_ && is_active_ ? next + std::chrono::seconds(1) : 2 * next;
        if (is_cleared_) continue;
        if (rewrites_ && is_active_) {
            show(describe_phase());
            continue;
        }
        fmt::print(stderr, "{}\n", describe_phase());
        std::fflush(stderr);
    }
}

std::string ProgressPrinter::describe_phase() const {
    const double seconds = 1e-3 * ms_since(phase_start_),
                 done = std::min((frame_ + share_) / frames_, 1.0);
    const std::string so_far = format_duration(seconds) + " so far";
    if (!(done > 0)) return fmt::format("{}: {}, no estimate yet", label_, so_far);
    std::string text = fmt::format("{}: about {} left, {:.0f} % done in {}", label_,
                                   format_duration(seconds * (1 - done) / done), 100 * done,
                                   format_duration(seconds));
    if (const double all = (static_cast<double>(index_) + done) / static_cast<double>(count_);
        count_ > 1)
        text += fmt::format("; about {} left in all", format_time_left(all));
    return text;
}

void ProgressPrinter::piece(std::uint64_t done, std::uint64_t all) {
    const std::lock_guard lock(mutex_);
    share_ = static_cast<double>(done) / static_cast<double>(std::max<std::uint64_t>(all, 1));
    is_cleared_ = false;
}

void ProgressPrinter::row(const std::string& label, std::size_t index, std::size_t count) {
    const std::lock_guard lock(mutex_);
    phase_start_ = SteadyClock::now();
    frame_ = 0, frames_ = 1, share_ = 0, is_cleared_ = false;
    if (index == 0) start_ = SteadyClock::now(), tenths_ = 0; // a new list of rows begins
    label_ = escape(label);
    index_ = index;
    count_ = std::max<std::size_t>(count, 1);
    shown_at_ = {};
    if (is_active_ && !rewrites_) fmt::print(stderr, "[{}/{}] {}\n", index + 1, count_, label_);
    if (in_tenths_) show_tenths();
}

void ProgressPrinter::show_tenths() {
    const std::size_t tenths = 10 * index_ / count_;
    if (tenths <= tenths_) return;
    tenths_ = tenths;
    fmt::print(stderr, "{} % done, about {} left, now {}\n", 10 * tenths,
               format_time_left(static_cast<double>(index_) / static_cast<double>(count_)), label_);
    std::fflush(stderr);
}

std::string ProgressPrinter::format_time_left(double done) const {
    const double elapsed = std::chrono::duration<double>(SteadyClock::now() - start_).count();
    return format_duration(elapsed * (1 - done) / done);
}

void ProgressPrinter::frame(int number, int total) {
    const std::lock_guard lock(mutex_);
    frame_ = number, frames_ = std::max(total, 1), share_ = 0, is_cleared_ = false;
    if (!is_active_ || !rewrites_) return;
    const SteadyClock::time_point now = SteadyClock::now();
    if (now - shown_at_ < std::chrono::milliseconds(100)) return;
    shown_at_ = now;
    // Rows take different times, but this estimate suffices to decide whether to wait.
    const double done = (static_cast<double>(index_) + static_cast<double>(number) / total) /
                        static_cast<double>(count_);
    const std::string place = count_ > 1 ? fmt::format("[{}/{}] ", index_ + 1, count_) : "";
    show(fmt::format("{}{}  frame {}/{}  about {} left", place, label_, number, total,
                     format_time_left(done)));
}

void ProgressPrinter::clear() {
    const std::lock_guard lock(mutex_);
    is_cleared_ = true;
    remove_line();
}

void ProgressPrinter::remove_line() {
    if (shown_width_ == 0) return;
    fmt::print(stderr, "\r{}\r", std::string(shown_width_, ' '));
    std::fflush(stderr);
    shown_width_ = 0;
}

void ProgressPrinter::show(const std::string& text) {
    const std::string cut = text.substr(0, terminal_columns() - 1);
    const std::size_t left_over = shown_width_ > cut.size() ? shown_width_ - cut.size() : 0;
    fmt::print(stderr, "\r{}{}", cut, std::string(left_over, ' '));
    std::fflush(stderr);
    shown_width_ = cut.size();
}

} // namespace catoptric::cli
