#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

namespace catoptric {

/// Bytes that are read a piece at a time, so that a picture's header can be judged before the rest
/// is in memory.
class ByteSource {
public:
    ByteSource() = default;
    ByteSource(const ByteSource&) = delete;
    ByteSource& operator=(const ByteSource&) = delete;
    virtual ~ByteSource() = default;

    virtual std::uint64_t size() const = 0;
    /// Fills `into` with the bytes from `offset` on and returns how many these are: fewer only at
    /// the end. Throws `io` when reading fails. From any thread.
    virtual std::size_t read(std::uint64_t offset, std::span<char> into) const = 0;
};

/// Bytes that lie in memory for as long as this is used.
class MemoryBytes final : public ByteSource {
public:
    explicit MemoryBytes(std::string_view bytes) : bytes_(bytes) {}
    std::uint64_t size() const override { return bytes_.size(); }
    std::size_t read(std::uint64_t offset, std::span<char> into) const override;

private:
    std::string_view bytes_;
};

/// Opens a file without reading it. The bytes of a pipe or a device, which have no places, are read
/// into memory. Throws `missing_input` when it is not there or cannot be opened.
std::unique_ptr<ByteSource> open_bytes(const std::filesystem::path& path);

} // namespace catoptric
