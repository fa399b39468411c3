/// \file
/// Records which code a program runs. Code compiled with -fsanitize-coverage=trace-pc calls the
/// function below in each basic block. Each program or library writes a file FOLDER/NAME, where
/// FOLDER is the environment variable CATOPTRIC_REACHED and NAME the name of its file. The byte at
/// offset N is 1 if the call that returns to address N ran. Processes share the file, so that
/// processes which end by a signal count too. tests/mutations/reach.py reads it.
#include <cstdint>
#include <cstdlib>
#include <dlfcn.h>
#include <fcntl.h>
#include <string>
#include <sys/mman.h>
#include <unistd.h>

extern "C" {
extern const char __ehdr_start __attribute__((visibility("hidden")));
extern const char etext __attribute__((visibility("hidden")));
__attribute__((visibility("hidden"))) void __sanitizer_cov_trace_pc();
}

namespace {

char* g_marks = nullptr; ///< one byte per address of this module
std::size_t g_count = 0; ///< number of bytes in g_marks; 0 if nothing is recorded

__attribute__((constructor(101))) void open_marks() {
    const char* folder = std::getenv("CATOPTRIC_REACHED");
    Dl_info module{};
    if (folder == nullptr || dladdr(&__ehdr_start, &module) == 0 || module.dli_fname == nullptr)
        return;
    const std::string name = module.dli_fname;
    const std::string path = folder + ("/" + name.substr(name.rfind('/') + 1));
    const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (file < 0) return;
    const std::size_t size = static_cast<std::size_t>(&etext - &__ehdr_start);
    if (ftruncate(file, static_cast<off_t>(size)) == 0) {
        void* mapped = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
        if (mapped != MAP_FAILED) {
            g_marks = static_cast<char*>(mapped);
            g_count = size;
        }
    }
    close(file);
}

} // namespace

void __sanitizer_cov_trace_pc() {
    // A call at the end of a function can be a jump, which returns to the caller, maybe in another
    // module.
    const auto offset = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0)) -
                        reinterpret_cast<std::uintptr_t>(&__ehdr_start);
    if (offset < g_count) g_marks[offset] = 1;
}
