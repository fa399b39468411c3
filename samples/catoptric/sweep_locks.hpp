#pragma once

#include <atomic>
#include <filesystem>

// Locks between processes that work on one sweep. The system releases the locks of a process that
// ends, also of one that was killed.
namespace catoptric::cli {

/// A file of which each byte can be locked by one process.
class PieceLockFile {
public:
    enum class Access { lock, look };
    /// Opens the file. To lock bytes, it is made if it is missing. Throws `cannot_create`.
    explicit PieceLockFile(const std::filesystem::path& file, Access access = Access::lock);
    ~PieceLockFile();
    PieceLockFile(const PieceLockFile&) = delete;
    PieceLockFile& operator=(const PieceLockFile&) = delete;

    /// Locks a byte, and returns false if another process holds it.
    bool try_lock(std::size_t index) const;
    void unlock(std::size_t index) const;
    /// Returns whether another process holds the byte.
    bool is_locked_elsewhere(std::size_t index) const;

private:
    int file_ = -1;
};

/// Lock of this user on this machine. Many processes may draw pictures at once, but a process that
/// measures times holds the lock alone.
class MachineLock {
public:
    enum class Use { shared, alone };
    /// Waits for the lock. Throws as a watcher does if `stop` is no longer 0.
    MachineLock(Use use, const std::atomic<int>& stop);
    ~MachineLock();
    MachineLock(const MachineLock&) = delete;
    MachineLock& operator=(const MachineLock&) = delete;

private:
    int file_ = -1;
};

} // namespace catoptric::cli
