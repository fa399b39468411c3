#pragma once

#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace catoptric {

/// One adjustable number or choice of a technique. Parsing, help, sweeps and the tests at extreme
/// values are all made from this row.
struct Knob {
    std::string_view name;
    std::string_view help;
    double low = 0;
    double high = 1;
    double value = 0; ///< default; for a choice the index into `choices`
    std::span<const std::string_view> choices = {}; ///< names, when the knob is a choice
    std::string_view special =
        {};               ///< a word allowed in place of the number, as "auto"; empty: none
    bool is_real = false; ///< else it is a whole number
};

/// A value for each of a technique's knobs.
class Settings {
public:
    explicit Settings(std::span<const Knob> knobs);

    /// The knob's number; a choice gives its index. A name that is no knob is `Failure::internal`,
    /// and so is a knob whose special word stands in place of a number.
    double number(std::string_view knob) const;
    int integer(std::string_view knob) const { return static_cast<int>(number(knob)); }
    std::string_view choice(std::string_view knob) const;
    /// The knob's special word stands in place of a number.
    bool is_special(std::string_view knob) const;
    bool has(std::string_view knob) const;

    /// Sets a knob from text. Throws `Failure::usage` naming the nearest knob or the range.
    void set(std::string_view owner, std::string_view knob, std::string_view text);
    /// Sets a knob that is known to be in range.
    void set(std::string_view knob, double value);

    std::span<const Knob> knobs() const { return knobs_; }
    /// The value as the user would type it.
    std::string text(std::string_view knob) const;

    friend bool operator==(const Settings& a, const Settings& b) { return a.values_ == b.values_; }

private:
    std::size_t index(std::string_view knob) const;
    std::span<const Knob> knobs_;
    std::vector<std::optional<double>> values_; ///< nothing: the special word
};

/// The name with the smallest edit distance to `word`, or empty when none is near (distance above
/// half the word's length, at least 2). A word of more than 64 bytes is near nothing, and of many
/// names only the first 10,000 are compared: some 50 ms at most.
std::string nearest_name(std::string_view word, std::span<const std::string> names);

/// " (did you mean 'x'?)" or nothing: the end of every message about an unknown name.
std::string did_you_mean(std::string_view word, std::span<const std::string> names);

} // namespace catoptric
