#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace catoptric {

/// One adjustable number or choice of a technique. Parsing, help, options such as `compare --axis`,
/// and tests at extreme values follow from this description.
struct Knob {
    std::string_view name;
    std::string_view help;
    double low = 0;
    double high = 1;
    double value = 0; ///< default; for a choice, the index into `choices`
    std::span<const std::string_view> choices = {}; ///< names, if the knob is a choice
    /// Lists the choices instead, if they follow from a table; null: they are `choices`.
    std::span<const std::string_view> (*find_choices)() = nullptr;
    std::string_view special =
        {};               ///< a word allowed instead of a number, such as "auto"; empty: none
    bool is_real = false; ///< a real number; otherwise an integer

    std::span<const std::string_view> names() const {
        return find_choices ? find_choices() : choices;
    }
};

/// A value for each of a technique's knobs.
class KnobSettings {
public:
    explicit KnobSettings(std::span<const Knob> knobs);

    /// Returns the knob's number, or the index of its choice. Throws `internal` if there is no such
    /// knob, or if its special word is set.
    double number(const Knob& knob) const;
    int integer(const Knob& knob) const { return static_cast<int>(number(knob)); }
    /// Returns the knob's choice as a value of an enumeration, which names the choices in order.
    template <typename Enum>
    Enum get(const Knob& knob) const {
        return static_cast<Enum>(integer(knob));
    }
    std::string_view choice_name(const Knob& knob) const;
    /// Returns whether the knob's special word is set instead of a number.
    bool is_special(const Knob& knob) const;
    /// Another knob of the same name, with other choices or another special word, does not count.
    bool has(const Knob& knob) const;

    /// Throws `Failure::usage`, naming the nearest knob or the range.
    void set(std::string_view owner, std::string_view knob, std::string_view text);
    std::span<const Knob> knobs() const { return knobs_; }
    /// Returns the value as the user would type it.
    std::string format(const Knob& knob) const;

    friend bool operator==(const KnobSettings& a, const KnobSettings& b) {
        return a.values_ == b.values_;
    }

private:
    std::size_t value_index(const Knob& knob) const;
    std::span<const Knob> knobs_;
    std::vector<std::optional<double>> values_; ///< no value: the special word
};

/// Returns the name with the smallest edit distance to `word`. Returns an empty string if no name
/// is near: the distance must be at most half the word's length, or 2 if that is greater. A word of
/// more than 64 bytes is near no name. Only the first 10,000 names are compared, which takes some
/// 50 ms at most.
std::string nearest_name(std::string_view word, std::span<const std::string> names);

/// Returns the end of a message about an unknown name: " (did you mean 'x'?)", or an empty string.
std::string suggest_name(std::string_view word, std::span<const std::string> names);
/// Returns the same, or "; there are a, b, c" with all names if no name is near.
std::string suggest_name_or_list(std::string_view word, std::span<const std::string> names);

} // namespace catoptric
