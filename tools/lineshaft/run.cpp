#include <filesystem>
#include <map>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "blocks/catalog.hpp"
#include "runtime/csv/csv_metadata.hpp"
#include "runtime/run/signal_json.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/reader.hpp"
#include "runtime/st/library/text_variables.hpp"
#include "runtime/st/types/value_text.hpp"
#include "runtime/trace/event_writer.hpp"
#include "runtime/trace/trace_files.hpp"
#include "tools/lineshaft/run_command.hpp"

namespace lineshaft {

namespace {

using Json = nlohmann::ordered_json;

void print_json(const Loaded& loaded, const RunReport& report, const Json& more) {
    const Machine& machine = loaded.linked.machine;
    nlohmann::ordered_json scans, signals;
    for (std::size_t i = 0; i < machine.tasks.size(); ++i)
        scans[machine.tasks[i].name] = report.result.scans[i];
    for (const Signal& signal : machine.signals)
        signals[signal.name] = to_json(signal, signal.value());
    auto expect = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < report.verdicts.size(); ++i) {
        expect.push_back(
            {{"text", loaded.linked.expectations[i].text}, {"ok", report.verdicts[i].ok}});
        if (report.verdicts[i].undecided) expect.back()["undecided"] = true;
        if (!report.verdicts[i].ok) expect.back()["deviation"] = report.verdicts[i].deviation;
    }
    nlohmann::ordered_json object{{"program", loaded.program.file->path},
                                  {"machine_time_s", seconds(report.result.time)},
                                  {"wall_time_s", wall_seconds()},
                                  {"scans", scans},
                                  {"time_errors", report.result.time_errors},
                                  {"warnings", report.warnings},
                                  {"signals", signals},
                                  {"expect", expect}};
    for (const TraceReport& trace : report.traces)
        object["traces"].push_back({{"name", trace.name},
                                    {"files", trace.paths},
                                    {"measurements", trace.measurements},
                                    {"rows", trace.rows}});
    if (report.faulted())
        object["fault"] = !report.output_error.empty()    ? report.output_error
                          : !report.restart_error.empty() ? report.restart_error
                                                          : report.result.message;
    if (more.is_object()) object.update(more);
    fmt::print("{}\n", object.dump(2));
}

/// What stands on the standard output when a file was to go there.
bool writes_to_stdout(const RunCommand& command) {
    return command.trace == "-" || command.pulses == "-";
}

void print_text(const RunCommand& command, const Loaded& loaded, const RunReport& report) {
    std::FILE* const out = writes_to_stdout(command) ? stderr : stdout;
    for (std::size_t i = 0; i < report.verdicts.size(); ++i) {
        const Verdict& verdict = report.verdicts[i];
        fmt::print(out, "{}  {}\n", verdict.word(), loaded.linked.expectations[i].text);
        if (!verdict.ok) fmt::print(out, "        {}\n", verdict.deviation);
    }
    if (command.common.quiet) return;
    const double machine_seconds = seconds(report.result.time), wall = wall_seconds();
    fmt::print(
        out, "{}: machine time {:.3f} s, wall time {:.3f} s, {:.0f} times faster than the clock\n",
        loaded.program.title, machine_seconds, wall, machine_seconds / wall);
    if (report.result.time_errors > 0)
        fmt::print(out, "time errors: {}\n", report.result.time_errors);
    if (!report.output_error.empty()) return;
    const auto tell = [out](const char* what, const std::string& path) {
        if (path != "-") fmt::print(out, "{}: {}\n", what, path);
    };
    for (const TraceReport& trace : report.traces)
        for (const std::string& path : trace.paths) tell("trace", path);
    if (!report.traces.empty() && command.trace != "-") tell("events", events_path(command.trace));
    if (!command.pulses.empty()) tell("pulses", command.pulses);
}

Exit exit_code(const RunReport& report) {
    const bool files_failed = !report.output_error.empty() || !report.restart_error.empty();
    if (files_failed && report.restart_error.empty() && is_unread()) return Exit::unread;
    if (files_failed) return Exit::fault;
    if (report.result.outcome == Outcome::interrupted) return Exit::interrupted;
    if (report.faulted()) return Exit::fault;
    return report.expectations_hold() ? Exit::fine : Exit::failed;
}

void add_style(CLI::App& sub, CsvStyle& style) {
    static const std::map<std::string, CsvStyle::Names> names{{"dot", CsvStyle::Names::dot},
                                                              {"slash", CsvStyle::Names::slash},
                                                              {"snake", CsvStyle::Names::snake}};
    static const std::map<std::string, bool> dialects{{"rfc4180", false}, {"excel-de", true}};
    sub.add_option("--names", style.names,
                   "Column names: dot (shaft.position), slash (PlotJuggler's tree) or snake")
        ->transform(one_of(names).description("dot|slash|snake"));
    sub.add_flag("--units", style.units, "Units in the header: shaft.position [mm]");
    sub.add_option("--dialect", style.excel_de,
                   "rfc4180, or excel-de: semicolons and decimal commas")
        ->transform(one_of(dialects).description("rfc4180|excel-de"));
}

/// L0509 for what else would go to the standard output.
void check_stdout(const RunCommand& command, const Loaded& loaded, Diagnostics& out) {
    const auto& traces = loaded.linked.traces;
    if (command.common.json)
        out.add(code::output_is_an_input, {},
                "'-' and --json would both write to the standard output", "name a file");
    if (command.trace == "-" && (traces.size() > 1 || (traces.size() == 1 && traces[0].repeat > 1)))
        out.add(code::output_is_an_input, {}, "the program records more than one trace",
                "name a file: --trace FILE.csv");
}

/// L0503, L0504, L0508 for a file that would have nothing in it.
void check_files(const RunCommand& command, const Loaded& loaded, Diagnostics& out) {
    const Mark program{loaded.program.file, 0, 0, 1};
    if (!command.trace.empty() && loaded.linked.traces.empty())
        out.add(code::no_trace_to_write, program,
                "the program has no 'trace:' to write to " + command.trace,
                "say under 'trace:' which task and signals to record");
    if (!command.pulses.empty() && loaded.linked.machine.devices.empty())
        out.add(code::no_pulses_to_write, program,
                "the program has no pulse channel to write to " + command.pulses,
                "'lineshaft blocks pto' describes one");
    if (!command.retain.empty() && loaded.linked.machine.retains_nothing())
        out.add(code::nothing_to_retain, program,
                "the program has nothing to keep in " + command.retain,
                "say under 'retain:' which blocks and signals outlive a run");
    if (writes_to_stdout(command)) check_stdout(command, loaded, out);
}

/// What `--show` prints: a signal, or a text, which is none.
struct Shown {
    std::string name;
    std::optional<Signal> signal = {};
    st::TextVariable text = {};
    const std::byte* block = nullptr;  ///< of a text

