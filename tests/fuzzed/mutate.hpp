#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

/// Random changes of files, each a function of the generator's state alone.
namespace test::fuzzed {

using Json = nlohmann::json;
using Random = std::mt19937_64; // whose numbers the standard fixes, unlike distributions

/// Returns a number from 0 to `count` - 1.
std::size_t below(Random& random, std::size_t count);

/// Returns the bytes with one to four changes anywhere: bits turned, bytes replaced, parts cut out,
/// doubled or moved, the end cut off.
std::string changed_bytes(std::string bytes, Random& random);

/// Returns the document with one to three changes of its structure: members removed, doubled,
/// renamed, put in another's place, or replaced by values of other kinds and extreme numbers. The
/// result is JSON.
Json changed_json(Json document, Random& random);

/// Returns text with one to four changes of lines and of the words in them: lines removed, doubled,
/// moved; numbers replaced by extreme ones; words by other words of the file.
std::string changed_lines(const std::string& text, Random& random);

/// Returns a PNG with one or two chunks changed: fields and data, order and count. Lengths and
/// checksums of the chunks are right again.
std::string changed_png(const std::string& png, Random& random);

/// Returns an OpenEXR file with the values of one or two header attributes changed, their sizes
/// kept.
std::string changed_exr(const std::string& exr, Random& random);

/// Returns a .glb with its JSON or its binary chunk changed; lengths are right again.
std::string changed_glb(const std::string& glb, Random& random);

/// Returns a .glb of a document and the bytes of its buffer.
std::string glb_of(const Json& document, const std::string& bytes);

} // namespace test::fuzzed
