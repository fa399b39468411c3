#pragma once

#include "core/byte_source.hpp"
#include "core/math.hpp"

#include <cstdint>
#include <mutex>
#include <span>
#include <stdexcept>
#include <thread>

#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfThreading.h>

// What readers and writers of OpenEXR files share.
namespace catoptric {

/// Returns the number of threads that encode or decode a picture; 0: the calling thread does. The
/// first large picture starts OpenEXR's threads, unless the program that uses this library has. A
/// small picture takes less time than starting a thread.
inline int start_exr_threads(uvec2 size) {
    constexpr std::size_t kLargePicturePixels = 1 << 19;
    if (std::size_t(size.x) * size.y < kLargePicturePixels) return 0;
    static std::once_flag once;
    std::call_once(once, [] {
        if (Imf::globalThreadCount() == 0)
            Imf::setGlobalThreadCount(static_cast<int>(std::thread::hardware_concurrency()));
    });
    return Imf::globalThreadCount();
}

/// Lets OpenEXR read from a source of bytes.
class ExrByteSourceInput final : public Imf::IStream {
public:
    explicit ExrByteSourceInput(const RandomAccessByteSource& bytes)
        : IStream("memory"), bytes_(bytes) {}
    bool read(char into[], int size) override {
        const std::span<char> wanted(into, static_cast<std::size_t>(size));
        if (bytes_.read(at_, wanted) < wanted.size())
            throw std::runtime_error("the file ends too early");
        at_ += wanted.size();
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t position) override { at_ = position; }

private:
    const RandomAccessByteSource& bytes_;
    std::uint64_t at_ = 0;
};

} // namespace catoptric
