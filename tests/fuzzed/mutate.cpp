#include "fuzzed/mutate.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <sstream>

namespace test::fuzzed {

namespace {

/// Numbers at the limits of common number formats.
const std::array<const char*, 22> kExtremes{
    "0",     "-0",         "1",           "-1",         "2",          "255",
    "256",   "65535",      "65536",       "2147483647", "2147483648", "4294967295",
    "1e308", "-1e308",     "1e-308",      "1e38",       "-1e39",      "9007199254740993",
    "0.5",   "4294967296", "-2147483648", "1000000000"};

template <typename List>
const auto& one_of(const List& list, Random& random) {
    return list[below(random, list.size())];
}

/// Appends pointers to all values of a document to `all`, the document itself first.
void collect(Json& value, std::vector<Json*>& all) {
    all.push_back(&value);
    if (!value.is_structured()) return;
    for (Json& member : value) collect(member, all);
}

Json other_value(Random& random, const std::vector<Json*>& all) {
    switch (below(random, 8)) {
    case 0: return nullptr;
    case 1: return Json::array();
    case 2: return Json::object();
    case 3: return std::string(below(random, 3) == 0 ? 5000 : 5, 'x');
    case 4: return below(random, 2) == 0;
    case 5: return *all[below(random, all.size())];
    default: return Json::parse(one_of(kExtremes, random));
    }
}

void change(Json& document, Random& random) {
    std::vector<Json*> all;
    collect(document, all);
    Json& value = *all[below(random, all.size())];
    const std::size_t what = below(random, 6);
    if (value.is_object() && !value.empty() && what < 4) {
        auto member = value.begin();
        std::advance(member, static_cast<std::ptrdiff_t>(below(random, value.size())));
        const std::string name = member.key();
        if (what == 0) {
            value.erase(name);
        } else if (what == 1) {
            const Json moved = *member;
            value.erase(name);
            value[name + "x"] = moved;
        } else {
            Json other = other_value(random, all);
            value[name] = std::move(other);
        }
    } else if (value.is_array() && !value.empty() && what < 4) {
        const std::size_t at = below(random, value.size());
        if (what == 0) {
            value.erase(at);
        } else if (what == 1) {
            const Json doubled = value[at];
            value.push_back(doubled);
        } else {
            Json other = other_value(random, all);
            value[at] = std::move(other);
        }
    } else if (value.is_number() && what < 4) {
        value = Json::parse(one_of(kExtremes, random));
    } else {
        Json other = other_value(random, all);
        value = std::move(other);
    }
}

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value = value << 8 | static_cast<std::uint8_t>(bytes[at + i]);
    return value;
}

std::string big_endian(std::uint32_t value) {
    return {static_cast<char>(value >> 24), static_cast<char>(value >> 16),
            static_cast<char>(value >> 8), static_cast<char>(value)};
}

std::uint32_t little_endian(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
}

std::string little_endian(std::uint32_t value) {
    std::string bytes(4, '\0');
    std::memcpy(bytes.data(), &value, 4);
    return bytes;
}

struct Chunk {
    std::string type, data;
};

constexpr std::size_t kPngSignature = 8, kChunkFrame = 12; // bytes of length, type and checksum

std::vector<Chunk> chunks_of(const std::string& png) {
    std::vector<Chunk> chunks;
    for (std::size_t at = kPngSignature; at + kChunkFrame <= png.size();) {
        const std::uint32_t length = big_endian(png, at);
        chunks.push_back({png.substr(at + 4, 4), png.substr(at + 8, length)});
        at += kChunkFrame + length;
    }
    return chunks;
}

std::string png_of(const std::string& signature, const std::vector<Chunk>& chunks) {
    std::string png = signature;
    for (const Chunk& chunk : chunks) {
        const std::string body = chunk.type + chunk.data;
        const auto sum = static_cast<std::uint32_t>(::crc32(
            0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size())));
        png += big_endian(static_cast<std::uint32_t>(chunk.data.size())) + body + big_endian(sum);
    }
    return png;
}

/// Replaces four bytes by an extreme number, or one byte by a random value.
void put_extreme(std::string& bytes, Random& random, bool is_big_endian) {
    constexpr std::array<std::uint32_t, 9> kFields{
        0, 1, 0xff, 0xffff, 0x10000, 0x7fffffff, 0x80000000, 0xffffffff, 0x4000};
    if (bytes.size() >= 4 && below(random, 2) == 0) {
        const std::uint32_t value = one_of(kFields, random);
        bytes.replace(below(random, bytes.size() - 3), 4,
                      is_big_endian ? big_endian(value) : little_endian(value));
    } else if (!bytes.empty()) {
        bytes[below(random, bytes.size())] = static_cast<char>(random());
    }
}

} // namespace

