#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lineshaft {

/// A file's text, kept so that messages can show the line.
struct SourceFile {
    std::string path;  ///< as the user gave it
    std::string text;
};

/// A place in a file: `length` characters from line:column, both counted from 1. line 0: no place.
struct Mark {
    std::shared_ptr<const SourceFile> file;
    int line = 0;
    int column = 0;
    int length = 1;
};

/// What a user got wrong.
struct Diagnostic {
    std::string code;  ///< `L0203`; `lineshaft explain L0203` prints the paragraph behind it
    Mark mark;
    std::string message;  ///< one line, lower case, no full stop
    std::string help;     ///< shown under the caret: "did you mean 'shaft.velocity'?"; may be empty
};

/// Collects diagnostics so that all are shown at once, sorted by place when rendered.
class Diagnostics {
  public:
    void add(std::string code, Mark mark, std::string message, std::string help = {});
    bool empty() const { return list_.empty(); }
    const std::vector<Diagnostic>& list() const { return list_; }

    /// Sorted by file, line, column; equal ones once; at most `limit`, then "... and N more".
    /// Every line ends with '\n'.
    std::string render(std::size_t limit = 50) const;

  private:
    std::vector<Diagnostic> list_;
};

/// One diagnostic as a compiler prints it:
///   FILE:9:22: error[L0203]: unknown port 'velocty' on 'shaft' (virtual_axis)
///      9 |     master_velocity: shaft.velocty
///        |                      ^~~~~~~~~~~~~ did you mean 'shaft.velocity'?
/// Long lines are shown as a window around the mark; control characters, and those that reorder or
/// hide text, as '?', a tab as one space; columns are characters (UTF-8 code points), not bytes.
/// Without a place: `error[L0001]: message` (after `FILE: ` if there is a file), the help below it.
std::string render(const Diagnostic& diagnostic);

/// The candidate nearest to `word` by edit distance (Damerau; capital letters count as small ones,
/// the first of equally near ones wins), empty if none is near: more edits than a third of the
/// word's length (at least 1, at most 3), or no letter in common.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// For `help`: "did you mean 'x'?" when one is near, else "known: a, b, c" (at most 12 names, then
/// "..."), empty without candidates.
std::string suggest(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace lineshaft
