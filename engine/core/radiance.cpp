#include "core/radiance.hpp"

#include "core/error.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace catoptric {

namespace {

/// Removes a word from the front of the line and returns it.
std::string_view take_word(std::string_view& line) {
    const std::size_t first = std::min(line.find_first_not_of(" \t\r"), line.size());
    line.remove_prefix(first);
    const std::string_view word = line.substr(0, line.find_first_of(" \t\r"));
    line.remove_prefix(word.size());
    return word;
}

template <typename Number>
std::optional<Number> parse_word(std::string_view word) {
    Number value{};
    const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
    return result.ec == std::errc() && result.ptr == word.data() + word.size()
               ? std::optional(value)
               : std::nullopt;
}

/// Reads the line of the picture's size, such as "-Y 512 +X 1024": the direction in which lines
/// follow each other and their number, then the direction and number of pixels in a line.
bool parse_size_line(std::string_view line, RadianceHeader& header) {
    std::string_view axes[2];
    for (int i = 0; i < 2; ++i) {
        axes[i] = take_word(line);
        const auto count = parse_word<std::uint32_t>(take_word(line));
        const bool is_axis = axes[i].size() == 2 && (axes[i][0] == '-' || axes[i][0] == '+') &&
                             (axes[i][1] == 'X' || axes[i][1] == 'Y');
        if (!is_axis || !count) return false;
        header.stored[1 - i] = *count;
        if (axes[i][1] == 'X') header.starts_right = axes[i][0] == '-';
        if (axes[i][1] == 'Y') header.starts_below = axes[i][0] == '+';
    }
    header.is_transposed = axes[0][1] == 'X';
    return axes[0][1] != axes[1][1] && take_word(line).empty();
}

/// Divides the factor by the numbers of EXPOSURE (one for all colours) or COLORCORR (three).
void divide_by(const std::string& name, std::string_view line, std::string_view key,
               RadianceHeader& header) {
    const std::string_view whole = line;
    line.remove_prefix(key.size());
    std::optional<double> number;
    for (std::size_t i = 0; i < 3; ++i) {
        if (i == 0 || key.starts_with("COLORCORR")) number = parse_word<double>(take_word(line));
        check(number && std::isfinite(*number) && *number > 0, Failure::bad_data, name,
              ": cannot be decoded: wanted numbers above 0, found ", quote(whole));
        header.factor[i] /= *number;
    }
}

void read_header_line(const std::string& name, std::string_view line, RadianceHeader& header) {
    for (const std::string_view key : {"EXPOSURE=", "COLORCORR="})
        if (line.starts_with(key)) divide_by(name, line, key, header);
    constexpr std::string_view kFormat = "FORMAT=";
    if (!line.starts_with(kFormat)) return;
    line.remove_prefix(kFormat.size());
    const std::string_view format = take_word(line);
    check(format == "32-bit_rle_rgbe", Failure::bad_data, name,
          ": wanted FORMAT=32-bit_rle_rgbe, found ", quote(format));
}

} // namespace

std::vector<float> RadianceHeader::turn(std::span<const float> stored_values) const {
    const uvec2 picture = size();
    std::vector<float> values(stored_values.size());
    for (std::uint32_t y = 0; y < picture.y; ++y)
        for (std::uint32_t x = 0; x < picture.x; ++x) {
            const std::uint32_t across = starts_right ? picture.x - 1 - x : x,
                                down = starts_below ? picture.y - 1 - y : y,
                                line = is_transposed ? across : down,
                                place = is_transposed ? down : across;
            const std::size_t from = 3 * (std::size_t(line) * stored.x + place);
            std::copy_n(stored_values.begin() + std::ptrdiff_t(from), 3,
                        values.begin() + std::ptrdiff_t(3 * (std::size_t(y) * picture.x + x)));
        }
    return values;
}

void RadianceHeader::scale(std::span<float> values) const {
    if (factor == std::array<double, 3>{1, 1, 1}) return;
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<float>(double{values[i]} * factor[i % 3]);
}

RadianceHeader read_radiance_header(const ByteSource& bytes, const std::string& name) {
    constexpr std::size_t kMaxHeaderBytes = 1 << 16;
    std::string text(std::min<std::uint64_t>(kMaxHeaderBytes, bytes.size()), '\0');
    text.resize(bytes.read(0, text));
    RadianceHeader header;
    std::string_view rest = text;
    bool is_size_next = false, has_size = false;
    while (!has_size) {
        const std::size_t end = rest.find('\n');
        check(end != rest.npos, Failure::bad_data, name,
              ": cannot be decoded: wanted a blank line and the picture's size within ",
              kMaxHeaderBytes, " bytes, found none");
        const std::string_view line = rest.substr(0, end);
        rest.remove_prefix(end + 1);
        if (is_size_next) {
            has_size = parse_size_line(line, header);
            check(has_size, Failure::bad_data, name,
                  ": cannot be decoded: wanted a size such as -Y 512 +X 1024, found ",
                  quote(line.substr(0, 80)));
        } else if (line.empty() || line == "\r") {
            is_size_next = true;
        } else {
            read_header_line(name, line, header);
        }
    }
    // Lines of 8 to 32767 pixels are stored as runs of at most 127 for each of 4 channels. Other
    // lines are stored without runs.
    const bool has_runs = header.stored.x >= 8 && header.stored.x < 1 << 15;
    const std::uint64_t line = has_runs ? 4 + 8 * std::uint64_t((header.stored.x + 126) / 127)
                                        : 4 * std::uint64_t(header.stored.x);
    const std::uint64_t least = text.size() - rest.size() + line * header.stored.y;
    check(least <= bytes.size(), Failure::bad_data, name, ": wanted at least ", least,
          " bytes for ", header.size().x, "x", header.size().y, " pixels, found ", bytes.size());
    return header;
}

} // namespace catoptric
