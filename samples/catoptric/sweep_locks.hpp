#pragma once

#include <atomic>
#include <filesystem>

// Locks between processes that run one sweep. The system releases the locks of a process that ends
// or is killed.
namespace catoptric::cli {

/// A file in which processes lock single bytes. Each byte stands for one piece of a sweep.
class PieceLockFile {
public:
    enum class Access { lock, look };
    /// Opens the lock file. If `access` allows locking, a missing file is created. Throws
    /// `cannot_create`.
    explicit PieceLockFile(const std::filesystem::path& file, Access access = Access::lock);
    ~PieceLockFile();
    PieceLockFile(const PieceLockFile&) = delete;
    PieceLockFile& operator=(const PieceLockFile&) = delete;

    /// Locks the byte at `index`. Returns false if another process holds the lock.
    bool try_lock(std::size_t index) const;
    void unlock(std::size_t index) const;
    /// Returns whether another process holds the lock of the byte at `index`.
    bool is_locked(std::size_t index) const;

private:
    int file_ = -1;
};

/// A lock for all processes of this user on this machine. Many processes may draw pictures at once.
/// A process that measures times must hold the lock alone.
class MachineLock {
public:
    enum class Use { shared, alone };
    /// Waits for the lock. If `stop` becomes other than 0, throws the error of a stopped run.
    MachineLock(Use use, const std::atomic<int>& stop);
    ~MachineLock();
    MachineLock(const MachineLock&) = delete;
    MachineLock& operator=(const MachineLock&) = delete;

private:
    int file_ = -1;
};

} // namespace catoptric::cli
