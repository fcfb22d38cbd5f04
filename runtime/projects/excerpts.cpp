#include "runtime/projects/excerpts.hpp"

#include <algorithm>
#include <utility>

#include "runtime/source/utf8.hpp"

namespace lineshaft::projects {

namespace {

constexpr std::size_t step_bytes = 512;

bool begins_character(char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80;
}

/// From `mark` over a text that goes on there.
void move_on(Mark& mark, std::string_view text) {
    for (const char c : text) {
        if (c == '\n')
            ++mark.line, mark.column = 1;
        else if (begins_character(c))
            ++mark.column;
    }
}

}  // namespace

PlacedFile::PlacedFile(std::shared_ptr<const SourceFile> file) : file_(std::move(file)) {
    Mark mark{nullptr, 1, 1, 1};
    for (std::size_t at = 0; at <= text().size(); at += step_bytes) {
        steps_.push_back(mark);
        move_on(mark, text().substr(at, step_bytes));
    }
}

Mark PlacedFile::mark(Part part) const {
    if (!file_->excerpts.empty()) return mark_of(file_, part.begin, part.end);
    const std::size_t step = part.begin / step_bytes;
    Mark mark = steps_[step];
    mark.file = file_;
    move_on(mark, text().substr(step * step_bytes, part.begin - step * step_bytes));
    constexpr std::size_t most = 400;  // bytes: a mark shows no more
    const std::string_view marked = text(part).substr(0, most);
    mark.length =
        std::max(1, static_cast<int>(count_characters(marked.substr(0, marked.find('\n')))));
    return mark;
}

void PlacedFile::copy(Excerpts& to, Part part) const {
    to.copy(*this, part);
}

void Excerpts::copy_to(const PlacedFile& from, std::size_t& copied, std::size_t end) {
    copy(from, {copied, end});
    copied = end;
}

void Excerpts::copy(const PlacedFile& from, Part part) {
    if (part.begin == part.end) return;
    const auto copy_from = [&](std::size_t begin, bool is_copied) {
        Mark place = from.mark({begin, part.end});
        if (is_copied) place.length = 1;
        place.drawn = drawn_;
        excerpts_.push_back({text_.size() + begin - part.begin, std::move(place), is_copied});
    };
    const auto& parts = from.file()->excerpts;
    const auto next = std::ranges::upper_bound(parts, part.begin, {}, &Excerpt::begin);
    copy_from(part.begin, parts.empty() || std::prev(next)->is_copied);
    for (auto it = next; it != parts.end() && it->begin < part.end; ++it)
        copy_from(it->begin, it->is_copied);
    text_ += from.text(part);
}

void Excerpts::write(std::string_view words, const Mark& place) {
    if (words.empty()) return;
    excerpts_.push_back({text_.size(), place, false});
    if (drawn_) excerpts_.back().place.drawn = drawn_;
    text_ += words;
}

void Excerpts::append(const Excerpts& other) {
    for (const Excerpt& excerpt : other.excerpts_)
        excerpts_.push_back({text_.size() + excerpt.begin, excerpt.place, excerpt.is_copied});
    text_ += other.text_;
}

std::shared_ptr<const SourceFile> Excerpts::finish(std::string path, std::string part,
                                                   const Diagnostics& mistakes) {
    std::vector<Diagnostic> all = mistakes.list();
    all.insert(all.end(), mistakes.warnings().begin(), mistakes.warnings().end());
    return std::make_shared<const SourceFile>(SourceFile{.path = std::move(path),
                                                         .text = std::exchange(text_, {}),
                                                         .part = std::move(part),
                                                         .excerpts = std::exchange(excerpts_, {}),
                                                         .mistakes = std::move(all)});
}

}  // namespace lineshaft::projects