std::size_t below(Random& random, std::size_t count) { return count == 0 ? 0 : random() % count; }

std::string changed_bytes(std::string bytes, Random& random) {
    for (std::size_t k = 0, count = 1 + below(random, 4); k < count && !bytes.empty(); ++k) {
        const std::size_t at = below(random, bytes.size());
        const std::size_t length = 1 + below(random, std::min<std::size_t>(64, bytes.size() - at));
        switch (below(random, 6)) {
        case 0: bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(random, 8))); break;
        case 1: bytes[at] = static_cast<char>(random()); break;
        case 2: bytes.erase(at, length); break;
        case 3: bytes.insert(at, bytes.substr(at, length)); break;
        case 4:
            bytes.replace(at, length, std::string(length, below(random, 2) ? '\xff' : '\0'));
            break;
        default: bytes.resize(at); break;
        }
    }
    return bytes;
}

Json changed_json(Json document, Random& random) {
    for (std::size_t k = 0, count = 1 + below(random, 3); k < count; ++k) change(document, random);
    return document;
}

std::string changed_lines(const std::string& text, Random& random) {
    std::vector<std::string> lines, words;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
        std::istringstream in_line(line);
        for (std::string word; in_line >> word;) words.push_back(word);
        lines.push_back(std::move(line));
    }
    for (std::size_t k = 0, count = 1 + below(random, 4); k < count && !lines.empty(); ++k) {
        const std::size_t at = below(random, lines.size());
        std::string& line = lines[at];
        const std::size_t blank = line.find(' ', below(random, line.size() + 1));
        const std::size_t begin = blank == std::string::npos ? line.size() : blank + 1;
        const std::size_t end = std::min(line.find(' ', begin), line.size());
        switch (below(random, 6)) {
        case 0: lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at)); break;
        case 1:
            lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), std::string(line));
            break;
        case 2: std::swap(line, lines[below(random, lines.size())]); break;
        case 3: line.replace(begin, end - begin, one_of(words, random)); break;
        default: line.replace(begin, end - begin, one_of(kExtremes, random)); break;
        }
    }
    std::string changed;
    for (const std::string& line : lines) changed += line + "\n";
    return changed;
}

std::string changed_png(const std::string& png, Random& random) {
    std::vector<Chunk> chunks = chunks_of(png);
    for (std::size_t k = 0, count = 1 + below(random, 2); k < count; ++k) {
        const std::size_t at = below(random, chunks.size());
        switch (below(random, 6)) {
        case 0:
            chunks.insert(chunks.begin() + static_cast<std::ptrdiff_t>(at), Chunk(chunks[at]));
            break;
        case 1: std::swap(chunks[at], chunks[below(random, chunks.size())]); break;
        case 2: chunks[at].data.resize(below(random, chunks[at].data.size() + 1)); break;
        default: put_extreme(chunks[at].data, random, true); break;
        }
    }
    return png_of(png.substr(0, kPngSignature), chunks);
}

std::string changed_exr(const std::string& exr, Random& random) {
    struct Range {
        std::size_t begin, size;
    };
    std::vector<Range>
        values; // of attributes: name, type, size, value; an empty name ends the list
    for (std::size_t at = 8; at < exr.size() && exr[at] != '\0';) {
        at = exr.find('\0', exr.find('\0', at) + 1) + 1;
        const std::uint32_t size = little_endian(exr, at);
        values.push_back({at + 4, size});
        at += 4 + size;
    }
    std::string changed = exr;
    for (std::size_t k = 0, count = 1 + below(random, 2); k < count; ++k) {
        const Range& range = one_of(values, random);
        std::string value = changed.substr(range.begin, range.size);
        put_extreme(value, random, false);
        changed.replace(range.begin, range.size, value);
    }
    return changed;
}

std::string glb_of(const Json& document, const std::string& bytes) {
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string binary = bytes;
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    const auto chunk = [](const std::string& data, const char* type) {
        return little_endian(static_cast<std::uint32_t>(data.size())) + std::string(type, 4) + data;
    };
    const std::string chunks = chunk(text, "JSON") + chunk(binary, "BIN\0");
    return "glTF" + little_endian(2) +
           little_endian(static_cast<std::uint32_t>(12 + chunks.size())) + chunks;
}

std::string changed_glb(const std::string& glb, Random& random) {
    const std::size_t length = little_endian(glb, 12);
    Json document = Json::parse(glb.substr(20, length));
    std::string bytes = glb.substr(28 + length);
    if (below(random, 4) == 0)
        bytes = changed_bytes(std::move(bytes), random);
    else
        document = changed_json(std::move(document), random);
    return glb_of(document, bytes);
}

} // namespace test::fuzzed
