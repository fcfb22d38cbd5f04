#include "runtime/study/junit.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace lineshaft {

namespace {

std::string escape(const std::string& text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' ? '?' : c;
        }
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
    double seconds = 0;
    for (const SuiteEntry& e : entries) seconds += e.wall_seconds;
    std::string xml = fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<testsuite name=\"lineshaft\" tests=\"{}\" failures=\"{}\" errors=\"{}\" "
        "time=\"{:.3f}\">\n",
        entries.size(), failures, errors, seconds);
    for (const SuiteEntry& e : entries) {
        xml += "  <testcase";
        if (!e.file.empty())
            xml +=
                fmt::format(" classname=\"{0}\" file=\"{0}\" line=\"{1}\"", escape(e.file), e.line);
        xml += fmt::format(" name=\"{}\" time=\"{:.3f}\"", escape(e.name), e.wall_seconds);
        if (e.failures.empty()) {
            xml += "/>\n";
            continue;
        }
        xml += ">\n";
        for (const std::string& failure : e.failures) xml += failure_element(e, failure);
        xml += "  </testcase>\n";
    }
    return xml + "</testsuite>\n";
}

}  // namespace lineshaft
