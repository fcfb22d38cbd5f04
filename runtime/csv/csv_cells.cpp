#include "runtime/csv/csv_cells.hpp"

#include "runtime/source/letters.hpp"

namespace lineshaft {

/// The end of the cell that begins at `at`: its separator, or the end of the line.
const char* cell_end(const char* at, const char* end, char separator) {
    bool quoted = false;
    for (; at != end && (quoted || *at != separator); ++at)
        if (*at == '"') quoted = !quoted;
    return at;
}

/// What the cell holds, its quotes removed.
std::string unquoted(std::string_view cell) {
    cell = trimmed(cell);
    if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') return std::string(cell);
    std::string text;
    for (std::size_t i = 1; i + 1 < cell.size(); ++i) {
        text += cell[i];
        if (cell[i] == '"' && cell[i + 1] == '"' && i + 2 < cell.size()) ++i;
    }
    return text;
}

std::vector<std::string> csv_cells(std::string_view line, char separator) {
    std::vector<std::string> cells;
    const char* at = line.data();
    const char* const end = at + line.size();
    while (true) {
        const char* const stop = cell_end(at, end, separator);
        cells.push_back(unquoted({at, static_cast<std::size_t>(stop - at)}));
        if (stop == end) return cells;
        at = stop + 1;
    }
}

std::string quoted(const std::string& text, char separator) {
    if (text.find_first_of(std::string("\"\r\n") + separator) == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) out.append(c == '"' ? 2U : 1U, c);
    return out + "\"";
}

char separator_of(std::string_view header) {
    bool quoted = false;
    int brackets = 0;
    for (const char c : header) {
        if (c == '"') quoted = !quoted;
        if (quoted) continue;
        if (c == '[') ++brackets;
        if (c == ']') --brackets;
        if (brackets == 0 && (c == ',' || c == ';')) return c;
    }
    return ',';
}

}  // namespace lineshaft
