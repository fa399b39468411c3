#pragma once

#include "core/error.hpp"
#include "scene/account.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

/// glTF's JSON, read with suspicion.
namespace catoptric::scene::gltf {

using Json = nlohmann::json;

/// Throws `bad_data` naming `file` for what is no JSON, nests 64 deep or more, or is over the
/// budget.
Json parse_json(const std::string& file, std::string_view text, Account& account);

/// What a value is, short enough for a message: `"text"`, `3.5`, `an array`.
std::string shown(const Json& value);

/// "nodes[3] 'lamp'", or without a name "nodes[3]".
std::string label_of(std::string_view list, std::size_t index, const std::string& name = {});

/// An object of the document and the way to it. What is absent has a default; what is there but of
/// the wrong kind throws `bad_data` with place, wanted and found. Valid as long as the
/// document and the file's name.
class Item {
public:
    Item(const Json& document, const std::string& file) : json_(&document), file_(&file) {}

    /// "FILE: nodes[3] 'lamp': mesh"; `label` is the same without the file, and `entry` ends with
    /// the last of a list: "nodes[3] 'lamp'".
    std::string place() const { return *file_ + label(": ", steps_); }
    std::string label() const { return label("", steps_); }
    std::string entry() const;
    template <typename... Parts>
    void require(bool ok, const Parts&... parts) const {
        if (!ok) fail(Failure::bad_data, place(), ": ", parts...);
    }

    bool has(std::string_view key) const { return find(key) != nullptr; }
    /// Null when there is none.
    const Json* find(std::string_view key) const;
    const Json& json() const { return *json_; }

    std::optional<Item> object(std::string_view key) const;
    /// Number of objects in the list `key`, and one of them.
    std::size_t size(std::string_view key) const;
    Item at(std::string_view key, std::size_t index) const;
    /// Calls `body` with each object of the list.
    template <typename Body>
    void each(std::string_view key, Body&& body) const {
        for (std::size_t i = 0, count = size(key); i < count; ++i) body(at(key, i));
    }
    std::size_t number_in_list() const { return way_[steps_ - 1].index.value_or(0); }

    /// A whole number below `count`.
    std::optional<std::size_t> index(std::string_view key, std::size_t count) const;
    std::size_t needed_index(std::string_view key, std::size_t count) const;
    std::vector<std::size_t> indices(std::string_view key, std::size_t count) const;
    std::uint64_t whole(std::string_view key, std::uint64_t otherwise) const;
    double number(std::string_view key, double otherwise) const;
    bool flag(std::string_view key, bool otherwise) const;
    std::string text(std::string_view key, std::string_view otherwise = {}) const;
    std::string name() const { return text("name"); }
    /// Exactly `count` numbers; empty when absent.
    std::vector<double> numbers(std::string_view key, std::size_t count) const;

private:
    /// Of the way: `key`, or with an index one of the list `key`.
    struct Step {
        std::string_view key;
        std::optional<std::size_t> index;
        const Json* json = nullptr; ///< what is there
    };
    static constexpr std::size_t kMostSteps = 8; // extensions within extensions lie no deeper

    Item to(const Step& step) const;
    std::string label(std::string_view before, std::size_t steps) const;
    std::uint64_t whole_of(const Json& value, std::string_view key) const;
    std::size_t index_of(const Json& value, std::string_view key, std::size_t count) const;
    const Json* list(std::string_view key) const;

    const Json* json_;
    const std::string* file_;
    std::array<Step, kMostSteps> way_{};
    std::size_t steps_ = 0; ///< 0: the document
};

} // namespace catoptric::scene::gltf
