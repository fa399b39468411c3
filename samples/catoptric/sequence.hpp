#pragma once

#include <optional>
#include <string>

namespace catoptric::cli {

/// The file names of a sequence of pictures: a name with one place for the frame's number, written
/// {n}, {n:W}, %d or %0Wd, where W is the number of digits, filled up with zeros.
class Sequence {
public:
    /// Returns the sequence that `name` asks for, or none where it names one picture. Throws
    /// `usage` for two places, or for one that begins with "{n" and is none of these.
    static std::optional<Sequence> find(const std::string& name);

    /// Returns the file name of frame `number`.
    std::string file(int number) const;

private:
    std::string before_, after_;
    int digits_ = 0;
};

} // namespace catoptric::cli
