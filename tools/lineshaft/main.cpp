#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <new>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <unistd.h>

#include "runtime/st/code/native/compile.hpp"
#include "runtime/version.hpp"
#include "tools/lineshaft/command.hpp"

namespace {

constexpr const char* out_of_memory = "lineshaft: error: out of memory\n";

std::int64_t now_ms() {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * std::int64_t{1000} + now.tv_nsec / 1'000'000;
}

/// The first signal asks for an end, a later one is the end. Some senders (`timeout`) send it twice
/// at once.
void on_signal(int) {
    constexpr std::int64_t apart_ms = 200;
    static std::atomic<std::int64_t> first_ms = 0;
    std::int64_t none = 0;
    const std::int64_t now = now_ms();
    if (!first_ms.compare_exchange_strong(none, now) && now - first_ms > apart_ms)
        ::_exit(static_cast<int>(lineshaft::Exit::interrupted));
    lineshaft::interrupt_requested = true;
}

/// A closed standard stream's number would go to the next file that is opened, and what is printed
/// into that file. What stands in for it takes nothing.
void occupy_closed_streams() {
    while (true) {
        const int descriptor = ::open("/dev/null", O_RDONLY);
        if (descriptor <= STDERR_FILENO && descriptor >= 0) continue;
        if (descriptor >= 0) ::close(descriptor);
        return;
    }
}

void set_up_signals() {
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    if (std::signal(SIGHUP, on_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // nohup
    std::signal(SIGPIPE, SIG_IGN);  // writing tells it
    std::signal(SIGXFSZ, SIG_IGN);  // likewise
}

/// The files of a run stay open until they get their names together, and a repeated trace has many.
void allow_many_files() {
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
    limit.rlim_cur = limit.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &limit);
}

/// A library that cannot go on without memory or a thread ends here, whatever it calls on its way.
[[noreturn]] void on_terminate() {
    try {
        if (const auto thrown = std::current_exception()) std::rethrow_exception(thrown);
    } catch (const std::bad_alloc&) {
        std::fputs(out_of_memory, stderr);
        std::_Exit(static_cast<int>(lineshaft::Exit::fault));
    } catch (const std::system_error& error) {
        std::fprintf(stderr, "lineshaft: error: %s\n", error.what());
        std::_Exit(static_cast<int>(lineshaft::Exit::fault));
    } catch (...) {
    }
    std::abort();
}

void set_up_messages() {
    spdlog::set_default_logger(spdlog::stderr_color_st("lineshaft"));
    spdlog::set_pattern("%n: %^%l%$: %v");
}

/// The one that is asked for alone, where that is known: making the options of all takes a third of
/// the instructions of a start.
void add_commands(CLI::App& app, std::string_view asked, lineshaft::Exit& result) {
    using namespace lineshaft;
    struct Command {
        std::string_view name;
        AddCommand add;
    };
    static constexpr Command commands[] = {
        {"new", add_new},       {"run", add_run},         {"serve", add_serve},
        {"debug", add_debug},   {"check", add_check},     {"test", add_test},
        {"study", add_study},   {"fit", add_fit},         {"blocks", add_blocks},
        {"form", add_form},     {"units", add_units},     {"states", add_states},
        {"schema", add_schema}, {"explain", add_explain}, {"plan", add_plan},
        {"diff", add_diff},     {"verify", add_verify},   {"contour", add_contour},
        {"report", add_report}, {"show", add_show},       {"plot", add_plot},
        {"lsp", add_lsp},       {"format", add_format}};
    if (asked == "--version") return;
    const auto named = std::ranges::find(commands, asked, &Command::name);
    if (named != std::end(commands)) return named->add(app, result);
    for (const Command& command : commands) command.add(app, result);
}

/// What is wrong with `word` as a command; empty when nothing is.
std::string unknown_command(const CLI::App& app, const std::string& word) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    if (std::ranges::find(names, word) != names.end()) return {};
    return fmt::format("there is no command '{}'; {}", word, lineshaft::suggest(word, names));
}

/// The option that is meant by one that is not known.
std::string meant_options(const CLI::App& command, const CLI::Error& error) {
    if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::ExtrasError)) return {};
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back(name);
    const std::string what = error.what();
    for (std::size_t at = what.find(" --"); at != what.npos; at = what.find(" --", at + 1)) {
        const std::string word = what.substr(at + 3, what.find(' ', at + 3) - at - 3);
        if (!lineshaft::nearest(word, names).empty())
            return "; " + lineshaft::suggest(word, names, "--");
    }
    return {};
}

std::string wrong_command_line(const CLI::App& app, const CLI::Error& error) {
    const auto asked = app.get_subcommands();
    const CLI::App& command = asked.empty() ? app : *asked.front();
    return fmt::format("lineshaft: error: {}{}\nlineshaft {}{}--help says more.\n", error.what(),
                       meant_options(command, error), asked.empty() ? "" : command.get_name(),
                       asked.empty() ? "" : " ");
}

/// The exit code.
std::string cannot_print(int error) {
    return fmt::format("cannot write to the standard output: {}", std::strerror(error));
}

int run_command(int argc, char** argv) {
    using namespace lineshaft;
    set_up_messages();
    CLI::App app{
        "A PLC soft-runtime for motion control: runs YAML programs scan by scan in virtual time.",
        "lineshaft"};
    app.set_version_flag("--version", fmt::format("lineshaft {} ({})", version(), LINESHAFT_BUILD));
    app.require_subcommand(1);
    app.footer(
        "Exit codes: 0 fine, 1 an expectation failed, 2 the program or the command line is wrong,\n"
        "3 a fault while running, 130 interrupted, 141 nobody reads what is printed.\n"
        "`lineshaft COMMAND --help` says more.");
    Exit result = Exit::fine;
    add_commands(app, argc > 1 ? argv[1] : "", result);
    if (argc > 1 && argv[1][0] != '-') {
        if (const std::string message = unknown_command(app, argv[1]); !message.empty()) {
            spdlog::error("{}", message);
            return static_cast<int>(Exit::wrong);
        }
    }
    app.failure_message([](const CLI::App* asked, const CLI::Error& error) {
        return wrong_command_line(*asked, error);
    });
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : static_cast<int>(Exit::wrong);
    }
    st::end_compiling();
    if (st::is_native_refused())
        spdlog::warn(
            "the system refuses executable memory: Structured Text was interpreted, which "
            "is slower; --no-native says so from the start");
    if (std::fflush(stdout) != 0) {
        if (is_unread()) return static_cast<int>(Exit::unread);
        spdlog::error("{}", cannot_print(errno));
        return static_cast<int>(Exit::fault);
    }
    return static_cast<int>(result);
}

}  // namespace

int main(int argc, char** argv) {
    occupy_closed_streams();
    set_up_signals();
    allow_many_files();
    std::set_terminate(on_terminate);
    try {
        return run_command(argc, argv);
    } catch (const std::bad_alloc&) {
        std::fputs(out_of_memory, stderr);
    } catch (const std::system_error& error) {
        if (lineshaft::is_unread()) return static_cast<int>(lineshaft::Exit::unread);
        const bool is_print = std::string_view(error.what()).starts_with("cannot write to file");
        std::fprintf(stderr, "lineshaft: error: %s\n",
                     is_print ? cannot_print(error.code().value()).c_str() : error.what());
    } catch (const std::exception& error) {
        if (lineshaft::is_unread()) return static_cast<int>(lineshaft::Exit::unread);
        std::fprintf(stderr, "lineshaft: error: %s\n", error.what());
    }
    return static_cast<int>(lineshaft::Exit::fault);
}
