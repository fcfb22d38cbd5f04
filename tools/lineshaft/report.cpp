#include <filesystem>
#include <regex>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/json_text.hpp"
#include "runtime/source/yaml.hpp"
#include "runtime/trace/output_file.hpp"
#include "tools/lineshaft/command.hpp"
#include "tools/lineshaft/report_data.hpp"

namespace lineshaft {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* report_help =
    "Inputs are traces (run --trace FILE.csv) and studies (study --json --traces DIR >FILE.json),\n"
    "whose traces are drawn, too: the first eight, or those of --cases. Signals of one name are "
    "laid\n"
    "over each other. Two lengths whose names differ by x for y only, as x.position and "
    "y.position,\n"
    "are drawn as a path, beside a circle with the deviation magnified. What a program says under\n"
    "'report:' is how its plots are arranged. The page needs no network and nothing but a browser.";

/// tools/report/page with uPlot in it, made by tools/report/bundle.mjs; empty in a build without.
constexpr unsigned char page_bytes[] = {
#ifdef LINESHAFT_PAGES
#include "report_page.inc"
#else
    0
#endif
};

constexpr std::size_t most_traces_unasked = 8;

struct ReportCommand {
    std::vector<std::string> inputs, signals, path;
    std::vector<double> circle;
    std::string output, title, condition, cases;
    bool quiet = false;
};

/// A trace of a study's case.
struct TracedCase {
    std::string label, path;
};

bool is_study_file(const std::string& path) {
    return std::filesystem::path(path).extension() == ".json";
}

/// What `study --json` printed; L0726 when it is anything else.
Json read_study_results(const std::string& path, Diagnostics& out) {
    const auto file = read_source(path, out);
    if (!file) return {};
    Json study = parse_json(file->text);
    const auto is_row = [](const Json& row) {
        const auto number_or_null = [&](const char* key) {
            return row.contains(key) && (row[key].is_number() || row[key].is_null());
        };
        return row.is_object() && row.contains("set") && row["set"].is_object() &&
               row.contains("signal") && row["signal"].is_string() && row.contains("unit") &&
               row["unit"].is_string() && row.contains("ok") && row["ok"].is_boolean() &&
               number_or_null("paper") && number_or_null("ours");
    };
    const auto are_rows = [&](const char* key) {
        return study.contains(key) && study[key].is_array() &&
               std::ranges::all_of(study[key], is_row);
    };
    if (study.is_object() && study.contains("title") && study["title"].is_string() &&
        are_rows("rows") && are_rows("claims"))
        return study;
    out.add(code::not_a_study_result, {file, 1, 1, 1}, "these are not the results of a study",
            "write them by: lineshaft study STUDY.yaml --json >FILE.json");
    return {};
}

/// `early_20_5`, `speed=5 mm/s, radius=20 mm`.
std::string label_of(const Json& row) {
    if (const std::string name = row.value("name", ""); !name.empty()) return name;
    std::string label;
    for (const auto& [name, value] : row["set"].items())
        label += fmt::format("{}{}={}", label.empty() ? "" : ", ", name,
                             value.is_string() ? value.get<std::string>() : value.dump());
    return label;
}

/// The first trace of each case whose label `wanted` is found in. Paths are those that `study` was
/// called with, or lie beside its result.
std::vector<TracedCase> traced_cases(const Json& study, const std::string& study_path,
                                     const std::regex& wanted) {
    namespace fs = std::filesystem;
    std::vector<TracedCase> found;
    for (const Json& row : study["rows"]) {
        const auto traces = row.find("traces");
        if (traces == row.end() || !traces->is_array() || traces->empty() ||
            !traces->front().is_string())
            continue;
        std::string path = traces->front();
        std::error_code unknown;  // then it is not there
        if (const fs::path beside = fs::path(study_path).parent_path() / path;
            !fs::exists(path, unknown) && fs::exists(beside, unknown))
            path = beside.string();
        const std::string label = label_of(row);
        if (std::regex_search(label, wanted) &&
            std::ranges::find(found, path, &TracedCase::path) == found.end())
            found.push_back({label, path});
    }
    return found;
}

/// The cases of all studies that are drawn; without --cases not too many.
std::vector<TracedCase> choose_cases(const ReportCommand& command, const Json& studies,
                                     const std::vector<std::string>& paths, Diagnostics& out) {
    std::vector<TracedCase> chosen;
    try {
        const std::regex wanted(command.cases);
        for (std::size_t i = 0; i < studies.size(); ++i)
            for (TracedCase& one : traced_cases(studies[i], paths[i], wanted))
                chosen.push_back(std::move(one));
    } catch (const std::regex_error& error) {
        out.add(code::unusable_option, {},
                fmt::format("--cases: '{}' is not a regular expression: {}", command.cases,
                            error.what()));
        return {};
    }
    if (!command.cases.empty() && chosen.empty())
        out.add(code::unusable_option, {},
                fmt::format("--cases: no traced case has '{}'", command.cases),
                "trace the cases by: lineshaft study STUDY.yaml --json --traces DIR >FILE.json");
    if (command.cases.empty() && chosen.size() > most_traces_unasked) {
        if (!command.quiet)
            spdlog::info("{} of {} traces are drawn; --cases REGEX chooses others",
                         most_traces_unasked, chosen.size());
        chosen.resize(most_traces_unasked);
    }
    return chosen;
}

std::vector<ReportRun> read_runs(const ReportCommand& command, const std::vector<TracedCase>& cases,
                                 Diagnostics& out) {
    std::vector<ReportRun> runs;
    const auto add = [&](const std::string& label, const std::string& path) {
        auto run = read_run(path, command.signals, out);
        if (!run) return;
        run->label = label;
        runs.push_back(std::move(*run));
    };
    for (const std::string& path : command.inputs)
        if (!is_study_file(path)) add(path, path);
    for (const TracedCase& one : cases) add(one.label, one.path);
    return runs;
}

const ReportRun* with_signal(const std::vector<ReportRun>& runs, const std::string& name) {
    const auto it =
        std::ranges::find_if(runs, [&](const ReportRun& run) { return run.table.find(name); });
    return it == runs.end() ? nullptr : &*it;
}

/// Complains unless a run has the signal.
void require(const std::vector<ReportRun>& runs, const std::string& name, Diagnostics& out) {
    if (!with_signal(runs, name)) runs.front().table.require(name, out);
}

/// What the first program that says anything says under `report:`; the command line goes before.
Json arrangement(const std::vector<ReportRun>& runs) {
    const auto it = std::ranges::find_if(
        runs, [](const ReportRun& run) { return run.arrangement.is_object(); });
    return it == runs.end() ? Json::object() : it->arrangement;
}

Json paths_json(const ReportCommand& command, const std::vector<ReportRun>& runs, const Json& said,
                Diagnostics& out) {
    Json list = Json::array();
    const auto add = [&](const std::string& x, const std::string& y) {
        const Json pair{{"x", x}, {"y", y}};
        if (std::ranges::find(list, pair) == list.end()) list.push_back(pair);
    };
    if (!runs.empty() && !command.path.empty()) {
        for (const std::string& name : command.path) require(runs, name, out);
        add(command.path[0], command.path[1]);
        return list;
    }
    if (said.contains("paths") && command.signals.empty()) return said["paths"];
    for (const ReportRun& run : runs)
        for (const PathPair& pair : find_paths(run)) add(pair.x, pair.y);
    return list;
}

/// What `--while` names.
Json condition_json(const ReportCommand& command, const std::vector<ReportRun>& runs,
                    const Json& said, Diagnostics& out) {
    if (command.condition.empty() || runs.empty()) return said.value("while", Json());
    require(runs, command.condition, out);
    return command.condition;
}

std::string title(const ReportCommand& command, const Json& report) {
    if (!command.title.empty()) return command.title;
    for (const char* key : {"runs", "studies"})
        for (const Json& part : report[key])
            if (const auto text = part["title"].get<std::string>(); !text.empty()) return text;
    return command.inputs.empty() ? "A study" : command.inputs.front();
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at))
        at = text.replace(at, what.size(), by).find(by, at) + by.size();
    return text;
}