    std::string value() const {
        return signal ? signal->describe(signal->value())
                      : st::text_literal(st::text_of(text, block));
    }
    Json json() const {
        return signal ? to_json(*signal, signal->value())
                      : Json(st::printable(st::text_of(text, block)));
    }
};

/// An output of a block, or of one in Structured Text a variable of its own.
bool is_shown(const Net& net, const Signal& signal) {
    if (signal.port.instance < 0) return false;
    const Direction direction = net.field(signal.port).direction;
    return direction == Direction::output ||
           (direction == Direction::local && net.instance(signal.port.instance).type->owner);
}

/// `whole` itself, or a part of it.
bool is_in(std::string_view name, std::string_view whole) {
    return name.starts_with(whole) &&
           (name.size() == whole.size() || name[whole.size()] == '.' || name[whole.size()] == '[');
}

void add_texts(const BlockPlace& block, std::string_view wanted, std::vector<Shown>& to) {
    for (const st::TextVariable& text : st::text_variables(*block.type)) {
        std::string name = fmt::format("{}.{}", block.name, text.name);
        if (is_in(name, wanted)) to.push_back({std::move(name), {}, text, block.published});
    }
}

/// What `--show` names: signals and texts, or a block, a structure or an array with all that it
/// has.
std::vector<Shown> shown_signals(const RunCommand& command, Loaded& loaded, Diagnostics& out) {
    std::vector<Shown> shown;
    Machine& machine = loaded.linked.machine;
    const Net& net = loaded.linked.net;
    for (const std::string& name : command.shown) {
        const std::size_t before = shown.size();
        for (const Signal& signal : machine.signals)
            if (signal.name != name && is_in(signal.name, name) && is_shown(net, signal))
                shown.push_back({signal.name, signal});
        for (const BlockPlace& block : machine.blocks) add_texts(block, name, shown);
        if (shown.size() != before) continue;
        const Node node = node_of(name);
        const bool is_block =
            is_identifier(name) &&
            std::ranges::find(net.inputs, name, &InputNode::name) == net.inputs.end();
        if (is_block && net.find_block(Reader(out), node, name) < 0) continue;
        if (const auto signal = net.find(Reader(out), node, name))
            shown.push_back({signal->name, machine.placed(*signal)});
    }
    return shown;
}

/// The values at the end.
void print_shown(const RunCommand& command, const std::vector<Shown>& shown) {
    std::FILE* const out = writes_to_stdout(command) ? stderr : stdout;
    for (const Shown& one : shown) fmt::print(out, "{:28} {}\n", one.name, one.value());
}

/// What --trace writes.
void add_traces(const RunCommand& command, const Loaded& loaded, std::vector<std::string>& files) {
    if (command.trace.empty() || command.trace == "-") return files.push_back(command.trace);
    for (const TraceSetup& trace : loaded.linked.traces)
        for (const std::string& csv : trace_paths(command.trace, trace)) {
            files.push_back(csv);
            files.push_back(sidecar_path(csv));
        }
    files.push_back(events_path(command.trace));
}

Exit execute(const RunCommand& command) {
    Diagnostics out;
    RunOptions how = run_options(command, out);
    auto loaded = load(command, {}, out);
    if (!loaded) return report(out, command.common.json);

    const std::vector<Shown> shown = shown_signals(command, *loaded, out);
    if (!out.empty()) return report(out, command.common.json);

    ProgressLine line(command.common.quiet || command.common.json);
    const Machine& machine = loaded->linked.machine;
    const double whole = seconds(std::min(machine.duration, machine.end));
    how.progress = [&](std::int64_t time) {
        line.show([&](double elapsed) {
            return fmt::format("{:.1f} s of at most {:.1f} s, {:.0f} times faster than the clock",
                               seconds(time), whole, seconds(time) / elapsed);
        });
    };
    const RunReport result = run(*loaded, how);
    const bool has_run = result.refused.empty();
    Json more;
    for (const Shown& one : shown)
        if (has_run) more["show"][one.name] = one.json();
    const Exit exit = tell(command, *loaded, result, more);
    if (has_run && !command.common.json) print_shown(command, shown);
    return exit;
}

}  // namespace

