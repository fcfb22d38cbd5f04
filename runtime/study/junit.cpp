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

}  // namespace

std::string junit_xml(const std::vector<SuiteEntry>& entries) {
    const auto failures = std::ranges::count_if(
        entries, [](const SuiteEntry& e) { return !e.failure.empty() && !e.error; });
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
        if (e.failure.empty()) {
            xml += "/>\n";
            continue;
        }
        const char* tag = e.error ? "error" : "failure";
        const std::string text = escape(e.failure);
        xml += fmt::format(">\n    <{} message=\"{}\">{}</{}>\n  </testcase>\n", tag,
                           text.substr(0, text.find('\n')), text, tag);
    }
    return xml + "</testsuite>\n";
}

}  // namespace lineshaft
