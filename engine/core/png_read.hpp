#pragma once

#include "core/byte_source.hpp"
#include "core/image_codec.hpp"
#include "core/image_module.hpp"

#include <memory>
#include <string>

namespace catoptric {

/// Reads a PNG file with libpng, row by row. Palettes become colours, transparent colours an alpha
/// channel, and values of 1, 2 and 4 bits 8 bits. Gamma and colour profiles are ignored.
class PngReader {
public:
    /// Reads the header. Throws `bad_data` if `bytes` is not a PNG file; the message begins with
    /// `name`. `bytes` must outlive the reader.
    PngReader(const ByteSource& bytes, const std::string& name);
    ~PngReader();

    ImageShape shape() const;
    /// Throws `bad_data` if the picture claims more than its file can hold: deflate expands one
    /// byte to at most 1032.
    void check_size() const;
    /// Fills `values`, floats in [0,1] or bytes, with the rows from `first` on. Each call must
    /// continue where the last one ended. An interlaced picture is held in memory as a whole.
    /// Throws `bad_data`.
    void read_rows(std::uint32_t first, std::uint32_t row_count, PixelType type, void* values);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace catoptric
