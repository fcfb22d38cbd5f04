#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>

#include <arpa/inet.h>
#include <fmt/core.h>
#include <netinet/in.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <unistd.h>

#include "blocks/catalog.hpp"
#include "runtime/debug/adapter.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/encoding.hpp"
#include "runtime/source/yaml_text.hpp"
#include "tools/lineshaft/run_command.hpp"
#include "tools/lineshaft/test_files.hpp"

namespace lineshaft {

namespace {

constexpr const char* debug_help =
    "Speaks the Debug Adapter Protocol on its standard streams, or with one client at --port: an\n"
    "editor starts it. Arguments of 'launch': program, the file (else the one of this command\n"
    "line); args, options as of this command, ['--set', 'x=1', '--trace', 'FILE.csv']; cwd;\n"
    "stopOnEntry; stopAtEnd; test, the name of a TEST, if the program is a file of tests, or a\n"
    "folder with some. Breakpoints stand in Structured Text; tasks are threads; stepBack and\n"
    "reverseContinue go back. The run is that of 'lineshaft run', to the same bytes.\n"
    "Breakpoints take conditions, counts and messages to log; function breakpoints are conditions\n"
    "on signals, slave.velocity > 20 mm/s. VS Code's extension starts it; nvim-dap has it as an\n"
    "adapter {type = 'executable', command = 'lineshaft', args = {'debug'}}.";

struct DebugOptions {
    RunCommand run;
    std::string record, test;
};

struct DebugCommand {
    DebugOptions options;
    int port = -1;
};

/// One client's socket; -1, and said, if there is none.
int accept_one(int port) {
    const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int one = 1;
    ::setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &one, sizeof one);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const plain = reinterpret_cast<sockaddr*>(&address);
    int client = -1;
    if (::bind(listener, plain, size) == 0 && ::listen(listener, 1) == 0 &&
        ::getsockname(listener, plain, &size) == 0) {
        fmt::print(stderr, "waiting for a debugger at 127.0.0.1:{}\n", ntohs(address.sin_port));
        client = ::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC);
    }
    if (client < 0) spdlog::error("cannot wait at port {}: {}", port, std::strerror(errno));
    ::close(listener);
    return client;
}

void add_options(CLI::App& app, DebugOptions& options) {
    options.run.add_to(app);
    app.get_option("program")->required(false);
    app.add_option("--recording", options.run.recording,
                   "Do again what was done from outside, as a recording has it")
        ->type_name("FILE.yaml");
    app.add_option("--test", options.test,
                   "Run this TEST of the program, which is a file of tests or a folder with some: "
                   "its name, or the beginning of it")
        ->type_name("NAME");
    add_dialect(app);
    app.add_option("--record", options.record,
                   "Write what was changed by hand to this file, for --recording")
        ->type_name("FILE.yaml");
}

/// What `launch` says, in place of what the command line does.
void take_arguments(DebugOptions& options, const std::string& program,
                    std::vector<std::string> args, Diagnostics& out) {
    CLI::App app;
    add_options(app, options);
    RunCommand& command = options.run;
    std::ranges::reverse(args);
    try {
        app.parse(args);
    } catch (const CLI::ParseError& wrong) {
        out.add(code::unusable_option, {}, fmt::format("in the launch's 'args': {}", wrong.what()));
    }
    if (!program.empty()) command.program = program;
    if (command.program.empty())
        out.add(code::unusable_option, {}, "no program is named",
                "say \"program\": \"FILE.yaml\" in the launch's arguments");
    if (command.common.json || command.resume || command.restart == Restart::hot ||
        !command.checkpoint_every.empty())
        out.add(code::unusable_option, {}, "--json and checkpoints are not for a debugger",
                "leave --json, --resume and --checkpoint-every out");
}

struct FoundTest {
    st::TestSuite suite;
    std::size_t number = 0;  ///< there
    std::shared_ptr<const SourceFile> file;
};

