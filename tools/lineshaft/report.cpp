#include <filesystem>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "runtime/source/yaml.hpp"
#include "runtime/trace/output_file.hpp"
#include "tools/lineshaft/command.hpp"
#include "tools/lineshaft/report_data.hpp"

namespace lineshaft {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* report_help =
    "Inputs are traces (run --trace FILE.csv) and studies (study --json >FILE.json). Traces of "
    "the\n"
    "same signals are laid over each other, the second one dashed. Two lengths whose names differ\n"
    "by x for y only, as x.position and y.position, are drawn as a path, too, beside a circle "
    "with\n"
    "the deviation magnified. The page needs no network and nothing but a browser.";

/// tools/report/page with uPlot in it, made by tools/report/bundle.mjs; empty in a build without.
constexpr unsigned char page_bytes[] = {
#ifdef LINESHAFT_PAGES
#include "report_page.inc"
#else
    0
#endif
};

struct ReportCommand {
    std::vector<std::string> inputs, signals, path;
    std::vector<double> circle;
    std::string output, title, condition;
    bool quiet = false;
};

bool is_study_file(const std::string& path) {
    return std::filesystem::path(path).extension() == ".json";
}

/// What `study --json` printed; L0726 when it is anything else.
Json read_study_results(const std::string& path, Diagnostics& out) {
    const auto file = read_source(path, out);
    if (!file) return {};
    Json study = Json::parse(file->text, nullptr, false);
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
    out.add("L0726", {file, 1, 1, 1}, "these are not the results of a study",
            "write them by: lineshaft study STUDY.yaml --json >FILE.json");
    return {};
}

std::vector<ReportRun> read_runs(const ReportCommand& command, Diagnostics& out) {
    std::vector<ReportRun> runs;
    for (const std::string& path : command.inputs) {
        if (is_study_file(path)) continue;
        if (auto run = read_run(path, command.signals, out)) runs.push_back(std::move(*run));
    }
    for (std::size_t i = 1; i < runs.size() && out.empty(); ++i)
        check_overlay(runs.front(), runs[i], out);
    return runs;
}

Json paths_json(const ReportCommand& command, const std::vector<ReportRun>& runs,
                Diagnostics& out) {
    Json list = Json::array();
    if (runs.empty()) return list;
    if (command.path.empty())
        for (const PathPair& pair : find_paths(runs.front()))
            list.push_back({{"x", pair.x}, {"y", pair.y}});
    else if (runs.front().table.require(command.path[0], out) &&
             runs.front().table.require(command.path[1], out))
        list.push_back({{"x", command.path[0]}, {"y", command.path[1]}});
    return list;
}

/// What `--while` names.
Json condition_json(const ReportCommand& command, const std::vector<ReportRun>& runs,
                    Diagnostics& out) {
    if (command.condition.empty() || runs.empty()) return nullptr;
    runs.front().table.require(command.condition, out);
    return command.condition;
}

std::string title(const ReportCommand& command, const Json& report) {
    if (!command.title.empty()) return command.title;
    for (const char* key : {"runs", "studies"})
        for (const Json& part : report[key])
            if (const auto text = part["title"].get<std::string>(); !text.empty()) return text;
    return command.inputs.front();
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

Json make_report(const ReportCommand& command, Diagnostics& out) {
    const std::vector<ReportRun> runs = read_runs(command, out);
    Json report{{"title", ""},
                {"runs", Json::array()},
                {"studies", Json::array()},
                {"paths", paths_json(command, runs, out)},
                {"while", condition_json(command, runs, out)},
                {"circle", nullptr}};
    for (const std::string& path : command.inputs)
        if (is_study_file(path)) report["studies"].push_back(read_study_results(path, out));
    if (!out.empty()) return report;
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

Exit execute(const ReportCommand& command) {
    if (std::size(page_bytes) == 1) {
        spdlog::error(
            "this lineshaft was built without uPlot, which draws the page; in the project's "
            "folder: "
            "tools/setup && cmake --preset release && cmake --build --preset release "
            "(lineshaft plot draws by gnuplot)");
        return Exit::wrong;
    }
    if (!command.circle.empty() && command.circle[2] <= 0) {
        spdlog::error("--circle: the radius must be above 0, not {}", command.circle[2]);
        return Exit::wrong;
    }
    Diagnostics out;
    check_outputs({command.output}, command.inputs, out);
    const Json report = make_report(command, out);
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

void add_report(CLI::App& app, Exit& result) {
    auto command = std::make_shared<ReportCommand>();
    CLI::App* sub = app.add_subcommand("report", "Make a page of traces and studies to look at");
    sub->add_option("inputs", command->inputs, "Traces (.csv) and results of studies (.json)")
        ->required();
    sub->add_option("-o,--output", command->output, "Write the page to this HTML file")
        ->type_name("FILE")
        ->required();
    sub->add_option("--signals", command->signals, "Draw these signals only: a.x,b.y")
        ->type_name("NAMES")
        ->delimiter(',');
    sub->add_option("--path", command->path,
                    "Draw these two signals as a path: x.position,y.position")
        ->type_name("X,Y")
        ->delimiter(',')
        ->expected(2);
    sub->add_option("--circle", command->circle,
                    "Compare the path with this circle, in the path's unit; else with one that is "
                    "found in the path")
        ->type_name("X,Y,RADIUS")
        ->delimiter(',')
        ->expected(3);
    sub->add_option("--while", command->condition,
                    "Take a path for the circle only while this signal is true: g.moving")
        ->type_name("SIGNAL");
    sub->add_option("--title", command->title, "Headline; else the program's title");
    sub->add_flag("--quiet", command->quiet, "Print messages only");
    sub->footer(report_help);
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
