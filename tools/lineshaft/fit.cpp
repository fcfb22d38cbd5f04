#include "runtime/fit/fit.hpp"

#include <cmath>
#include <thread>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "blocks/catalog.hpp"
#include "runtime/trace/output_file.hpp"
#include "tools/lineshaft/command.hpp"
#include "tools/lineshaft/fit_table.hpp"

namespace lineshaft {

namespace {

constexpr const char* fit_help =
    "The plan names parameters of a program with bounds, and cases with what was measured of "
    "them:\n"
    "  lineshaft_fit: 1\n"
    "  program: jerk_line.yaml\n"
    "  parameters: {interrupt_cost: {from: 0 ms, to: 1 ms}}\n"
    "  cases:\n"
    "    - {set: {x: 7.5 cm}, compare: {line.time: {paper: 8.449 s}}}\n"
    "    - {set: {x: 6 cm}, hold_out: true, compare: {line.time: {paper: 7.443 s, within: 5 ms}}}\n"
    "Cases with hold_out are only compared with what the others have found; hold_out: each also\n"
    "leaves out each case in turn. 'lineshaft form fit' has the keys. Exit code 1: a value is\n"
    "outside of its 'within'.";

struct FitCommand {
    CommonOptions common;
    std::string plan, output;
    unsigned jobs = std::max(1u, std::thread::hardware_concurrency());
};

FitReport search(const FitPlan& plan, const Catalog& catalog, const FitCommand& command) {
    ProgressLine line(command.common.quiet || command.common.json);
    const auto progress = [&](const FitProgress& p) {
        line.show([&](double elapsed) {
            const std::string where =
                p.left_out > 0 ? fmt::format("without case {} of {}", p.left_out, plan.cells.size())
                               : fmt::format("start {} of {}", p.start, plan.starts);
            return fmt::format("{}, {} runs, {:.1f} a second, {}", where, p.runs,
                               static_cast<double>(p.runs) / elapsed,
                               std::isfinite(p.sum)
                                   ? fmt::format("least sum of squares {:.6g}", p.sum)
                                   : "no sum of squares yet");
        });
    };
    return run(plan, catalog,
               {.jobs = command.jobs, .interrupt = &interrupt_requested, .progress = progress});
}

void print(const FitPlan& plan, const FitReport& result, const CommonOptions& common) {
    if (common.json) return fmt::print("{}\n", fit_json(plan, result).dump(2));
    fmt::print("{}", fit_table(plan, result));
    if (!common.quiet)
        fmt::print("\n{} runs, wall time {:.2f} s\n", result.runs, result.wall_seconds);
}

Exit execute(const FitCommand& command) {
    Diagnostics out;
    const LoadOptions options = command.common.load_options(out);
    const Catalog catalog = standard_blocks();
    const auto file = read_source(command.plan, out);
    FitPlan plan;
    if (file) plan = read_fit(file, options, catalog, out);
    check_outputs({command.output}, {}, out);
    if (!out.empty()) return report(out, command.common.json);

    const FitReport result = search(plan, catalog, command);
    print(plan, result, command.common);
    if (result.interrupted) return Exit::interrupted;
    if (!command.output.empty() && !result.values.empty()) {
        OutputFile yaml(command.output);
        yaml.write(fit_settings(plan, result));
        if (!yaml.commit()) {
            spdlog::error("{}", yaml.error());
            return Exit::fault;
        }
    }
    if (!result.faults.empty() || result.values.empty()) return Exit::fault;
    return result.ok() ? Exit::fine : Exit::failed;
}

}  // namespace

void add_fit(CLI::App& app, Exit& result) {
    auto command = std::make_shared<FitCommand>();
    CLI::App* sub = app.add_subcommand(
        "fit", "Identify a program's parameters from measured figures or traces");
    sub->footer(fit_help);
    sub->add_option("plan", command->plan, "The plan, a YAML file")->required();
    sub->add_option("-o,--output", command->output, "Write the values found as a study's 'set:'")
        ->type_name("OUT.yaml");
    sub->add_option("-j,--jobs", command->jobs, "Runs side by side")
        ->check(CLI::Range(1u, 1024u))
        ->capture_default_str();
    command->common.add_to(*sub);
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
