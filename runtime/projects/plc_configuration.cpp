#include "runtime/projects/plc_configuration.hpp"

#include <algorithm>
#include <string_view>

#include "runtime/projects/excerpts.hpp"
#include "runtime/source/letters.hpp"

namespace lineshaft::projects {

namespace {

constexpr std::string_view first_word = "PLC_CONFIGURATION", last_word = "PLC_END";

/// Names of channels and bits as declarations.
class Channels {
  public:
    explicit Channels(const std::shared_ptr<const SourceFile>& source)
        : file_(source), text_(source->text) {}

    void read(Part section) {
        for (std::size_t at = section.begin; at < section.end;) {
            const std::size_t end = std::min(text_.find('\n', at), section.end);
            read_line({at, end});
            at = end + 1;
        }
    }
    void finish(Project& project) {
        if (declared_.is_empty()) return;
        declared_.write("END_VAR\n", file_.mark({0, 1}));
        project.add(declared_.finish(file_.file()->path, std::string(first_word)));
    }

  private:
    void read_line(Part line) {
        line.begin = std::min(text_.find_first_not_of(" \t", line.begin), line.end);
        const std::string_view text = file_.text(line);
        if (text.starts_with("_SECTION_NAME:")) section_ = quoted(line);
        if (text.starts_with("_CHANNEL") && !text.starts_with("_CHANNEL_")) name_ = {};
        if (text.starts_with("_SYMBOLIC_NAME:")) name_ = quoted(line);
        if (text.starts_with("_IECADR:")) declare(name_, address(line));
        if (text.starts_with("_BIT ")) declare(quoted(line), address(line));
    }
    /// Between the first two quotes.
    Part quoted(Part line) const {
        const std::size_t open = text_.find('\'', line.begin);
        if (open >= line.end) return {};
        const std::size_t close = text_.find('\'', open + 1);
        return close >= line.end ? Part{} : Part{open + 1, close};
    }
    Part address(Part line) const {
        const std::size_t begin = text_.find('%', line.begin);
        if (begin >= line.end) return {};
        return {begin, std::min(text_.find_first_of(" \t\r\n", begin), line.end)};
    }
    std::string_view type_of(Part address) const {
        constexpr std::pair<char, std::string_view> types[] = {
            {'B', "BYTE"}, {'W', "WORD"}, {'D', "DWORD"}, {'L', "LWORD"}, {'R', "REAL"}};
        const std::string section = lower(file_.text(section_));
        const char size = address.end - address.begin > 2 ? text_[address.begin + 2] : 'X';
        const bool is_real =
            section.find("float") != section.npos || section.find("real") != section.npos;
        if (size == 'D' && is_real) return "REAL";
        const auto* type =
            std::ranges::find(types, size, &std::pair<char, std::string_view>::first);
        return type == std::end(types) ? "BOOL" : type->second;
    }
    void declare(Part name, Part address) {
        if (name.begin == name.end || address.begin == address.end) return;
        const Mark place = file_.mark(name);
        declared_.write(declared_.is_empty() ? "VAR_GLOBAL\n    " : "    ", place);
        declared_.copy(file_, name);
        declared_.write(" AT ", place);
        declared_.copy(file_, address);
        declared_.write(" : ", place);
        declared_.write(type_of(address), place);
        declared_.write(";\n", place);
    }

    PlacedFile file_;
    std::string_view text_;
    Part section_, name_;
    Excerpts declared_;
};

}  // namespace

void read_plc_configuration(const Reading& to, const std::shared_ptr<const SourceFile>& source) {
    const std::string_view text = source->text;
    if (text.find(last_word) == text.npos) return;
    Channels channels(source);
    for (std::size_t at = text.find(first_word); at != text.npos; at = text.find(first_word, at)) {
        const std::size_t end = text.find(last_word, at);
        if (end == text.npos) break;
        channels.read({at, end});
        at = end;
    }
    channels.finish(to.project);
}

}  // namespace lineshaft::projects