/// The test of that name in a file of tests, or in a folder with such files, else the first that
/// begins so.
std::optional<FoundTest> find_test(const std::string& path, const std::string& name,
                                   Diagnostics& out) {
    std::optional<FoundTest> found;
    std::vector<std::string> names;
    std::string of_suites;
    for (const TestFile& tests : find_tests(path, {})) {
        if (runs_suites(tests)) {
            of_suites = tests.path;
            continue;
        }
        Diagnostics wrong;
        const auto file = read_source(tests.path, wrong);
        if (file && !tests.is_named && !has_tests(file)) continue;
        const auto suites = file ? compile_tests(tests, file, wrong) : std::vector<st::TestSuite>();
        for (const st::TestSuite& suite : suites)
            for (std::size_t i = 0; i < suite.tests().size(); ++i) {
                const std::string& each = suite.tests()[i].name;
                if (each == name) return FoundTest{suite, i, file};
                if (!found && each.starts_with(name)) found = FoundTest{suite, i, file};
                names.push_back(each);
            }
        if (tests.is_named && !wrong.empty()) return out = wrong, std::nullopt;
    }
    if (!found && !of_suites.empty())
        out.add(code::unusable_option, {},
                fmt::format("{} has suites of TcUnit, which its program runs", of_suites),
                fmt::format("write 'lineshaft new suites --from {}', and debug suites.yaml with a "
                            "breakpoint in the test",
                            of_suites));
    else if (!found)
        out.add(code::unusable_option, {}, fmt::format("{} has no TEST '{}'", path, name),
                fmt::format("there are: {}", fmt::join(names, ", ")));
    return found;
}

/// A machine whose first scan is the test.
std::optional<Loaded> load_test(const DebugOptions& options, Diagnostics& out) {
    const auto test = find_test(options.run.program, options.test, out);
    if (!test) return {};
    auto kinds = std::make_shared<Catalog>();
    for (const BlockType& kind : test->suite.kinds(test->number)) kinds->add(kind);
    std::string text =
        "lineshaft: 1\ntasks: {test: {every: 1 ms}}\nrun: {for: 0.5 ms}\nblocks:\n"
        "  TEST: {type: TEST, task: test}\n";
    for (const auto& [name, kind] : test->suite.objects())
        text += fmt::format("  {}: {{type: {}, task: test}}\n", name, yaml_name(kind));
    const auto program = std::make_shared<SourceFile>(SourceFile{"TEST.yaml", text});
    Loaded loaded{.program = read_program(program, {}, out), .linked = {}};
    loaded.program.file = test->file;
    loaded.linked = link(loaded.program, standard_blocks(), out, std::move(kinds));
    return loaded;
}

std::unique_ptr<debug::Launched> launch(DebugOptions options, const std::string& program,
                                        const std::vector<std::string>& args, std::string& error) {
    Diagnostics out;
    take_arguments(options, program, args, out);
    const RunCommand& command = options.run;
    RunOptions how = run_options(command, out);
    std::optional<Loaded> loaded;
    if (out.empty())
        loaded =
            options.test.empty() ? load(command, {options.record}, out) : load_test(options, out);
    if (!loaded || !out.empty()) {
        error = out.render();
        return {};
    }
    auto made = std::make_unique<debug::Launched>(
        debug::Launched{std::move(*loaded), std::move(how), {}, options.record});
    made->tell = [command, is_test = !options.test.empty(),
                  &program_run = made->loaded](const RunReport& report) {
        const Exit exit = tell(command, program_run, report);
        return static_cast<int>(is_test && exit == Exit::fault ? Exit::failed : exit);
    };
    return made;
}

Exit execute(const DebugCommand& command) {
    int in = STDIN_FILENO, out = -1;
    if (command.port >= 0) {
        in = out = accept_one(command.port);
        if (in < 0) return Exit::fault;
    } else {
        out = ::dup(STDOUT_FILENO);
    }
    // What the run prints is not for the protocol's stream.
    ::dup2(STDERR_FILENO, STDOUT_FILENO);
    Messages messages(in, out);
    const auto exit = static_cast<Exit>(debug::serve_debugger(
        messages, [&](const std::string& program, const auto& args, std::string& error) {
            return launch(command.options, program, args, error);
        }));
    return exit == Exit::fine && interrupt_requested ? Exit::interrupted : exit;
}

}  // namespace

void add_debug(CLI::App& app, Exit& result) {
    auto command = std::make_shared<DebugCommand>();
    CLI::App* sub = app.add_subcommand("debug", "Run a program under an editor's debugger");
    sub->footer(debug_help);
    add_options(*sub, command->options);
    sub->add_option("--port", command->port,
                    "Wait for one client at this port of 127.0.0.1 (0: any, which is told), not at "
                    "the standard streams")
        ->check(CLI::Range(0, 65535))
        ->type_name("PORT");
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
