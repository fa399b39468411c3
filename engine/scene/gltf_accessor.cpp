#include "scene/gltf_accessor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

namespace catoptric::scene::gltf {

namespace {

struct Type {
    std::string_view name;
    std::size_t width; ///< components of an element
};
constexpr Type kTypes[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                           {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};

struct View {
    std::string_view bytes;
    std::size_t stride; ///< 0: tightly packed
};

std::size_t bytes_of(std::uint64_t component, const Item& item) {
    switch (static_cast<Component>(component)) {
    case Component::i8:
    case Component::u8: return 1;
    case Component::i16:
    case Component::u16: return 2;
    case Component::u32:
    case Component::f32: return 4;
    }
    item.require(false, "componentType: wanted 5120, 5121, 5122, 5123, 5125 or 5126, found ",
                 component);
    return 0;
}

std::vector<View> views_of(const Item& root, const std::vector<std::string_view>& buffers) {
    std::vector<View> views;
    root.each("bufferViews", [&](const Item& item) {
        const std::string_view buffer = buffers[item.needed_index("buffer", buffers.size())];
        const std::uint64_t offset = item.whole("byteOffset", 0),
                            length = item.whole("byteLength", 0);
        item.require(length >= 1 && offset <= buffer.size() && length <= buffer.size() - offset,
                     "wanted ", length, " bytes, at least 1, from ", offset,
                     " on, found a buffer of ", buffer.size());
        const std::uint64_t stride = item.whole("byteStride", 0);
        const bool is_legal = stride == 0 || (stride >= 4 && stride <= 252 && stride % 4 == 0);
        item.require(is_legal, "byteStride: wanted a multiple of 4 from 4 to 252, found ", stride);
        views.push_back({buffer.substr(offset, length), stride});
    });
    return views;
}

/// Where `count` elements of `size` bytes begin that lie in one of the views.
const char* elements(const Item& item, const std::vector<View>& views, std::uint64_t count,
                     std::size_t size, std::size_t& stride) {
    const View& view = views[item.needed_index("bufferView", views.size())];
    stride = view.stride == 0 ? size : view.stride;
    const std::uint64_t offset = item.whole("byteOffset", 0);
    const std::uint64_t room = view.bytes.size() -
                               std::min<std::uint64_t>(offset, view.bytes.size());
    const std::uint64_t fit = room < size || stride < size ? 0 : (room - size) / stride + 1;
    item.require(count >= 1 && count <= fit, "wanted ", count,
                 " elements, at least 1, found a buffer view that holds ", fit);
    return view.bytes.data() + offset;
}

/// Values that stand in place of some: they and their places lie in their views.
void check_sparse(const Item& accessor, const std::vector<View>& views, std::uint64_t count,
                  std::size_t element) {
    const std::optional<Item> sparse = accessor.object("sparse");
    if (!sparse) return;
    const std::uint64_t changed = sparse->whole("count", 0);
    sparse->require(changed >= 1 && changed <= count, "count: wanted 1 to ", count, ", found ",
                    changed);
    const std::optional<Item> indices = sparse->object("indices"),
                              values = sparse->object("values");
    sparse->require(indices && values, "wanted indices and values, found one of them or none");
    const std::uint64_t component = indices->whole("componentType", 0);
    std::size_t stride = 0;
    elements(*indices, views, changed, bytes_of(component, *indices), stride);
    elements(*values, views, changed, element, stride);
}

Accessor accessor_of(const Item& item, const std::vector<View>& views) {
    Accessor accessor;
    const std::string type = item.text("type");
    const auto* const known = std::ranges::find(kTypes, type, &Type::name);
    item.require(known != std::end(kTypes),
                 "type: wanted SCALAR, VEC2 .. VEC4 or MAT2 .. MAT4, found ",
                 item.has("type") ? shown(*item.find("type")) : "none");
    accessor.type = known->name;
    const std::uint64_t component = item.whole("componentType", 0);
    const std::size_t size = known->width * bytes_of(component, item);
    accessor.component = static_cast<Component>(component);
    accessor.count = item.whole("count", 0);
    item.require(accessor.count >= 1, "count: wanted at least 1, found ", accessor.count);
    accessor.sparse = item.has("sparse");
    if (item.has("bufferView"))
        accessor.first = elements(item, views, accessor.count, size, accessor.stride);
    check_sparse(item, views, accessor.count, size);
    return accessor;
}

/// glTF and every machine that we run on are little-endian.
template <typename Stored>
Stored stored_at(const char* bytes) {
    Stored value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

} // namespace

Accessors::Accessors(const Item& root, const std::vector<std::string_view>& buffers)
    : file_(root.place()) {
    const std::vector<View> views = views_of(root, buffers);
    root.each("accessors", [&](const Item& item) { list_.push_back(accessor_of(item, views)); });
    known_.resize(list_.size(), false);
}

const Accessor& Accessors::dense(std::size_t index, std::string_view type,
                                 const std::string& place) const {
    const Accessor& accessor = list_[index];
    check(accessor.first != nullptr && !accessor.sparse, Failure::bad_data, place,
          ": wanted an accessor with a buffer view and without sparse, found another");
    check(accessor.type == type, Failure::bad_data, place, ": wanted an accessor of ", type,
          ", found ", accessor.type);
    return accessor;
}

const Accessor& Accessors::floats(std::size_t index, std::string_view type, Total& total,
                                  const std::string& place) {
    const Accessor& accessor = dense(index, type, place);
    check(accessor.component == Component::f32, Failure::bad_data, place,
          ": wanted floats, found component type ", static_cast<int>(accessor.component));
    if (known_[index]) return accessor;
    total.add(accessor.count, place);
    const std::size_t width = type == "VEC3" ? 3 : 1;
    for (std::size_t i = 0; i < accessor.count; ++i)
        for (std::size_t k = 0; k < width; ++k)
            check(std::isfinite(stored_at<float>(accessor.first + i * accessor.stride + 4 * k)),
                  Failure::bad_data, place, ": element ", i,
                  ": wanted finite numbers, found NaN or infinity");
    known_[index] = true;
    return accessor;
}

const Accessor& Accessors::whole(std::size_t index, const std::string& place) const {
    const Accessor& accessor = dense(index, "SCALAR", place);
    const bool is_unsigned = accessor.component == Component::u8 ||
                             accessor.component == Component::u16 ||
                             accessor.component == Component::u32;
    check(is_unsigned, Failure::bad_data, place,
          ": wanted component type 5121, 5123 or 5125, found ",
          static_cast<int>(accessor.component));
    return accessor;
}

double scalar_at(const Accessor& accessor, std::size_t index) {
    return stored_at<float>(accessor.first + index * accessor.stride);
}

dvec3 vector_at(const Accessor& accessor, std::size_t index) {
    const auto [x, y,
                z] = stored_at<std::array<float, 3>>(accessor.first + index * accessor.stride);
    return {x, y, z};
}

std::uint32_t whole_at(const Accessor& accessor, std::size_t index) {
    const char* bytes = accessor.first + index * accessor.stride;
    switch (accessor.component) {
    case Component::u8: return stored_at<std::uint8_t>(bytes);
    case Component::u16: return stored_at<std::uint16_t>(bytes);
    default: return stored_at<std::uint32_t>(bytes);
    }
}

std::uint32_t restart_of(Component component) {
    switch (component) {
    case Component::u8: return std::numeric_limits<std::uint8_t>::max();
    case Component::u16: return std::numeric_limits<std::uint16_t>::max();
    default: return std::numeric_limits<std::uint32_t>::max();
    }
}

} // namespace catoptric::scene::gltf
