#include <filesystem>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "runtime/trace/output_file.hpp"
#include "tools/lineshaft/command.hpp"
#include "tools/lineshaft/new_project.hpp"

namespace lineshaft {

namespace {

/// {0} is the file's name without its ending, {1} to {3} are it and what is made of it as a shell
/// takes them.
constexpr const char* program_text =
    R"(# {0}: one axis, and one command to it. Try, and then change:
#   lineshaft run {1} --trace {2}       expectations, and the trace below
#   lineshaft report {2} -o {3}         a page to look at
#   lineshaft test {1}                      the same as a regression test
#   lineshaft blocks MC_MoveAbsolute             a block's pins; lineshaft form: all that a program may say
lineshaft: 1
title: One axis, one move
parameters:                      # --set target=80mm
  target: 50 mm
tasks:                           # the larger priority runs first
  servo: {{every: 1 ms, priority: 26}}
  main: {{every: 10 ms}}
blocks:
  x:
    type: axis                   # the technology object; commands refer to it
    task: servo
    default_velocity: 100 mm/s
    default_acceleration: 1000 mm/s^2
    default_deceleration: 1000 mm/s^2
    default_jerk: 5e4 mm/s^3
  move:
    type: MC_MoveAbsolute
    task: main                   # what it commands counts when this task has published it
    Axis: x
    Position: $target
    Execute: inputs.start        # a wire; a rising edge starts the move
inputs: {{start: false}}           # from outside
stimulus:
  - {{at: 20 ms, set: {{inputs.start: true}}}}
run: {{for: 1.5 s}}
trace: {{task: servo, signals: [x.position, x.velocity, x.acceleration, x.state, move.Done]}}
expect:
  - {{within 1 s of inputs.start: move.Done}}
  - {{at: end, x.position: $target, within: 1e-9 mm}}
  - {{always: x.velocity, at_most: 100.000001 mm/s}}
)";

struct NewCommand {
    std::string name, project;
    bool quiet = false;
};

std::string first_program(const std::string& name) {
    return fmt::format(program_text, name, shell_word(name + ".yaml"), shell_word(name + ".csv"),
                       shell_word(name + ".html"));
}

Exit execute(const NewCommand& command) {
    std::filesystem::path path = command.name;
    if (!path.has_filename()) {
        spdlog::error("'{}' names no file: lineshaft new shaft.yaml", command.name);
        return Exit::wrong;
    }
    if (path.extension() == ".yml") path.replace_extension();
    if (path.extension() != ".yaml") path += ".yaml";
    std::error_code unknown;
    if (std::filesystem::exists(path, unknown)) {
        spdlog::error("'{}' is there already; name another file", path.string());
        return Exit::wrong;
    }
    Diagnostics out;
    check_outputs({path.string()}, {}, out);
    const std::string text = command.project.empty() ? first_program(path.stem().string())
                                                     : program_around(command.project, path, out);
    if (!out.empty() || !out.warnings().empty()) report(out, false);
    if (!out.empty()) return Exit::wrong;
    const std::string option =
        command.project.empty() ? std::string() : include_option(command.project, path);
    OutputFile file(path.string());
    file.write(text);
    if (!file.commit()) {
        spdlog::error("{}", file.error());
        file.discard();
        return Exit::fault;
    }
    if (!command.quiet)
        fmt::print("{}: a program that runs; try: lineshaft run {}{}\n", path.string(),
                   shell_word(path.string()), option);
    return Exit::fine;
}

}  // namespace

void add_new(CLI::App& app, Exit& result) {
    auto command = std::make_shared<NewCommand>();
    CLI::App* sub = app.add_subcommand("new", "Write a commented program to begin with");
    sub->add_option("name", command->name, "The program's file; .yaml may be left out")->required();
    sub->add_option("--from", command->project,
                    "Write it around a project of another tool: TwinCAT (.plcproj), PLCopen XML, "
                    "sources, or a folder of them")
        ->type_name("PROJECT");
    add_dialect(*sub);
    sub->add_flag("--quiet", command->quiet, "Print messages only");
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
