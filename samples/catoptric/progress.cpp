#include "progress.hpp"

#include "core/text.hpp"
#include "signals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
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

std::size_t count_terminal_columns() {
    winsize size{};
    const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
    return known ? size.ws_col : 80U;
}

} // namespace

app::Watcher make_progress_watcher(ProgressPrinter& progress) {
    return {.on_row = [&](const std::string& label, std::size_t index,
                          std::size_t count) { progress.row(label, index, count); },
            .on_frame = [&](int number, int total) { progress.frame(number, total); },
            .stop = &stop_on_signals()};
}

std::string format_duration(double seconds) {
    const auto whole = std::llround(std::clamp(seconds, 0.0, 3.6e8));
    const long long hours = whole / 3600, minutes = whole / 60 % 60, rest = whole % 60;
    return hours > 0 ? fmt::format("{}:{:02}:{:02}", hours, minutes, rest)
                     : fmt::format("{}:{:02}", minutes, rest);
}

ProgressPrinter::ProgressPrinter(const OutputOptions& output_options,
                                 ProgressOffTerminal off_terminal)
    : is_active_(!output_options.quiet &&
                 (output_options.progress == ProgressMode::always ||
                  (output_options.progress == ProgressMode::automatic && is_stderr_terminal()))),
      rewrites_(is_stderr_terminal()),
      in_tenths_(!is_active_ && !output_options.quiet &&
                 output_options.progress == ProgressMode::automatic &&
                 off_terminal == ProgressOffTerminal::tenths) {}

ProgressPrinter::~ProgressPrinter() { clear(); }

void ProgressPrinter::row(const std::string& label, std::size_t index, std::size_t count) {
    if (index == 0) start_ = SteadyClock::now(), tenths_ = 0; // a new list of rows begins
    label_ = escape_control_characters(label);
    index_ = index;
    count_ = std::max<std::size_t>(count, 1);
    shown_at_ = {};
    if (is_active_ && !rewrites_) fmt::print(stderr, "[{}/{}] {}\n", index + 1, count_, label_);
    if (in_tenths_) show_progress_every_ten_percent();
}

void ProgressPrinter::show_progress_every_ten_percent() {
    const std::size_t tenths = 10 * index_ / count_;
    if (tenths <= tenths_) return;
    tenths_ = tenths;
    fmt::print(
        stderr, "{} % done, about {} left, now {}\n", 10 * tenths,
        format_estimated_time_left(static_cast<double>(index_) / static_cast<double>(count_)),
        label_);
    std::fflush(stderr);
}

std::string ProgressPrinter::format_estimated_time_left(double done) const {
    const double elapsed = std::chrono::duration<double>(SteadyClock::now() - start_).count();
    return format_duration(elapsed * (1 - done) / done);
}

void ProgressPrinter::frame(int number, int total) {
    if (!is_active_ || !rewrites_) return;
    const SteadyClock::time_point now = SteadyClock::now();
    if (now - shown_at_ < std::chrono::milliseconds(100)) return;
    shown_at_ = now;
    // Rows take different times, but this estimate suffices to decide whether to wait.
    const double done = (static_cast<double>(index_) + static_cast<double>(number) / total) /
                        static_cast<double>(count_);
    const std::string place = count_ > 1 ? fmt::format("[{}/{}] ", index_ + 1, count_) : "";
    show(fmt::format("{}{}  frame {}/{}  about {} left", place, label_, number, total,
                     format_estimated_time_left(done)));
}

void ProgressPrinter::clear() {
    if (shown_width_ == 0) return;
    fmt::print(stderr, "\r{}\r", std::string(shown_width_, ' '));
    std::fflush(stderr);
    shown_width_ = 0;
}

void ProgressPrinter::show(const std::string& text) {
    const std::string cut = text.substr(0, count_terminal_columns() - 1);
    const std::size_t left_over = shown_width_ > cut.size() ? shown_width_ - cut.size() : 0;
    fmt::print(stderr, "\r{}{}", cut, std::string(left_over, ' '));
    std::fflush(stderr);
    shown_width_ = cut.size();
}

} // namespace catoptric::cli
