#pragma once

#include "core/math.hpp"
#include "scene/json.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace catoptric::scene::gltf {

/// glTF's numbers for component types.
enum class Component { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

/// Elements in a buffer. All of them lie in it.
struct Accessor {
    const char* first = nullptr; ///< null: the file says nothing of the values
    std::size_t stride = 0, count = 0;
    std::string_view type; ///< "SCALAR", "VEC3", ...
    Component component = Component::f32;
    bool sparse = false;
};

/// All accessors of a file, those that nobody asks for too: each must lie in its view, that in its
/// buffer, and have a type that there is.
class Accessors {
public:
    /// Throws `bad_data` naming the accessor or view. `buffers` must outlive this.
    Accessors(const Item& root, const std::vector<std::string_view>& buffers);

    std::size_t size() const { return list_.size(); }
    const Accessor& operator[](std::size_t index) const { return list_[index]; }

    /// The dense accessor `index` of floats: "SCALAR" or "VEC3". Throws `bad_data` for another.
    /// When it is first asked for, its elements are added to `total` and must be finite.
    const Accessor& floats(std::size_t index, std::string_view type, Total& total,
                           const std::string& place);
    /// The dense accessor `index` of whole numbers, "SCALAR" and unsigned.
    const Accessor& whole(std::size_t index, const std::string& place) const;

private:
    const Accessor& dense(std::size_t index, std::string_view type, const std::string& place) const;

    std::string file_;
    std::vector<Accessor> list_;
    std::vector<bool> known_; ///< to be finite
};

double scalar_at(const Accessor& accessor, std::size_t index);
dvec3 vector_at(const Accessor& accessor, std::size_t index);
std::uint32_t whole_at(const Accessor& accessor, std::size_t index);
/// The whole number that means "begin anew" among indices.
std::uint32_t restart_of(Component component);

} // namespace catoptric::scene::gltf
