#pragma once

#include "core/byte_source.hpp"
#include "core/image_codec.hpp"

#include <memory>
#include <string>

namespace catoptric {

/// Reads an OpenEXR file with the OpenEXR library, row by row.
class ExrReader {
public:
    /// Opens a picture of one part, in scanlines or tiles, with the channels R, G, B, or R, G, B,
    /// A, or Y, of half or single precision. Returns null for other pictures and for files that
    /// cannot be opened, because OpenImageIO reads more kinds and says why it refuses a file.
    /// `size`: size that the file's header claims. `bytes` must outlive the reader.
    static std::unique_ptr<ExrReader> open_usual_picture(const RandomAccessByteSource& bytes,
                                                         const std::string& name, uvec2 size);
    ~ExrReader();

    ImageSizeAndChannels image_size_and_channels() const;
    /// Fills `values` with the rows from `first` on. Throws `bad_data` if they cannot be decoded.
    void read_image_rows(std::uint32_t first, std::uint32_t row_count, float* values);

private:
    struct ExrReadState;
    explicit ExrReader(std::unique_ptr<ExrReadState> state);
    std::unique_ptr<ExrReadState> exr_state_;
};

} // namespace catoptric
