#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

namespace catoptric {

/// A source of bytes that are read piece by piece, so that a picture's header can be checked before
/// the rest is in memory.
class ByteSource {
public:
    ByteSource() = default;
    ByteSource(const ByteSource&) = delete;
    ByteSource& operator=(const ByteSource&) = delete;
    virtual ~ByteSource() = default;

    virtual std::uint64_t size() const = 0;
    /// Fills `into` with the bytes from `offset` on. Returns the number of bytes read, which is
    /// smaller only at the end. Throws `io` if reading fails. May be called from any thread.
    virtual std::size_t read(std::uint64_t offset, std::span<char> into) const = 0;
};

/// A source of bytes in memory. The memory must outlive it.
class MemorySource final : public ByteSource {
public:
    explicit MemorySource(std::string_view bytes) : bytes_(bytes) {}
    std::uint64_t size() const override { return bytes_.size(); }
    std::size_t read(std::uint64_t offset, std::span<char> into) const override;

private:
    std::string_view bytes_;
};

/// Opens a file without reading it. A pipe or a device cannot be read at an offset, so its bytes
/// are read into memory. Throws `missing_input` if the file does not exist or cannot be opened.
std::unique_ptr<ByteSource> open_source(const std::filesystem::path& path);

} // namespace catoptric
