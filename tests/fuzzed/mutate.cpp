#include "fuzzed/mutate.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <sstream>

namespace test::fuzzed {

namespace {

/// Numbers at the limits of common number formats.
const std::array<const char*, 22> kExtremeNumberTexts{
    "0",     "-0",         "1",           "-1",         "2",          "255",
    "256",   "65535",      "65536",       "2147483647", "2147483648", "4294967295",
    "1e308", "-1e308",     "1e-308",      "1e38",       "-1e39",      "9007199254740993",
    "0.5",   "4294967296", "-2147483648", "1000000000"};

template <typename List>
const auto& choose_one_of(const List& list, Random& random) {
    return list[random_number_below(random, list.size())];
}

/// Appends pointers to all values of a document to `all`, the document itself first.
void collect_json_values(Json& value, std::vector<Json*>& all) {
    all.push_back(&value);
    if (!value.is_structured()) return;
    for (Json& member : value) collect_json_values(member, all);
}

Json choose_other_json_value(Random& random, const std::vector<Json*>& all) {
    switch (random_number_below(random, 8)) {
    case 0: return nullptr;
    case 1: return Json::array();
    case 2: return Json::object();
    case 3: return std::string(random_number_below(random, 3) == 0 ? 5000 : 5, 'x');
    case 4: return random_number_below(random, 2) == 0;
    case 5: return *all[random_number_below(random, all.size())];
    default: return Json::parse(choose_one_of(kExtremeNumberTexts, random));
    }
}

void change_json_once(Json& document, Random& random) {
    std::vector<Json*> all;
    collect_json_values(document, all);
    Json& value = *all[random_number_below(random, all.size())];
    const std::size_t what = random_number_below(random, 6);
    if (value.is_object() && !value.empty() && what < 4) {
        auto member = value.begin();
        std::advance(member,
                     static_cast<std::ptrdiff_t>(random_number_below(random, value.size())));
        const std::string name = member.key();
        if (what == 0) {
            value.erase(name);
        } else if (what == 1) {
            const Json moved = *member;
            value.erase(name);
            value[name + "x"] = moved;
        } else {
            Json other = choose_other_json_value(random, all);
            value[name] = std::move(other);
        }
    } else if (value.is_array() && !value.empty() && what < 4) {
        const std::size_t at = random_number_below(random, value.size());
        if (what == 0) {
            value.erase(at);
        } else if (what == 1) {
            const Json doubled = value[at];
            value.push_back(doubled);
        } else {
            Json other = choose_other_json_value(random, all);
            value[at] = std::move(other);
        }
    } else if (value.is_number() && what < 4) {
        value = Json::parse(choose_one_of(kExtremeNumberTexts, random));
    } else {
        Json other = choose_other_json_value(random, all);
        value = std::move(other);
    }
}

std::uint32_t big_endian_number(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value = value << 8 | static_cast<std::uint8_t>(bytes[at + i]);
    return value;
}

std::string big_endian_number(std::uint32_t value) {
    return {static_cast<char>(value >> 24), static_cast<char>(value >> 16),
            static_cast<char>(value >> 8), static_cast<char>(value)};
}

std::uint32_t little_endian_number(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
}

std::string little_endian_number(std::uint32_t value) {
    std::string bytes(4, '\0');
    std::memcpy(bytes.data(), &value, 4);
    return bytes;
}

struct PngChunk {
    std::string type, data;
};

constexpr std::size_t kPngSignatureBytes = 8,
                      kPngChunkOverheadBytes = 12; // bytes of length, type and checksum

std::vector<PngChunk> split_png_chunks(const std::string& png) {
    std::vector<PngChunk> chunks;
    for (std::size_t at = kPngSignatureBytes; at + kPngChunkOverheadBytes <= png.size();) {
        const std::uint32_t length = big_endian_number(png, at);
        chunks.push_back({png.substr(at + 4, 4), png.substr(at + 8, length)});
        at += kPngChunkOverheadBytes + length;
    }
    return chunks;
}

std::string join_png_chunks(const std::string& signature, const std::vector<PngChunk>& chunks) {
    std::string png = signature;
    for (const PngChunk& chunk : chunks) {
        const std::string body = chunk.type + chunk.data;
        const auto sum = static_cast<std::uint32_t>(::crc32(
            0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size())));
        png += big_endian_number(static_cast<std::uint32_t>(chunk.data.size())) + body +
               big_endian_number(sum);
    }
    return png;
}

/// Replaces four bytes by an extreme number, or one byte by a random value.
void replace_by_extreme_number(std::string& bytes, Random& random, bool is_big_endian) {
    constexpr std::array<std::uint32_t, 9> kExtremeFieldValues{
        0, 1, 0xff, 0xffff, 0x10000, 0x7fffffff, 0x80000000, 0xffffffff, 0x4000};
    if (bytes.size() >= 4 && random_number_below(random, 2) == 0) {
        const std::uint32_t value = choose_one_of(kExtremeFieldValues, random);
        bytes.replace(random_number_below(random, bytes.size() - 3), 4,
                      is_big_endian ? big_endian_number(value) : little_endian_number(value));
    } else if (!bytes.empty()) {
        bytes[random_number_below(random, bytes.size())] = static_cast<char>(random());
    }
}

} // namespace

