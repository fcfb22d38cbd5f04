#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lineshaft {

struct SourceFile;

/// A place in a file: `length` characters from line:column, both counted from 1. line 0: no place.
struct Mark {
    std::shared_ptr<const SourceFile> file;
    int line = 0;
    int column = 0;
    int length = 1;
    /// What is drawn there, of a network: `network 2, contact 7`. None: it is text.
    std::shared_ptr<const std::string> drawn = nullptr;
};

/// What a user got wrong.
struct Diagnostic {
    std::string code;  ///< `L0203`; `lineshaft explain L0203` prints the paragraph behind it
    Mark mark;
    std::string message;  ///< one line, lower case, no full stop
    std::string help;     ///< shown under the caret: "did you mean 'shaft.velocity'?"; may be empty
    bool is_warning = false;  ///< of what is allowed and hardly meant

    /// With the element of a network that it is about, if any.
    std::string whole_message() const;
};

/// Where a part of a text that was put together of others comes from: it ends where the next
/// begins.
struct Excerpt {
    std::size_t begin = 0;   ///< in bytes of the text
    Mark place;              ///< of its first character
    bool is_copied = false;  ///< as it stands there; else all of it was made for what is at `place`
};

/// A file's text, kept so that messages can show the line.
struct SourceFile {
    std::string path;  ///< as the user gave it
    std::string text;
    int first_line = 1;     ///< number of the line that `text` begins with: it may be a part
    std::string part = {};  ///< which of several texts that one file holds; empty: the only one
    std::vector<Excerpt> excerpts = {};  ///< of a text that does not stand like this in a file
    std::string read_as = {};  ///< `.var`: a name's ending that says how, where its own does not
    /// Mistakes in what it was made of, and warnings: who compiles it tells them, so that nobody
    /// minds what is not used.
    std::vector<Diagnostic> mistakes = {};

    /// `lineshaft_study:` at the beginning of a line: what kind of file it is, before it is read.
    bool has_key(std::string_view key) const {
        return text.starts_with(key) || text.find("\n" + std::string(key)) != std::string::npos;
    }
    bool is_same_text(const SourceFile& other) const {
        return path == other.path && part == other.part;
    }
};

/// The place of bytes [begin, end) of a text, in the file that they come from: the one way from a
/// byte to a line and column. Of what goes over several lines the first is marked.
Mark mark_of(const std::shared_ptr<const SourceFile>& file, std::size_t begin, std::size_t end);

/// Collects diagnostics so that all are shown at once, sorted by place when rendered. A file may
/// have a mistake in each of its bytes: the first thousand are kept, their texts as far as they are
/// shown.
class Diagnostics {
  public:
    void add(std::string code, Mark mark, std::string message, std::string help = {});
    /// A mistake or a warning that was found before.
    void add(const Diagnostic& found);
    bool empty() const { return list_.empty(); }
    const std::vector<Diagnostic>& list() const { return list_; }
    /// Errors that were added, kept or not.
    std::size_t count() const { return count_; }

    /// Tells what is allowed and hardly meant: no error, so that the list may be empty. Equal
    /// warnings are kept once.
    void warn(std::string code, Mark mark, std::string message, std::string help = {});
    /// False: so many were told that one more is not kept.
    bool keeps_warnings() const;
    const std::vector<Diagnostic>& warnings() const { return warnings_; }
    /// Warnings become errors.
    void be_strict();

    /// Errors, else warnings, sorted by file, line, column; equal ones once; at most `limit`, then
    /// "... and N more". Every line ends with '\n'.
    std::string render(std::size_t limit = 50) const;

  private:
    std::vector<Diagnostic> list_, warnings_;
    std::size_t count_ = 0;
};

/// One diagnostic as a compiler prints it:
///   FILE:9:22: error[L0203]: unknown port 'velocty' on 'shaft' (axis)
///      9 |     master_velocity: shaft.velocty
///        |                      ^~~~~~~~~~~~~ did you mean 'shaft.velocity'?
/// Long lines are shown as a window around the mark; control characters, and those that reorder or
/// hide text, as '?', a tab as one space; columns are characters (UTF-8 code points), not bytes.
/// Without a place: `error[L0001]: message` (after `FILE: ` if there is a file), the help below it.
std::string render(const Diagnostic& diagnostic);

/// The candidates (at most 3) that `word` may be meant for: the one word that it abbreviates
/// (`pos`, position), else the nearest by edit distance (Damerau; capital letters count as small
/// ones), of which there may be several (in a third of the word's length, at most 3, so none of a
/// word of two letters), else the longest that it spells out (MC_GearInPosition, MC_GearInPos).
std::vector<std::string> nearest(std::string_view word, const std::vector<std::string>& candidates);

/// For `help`: "did you mean 'x' or 'y'?" when some are near, else "known: a, b, c" (at most 12
/// names, then
/// "..."), empty without candidates. `before` stands before each name that is meant.
std::string suggest(std::string_view word, const std::vector<std::string>& candidates,
                    std::string_view before = {});

}  // namespace lineshaft
