#include <thread>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "blocks/catalog.hpp"
#include "runtime/study/study_reader.hpp"
#include "runtime/study/study_runner.hpp"
#include "runtime/study/table.hpp"
#include "tools/lineshaft/command.hpp"

namespace lineshaft {

namespace {

struct StudyCommand {
    CommonOptions common;
    std::string plan;
    unsigned jobs = std::max(1u, std::thread::hardware_concurrency());
};

Exit execute(const StudyCommand& command) {
    Diagnostics out;
    const LoadOptions options = command.common.load_options(out);
    const Catalog catalog = standard_blocks();
    const auto file = read_source(command.plan, out);
    Study study;
    if (file) study = read_study(file, options, catalog, out);
    if (!out.empty()) return report(out, command.common.json);

    ProgressLine line(command.common.quiet || command.common.json);
    const auto progress = [&](std::size_t done, std::size_t all) {
        line.show([&](double elapsed) {
            const double rate = static_cast<double>(done) / elapsed;
            return fmt::format("{} of {} cases, {:.1f} a second, {:.0f} s left", done, all, rate,
                               static_cast<double>(all - done) / rate);
        });
    };
    const StudyReport result =
        run(study, catalog,
            {.jobs = command.jobs, .interrupt = &interrupt_requested, .progress = progress});
    if (command.common.json)
        fmt::print("{}\n", study_json(study, result).dump(2));
    else {
        fmt::print("{}", study_table(study, result));
        if (!command.common.quiet)
            fmt::print(
                "\n{} cases, machine time {:.1f} s, wall time {:.2f} s, {:.0f} times faster than "
                "the clock\n",
                study.cases.size(), result.machine_seconds, result.wall_seconds,
                result.machine_seconds / result.wall_seconds);
    }
    if (result.interrupted) return Exit::interrupted;
    if (!result.faults.empty()) return Exit::fault;
    return result.ok() ? Exit::fine : Exit::failed;
}

}  // namespace

void add_study(CLI::App& app, Exit& result) {
    auto command = std::make_shared<StudyCommand>();
    CLI::App* sub =
        app.add_subcommand("study", "Run a program's cases; print the paper's figures beside ours");
    sub->add_option("plan", command->plan, "The study, a YAML file")->required();
    sub->add_option("-j,--jobs", command->jobs, "Runs side by side")
        ->check(CLI::Range(1u, 1024u))
        ->capture_default_str();
    command->common.add_to(*sub);
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
