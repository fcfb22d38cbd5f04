#include "runtime/serve/serve.hpp"

#include <cmath>

#include <fmt/core.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include "runtime/serve/api.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/input_file.hpp"
#include "runtime/source/reader.hpp"
#include "tools/lineshaft/run_command.hpp"

namespace lineshaft {

namespace {

using Json = nlohmann::ordered_json;

#ifdef LINESHAFT_PAGES
/// tools/report/live with uPlot in it, made by tools/report/bundle.mjs.
constexpr unsigned char live_page_bytes[] = {
#include "live_page.inc"
};

std::string_view live_page() {
    return {reinterpret_cast<const char*>(live_page_bytes), sizeof live_page_bytes};
}
#else
std::string_view live_page() {
    return "This lineshaft was built without uPlot, which draws the page; tools/setup adds it.";
}
#endif

constexpr const char* serve_help =
    "The machine runs until ^C, or for the time of --for, whatever 'run:' says; its expectations\n"
    "are not judged. Its virtual times are exact whatever the clock does: scans that come late\n"
    "are counted, and told at the end. 'lineshaft run PROGRAM.yaml --recording FILE.yaml' does\n"
    "again what was done by the clients, to the same bytes.";

struct ServeCommand {
    RunCommand run;
    std::string speed = "1", duration, record, record_sync = "each", audit, http = "127.0.0.1:8080",
                modbus, token_file;
    WhenLate late = WhenLate::catch_up;
    int realtime = 0;
    bool allow_write = false, openapi = false;
};

/// L0305 for what is neither `max` nor above 0.
double speed_of(const std::string& text, Diagnostics& out) {
    if (text == "max") return Pacer::unpaced;
    const auto speed = Reader(out).quantity(node_of(text), "expected a number, or max");
    if (!speed ||
        (!speed->has_unit && speed->number >= Pacer::least && speed->number <= Pacer::most))
        return speed ? speed->number : 1;
    out.add(code::number_out_of_range, {}, fmt::format("'{}' is not a speed", text),
            "write --speed 1 for the clock's, 0.1, 10, or max; from 1e-6 to 1e6");
    return 1;
}

std::int64_t end_of(const std::string& text, Diagnostics& out) {
    if (text.empty()) return never;
    return Reader(out).time(node_of(text)).value_or(never);
}

/// L0305 for what is neither a time nor one of the words.
RecordSync sync_of(const std::string& text, Diagnostics& out) {
    if (text == "each") return {RecordSync::each};
    if (text == "none") return {RecordSync::none};
    Diagnostics of_time;
    const auto time = Reader(of_time).time(node_of(text));
    if (time && *time > 0) return {*time};
    out.add(code::number_out_of_range, {},
            fmt::format("'{}' is not a time for --record-sync", text),
            "write each, none, or a time such as '10 ms'");
    return {};
}

/// Port 0 for none.
Address address_of(const std::string& text, const char* option, Diagnostics& out) {
    if (text.empty() || text == "off") return {};
    if (const auto address = Address::parse(text)) return *address;
    out.add(code::unusable_address, {}, fmt::format("'{}' is not an address", text),
            fmt::format("write {} 127.0.0.1:8080, or off", option));
    return {};
}

/// The first line of the file.
std::string token_of(const std::string& path, Diagnostics& out) {
    constexpr std::size_t shortest = 16, most = 4096;
    if (path.empty()) return {};
    int error = 0;
    const std::string text = read_bytes(path, most, error);
    const std::string token = text.substr(0, text.find_first_of("\r\n"));
    if (error != 0 || token.size() < shortest)
        out.add(code::no_token, {}, fmt::format("'{}' has no token of 16 characters or more", path),
                "make one: openssl rand -hex 16 >token; chmod 600 token");
    else if (struct stat file{}; ::stat(path.c_str(), &file) == 0 && (file.st_mode & 077) != 0)
        spdlog::warn("others on this machine may read or change the token in '{}': chmod 600 '{}'",
                     path, path);
    return token;
}

ServeOptions serve_options(const ServeCommand& command, Diagnostics& out) {
    const HttpOptions http{
        .address = address_of(command.http, "--http", out),
        .guard = {.allow_write = command.allow_write, .token = token_of(command.token_file, out)},
        .page = live_page(),
        .tell = [](const std::string& text) { spdlog::warn("{}", text); }};
    return {.live = {.speed = speed_of(command.speed, out),
                     .late = command.late,
                     .end = end_of(command.duration, out),
                     .interrupt = &interrupt_requested},
            .realtime = command.realtime,
            .record = !command.record.empty() ? command.record
                      : command.allow_write   ? "recording.yaml"
                                              : "",
            .sync = sync_of(command.record_sync, out),
            .audit = command.audit,
            .http = http,
            .modbus = address_of(command.modbus, "--modbus", out)};
}

/// On stderr, for the results go to stdout.
void tell_where(const ServeCommand& command, const ServeOptions& options,
                const std::string& record) {
    if (command.run.common.quiet) return;
    std::string text = fmt::format("serving {}", command.run.program);
    if (options.http.address.port > 0)
        text += fmt::format(" at http://{}/", options.http.address.text());
    if (options.modbus.port > 0) text += fmt::format(", Modbus/TCP at {}", options.modbus.text());
    if (!options.http.guard.allow_write)
        text += ", to be looked at only (--allow-write allows more)";
    if (!record.empty()) text += ", recording to " + record;
    if (record != options.record)
        text += fmt::format(", for {} is of a machine that was killed", options.record);
    fmt::print(stderr, "{}; ^C ends it\n", text);
}

void print_pace(const Pace& pace, std::FILE* out) {
    const auto us = [](std::int64_t time) { return static_cast<double>(time) / 1e3; };
    for (const TaskPace& task : pace.tasks)
        if (const Lateness& late = task.lateness; late.count() > 0)
            fmt::print(out,
                       "{}: {} scans, late by {:.1f} us (p50), {:.1f} us (p99), {:.1f} us (p99.9), "
                       "{:.1f} us (greatest), {} overruns\n",
                       task.name, late.count(), us(late.quantile(0.5)), us(late.quantile(0.99)),
                       us(late.quantile(0.999)), us(late.greatest()), task.overruns);
    if (pace.skipped > 0)
        fmt::print(out, "the clock was put off by {} in all\n", format_time(pace.skipped));
}

Exit execute(const ServeCommand& command) {
    if (command.openapi) {
        fmt::print("{}\n", openapi().dump(2));
        return Exit::fine;
    }
    Diagnostics out;
    const ServeOptions options = serve_options(command, out);
    RunOptions how = run_options(command.run, out);
    how.interrupt = nullptr;
    auto loaded = load(command.run, {options.record, options.audit}, out);
    if (loaded && options.modbus.port > 0 && loaded->linked.modbus.empty())
        out.add(code::no_trace_to_write, {loaded->program.file, 0, 0, 1},
                "the program has no 'modbus:' for clients of --modbus",
                "say under 'modbus:' which signals they find where");
    if (!loaded || !out.empty()) return report(out, command.run.common.json);
    const ServeReport served = serve(*loaded, how, options, [&](const std::string& record) {
        tell_where(command, options, record);
    });
    const Exit exit = tell(command.run, *loaded, served.run, {{"serving", to_json(served.pace)}});
    if (!served.run.refused.empty()) return exit;
    if (!command.run.common.json && !command.run.common.quiet)
        print_pace(served.pace, command.run.trace == "-" ? stderr : stdout);
    if (const std::int64_t overruns = served.pace.overruns(); overruns > 0)
        spdlog::warn("{} scans were a whole interval late: this machine did not keep up", overruns);
    for (const std::string& error : {served.recording_error, served.audit_error})
        if (!error.empty()) spdlog::error("{}", error);
    return served.recording_error.empty() && served.audit_error.empty() ? exit : Exit::fault;
}

}  // namespace

void add_serve(CLI::App& app, Exit& result) {
    auto command = std::make_shared<ServeCommand>();
    CLI::App* sub =
        app.add_subcommand("serve", "Run a program by the clock, for others to talk to");
    sub->footer(serve_help);
    command->run.add_to(*sub);
    sub->add_option("--speed", command->speed,
                    "Virtual seconds a second: 1 is the clock's; max does not wait")
        ->type_name("NUMBER|max");
    sub->add_option("--for", command->duration, "Stop when so much virtual time has passed")
        ->type_name("TIME");
    const std::map<std::string, WhenLate> ways{{"catch_up", WhenLate::catch_up},
                                               {"skip", WhenLate::skip}};
    sub->add_option("--late", command->late,
                    "When a scan is a whole interval late: catch_up, the next ones follow at once; "
                    "skip, the clock is put off")
        ->transform(one_of(ways))
        ->type_name("catch_up|skip");
    sub->add_option("--realtime", command->realtime,
                    "Run before all other programs: SCHED_FIFO at this priority, memory locked")
        ->check(CLI::Range(1, 99))
        ->type_name("PRIORITY");
    sub->add_option("--record", command->record, "Write what comes from clients to this file")
        ->type_name("FILE.yaml");
    sub->add_option("--record-sync", command->record_sync,
                    "When what is recorded is handed to the disk: each, before it is acknowledged; "
                    "a time, so long after it at most; none, when the system likes. A machine that "
                    "is killed has recorded what it acknowledged with all of them")
        ->capture_default_str()
        ->type_name("each|TIME|none");
    sub->add_option("--audit", command->audit,
                    "Append to this file who wanted to change what, and the answer: a line of JSON "
                    "each, also of what was refused")
        ->type_name("FILE");
    sub->add_option("--http", command->http, "Where the page and the API are; off: nowhere")
        ->capture_default_str()
        ->type_name("ADDRESS:PORT");
    sub->add_option("--modbus", command->modbus,
                    "Where clients of Modbus/TCP find what the program's 'modbus:' says, such as "
                    "127.0.0.1:1502")
        ->type_name("ADDRESS:PORT");
    sub->add_flag("--allow-write", command->allow_write,
                  "Let clients set inputs, force signals, pause and step; what they write is "
                  "recorded, to recording.yaml unless --record says where");
    sub->add_option("--token-file", command->token_file,
                    "A file whose first line clients of other machines send to write by HTTP: "
                    "Authorization: Bearer TOKEN. By Modbus they only read")
        ->type_name("FILE");
    sub->add_flag("--openapi", command->openapi, "Print the API's description and end")
        ->trigger_on_parse();
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
