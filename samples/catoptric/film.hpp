#pragma once

#include "core/file.hpp"
#include "measure/picture.hpp"
#include "session/watcher.hpp"

#include <cstdint>
#include <string>
#include <vector>

#include <sys/types.h>

// Films, which the program ffmpeg encodes.
namespace catoptric::cli {

/// Returns whether the name ends in .mp4.
bool is_film_name(const std::string& name);

/// Throws `missing_input`, with the package to install, if PATH holds no ffmpeg. Throws `usage` for
/// a picture with an odd edge, because the film stores one colour for each 2x2 pixels.
void check_film(const std::string& file, uvec2 size);

/// Returns the command that reads frames of 8-bit RGB from stdin and writes a film (H.264 in MP4).
/// `output`: an absolute path.
std::vector<std::string> ffmpeg_words(uvec2 size, double frames_per_second,
                                      const std::string& output);

/// A film that is written frame by frame. The file is replaced as a whole by `finish`, or not at
/// all.
class FilmWriter {
public:
    /// Starts ffmpeg. `watcher` must outlive this object: a stop ends the waits. Throws as
    /// check_film does.
    FilmWriter(const std::string& file, uvec2 size, double frames_per_second,
               const session::Watcher& watcher);
    /// Ends ffmpeg if the film is not finished.
    ~FilmWriter();
    FilmWriter(const FilmWriter&) = delete;
    FilmWriter& operator=(const FilmWriter&) = delete;

    /// Adds a frame: a picture as displayed. Throws `io` if ffmpeg has ended, and as
    /// session::throw_if_stopped does.
    void add_frame(const measure::Picture& display);
    /// Waits for ffmpeg and puts the film in place. Throws `io` if ffmpeg failed.
    void finish();

private:
    void start_ffmpeg(const std::vector<std::string>& words);
    void write_bytes(const std::vector<std::uint8_t>& bytes);
    int wait_for_ffmpeg();
    [[noreturn]] void fail_ended(int status) const;

    std::string name_;
    PartialFile partial_;
    const session::Watcher& watcher_;
    pid_t process_ = 0; ///< 0: ended and waited for
    int input_ = -1;    ///< our end of ffmpeg's stdin; -1: closed
};

} // namespace catoptric::cli
