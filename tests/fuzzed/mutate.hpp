#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

/// Random changes of files. Each change depends only on the state of the random generator.
namespace test::fuzzed {

using Json = nlohmann::json;
using Random = std::mt19937_64; // generator with standardised numbers

/// Returns a number from 0 to `count` - 1.
std::size_t random_number_below(Random& random, std::size_t count);

/// Returns the bytes with one to four changes anywhere: flipped bits, replaced bytes, parts removed
/// or repeated, or the end cut off.
std::string change_random_bytes(std::string bytes, Random& random);

/// Returns the document with one to three changes of its structure. Members are removed, doubled,
/// renamed, or replaced by other members, values of other kinds or extreme numbers. The result is
/// valid JSON.
Json change_json_document(Json document, Random& random);

/// Returns the text with one to four changes. Lines are removed, doubled or moved. Words are
/// replaced by extreme numbers or by other words of the file.
std::string change_text_lines(const std::string& text, Random& random);

/// Returns a PNG file with one or two chunks changed: their fields, data, order or count. Lengths
/// and checksums of the chunks are correct again.
std::string change_png_file(const std::string& png, Random& random);

/// Returns an OpenEXR file with the values of one or two header attributes changed. Sizes stay the
/// same.
std::string change_exr_file(const std::string& exr, Random& random);

/// Returns a .glb file with its JSON or its binary chunk changed. Lengths are correct again.
std::string change_glb_file(const std::string& glb, Random& random);

/// Returns a .glb file made of a document and the bytes of its buffer.
std::string make_glb_file(const Json& document, const std::string& bytes);

} // namespace test::fuzzed
