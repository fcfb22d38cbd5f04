#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "blocks/catalog.hpp"
#include "runtime/run/single_run.hpp"
#include "runtime/study/result_file.hpp"
#include "runtime/study/study_reader.hpp"
#include "runtime/study/study_runner.hpp"

namespace {

using namespace lineshaft;

struct Asked {
    LoadOptions load;
    RunOptions run;
    std::string results;
    unsigned jobs = 1;
};

/// What tools/determinism says behind the file, as the command takes it.
bool read_options(const std::vector<std::string>& words, Asked& asked) {
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] == "--quiet") continue;
        if (i + 1 == words.size()) return false;
        const std::string &name = words[i], &value = words[++i];
        if (name == "--trace")
            asked.run.trace_path = value;
        else if (name == "--pulses")
            asked.run.pulses_path = value;
        else if (name == "-o")
            asked.results = value;
        else if (name == "-j")
            asked.jobs = static_cast<unsigned>(std::atoi(value.c_str()));
        else if (const auto equals = value.find('='); name == "--set" && equals != value.npos)
            asked.load.settings.push_back({value.substr(0, equals), value.substr(equals + 1)});
        else
            return false;
    }
    return true;
}

bool run_program(const std::string& file, const Asked& asked, Diagnostics& out) {
    auto loaded = load_program(file, asked.load, standard_blocks(), out);
    if (!loaded) return false;
    const RunReport report = run(*loaded, asked.run);
    return !report.faulted() && report.refused.empty();
}

bool run_study(const std::string& file, const Asked& asked, Diagnostics& out) {
    const Catalog catalog = standard_blocks();
    const auto source = read_source(file, out);
    if (!source) return false;
    const Study study = read_study(source, asked.load, catalog, out);
    if (!out.empty()) return false;
    const StudyCsv csv(study);
    ResultFile results(asked.results, study, csv, {});
    if (!results.begin()) return false;
    run_cases(study, catalog, CaseRange{0, study.case_count()}, {.jobs = asked.jobs},
              [&](const CaseResult& result) { return results.add(result); });
    return results.error().empty() && results.commit();
}

}  // namespace

/// `record run|study FILE ...`: the files that the same words make `lineshaft` write.
int main(int count, char** arguments) {
    const std::vector<std::string> words(arguments + 1, arguments + count);
    Asked asked;
    if (words.size() < 2 || (words[0] != "run" && words[0] != "study") ||
        !read_options({words.begin() + 2, words.end()}, asked)) {
        std::fputs("usage: record run|study FILE OPTION...\n", stderr);
        return 2;
    }
    Diagnostics out;
    const bool done = (words[0] == "run" ? run_program : run_study)(words[1], asked, out);
    std::fputs(out.render().c_str(), stderr);
    return done ? 0 : 1;
}
