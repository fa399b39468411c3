#include "sweep_locks.hpp"

#include "core/error.hpp"
#include "session/watcher.hpp"

#include <cerrno>
#include <chrono>
#include <string>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace catoptric::cli {

namespace {

constexpr std::chrono::milliseconds kLockPollInterval{50};

int open_lock_file(const std::filesystem::path& file, int flags) {
    const int opened = ::open(file.c_str(), flags | O_CLOEXEC | O_NOFOLLOW, 0666);
    const int error = errno;
    check(opened >= 0, Failure::cannot_create, file.string(),
          ": cannot be opened: ", std::generic_category().message(error));
    return opened;
}

/// Returns a folder for lock files that is the same for all processes of this machine, whatever
/// their environment variables.
std::filesystem::path find_machine_folder() {
    std::error_code ignored;
    return std::filesystem::is_directory("/dev/shm", ignored) ? "/dev/shm" : "/tmp";
}

/// Returns a lock of the byte at `index`. The lock belongs to the open file and not to the whole
/// process, so each thread can hold locks of its own.
struct flock make_byte_lock(short type, std::size_t index) {
    struct flock lock {};
    lock.l_type = type;
    lock.l_whence = SEEK_SET;
    lock.l_start = static_cast<off_t>(index);
    lock.l_len = 1;
    return lock;
}

std::filesystem::path machine_lock_file() {
    return find_machine_folder() / ("catoptric-sweep-" + std::to_string(::getuid()) + ".lock");
}

} // namespace

PieceLockFile::PieceLockFile(const std::filesystem::path& file, Access access)
    : file_(open_lock_file(file, access == Access::look ? O_RDONLY : O_RDWR | O_CREAT)) {}
PieceLockFile::~PieceLockFile() { ::close(file_); }

bool PieceLockFile::try_lock(std::size_t index) const {
    struct flock lock = make_byte_lock(F_WRLCK, index);
    if (::fcntl(file_, F_OFD_SETLK, &lock) == 0) return true;
    const int error = errno;
    check(error == EAGAIN || error == EACCES, Failure::io,
          "a piece of the sweep cannot be locked: ", std::generic_category().message(error));
    return false;
}

void PieceLockFile::unlock(std::size_t index) const {
    struct flock lock = make_byte_lock(F_UNLCK, index);
    ::fcntl(file_, F_OFD_SETLK, &lock);
}

bool PieceLockFile::is_locked(std::size_t index) const {
    struct flock lock = make_byte_lock(F_WRLCK, index);
    return ::fcntl(file_, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

MachineLock::MachineLock(Use use, const std::atomic<int>& stop)
    : file_(open_lock_file(machine_lock_file(), O_RDWR | O_CREAT)) {
    const int operation = (use == Use::alone ? LOCK_EX : LOCK_SH) | LOCK_NB;
    try {
        while (::flock(file_, operation) != 0) {
            const int error = errno;
            check(error == EWOULDBLOCK || error == EINTR, Failure::io, machine_lock_file().string(),
                  ": cannot be locked: ", std::generic_category().message(error));
            session::throw_if_stopped({.stop = &stop});
            std::this_thread::sleep_for(kLockPollInterval);
        }
    } catch (...) {
        ::close(file_);
        throw;
    }
}
MachineLock::~MachineLock() { ::close(file_); }

} // namespace catoptric::cli
