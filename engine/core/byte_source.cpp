#include "core/byte_source.hpp"

#include "core/error.hpp"
#include "core/file.hpp"

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace catoptric {

namespace {

class FileSource final : public ByteSource {
public:
    FileSource(int file, std::uint64_t size, std::string name)
        : file_(file), size_(size), name_(std::move(name)) {}
    ~FileSource() override { ::close(file_); }

    std::uint64_t size() const override { return size_; }
    std::size_t read(std::uint64_t offset, std::span<char> into) const override {
        std::size_t count = 0;
        while (count < into.size()) {
            const ssize_t more = ::pread(file_, into.data() + count, into.size() - count,
                                         static_cast<off_t>(offset + count));
            if (more < 0 && errno == EINTR) continue;
            check(more >= 0, Failure::io, name_, ": reading failed after ", offset + count,
                  " bytes");
            if (more == 0) break;
            count += static_cast<std::size_t>(more);
        }
        return count;
    }

private:
    int file_;
    std::uint64_t size_;
    std::string name_;
};

class OwnedSource final : public ByteSource {
public:
    explicit OwnedSource(std::string bytes) : bytes_(std::move(bytes)) {}
    std::uint64_t size() const override { return bytes_.size(); }
    std::size_t read(std::uint64_t offset, std::span<char> into) const override {
        return MemorySource(bytes_).read(offset, into);
    }

private:
    std::string bytes_;
};

} // namespace

std::size_t MemorySource::read(std::uint64_t offset, std::span<char> into) const {
    if (offset >= bytes_.size()) return 0;
    const std::string_view part = bytes_.substr(offset, into.size());
    std::ranges::copy(part, into.begin());
    return part.size();
}

std::unique_ptr<ByteSource> open_source(const std::filesystem::path& path) {
    struct stat facts {};
    if (::stat(path.c_str(), &facts) != 0 || !S_ISREG(facts.st_mode))
        return std::make_unique<OwnedSource>(read_file(path));
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    const int error = errno;
    check(file >= 0, Failure::missing_input, path.string(),
          ": cannot be opened: ", std::generic_category().message(error));
    return std::make_unique<FileSource>(file, static_cast<std::uint64_t>(facts.st_size),
                                        path.string());
}

} // namespace catoptric
