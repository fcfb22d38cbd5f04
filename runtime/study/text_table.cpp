#include "runtime/study/text_table.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace lineshaft {

std::string align(const std::vector<Cells>& rows) {
    std::vector<std::size_t> widths;
    for (const Cells& row : rows) {
        widths.resize(std::max(widths.size(), row.size()));
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    }
    std::string text;
    for (const Cells& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i)
            if (widths[i] > 0) line += fmt::format("{:<{}}  ", row[i], widths[i]);
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    return text;
}

std::string short_number(double value, bool percent) {
    if (percent) return fmt::format("{:.{}f} %", value * 100, decimals(value * 100));
    if (value == std::trunc(value) && std::abs(value) < 1e9) return fmt::format("{:.0f}", value);
    return fmt::format("{:.4g}", value);
}

int decimals(double percentage) {
    int count = 1;
    for (double p = std::abs(percentage); p > 0 && p < 0.995 && count < 5; p *= 10) ++count;
    return count;
}

}  // namespace lineshaft
