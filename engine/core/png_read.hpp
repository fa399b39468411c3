#pragma once

#include "core/byte_source.hpp"
#include "core/image_codec.hpp"
#include "core/image_module.hpp"

#include <memory>
#include <string>

namespace catoptric {

/// A PNG that libpng reads, row by row. Palettes become colours, transparent colours an alpha
/// channel and values of 1, 2 and 4 bits 8 bits; gamma and profiles of colour are not looked at.
class PngReader {
public:
    /// Reads the header. Throws `bad_data`, beginning with `name`, for what is none. `bytes` must
    /// live as long.
    PngReader(const ByteSource& bytes, const std::string& name);
    ~PngReader();

    ImageShape shape() const;
    /// Throws `bad_data` for a picture that claims more than its file can hold: deflate makes at
    /// most 1032 bytes of one.
    void check_size() const;
    /// Fills `values`, floats in [0,1] or bytes, with the rows from `first` on; these follow on
    /// the ones read before. An interlaced picture is held as a whole. Throws `bad_data`.
    void read_rows(std::uint32_t first, std::uint32_t row_count, CodecValue type, void* values);

private:
    struct Open;
    std::unique_ptr<Open> open_;
};

} // namespace catoptric