RunOptions run_options(const RunCommand& command, Diagnostics& out) {
    namespace fs = std::filesystem;
    RunOptions options{.trace_path = command.trace,
                       .pulses_path = command.pulses,
                       .csv_style = command.style,
                       .interrupt = &interrupt_requested,
                       .progress = {},
                       .restart = command.resume ? Restart::hot : command.restart,
                       .retain_path = command.retain,
                       .checkpoint_path = command.checkpoint};
    if (options.checkpoint_path.empty())
        options.checkpoint_path = fs::path(command.program).stem().string() + ".checkpoint";
    if (command.checkpoint_every.empty()) return options;
    Node every;
    every.text = command.checkpoint_every;
    options.checkpoint_every = Reader(out).time(every).value_or(1);
    if (options.checkpoint_every == 0)
        out.add(code::not_a_time, {}, "--checkpoint-every must be above 0 s",
                "write 10s, for instance");
    return options;
}

std::optional<Loaded> load(const RunCommand& command, const std::vector<std::string>& outputs,
                           Diagnostics& out) {
    LoadOptions options = command.common.load_options(out);
    options.forces = command.forces;
    options.recording = command.recording;
    auto loaded = load_program(command.program, options, standard_blocks(), out);
    if (loaded) check_files(command, *loaded, out);
    std::vector<std::string> all{command.pulses, command.retain, command.checkpoint};
    all.insert(all.end(), outputs.begin(), outputs.end());
    if (loaded) add_traces(command, *loaded, all);
    check_outputs(all, {}, out);
    if (command.strict) out.be_strict();
    if (!out.empty()) return {};
    fmt::print(stderr, "{}", out.render());
    return loaded;
}

