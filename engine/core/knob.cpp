#include "core/knob.hpp"

#include "core/error.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

namespace catoptric {

namespace {

// These limits bound the time of a suggestion, which is only for typing errors: at most 64 x 96
// steps for each name.
constexpr std::size_t kMaxWordLength = 64;
constexpr std::size_t kMaxSearchedNames = 10'000;

std::string format_value(double value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed).ptr;
    return {text, end};
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0]++;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t changed = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, changed});
        }
    }
    return row.back();
}

bool is_same_knob(const Knob& a, const Knob& b) {
    return a.name == b.name && a.special == b.special && a.choices.data() == b.choices.data() &&
           a.find_choices == b.find_choices;
}

} // namespace

KnobSettings::KnobSettings(std::span<const Knob> knobs) : knobs_(knobs) {
    for (const Knob& knob : knobs) values_.push_back(knob.value);
}

std::size_t KnobSettings::value_index(const Knob& knob) const {
    const auto found = std::ranges::find_if(
        knobs_, [&](const Knob& known) { return is_same_knob(known, knob); });
    check(found != knobs_.end(), Failure::internal, "there is no knob '", knob.name, "'");
    return static_cast<std::size_t>(found - knobs_.begin());
}

bool KnobSettings::has(const Knob& knob) const {
    return std::ranges::any_of(knobs_,
                               [&](const Knob& known) { return is_same_knob(known, knob); });
}

double KnobSettings::number(const Knob& knob) const {
    const std::size_t i = value_index(knob);
    check(values_[i].has_value(), Failure::internal, "knob '", knob.name, "' is '",
          knobs_[i].special, "', no number");
    return *values_[i];
}

std::string_view KnobSettings::choice_name(const Knob& knob) const {
    const std::size_t i = value_index(knob);
    const std::span<const std::string_view> choices = knobs_[i].names();
    check(!choices.empty(), Failure::internal, "knob '", knob.name, "' is not a choice");
    return choices[static_cast<std::size_t>(number(knob))];
}

bool KnobSettings::is_special(const Knob& knob) const {
    return !values_[value_index(knob)].has_value();
}

void KnobSettings::set(std::string_view owner, std::string_view name, std::string_view text) {
    std::vector<std::string> names;
    for (const Knob& knob : knobs_) names.emplace_back(knob.name);
    const auto named = std::ranges::find(knobs_, name, &Knob::name);
    if (named == knobs_.end())
        fail(Failure::usage, "technique '", owner, "' has no knob '", name, "'",
             suggest_name_or_list(name, names));
    const Knob& knob = *named;
    std::optional<double>& target = values_[static_cast<std::size_t>(named - knobs_.begin())];
    if (const std::span<const std::string_view> known = knob.names(); !known.empty()) {
        const auto found = std::ranges::find(known, text);
        const std::vector<std::string> choices(known.begin(), known.end());
        std::string wanted;
        for (const std::string& choice : choices) wanted += (wanted.empty() ? "" : "|") + choice;
        check(found != known.end(), Failure::usage, "knob '", name, "' of '", owner, "' takes ",
              wanted, ", not '", text, "'", suggest_name(text, choices));
        target = static_cast<double>(found - known.begin());
        return;
    }
    if (!knob.special.empty() && text == knob.special) {
        target = std::nullopt;
        return;
    }
    const std::string range = format_value(knob.low) + " to " + format_value(knob.high) +
                              (knob.special.empty() ? "" : " or " + std::string(knob.special));
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    check(error == std::errc{} && end == text.data() + text.size() &&
              (knob.is_real || value == std::floor(value)),
          Failure::usage, "knob '", name, "' of '", owner, "' takes a ",
          knob.is_real ? "" : "whole ", "number from ", range, ", not '", text, "'",
          suggest_name(text, std::vector{std::string(knob.special)}));
    check(value >= knob.low && value <= knob.high, Failure::usage, "knob '", name, "' of '", owner,
          "' takes ", range, ", not ", text);
    target = value;
}

std::string KnobSettings::format(const Knob& knob) const {
    if (is_special(knob)) return std::string(knob.special);
    return knob.names().empty() ? format_value(number(knob)) : std::string(choice_name(knob));
}

std::string nearest_name(std::string_view word, std::span<const std::string> names) {
    if (word.size() > kMaxWordLength) return {};
    std::size_t best = std::max<std::size_t>(2, word.size() / 2) + 1;
    std::string nearest;
    for (const std::string& name : names.first(std::min(names.size(), kMaxSearchedNames))) {
        // The difference in length is a lower bound of the distance.
        if (name.size() >= word.size() + best) continue;
        const std::size_t distance = edit_distance(word, name);
        if (distance < best) best = distance, nearest = name;
    }
    return nearest;
}

std::string suggest_name(std::string_view word, std::span<const std::string> names) {
    const std::string nearest = nearest_name(word, names);
    return nearest.empty() ? "" : " (did you mean " + quote(nearest) + "?)";
}

std::string suggest_name_or_list(std::string_view word, std::span<const std::string> names) {
    std::string text = suggest_name(word, names);
    if (!text.empty()) return text;
    for (const std::string& name : names) text += (text.empty() ? "; there are " : ", ") + name;
    return text.empty() ? "; there is none" : text;
}

} // namespace catoptric