std::string html(const std::string& text) {
    return replaced(replaced(text, "&", "&amp;"), "<", "&lt;");
}

/// The report as text that cannot end the <script> it stands in.
std::string script(const Json& report) {
    return replaced(report.dump(-1, ' ', false, Json::error_handler_t::replace), "<", "\\u003c");
}

std::string page(const Json& report) {
    const std::string text(reinterpret_cast<const char*>(page_bytes), sizeof page_bytes);
    constexpr std::string_view title_mark = "{{title}}", data_mark = "{{data}}";
    const std::size_t title_at = text.find(title_mark), data_at = text.find(data_mark);
    return text.substr(0, title_at) + html(report["title"].get<std::string>()) +
           text.substr(title_at + title_mark.size(), data_at - title_at - title_mark.size()) +
           script(report) + text.substr(data_at + data_mark.size());
}

/// The report of `studies`, which were read from `paths`, and of the command's traces.
Json make_report(const ReportCommand& command, Json studies, const std::vector<std::string>& paths,
                 Diagnostics& out) {
    const auto cases = choose_cases(command, studies, paths, out);
    const std::vector<ReportRun> runs = read_runs(command, cases, out);
    if (!out.empty()) return {};
    Json said = arrangement(runs);
    Json report{{"title", ""},
                {"runs", Json::array()},
                {"studies", std::move(studies)},
                {"runs_first", !runs.empty() && runs.size() > cases.size()},
                {"paths", paths_json(command, runs, said, out)},
                {"while", condition_json(command, runs, said, out)},
                {"circle", said.value("circle", Json())},
                {"band", said.value("band", Json())},
                {"arrangement", said}};
    ProgressLine line(command.quiet);
    for (const ReportRun& run : runs) {
        line.show([&](double) { return fmt::format("packing {}", run.path); });
        report["runs"].push_back(to_json(run));
    }
    if (!command.circle.empty())
        report["circle"] = {
            {"x", command.circle[0]}, {"y", command.circle[1]}, {"radius", command.circle[2]}};
    report["title"] = title(command, report);
    return report;
}

