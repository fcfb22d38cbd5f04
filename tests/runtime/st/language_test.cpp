#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "tests/runtime/st/instance.hpp"
#include "tests/source_folder.hpp"

using namespace lineshaft;

// Every file of tests/st: programs with what must come out beside the line that makes it. See
// tests/st/README.md.
namespace {

struct Expectation {
    int line = 0;
    std::string kind, text;
};

std::vector<Expectation> expectations_of(const std::string& text) {
    static const std::regex pattern(R"(//\s*(expect|scans|step|error|warning|fault):\s*(.*?)\s*$)");
    std::vector<Expectation> found;
    std::istringstream lines(text);
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        std::smatch match;
        if (std::regex_search(line, match, pattern)) found.push_back({number, match[1], match[2]});
    }
    return found;
}

std::string told(const std::vector<Diagnostic>& list) {
    std::vector<std::string> all;
    for (const Diagnostic& d : list)
        if (d.code != "L0921") all.push_back(fmt::format("{} {}", d.mark.line, d.code));
    std::ranges::sort(all);
    return fmt::format("{}", fmt::join(all, ", "));
}

std::string wanted(const std::vector<Expectation>& expectations, const std::string& kind) {
    std::vector<std::string> all;
    for (const Expectation& e : expectations)
        if (e.kind == kind) all.push_back(fmt::format("{} {}", e.line, e.text));
    std::ranges::sort(all);
    return fmt::format("{}", fmt::join(all, ", "));
}

/// `x = 5, y = 2.5`: split at commas that stand outside of brackets.
std::vector<std::pair<std::string, std::string>> pairs_of(const std::string& text) {
    static const std::regex pattern(
        R"(\s*([\w.]+(?:\[[\d,-]+\][\w.]*)*)\s*=\s*([^,]+?)\s*(?:,|$))");
    std::vector<std::pair<std::string, std::string>> pairs;
    for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it)
        pairs.emplace_back((*it)[1], (*it)[2]);
    return pairs;
}

int judge(const std::filesystem::path& path) {
    const std::string name = path.filename().string();
    const auto source = st::read(path.string());
    const auto expectations = expectations_of(source->text);
    Diagnostics out;
    const auto library = st::compile({source}, standard_blocks(), out);
    INFO(name << "\n" << (library ? "" : out.render()));
    CHECK(told(out.list()) == wanted(expectations, "error"));
    if (library) CHECK(told(out.warnings()) == wanted(expectations, "warning"));
    const auto cases = static_cast<int>(expectations.size());
    if (!library) return cases;
    std::int64_t scans = 1, step = 1'000'000;
    for (const Expectation& e : expectations) {
        if (e.kind == "scans") scans = std::stoll(e.text);
        if (e.kind == "step") step = std::stoll(e.text);
    }
    st::Instances instances(*library);
    for (std::int64_t i = 0; i < scans; ++i) instances.scan(i * step, step);
    std::string faults;
    for (const auto& fault : instances.faults()) faults += fault;
    CHECK(faults == wanted(expectations, "fault"));
    for (const Expectation& e : expectations) {
        if (e.kind != "expect") continue;
        const auto pairs = pairs_of(e.text);
        CHECKED_IF(!pairs.empty()) {}
        for (const auto& [signal, value] : pairs) {
            INFO(name << ":" << e.line << ": " << signal);
            CHECK(instances.text(signal) == value);
        }
    }
    return cases;
}

}  // namespace

TEST_CASE("Structured Text: every line of tests/st does what stands beside it", "[st]") {
    int cases = 0;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(test::in_source("tests/st")))
        for (const char* ending : {".st", ".scl", ".EXP"})
            if (entry.path().extension() == ending) files.push_back(entry.path());
    std::ranges::sort(files);
    for (const auto& file : files) cases += judge(file);
    WARN(cases << " cases in " << files.size() << " files");
}
