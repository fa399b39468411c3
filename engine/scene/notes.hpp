#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace catoptric::scene {

/// What a loader left out, repaired or could not read: of each kind how often, and where first, so
/// that a file of a hundred thousand oddities has a line for each kind.
class Notes {
public:
    /// `first` says where it is, printable; shown for the first of its kind.
    void add(std::string_view kind, std::string_view first, std::uint64_t count = 1);

    /// "FILE: KIND: COUNT (first: PLACE)" for each kind, in the order in which they came; what
    /// comes after 40 kinds only as a number.
    std::vector<std::string> lines(const std::string& file) const;

private:
    struct Kind {
        std::string text, first;
        std::uint64_t count = 0;
    };
    std::vector<Kind> kinds_;
    std::unordered_map<std::string, std::size_t> index_of_;
    std::uint64_t others_ = 0;
};

} // namespace catoptric::scene
