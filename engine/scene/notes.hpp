#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace catoptric::scene {

/// Kind of note for a colour or factor that a file gives outside of 0 to 1.
inline constexpr std::string_view kClampedFactorNote =
    "colours and factors outside 0 to 1, clamped (a colour of 0 to 255 must be divided by 255)";

/// Returns whether a loader that clamps this number to 0 to `largest` changes it by more than
/// rounding does.
constexpr bool is_clamped_factor(double number, double largest = 1) {
    constexpr double kRounding = 1e-4;
    return number < -kRounding || number > largest + kRounding;
}

/// Summary of what a loader left out, repaired or could not read. It keeps the count and the first
/// place of each kind. A file with a hundred thousand oddities therefore has one line for each
/// kind.
class LoaderNotes {
public:
    /// Adds `count` occurrences of `kind`. `first` is their place, printable; it is shown if they
    /// are the first of their kind.
    void add(std::string_view kind, std::string_view first, std::uint64_t count = 1);

    /// Returns "FILE: KIND: COUNT (first: PLACE)" for each kind, in order of first occurrence.
    /// Occurrences beyond 40 kinds are given only as a number.
    std::vector<std::string> lines(const std::string& file) const;

private:
    struct Note {
        std::string text, first;
        std::uint64_t count = 0;
    };
    std::vector<Note> kinds_;
    std::unordered_map<std::string, std::size_t> index_of_;
    std::uint64_t others_ = 0;
};

} // namespace catoptric::scene
