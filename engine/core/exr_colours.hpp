#pragma once

#include "core/byte_source.hpp"
#include "core/image_codec.hpp"

#include <memory>
#include <string>

namespace catoptric {

/// Returns the number of threads that encode or decode a picture; 0: the calling thread does. The
/// first large picture starts OpenEXR's threads, unless the program that uses this library has. A
/// small picture takes less time than starting a thread.
int start_exr_threads(uvec2 size);

/// Reads the colours of an OpenEXR file by the names of its layers, in the display window.
///
/// A layer is the part of a channel's name before its last dot; in a file of several parts, the
/// name of the part before it. A layer has colours if it has R, G and B, or Y without chroma. The
/// colours read are those of the layer asked for; else R, G and B without a layer; else of the only
/// layer that has colours. Whole numbers are read as numbers. Pixels of the display window without
/// data are 0.
class ExrColourReader {
public:
    /// `layer`: empty for the file's own choice. `size`: that of the file's header, by which
    /// threads are started. `bytes` must outlive the reader. Throws `bad_data` with the names that
    /// the file has if no layer fits or several do, and for a file that cannot be opened.
    ExrColourReader(const ByteSource& bytes, const std::string& name, uvec2 size,
                    const std::string& layer);
    ~ExrColourReader();

    /// Returns the display window's size and the channels R, G, B or Y, with A if the layer has it.
    const ImageShape& shape() const;
    /// Fills `values` with the rows from `first` on. Throws `bad_data` if they cannot be decoded.
    void read_rows(std::uint32_t first, std::uint32_t row_count, float* values);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace catoptric
