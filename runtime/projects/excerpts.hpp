#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "runtime/source/diagnostic.hpp"

namespace lineshaft::projects {

/// Bytes [begin, end) of a file.
struct Part {
    std::size_t begin = 0, end = 0;
};

class Excerpts;

/// A file with places that are found quickly, whatever the length of its lines.
class PlacedFile {
  public:
    PlacedFile() = default;
    explicit PlacedFile(std::shared_ptr<const SourceFile> file);
    virtual ~PlacedFile() = default;
    PlacedFile(const PlacedFile&) = default;
    PlacedFile(PlacedFile&&) = default;
    PlacedFile& operator=(const PlacedFile&) = default;
    PlacedFile& operator=(PlacedFile&&) = default;

    const std::shared_ptr<const SourceFile>& file() const { return file_; }
    std::string_view text() const { return file_->text; }
    std::string_view text(Part part) const {
        return text().substr(part.begin, part.end - part.begin);
    }
    Mark mark(Part part) const;

    /// What a part says.
    virtual std::string plain(Part part) const { return std::string(text(part)); }
    virtual void copy(Excerpts& to, Part part) const;

  private:
    std::shared_ptr<const SourceFile> file_;
    std::vector<Mark> steps_;  ///< of each 4096th byte; without the file
};

/// Puts a text together of what stands in files, and of words that the language asks for where a
/// file has XML. Each piece knows where it comes from.
class Excerpts {
  public:
    /// What stands there, as it stands.
    void copy(const PlacedFile& from, Part part);
    /// What stands from `copied` on to `end`, which `copied` is then.
    void copy_to(const PlacedFile& from, std::size_t& copied, std::size_t end);
    /// Words for what is at `place`.
    void write(std::string_view words, const Mark& place);
    /// What another has put together, behind what is there.
    void append(const Excerpts& other);
    /// What is drawn where the next pieces come from, which messages name.
    void draw(std::shared_ptr<const std::string> element) { drawn_ = std::move(element); }

    bool is_empty() const { return text_.empty(); }
    std::string_view text() const { return text_; }
    /// The text, under the path of the file; `part` names it among several of the file. Mistakes
    /// and warnings are its own.
    std::shared_ptr<const SourceFile> finish(std::string path, std::string part = {},
                                             const Diagnostics& mistakes = {});

  private:
    std::string text_;
    std::vector<Excerpt> excerpts_;
    std::shared_ptr<const std::string> drawn_;
};

}  // namespace lineshaft::projects
