#pragma once

#include <optional>
#include <string>

namespace catoptric::cli {

/// The file names of a sequence of pictures. A name has one place for the frame's number: {n},
/// {n:W}, %d or %0Wd. W is the number of digits, padded with zeros. In the names of folders these
/// forms have no meaning.
class FileSequence {
public:
    /// Returns the sequence that `name` describes, or none if it names one picture. Throws `usage`
    /// for two places, and for a place that begins with "{n" but has none of these forms.
    static std::optional<FileSequence> parse(const std::string& name);

    /// Returns the file name of frame `number`.
    std::string file(int number) const;

private:
    std::string before_, after_;
    int digits_ = 0;
};

} // namespace catoptric::cli