/// Says how to add what a build without the page lacks.
bool can_draw() {
    if (std::size(page_bytes) > 1) return true;
    spdlog::error(
        "this lineshaft was built without uPlot, which draws the page; in the project's folder: "
        "tools/setup && cmake --preset release && cmake --build --preset release "
        "(lineshaft plot draws by gnuplot)");
    return false;
}

Exit write(const ReportCommand& command, Json studies, const std::vector<std::string>& paths,
           Diagnostics& out) {
    Json report;
    if (out.empty()) report = make_report(command, std::move(studies), paths, out);
    if (!out.empty()) return lineshaft::report(out, false);
    OutputFile file(command.output);
    file.write(page(report));
    if (!file.commit()) {
        spdlog::error("{}", file.error());
        return Exit::fault;
    }
    if (!command.quiet && command.output != "-") fmt::print("report: {}\n", command.output);
    return Exit::fine;
}

Exit execute(const ReportCommand& command) {
    if (!can_draw()) return Exit::wrong;
    if (!command.circle.empty() && command.circle[2] <= 0) {
        spdlog::error("--circle: the radius must be above 0, not {}", command.circle[2]);
        return Exit::wrong;
    }
    Diagnostics out;
    check_outputs({command.output}, command.inputs, out);
    Json studies = Json::array();
    std::vector<std::string> paths;
    for (const std::string& path : command.inputs)
        if (is_study_file(path)) {
            studies.push_back(read_study_results(path, out));
            paths.push_back(path);
        }
    return write(command, std::move(studies), paths, out);
}

}  // namespace

Exit write_report(std::vector<std::string> inputs, std::vector<std::string> signals,
                  const std::string& output, bool quiet) {
    ReportCommand command;
    command.inputs = std::move(inputs);
    command.signals = std::move(signals);
    command.output = output;
    command.quiet = quiet;
    return execute(command);
}

Exit report_study(const nlohmann::ordered_json& study, const std::string& output, bool quiet) {
    if (!can_draw()) return Exit::wrong;
    ReportCommand command;
    command.output = output;
    command.title = study.value("title", "");
    command.quiet = quiet;
    Diagnostics out;
    return write(command, Json::array({study}), {""}, out);
}

void add_report(CLI::App& app, Exit& result) {
    auto command = std::make_shared<ReportCommand>();
    CLI::App* sub = app.add_subcommand("report", "Make a page of traces and studies to look at");
    sub->add_option("inputs", command->inputs, "Traces (.csv) and results of studies (.json)")
        ->required();
    sub->add_option("-o,--output", command->output, "Write the page to this HTML file")
        ->type_name("FILE")
        ->required();
    add_signals(*sub, "--signals", command->signals, "Draw these signals only: a.x,b.y")
        ->type_name("NAMES");
    add_signals(*sub, "--path", command->path,
                "Draw these two signals as a path: x.position,y.position", 2)
        ->type_name("X,Y");
    sub->add_option("--circle", command->circle,
                    "Compare the path with this circle, in the path's unit; else with one that is "
                    "found in the path")
        ->type_name("X,Y,RADIUS")
        ->delimiter(',')
        ->expected(3);
    sub->add_option("--while", command->condition,
                    "Take a path for the circle only while this signal is true: move.Active")
        ->type_name("SIGNAL");
    sub->add_option("--cases", command->cases,
                    "Of a study's traces, draw those of the cases that this finds: early|centred")
        ->type_name("REGEX");
    sub->add_option("--title", command->title, "Headline; else the program's title");
    sub->add_flag("--quiet", command->quiet, "Print messages only");
    sub->footer(report_help);
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
