#include "runtime/study/junit.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/source/utf8.hpp"

namespace lineshaft {

namespace {

/// What is no UTF-8, and what XML cannot hold, is '?'.
std::string escape(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        const Utf8Character c = first_character(text);
        const std::string_view written = text.substr(0, c.bytes);
        text.remove_prefix(c.bytes);
        const bool is_blank = c.code == '\n' || c.code == '\t';
        if (c.code == '&')
            out += "&amp;";
        else if (c.code == '<')
            out += "&lt;";
        else if (c.code == '>')
            out += "&gt;";
        else if (c.code == '"')
            out += "&quot;";
        else if (!c.valid || (c.code < 0x20 && !is_blank) || c.code == 0xFFFE || c.code == 0xFFFF)
            out += '?';
        else
            out += written;
    }
    return out;
}

std::string failure_element(const SuiteEntry& entry, const std::string& failure) {
    std::string text = escape(failure);
    const std::string message = text.substr(0, text.find('\n'));
    if (!entry.repeat.empty()) text += "\nrepeat it by: " + escape(entry.repeat);
    return fmt::format("    <{0} message=\"{1}\">{2}</{0}>\n", entry.error ? "error" : "failure",
                       message, text);
}

}  // namespace

std::string junit_xml(const std::vector<SuiteEntry>& entries) {
    const auto failures = std::ranges::count_if(
        entries, [](const SuiteEntry& e) { return !e.failures.empty() && !e.error; });
    const auto errors = std::ranges::count_if(entries, &SuiteEntry::error);
    const auto skipped =
        std::ranges::count_if(entries, [](const SuiteEntry& e) { return !e.skipped.empty(); });
    double seconds = 0;
    for (const SuiteEntry& e : entries) seconds += e.wall_seconds;
    std::string xml = fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<testsuite name=\"lineshaft\" tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\" "
        "time=\"{:.3f}\">\n",
        entries.size(), failures, errors, skipped, seconds);
    for (const SuiteEntry& e : entries) {
        const std::string file = escape(e.file.empty() ? e.name : e.file);
        xml += fmt::format("  <testcase classname=\"{0}\" file=\"{0}\"", file);
        if (e.line > 0) xml += fmt::format(" line=\"{}\"", e.line);
        xml += fmt::format(" name=\"{}\" time=\"{:.3f}\"", escape(e.name), e.wall_seconds);
        if (e.failures.empty() && e.skipped.empty()) {
            xml += "/>\n";
            continue;
        }
        xml += ">\n";
        if (!e.skipped.empty())
            xml += fmt::format("    <skipped message=\"{}\"/>\n", escape(e.skipped));
        for (const std::string& failure : e.failures) xml += failure_element(e, failure);
        xml += "  </testcase>\n";
    }
    return xml + "</testsuite>\n";
}

}  // namespace lineshaft
