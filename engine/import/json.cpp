#include "import/json.hpp"

#include "core/json.hpp"
#include "core/text.hpp"

#include <cmath>

namespace catoptric::scene::gltf {

Json parse_json(const std::string& file, std::string_view text, LoadAccount& account) {
    account.json_bytes.add(text.size(), file);
    return catoptric::parse_json<Json>(
        file, text, [&](std::uint64_t bytes) { account.json_memory.add(bytes, file); });
}

std::string describe(const Json& value) {
    if (value.is_array()) return "an array";
    if (value.is_object()) return "an object";
    if (!value.is_string()) return value.dump();
    std::string text = quote(value.get_ref<const std::string&>());
    text[0] = '"';
    text[text.rfind('\'')] = '"';
    return text;
}

std::string JsonObject::path(std::string_view before, std::size_t steps) const {
    std::string text;
    for (std::size_t i = 0; i < steps; ++i) {
        const auto& [key, index, json] = way_[i];
        text += i == 0 ? before : std::string_view(": ");
        const auto name = json->find("name"); // `end` for values that are not objects
        const bool is_named = name != json->end() && name->is_string();
        text += index ? item_label(key, *index, is_named ? name->get<std::string>() : "") : key;
    }
    return text;
}

std::string JsonObject::entry() const {
    std::size_t steps = steps_;
    while (steps > 0 && !way_[steps - 1].index) --steps;
    return path("", steps);
}

JsonObject JsonObject::to(const PathStep& step) const {
    if (steps_ == kMaxPathSteps)
        fail(Failure::internal, place(), ": ", step.key, ": lies too deep");
    JsonObject item = *this;
    item.way_[item.steps_++] = step;
    item.json_ = step.json;
    return item;
}

const Json* JsonObject::find(std::string_view key) const {
    const auto at = json_->find(key);
    return at == json_->end() ? nullptr : &*at;
}

std::optional<JsonObject> JsonObject::object(std::string_view key) const {
    const Json* value = find(key);
    if (value == nullptr) return std::nullopt;
    require(value->is_object(), key, ": wanted an object, found ", describe(*value));
    return to({key, std::nullopt, value});
}

std::optional<JsonObject> JsonObject::extension(std::string_view name) const {
    const std::optional<JsonObject> extensions = object("extensions");
    return extensions ? extensions->object(name) : std::nullopt;
}

const Json* JsonObject::list(std::string_view key) const {
    const Json* value = find(key);
    if (value != nullptr)
        require(value->is_array(), key, ": wanted an array, found ", describe(*value));
    return value;
}

std::size_t JsonObject::size(std::string_view key) const {
    const Json* value = list(key);
    return value == nullptr ? 0 : value->size();
}

JsonObject JsonObject::at(std::string_view key, std::size_t index) const {
    const Json& value = (*list(key))[index];
    const JsonObject item = to({key, index, &value});
    if (!value.is_object())
        fail(Failure::bad_data, item.place(), ": wanted an object, found ", describe(value));
    return item;
}

std::uint64_t JsonObject::to_whole(const Json& value, std::string_view key) const {
    constexpr double kMaxExactInteger =
        9007199254740992; // 2^53: doubles hold every integer up to it
    const double number = value.is_number_float() ? value.get<double>() : -1;
    if (number >= 0 && number <= kMaxExactInteger && number == std::floor(number))
        return static_cast<std::uint64_t>(number);
    require(value.is_number_unsigned(), key, ": wanted a whole number of at least 0, found ",
            describe(value));
    return value.get<std::uint64_t>();
}

std::size_t JsonObject::to_index(const Json& value, std::string_view key, std::size_t count) const {
    const std::uint64_t index = to_whole(value, key);
    require(index < count, key, ": wanted an index below ", count, ", found ", index);
    return index;
}

std::optional<std::size_t> JsonObject::index(std::string_view key, std::size_t count) const {
    const Json* value = find(key);
    return value == nullptr ? std::nullopt : std::optional(to_index(*value, key, count));
}

std::size_t JsonObject::needed_index(std::string_view key, std::size_t count) const {
    const std::optional<std::size_t> given = index(key, count);
    require(given.has_value(), key, ": wanted an index, found none");
    return *given;
}

std::vector<std::size_t> JsonObject::indices(std::string_view key, std::size_t count) const {
    std::vector<std::size_t> indices;
    if (const Json* values = list(key))
        for (const Json& value : *values) indices.push_back(to_index(value, key, count));
    return indices;
}

std::uint64_t JsonObject::whole(std::string_view key, std::uint64_t otherwise) const {
    const Json* value = find(key);
    return value == nullptr ? otherwise : to_whole(*value, key);
}

double JsonObject::number(std::string_view key, double otherwise) const {
    const Json* value = find(key);
    if (value == nullptr) return otherwise;
    require(value->is_number(), key, ": wanted a number, found ", describe(*value));
    return value->get<double>();
}

bool JsonObject::flag(std::string_view key, bool otherwise) const {
    const Json* value = find(key);
    if (value == nullptr) return otherwise;
    require(value->is_boolean(), key, ": wanted true or false, found ", describe(*value));
    return value->get<bool>();
}

std::string JsonObject::text(std::string_view key, std::string_view otherwise) const {
    const Json* value = find(key);
    if (value == nullptr) return std::string(otherwise);
    require(value->is_string(), key, ": wanted a text, found ", describe(*value));
    return value->get<std::string>();
}

std::vector<double> JsonObject::numbers(std::string_view key, std::size_t count) const {
    std::vector<double> numbers;
    const Json* values = list(key);
    if (values == nullptr) return numbers;
    require(values->size() == count, key, ": wanted ", count, " numbers, found ", values->size());
    for (const Json& value : *values) {
        require(value.is_number(), key, ": wanted numbers, found ", describe(value));
        numbers.push_back(value.get<double>());
    }
    return numbers;
}

std::optional<JsonObject> find_extras(const JsonObject& item) {
    const Json* extras = item.find("extras");
    if (extras == nullptr || !extras->is_object()) return std::nullopt;
    return item.object("extras")->object("catoptric");
}

} // namespace catoptric::scene::gltf
