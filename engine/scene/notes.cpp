#include "scene/notes.hpp"

namespace catoptric::scene {

namespace {

constexpr std::size_t kMaxNoteKinds = 40; // as many lines as a user may still read

} // namespace

void LoaderNotes::add(std::string_view kind, std::string_view first, std::uint64_t count) {
    if (count == 0) return;
    const auto known = index_of_.find(std::string(kind));
    if (known != index_of_.end()) {
        kinds_[known->second].count += count;
    } else if (kinds_.size() < kMaxNoteKinds) {
        index_of_[std::string(kind)] = kinds_.size();
        kinds_.push_back({.text = std::string(kind), .first = std::string(first), .count = count});
    } else {
        others_ += count;
    }
}

std::vector<std::string> LoaderNotes::lines(const std::string& file) const {
    std::vector<std::string> lines;
    for (const auto& [text, first, count] : kinds_)
        lines.push_back(file + ": " + text + ": " + std::to_string(count) + " (first: " + first +
                        ")");
    if (others_ > 0)
        lines.push_back(file +
                        ": further notes of other kinds, not listed: " + std::to_string(others_));
    return lines;
}

} // namespace catoptric::scene