std::size_t random_number_below(Random& random, std::size_t count) {
    return count == 0 ? 0 : random() % count;
}

std::string change_random_bytes(std::string bytes, Random& random) {
    for (std::size_t k = 0, count = 1 + random_number_below(random, 4); k < count && !bytes.empty();
         ++k) {
        const std::size_t at = random_number_below(random, bytes.size());
        const std::size_t length = 1 + random_number_below(
                                           random, std::min<std::size_t>(64, bytes.size() - at));
        switch (random_number_below(random, 6)) {
        case 0:
            bytes[at] = static_cast<char>(bytes[at] ^ (1 << random_number_below(random, 8)));
            break;
        case 1: bytes[at] = static_cast<char>(random()); break;
        case 2: bytes.erase(at, length); break;
        case 3: bytes.insert(at, bytes.substr(at, length)); break;
        case 4:
            bytes.replace(at, length,
                          std::string(length, random_number_below(random, 2) ? '\xff' : '\0'));
            break;
        default: bytes.resize(at); break;
        }
    }
    return bytes;
}

Json change_json_document(Json document, Random& random) {
    for (std::size_t k = 0, count = 1 + random_number_below(random, 3); k < count; ++k)
        change_json_once(document, random);
    return document;
}

std::string change_text_lines(const std::string& text, Random& random) {
    std::vector<std::string> lines, words;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
        std::istringstream in_line(line);
        for (std::string word; in_line >> word;) words.push_back(word);
        lines.push_back(std::move(line));
    }
    for (std::size_t k = 0, count = 1 + random_number_below(random, 4); k < count && !lines.empty();
         ++k) {
        const std::size_t at = random_number_below(random, lines.size());
        std::string& line = lines[at];
        const std::size_t blank = line.find(' ', random_number_below(random, line.size() + 1));
        const std::size_t begin = blank == std::string::npos ? line.size() : blank + 1;
        const std::size_t end = std::min(line.find(' ', begin), line.size());
        switch (random_number_below(random, 6)) {
        case 0: lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at)); break;
        case 1:
            lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), std::string(line));
            break;
        case 2: std::swap(line, lines[random_number_below(random, lines.size())]); break;
        case 3: line.replace(begin, end - begin, choose_one_of(words, random)); break;
        default:
            line.replace(begin, end - begin, choose_one_of(kExtremeNumberTexts, random));
            break;
        }
    }
    std::string changed;
    for (const std::string& line : lines) changed += line + "\n";
    return changed;
}

std::string change_png_file(const std::string& png, Random& random) {
    std::vector<PngChunk> chunks = split_png_chunks(png);
    for (std::size_t k = 0, count = 1 + random_number_below(random, 2); k < count; ++k) {
        const std::size_t at = random_number_below(random, chunks.size());
        switch (random_number_below(random, 6)) {
        case 0:
            chunks.insert(chunks.begin() + static_cast<std::ptrdiff_t>(at), PngChunk(chunks[at]));
            break;
        case 1: std::swap(chunks[at], chunks[random_number_below(random, chunks.size())]); break;
        case 2:
            chunks[at].data.resize(random_number_below(random, chunks[at].data.size() + 1));
            break;
        default: replace_by_extreme_number(chunks[at].data, random, true); break;
        }
    }
    return join_png_chunks(png.substr(0, kPngSignatureBytes), chunks);
}

std::string change_exr_file(const std::string& exr, Random& random) {
    struct ByteRange {
        std::size_t begin, size;
    };
    std::vector<ByteRange>
        values; // of attributes: name, type, size, value; an empty name ends the list
    for (std::size_t at = 8; at < exr.size() && exr[at] != '\0';) {
        at = exr.find('\0', exr.find('\0', at) + 1) + 1;
        const std::uint32_t size = little_endian_number(exr, at);
        values.push_back({at + 4, size});
        at += 4 + size;
    }
    std::string changed = exr;
    for (std::size_t k = 0, count = 1 + random_number_below(random, 2); k < count; ++k) {
        const ByteRange& range = choose_one_of(values, random);
        std::string value = changed.substr(range.begin, range.size);
        replace_by_extreme_number(value, random, false);
        changed.replace(range.begin, range.size, value);
    }
    return changed;
}

std::string make_glb_file(const Json& document, const std::string& bytes) {
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string binary = bytes;
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    const auto chunk = [](const std::string& data, const char* type) {
        return little_endian_number(static_cast<std::uint32_t>(data.size())) +
               std::string(type, 4) + data;
    };
    const std::string chunks = chunk(text, "JSON") + chunk(binary, "BIN\0");
    return "glTF" + little_endian_number(2) +
           little_endian_number(static_cast<std::uint32_t>(12 + chunks.size())) + chunks;
}

std::string change_glb_file(const std::string& glb, Random& random) {
    const std::size_t length = little_endian_number(glb, 12);
    Json document = Json::parse(glb.substr(20, length));
    std::string bytes = glb.substr(28 + length);
    if (random_number_below(random, 4) == 0)
        bytes = change_random_bytes(std::move(bytes), random);
    else
        document = change_json_document(std::move(document), random);
    return make_glb_file(document, bytes);
}

} // namespace test::fuzzed
