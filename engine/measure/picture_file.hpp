#pragma once

#include "measure/picture.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

// Picture files that are read piece by piece or refused by their size.
namespace catoptric::measure {

/// Largest picture that is read unless the caller says otherwise: 2^29 values, 2 GiB of float.
constexpr std::uint64_t kMaxPictureValues = std::uint64_t{1} << 29;

/// A picture's file, or a folder of pictures, and the layer of OpenEXR files that is meant.
struct PictureLocation {
    std::filesystem::path file;
    std::string layer; ///< empty: that which the file itself prefers (core/exr_colours.hpp)
};
/// Reads "FILE:LAYER". A file whose whole name is the text is meant without a layer.
PictureLocation locate_picture(const std::filesystem::path& path);

/// Reads a picture row by row as `read_picture` does.
class PictureReader {
public:
    /// Refuses a picture by its width and height: throws if they are not accepted.
    using SizeCheck = std::function<void(int, int)>;

    /// Reads only the header and checks it against `judge`, `kMaxPictureValues`, and whether a file
    /// of this size can hold so many values. Memory for the picture is allocated after these
    /// checks.
    explicit PictureReader(const std::filesystem::path& path, const SizeCheck& judge = {});
    ~PictureReader();
    PictureReader(PictureReader&&) noexcept;
    PictureReader& operator=(PictureReader&&) noexcept;

    int picture_width() const;
    int height() const;
    std::string format() const; ///< "OpenEXR", "Radiance" or "PNG"
    bool is_8_bit() const;      ///< whether it is a PNG of at most 8 bits a value
    /// Fills `pixels` with as many whole rows as it holds, beginning at row `first`. Each call must
    /// continue where the last one ended.
    void read_rows(int first, std::span<vec3> pixels);

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Reads a whole picture. `judge` may refuse it by its size.
Picture read_picture(const std::filesystem::path& path, const PictureReader::SizeCheck& judge);

/// A channel of an OpenEXR file beside R, G and B, such as "depth.Z": a value for each pixel.
struct ExtraChannel {
    std::string name;
    std::vector<float> values;
};
/// Returns an OpenEXR file as `encode_exr` does, with more channels. Each value is bit-exact.
std::string encode_exr(const Picture& picture, std::span<const ExtraChannel> channels,
                       const std::string& text = {});

/// Returns whether a file begins with the signature of a PNG.
bool is_png(const std::filesystem::path& path);

/// Returns red, green and blue of each pixel, row by row, as a PNG file holds them: 0 to 255,
/// clamped. NaN becomes 0.
std::vector<std::uint8_t> to_bytes(const Picture& display);

} // namespace catoptric::measure
