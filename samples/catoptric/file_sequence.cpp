#include "file_sequence.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <regex>

namespace catoptric::cli {

std::optional<FileSequence> FileSequence::parse(const std::string& name) {
    static const std::regex kNumberPlaceholder(R"(\{n(?::0?([1-9]))?\}|%(?:0?([1-9]))?d)");
    const std::size_t begin = name.rfind('/') + 1; // 0 without a folder
    const std::string folder = name.substr(0, begin), last = name.substr(begin);
    std::smatch place;
    const bool found = std::regex_search(last, place, kNumberPlaceholder);
    const std::string rest = found ? place.suffix().str() : last;
    check(!std::regex_search(rest, kNumberPlaceholder), Failure::usage,
          "-o: wanted one place for the frame's number, found two in '", name, "'");
    check(rest.find("{n") == std::string::npos &&
              (!found || place.prefix().str().find("{n") == std::string::npos),
          Failure::usage, "-o: wanted {n}, {n:4}, %d or %04d for the frame's number, found '", name,
          "'");
    if (!found) return std::nullopt;
    const std::string digits = place[1].str() + place[2].str();
    FileSequence sequence;
    sequence.before_ = folder + place.prefix().str();
    sequence.after_ = rest;
    sequence.digits_ = digits.empty() ? 0 : std::stoi(digits);
    return sequence;
}

std::string FileSequence::file(int number) const {
    return fmt::format("{}{:0{}}{}", before_, number, digits_, after_);
}

} // namespace catoptric::cli