Exit tell(const RunCommand& command, const Loaded& loaded, const RunReport& result,
          const Json& more) {
    if (!result.refused.empty()) return report(result.refused, command.common.json);
    if (command.common.json)
        print_json(loaded, result, more);
    else
        print_text(command, loaded, result);
    for (const TraceReport& trace : result.traces)
        if (trace.measurements == 0)
            spdlog::warn("the trigger of trace '{}' did not come: {} has no rows",
                         trace.name.empty() ? "trace" : trace.name, trace.paths.front());
    for (const std::string& text : result.warnings) spdlog::warn("{}", text);
    for (const std::string& text : result.never_looked_at)
        spdlog::log(command.strict ? spdlog::level::err : spdlog::level::warn,
                    "'{}' is never looked at: its task never scans", text);
    const Exit exit = exit_code(result);
    if (exit == Exit::unread) return exit;
    if (!result.result.message.empty()) spdlog::error("{}", result.result.message);
    if (!result.output_error.empty()) spdlog::error("{}", result.output_error);
    if (!result.restart_error.empty()) spdlog::error("{}", result.restart_error);
    const bool unseen = command.strict && !result.never_looked_at.empty();
    return exit == Exit::fine && unseen ? Exit::failed : exit;
}

void RunCommand::add_to(CLI::App& sub) {
    sub.add_option("program", program, "The program, a YAML file")->required();
    sub.add_option("--trace", trace,
                   "Write the program's trace to this CSV file, the trace NAME of its 'traces:' to "
                   "FILE.NAME.csv; - is the standard output")
        ->type_name("FILE.csv");
    add_style(sub, style);
    sub.add_option(
           "--pulses", pulses,
           "Write the rising edges of all pulse channels to this CSV file; - is the standard "
           "output")
        ->type_name("FILE");
    sub.add_option(
           "--force", forces,
           "Keep a signal at a value, whatever the program writes: gear.RatioNumerator=2@1s..2s")
        ->type_name("SIGNAL=VALUE@FROM..UNTIL")
        ->take_all()
        ->expected(1, -1)
        ->trigger_on_parse(false);
    sub.add_option("--retain-file", retain,
                   "Begin with the retained values of this file, and keep them there at the end")
        ->type_name("FILE");
    const std::map<std::string, Restart> restarts{
        {"cold", Restart::cold}, {"warm", Restart::warm}, {"hot", Restart::hot}};
    sub.add_option("--restart", restart,
                   "cold: all initial values; warm: retained ones kept; hot: go on from the "
                   "checkpoint")
        ->transform(one_of(restarts))
        ->type_name("cold|warm|hot");
    sub.add_flag("--resume", resume, "Short for --restart hot");
    sub.add_option("--checkpoint", checkpoint,
                   "The checkpoint's file; default: the program's name with .checkpoint, here")
        ->type_name("FILE");
    sub.add_option("--checkpoint-every", checkpoint_every,
                   "Write a checkpoint each time so much virtual time has passed, such as 10s")
        ->type_name("TIME");
    add_strict(sub, strict);
    common.add_to(sub);
}

void add_run(CLI::App& app, Exit& result) {
    auto command = std::make_shared<RunCommand>();
    CLI::App* sub = app.add_subcommand("run", "Run a program and judge its expectations");
    command->add_to(*sub);
    sub->add_option("--recording", command->recording,
                    "Play back what 'lineshaft serve' recorded, and end where that ends")
        ->type_name("FILE.yaml");
    add_signals(
        *sub, "--show", command->shown,
        "Print what these are at the end: signals, texts, and blocks, structures and arrays "
        "with all that they have: x.position,main")
        ->type_name("SIGNALS");
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
