#include "gpu/cache_file.hpp"

#include <cstdint>
#include <cstring>

namespace catoptric::gpu {

namespace {

/// Returns the 64-bit FNV-1a checksum. Drivers do not check cache data, so a truncated file must
/// not reach them.
std::uint64_t fnv1a(std::string_view data) {
    std::uint64_t sum = 0xcbf29ce484222325;
    for (const char byte : data) sum = (sum ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
    return sum;
}

} // namespace

std::string add_header(std::string_view signature, std::string_view data) {
    const std::uint64_t sum = fnv1a(data);
    std::string file(signature);
    file.append(reinterpret_cast<const char*>(&sum), sizeof sum);
    return file.append(data);
}

std::string strip_header(std::string_view signature, std::string_view file) {
    std::uint64_t sum = 0;
    const std::size_t head = signature.size() + sizeof sum;
    if (file.size() < head || !file.starts_with(signature)) return {};
    std::memcpy(&sum, file.data() + signature.size(), sizeof sum);
    const std::string_view data = file.substr(head);
    return fnv1a(data) == sum ? std::string(data) : std::string();
}

} // namespace catoptric::gpu
