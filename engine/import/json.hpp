#pragma once

#include "core/error.hpp"
#include "import/budget.hpp"
#include "scene/unsupported_feature.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

/// Reads glTF's JSON and checks every value, because files are not trusted.
namespace catoptric::scene::gltf {

using Json = nlohmann::json;

/// Parses JSON. Throws `bad_data` naming `file` for invalid JSON, for values nested 64 deep or
/// more, or for text over the budget.
Json parse_json(const std::string& file, std::string_view text, LoadAccount& account);

/// Returns a short description of a value for messages: `"text"`, `3.5`, `an array`.
std::string describe(const Json& value);

/// An object of the document and the path to it. An absent member gives a default. A member of the
/// wrong type throws `bad_data` with its place, the expected type and the value found. Valid while
/// the document and the file's name exist.
class JsonObject {
public:
    JsonObject(const Json& document, const std::string& file) : json_(&document), file_(&file) {}

    /// Returns the object's place for messages: "FILE: nodes[3] 'lamp': mesh".
    std::string place() const { return *file_ + path(": ", steps_); }
    /// Returns the place without the file: "nodes[3] 'lamp': mesh".
    std::string path() const { return path("", steps_); }
    /// Returns the label up to its last list element: "nodes[3] 'lamp'".
    std::string entry() const;
    template <typename... Parts>
    void require(bool ok, const Parts&... parts) const {
        if (!ok) fail(Failure::bad_data, place(), ": ", parts...);
    }

    bool has(std::string_view key) const { return find(key) != nullptr; }
    /// Returns the member `key`, or null if it is absent.
    const Json* find(std::string_view key) const;
    const Json& json() const { return *json_; }

    std::optional<JsonObject> object(std::string_view key) const;
    /// Returns the member `name` of the member "extensions", or none if either is absent.
    std::optional<JsonObject> extension(std::string_view name) const;
    /// Returns the number of objects in the list `key`, 0 if it is absent.
    std::size_t size(std::string_view key) const;
    /// Returns one object of the list `key`, which must exist and be longer than `index`.
    JsonObject at(std::string_view key, std::size_t index) const;
    /// Calls `body` with each object of the list.
    template <typename Body>
    void each(std::string_view key, Body&& body) const {
        for (std::size_t i = 0, count = size(key); i < count; ++i) body(at(key, i));
    }
    /// Returns this object's index in the list that holds it, or 0 if no list does.
    std::size_t index_in_list() const { return way_[steps_ - 1].index.value_or(0); }

    /// Returns an integer from 0 to `count` - 1, or none if it is absent.
    std::optional<std::size_t> index(std::string_view key, std::size_t count) const;
    /// The same, but throws `bad_data` if it is absent.
    std::size_t needed_index(std::string_view key, std::size_t count) const;
    /// Returns a list of integers from 0 to `count` - 1, empty if it is absent.
    std::vector<std::size_t> indices(std::string_view key, std::size_t count) const;
    /// Returns an integer of at least 0, or `otherwise` if it is absent. Accepts 3.0.
    std::uint64_t whole(std::string_view key, std::uint64_t otherwise) const;
    double number(std::string_view key, double otherwise) const;
    bool flag(std::string_view key, bool otherwise) const;
    std::string text(std::string_view key, std::string_view otherwise = {}) const;
    std::string name() const { return text("name"); }
    /// Returns exactly `count` numbers, or an empty list if the member is absent.
    std::vector<double> numbers(std::string_view key, std::size_t count) const;

private:
    /// One step of the path: the member `key` or, with an index, one element of the list `key`.
    struct PathStep {
        std::string_view key;
        std::optional<std::size_t> index;
        const Json* json = nullptr; ///< the value that the step leads to
    };
    static constexpr std::size_t kMaxPathSteps = 8; // nested extensions need no more steps

    JsonObject to(const PathStep& step) const;
    std::string path(std::string_view before, std::size_t steps) const;
    std::uint64_t to_whole(const Json& value, std::string_view key) const;
    std::size_t to_index(const Json& value, std::string_view key, std::size_t count) const;
    const Json* list(std::string_view key) const;

    const Json* json_;
    const std::string* file_;
    std::array<PathStep, kMaxPathSteps> way_{};
    std::size_t steps_ = 0; ///< 0 for the document itself
};

/// Returns the object "catoptric" of an object's `extras`, if any. `extras` may be of any type.
std::optional<JsonObject> find_extras(const JsonObject& item);

} // namespace catoptric::scene::gltf
